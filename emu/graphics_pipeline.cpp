// SPDX-License-Identifier: Apache-2.0
#include "emu/graphics_pipeline.h"

namespace tessemu {

namespace {

void require(bool holds, char const* what)
{
    if (!holds) throw Error(what);
}

void check_limit(std::string const& thing, int value, int limit)
{
    if (value > limit) throw LimitError(thing, std::uint64_t(value), std::uint64_t(limit));
}

constexpr int kMaxRegisters = 32; // of four components, in and out of every stage (R44, R81)

} // namespace

GraphicsPipeline::GraphicsPipeline(GraphicsPipelineDesc desc) : desc_(std::move(desc))
{
    auto const& d = desc_;
    require(d.vertex_shader != nullptr, "a pipeline needs a vertex shader");
    require((d.hull_shader == nullptr) == (d.domain_shader == nullptr),
            "hull shader and domain shader must be bound together (R3)");
    check_limit("vertex shader input scalars", d.vertex_shader->input_floats(), 4 * kMaxRegisters);
    check_limit("vertex shader output scalars", d.vertex_shader->output_floats(),
                4 * kMaxRegisters);

    int shaded = d.vertex_shader->output_floats();
    if (d.hull_shader) {
        HullProgram const& hs = *d.hull_shader;
        DomainProgram const& ds = *d.domain_shader;
        require(d.input_control_points >= 1, "a patch needs at least 1 control point");
        check_limit("control points per patch", d.input_control_points, kMaxControlPoints);
        check_limit("output control points", hs.control_points(), kMaxControlPoints);
        check_limit("scalars of all output control points",
                    hs.control_points() * hs.control_point_floats(), kMaxHullOutputScalars);
        check_limit("scalars of patch constants, tess factors included",
                    hs.patch_constants() * hs.patch_constant_floats() +
                        tess_factor_count(hs.domain()),
                    kMaxPatchConstantScalars);
        check_limit("fork instances", hs.patch_constants(), 128);
        check_limit("domain shader output scalars", ds.output_floats(), 4 * kMaxRegisters);
        require(hs.input_floats() == d.vertex_shader->output_floats(),
                "the hull shader's input control point is not the vertex shader's output");
        require(hs.domain() == ds.domain(), "hull and domain shader differ in their domain (R79)");
        require(hs.control_points() == ds.control_points(),
                "hull and domain shader differ in their number of control points");
        require(hs.control_point_floats() == ds.control_point_floats() &&
                    hs.patch_constant_floats() == ds.patch_constant_floats(),
                "hull and domain shader differ in their records");
        bool const isoline = ds.domain() == TessellatorDomain::Isoline;
        bool const line = d.output_primitive == OutputPrimitive::Line;
        require(d.output_primitive == OutputPrimitive::Point || isoline == line,
                "lines come from isolines and triangles from quad and tri domains (R75)");
        shaded = ds.output_floats();
    }
    if (d.geometry_shader) {
        GeometryProgram const& gs = *d.geometry_shader;
        require(gs.input_floats() == shaded,
                "the geometry shader's input vertex is not the output of the stage before it");
        check_limit("geometry shader output scalars", gs.output().floats, 4 * kMaxRegisters);
        check_limit("scalars that a geometry shader invocation may emit",
                    gs.max_vertices() * gs.output().floats, kMaxGeometryScalars);
        check_limit("geometry shader instances", gs.instances(), kMaxGeometryInstances);
        check_limit("vertices of all geometry shader instances", gs.instances() * gs.max_vertices(),
                    kMaxGeometryScalars);
        if (d.hull_shader) {
            auto const wanted =
                d.output_primitive == OutputPrimitive::Point  ? PrimitiveTopology::PointList
                : d.output_primitive == OutputPrimitive::Line ? PrimitiveTopology::LineList
                                                              : PrimitiveTopology::TriangleList;
            require(gs.input_topology() == wanted,
                    "the geometry shader does not take what the tessellator puts out (R82)");
        }
        shaded = gs.output().floats;
    }
    if (d.stream_output) {
        check_stream_output(*d.stream_output, shaded);
        bool several = false;
        for (StreamOutputEntry const& e : d.stream_output->entries) several |= e.stream > 0;
        require(!several || (d.geometry_shader &&
                             d.geometry_shader->output_topology() == GeometryOutput::PointList),
                "more than one stream needs a geometry shader that puts out points (R86)");
    }
    if (d.pixel_shader) {
        require(d.pixel_shader->input_floats() + 4 <= shaded,
                "the pixel shader reads more attributes than the stage before it writes");
        check_limit("colour targets of the pixel shader", d.pixel_shader->info().color_targets,
                    int(kMaxRenderTargets));
    }
}

} // namespace tessemu
