// SPDX-License-Identifier: Apache-2.0
#include "pipeline/technique.h"

#include "pipeline/acc_technique.h"
#include "pipeline/catmull_clark.h"
#include "pipeline/displacement.h"
#include "pipeline/gregory_stencil_technique.h"
#include "pipeline/gregory_two_stage_technique.h"
#include "pipeline/pm_technique.h"

#include <algorithm>

namespace tessemu {

std::vector<std::unique_ptr<Technique>> const& techniques()
{
    static std::vector<std::unique_ptr<Technique>> const all = [] {
        std::vector<std::unique_ptr<Technique>> t;
        t.push_back(make_gregory_stencil_technique());
        t.push_back(make_gregory_two_stage_technique());
        t.push_back(make_acc_technique());
        t.push_back(make_pm_technique());
        return t;
    }();
    return all;
}

Technique const& find_technique(std::string_view name)
{
    std::string known;
    for (auto const& t : techniques()) {
        if (t->info().name == name) return *t;
        known += (known.empty() ? "" : ", ") + t->info().name;
    }
    throw Error("scheme '" + std::string(name) + "' is not known; there is " + known);
}

FacePoint domain_to_face(PatchOrigin const& origin, float u, float v)
{
    if (origin.sides == 3) {
        float const weight[3] = {u, v, 1 - u - v};
        return {weight[(3 - origin.rotation) % 3], weight[(4 - origin.rotation) % 3]};
    }
    switch (origin.rotation) {
    case 1:
        return {1 - v, u};
    case 2:
        return {1 - u, 1 - v};
    case 3:
        return {v, 1 - u};
    default:
        return {u, v};
    }
}

DrawPass make_patch_pass(PatchKind const& kind, ControlMesh const& mesh, int control_points,
                         std::span<std::uint32_t const> indices,
                         std::span<PatchOrigin const> patches,
                         std::shared_ptr<VertexProgram const> vertex,
                         std::shared_ptr<HullProgram const> hull,
                         std::shared_ptr<DomainProgram const> domain, PassSettings const& settings)
{
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    GraphicsPipelineDesc desc;
    desc.vertex_shader = std::move(vertex);
    desc.hull_shader = std::move(hull);
    PatchEpilog epilog = make_patch_epilog(
        mesh, patches, {settings.view_projection, settings.parity, settings.lattice},
        settings.displacement, settings.machine);
    desc.domain_shader = with_epilog(std::move(domain), std::move(epilog.program));
    if (settings.pixel_shader) desc.pixel_shader = settings.pixel_shader(kind);
    desc.partitioning = settings.partitioning;
    desc.output_primitive = OutputPrimitive::TriangleCw;
    desc.input_control_points = control_points;
    DrawCall call;
    call.control_points = control_points;
    call.set_vertices({&mesh.positions.data()->x, mesh.positions.size() * 3}, 3);
    call.indices = indices;
    DrawPass pass{kind, GraphicsPipeline(std::move(desc)), call, patches, {}, {}, {}, {}};
    pass.memory = {std::move(epilog.memory), settings.pose};
    return pass;
}

namespace {

// Patches of an instanced pass: every vertex as a streamed-out point, instance after instance.
DrawStatistics visit_instances(DrawPass const& pass, PatchVisitor const& visit,
                               ThreadPool const& threads, DrawOptions options)
{
    std::size_t const points = pass.pattern->patch.points(), patches = pass.call.instance_count;
    GraphicsPipelineDesc desc = pass.pipeline.desc();
    auto const floats = std::size_t(desc.vertex_shader->output_floats());
    desc.pixel_shader = {};
    desc.stream_output.emplace();
    desc.stream_output->rasterized_stream = -1;
    for (std::size_t k = 0; k < floats; k += 4)
        desc.stream_output->entries.push_back(
            {0, std::int16_t(k), std::uint8_t(std::min<std::size_t>(4, floats - k)), 0});
    DrawCall call = pass.call;
    call.topology = PrimitiveTopology::PointList;
    call.indices = {};
    call.vertex_count = std::uint32_t(points);
    std::vector<float> vertices(patches * points * floats), patch(points * floats);
    StreamOutputBuffer buffer{std::as_writable_bytes(std::span(vertices)), 0};
    options.stream_output = std::span(&buffer, 1);
    DrawStatistics const statistics =
        draw(GraphicsPipeline(std::move(desc)), call, nullptr, {}, threads, options);
    for (std::size_t p = 0; p < patches; ++p) {
        for (std::size_t i = 0; i < points; ++i)
            for (std::size_t k = 0; k < floats; ++k)
                patch[k * points + i] = vertices[(p * points + i) * floats + k];
        visit({std::uint32_t(p), pass.pattern.get(), patch.data(), points});
    }
    return statistics;
}

} // namespace

DrawStatistics draw_pass(DrawPass const& pass, RasterTarget const* raster,
                         PatchVisitor const& visit, ThreadPool const& threads,
                         DrawOptions const& options)
{
    DrawStatistics s;
    if (pass.prepare) s += pass.prepare(threads, options.vertex_cache);
    if (pass.pattern && visit) {
        s += visit_instances(pass, visit, threads, options);
        if (!raster) return s;
    }
    DrawOptions with_mistakes = options;
    with_mistakes.mistakes = pass.mistakes;
    s += draw(pass.pipeline, pass.call, raster, pass.pattern ? PatchVisitor{} : visit, threads,
              with_mistakes);
    return s;
}

std::vector<char> hidden_faces(Topology const& topology, std::vector<std::string>& warnings)
{
    ControlMesh const& mesh = topology.mesh();
    std::vector<char> hidden(mesh.faces(), 0);
    for (std::uint32_t f : mesh.holes) hidden[f] = 1;
    if (mesh.boundary != BoundaryRule::None) return hidden;
    std::size_t dropped = 0;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f)
        for (std::uint32_t v : mesh.face(f))
            if (topology.is_boundary(v) && !hidden[f]) hidden[f] = 1, ++dropped;
    if (dropped)
        warnings.push_back(std::to_string(dropped) +
                           " faces at the boundary are not drawn: interpolateboundary is 0");
    return hidden;
}

