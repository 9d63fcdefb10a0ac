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

std::vector<ResourceInfo> GraphicsPipelineDesc::domain_resources() const
{
    std::vector<ResourceInfo> all = domain_shader.resources();
    for (ResourceInfo& r : domain_epilog.resources()) all.push_back(std::move(r));
    return all;
}

GraphicsPipeline::GraphicsPipeline(GraphicsPipelineDesc desc) : desc_(std::move(desc))
{
    auto const& d = desc_;
    require(bool(d.vertex_shader), "a pipeline needs a vertex shader");
    require(bool(d.hull_shader) == bool(d.domain_shader),
            "hull shader and domain shader must be bound together (R3)");
    require(!d.domain_epilog || d.domain_shader, "an epilog needs a domain shader");
    check_limit("vertex shader input scalars", d.vertex_shader->input_floats(), 4 * kMaxRegisters);
    check_limit("vertex shader output scalars", d.vertex_shader->output_floats(),
                4 * kMaxRegisters);

    int shaded = d.vertex_shader->output_floats();
    if (d.hull_shader) {
        HullProgram const& hs = d.hull_shader.program();
        DomainProgram const& ds = d.domain_shader.program();
        int const points = d.hull_shader.control_points(),
                  constants = d.hull_shader.patch_constants();
        require(d.input_control_points >= 1, "a patch needs at least 1 control point");
        check_limit("control points per patch", d.input_control_points, kMaxControlPoints);
        check_limit("output control points", points, kMaxControlPoints);
        check_limit("scalars of all output control points", points * hs.control_point_floats(),
                    kMaxHullOutputScalars);
        check_limit("scalars of patch constants, tess factors included",
                    constants * hs.patch_constant_floats() + tess_factor_count(hs.domain()),
                    kMaxPatchConstantScalars);
        check_limit("fork instances", constants, 128);
        if (d.domain_epilog) {
            int const in = d.domain_epilog->input_floats(), out = d.domain_epilog->output().floats;
            if (ds.output_floats() != in)
                throw Error("the domain shader gives " + std::to_string(ds.output_floats()) +
                            " scalars, its epilog takes " + std::to_string(in));
            if (out < in) // outputs replace inputs in place
                throw Error("a domain shader's epilog gives " + std::to_string(out) +
                            " scalars, at least the " + std::to_string(in) +
                            " that it takes are needed");
        }
        check_limit("domain shader output scalars", d.domain_output().floats, 4 * kMaxRegisters);
        require(hs.input_floats() == d.vertex_shader->output_floats(),
                "the hull shader's input control point is not the vertex shader's output");
        require(hs.domain() == ds.domain(), "hull and domain shader differ in their domain (R79)");
        require(ds.control_points() == 0 || ds.control_points() == points,
                "hull and domain shader differ in their number of control points");
        require(hs.control_point_floats() == ds.control_point_floats() &&
                    hs.patch_constant_floats() == ds.patch_constant_floats(),
                "hull and domain shader differ in their records");
        bool const isoline = ds.domain() == TessellatorDomain::Isoline;
        bool const line = d.output_primitive == OutputPrimitive::Line;
        require(d.output_primitive == OutputPrimitive::Point || isoline == line,
                "lines come from isolines and triangles from quad and tri domains (R75)");
        shaded = d.domain_output().floats;
    }
    if (d.geometry_shader) {
        GeometryProgram const& gs = d.geometry_shader.program();
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

bool rasterization_is_on(GraphicsPipelineDesc const& d, RasterTarget const* t)
{
    if (!t || (d.stream_output && d.stream_output->rasterized_stream < 0)) return false;
    return bool(d.pixel_shader) || t->depth_stencil.depth_enable || t->depth_stencil.stencil_enable;
}

void check_draw(GraphicsPipelineDesc const& d, DrawCall const& call, RasterTarget const* target,
                std::size_t stream_output_buffers)
{
    check_draw_call(call);
    if (call.vertex_floats() != d.vertex_shader->input_floats())
        throw Error("the input layout gives " + std::to_string(call.vertex_floats()) +
                    " scalars, the vertex shader reads " +
                    std::to_string(d.vertex_shader->input_floats()));
    bool const patches = call.topology == PrimitiveTopology::PatchList;
    if (d.hull_shader && !patches) throw Error("a hull shader needs a patch list (R3)");
    if (patches && (call.control_points < 1 || call.control_points > kMaxControlPoints))
        throw LimitError("control points per patch", std::uint64_t(call.control_points),
                         kMaxControlPoints);
    if (patches && !d.hull_shader && !d.geometry_shader && rasterization_is_on(d, target))
        throw Error("a patch list cannot be rasterized without hull and domain shader (R4)");
    if (d.hull_shader && call.control_points != d.input_control_points)
        throw Error("the draw has " + std::to_string(call.control_points) +
                    " control points per patch, the pipeline was created for " +
                    std::to_string(d.input_control_points));
    if (d.geometry_shader && !d.hull_shader &&
        vertices_per_primitive(call.topology, call.control_points) !=
            d.geometry_shader->input_vertices())
        throw Error("the topology has " +
                    std::to_string(vertices_per_primitive(call.topology, call.control_points)) +
                    " vertices per primitive, the geometry shader takes " +
                    std::to_string(d.geometry_shader->input_vertices()));
    if (stream_output_buffers > kMaxStreamOutputBuffers)
        throw LimitError("stream output buffers", stream_output_buffers, kMaxStreamOutputBuffers);
    if (!target) return;
    auto const limit = [](char const* thing, std::size_t value, std::size_t most) {
        if (value > most) throw LimitError(thing, value, most);
    };
    limit("render targets", target->color.size(), kMaxRenderTargets);
    limit("viewports", target->viewports.size(), kMaxViewports);
    limit("scissor rectangles", target->scissors.size(), kMaxViewports);
    for (Viewport const& v : target->viewports) {
        bool const depth = 0 <= v.min_depth && v.min_depth <= v.max_depth && v.max_depth <= 1;
        auto const inside = [](float p) { return p >= -32768 && p <= 32767; };
        if (!depth || v.width < 0 || v.height < 0 || !inside(v.x) || !inside(v.y) ||
            !inside(v.x + v.width) || !inside(v.y + v.height))
            throw Error("a viewport must lie within -32768 to 32767 and its depths within 0 to 1 "
                        "(R97)");
    }
    int width = 0, height = 0, samples = 0;
    auto const same = [&](int w, int h, int s) {
        if (samples == 0) width = w, height = h, samples = s;
        if (w != width || h != height || s != samples)
            throw Error("targets differ in size or samples: " + std::to_string(w) + "x" +
                        std::to_string(h) + "x" + std::to_string(s) + " beside " +
                        std::to_string(width) + "x" + std::to_string(height) + "x" +
                        std::to_string(samples));
    };
    for (ColorTarget const* c : target->color)
        if (c) same(c->width(), c->height(), c->samples());
    if (target->depth)
        same(target->depth->width(), target->depth->height(), target->depth->samples());
    if (target->coverage)
        same(target->coverage->width, target->coverage->height, target->coverage->samples);
}

} // namespace tessemu