void warn_of_tags(ControlMesh const& mesh, std::vector<std::string>& warnings)
{
    if (!mesh.creases.empty())
        warnings.push_back(std::to_string(mesh.creases.size()) +
                           " crease edges are drawn smooth: the scheme knows no creases");
    if (!mesh.corners.empty())
        warnings.push_back(std::to_string(mesh.corners.size()) +
                           " sharp corners are drawn smooth: the scheme knows no corners");
}

PreparedMesh prepare_mesh(ControlMesh mesh, Technique const& technique)
{
    PreparedMesh out;
    out.mesh = std::make_unique<ControlMesh>(std::move(mesh));
    out.topology = std::make_unique<Topology>(*out.mesh);
    std::size_t largest = 0, polygons = 0;
    for (std::size_t f = 0; f < out.mesh->faces(); ++f) {
        largest = std::max(largest, out.mesh->face(f).size());
        if (out.mesh->face(f).size() > 4) ++polygons;
    }
    if (polygons > 0 && !technique.takes_polygons()) {
        auto split = std::make_unique<ControlMesh>(catmull_clark_step(*out.topology));
        out.warnings.push_back(std::to_string(polygons) + " faces have more than 4 sides (up to " +
                               std::to_string(largest) + "): one Catmull-Clark step makes " +
                               std::to_string(split->faces()) + " quads of the mesh's " +
                               std::to_string(out.mesh->faces()) + " faces");
        out.topology = std::make_unique<Topology>(*split);
        out.mesh = std::move(split);
    }
    return out;
}

} // namespace tessemu
