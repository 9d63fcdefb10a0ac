// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/patch_mesh.h"

#include "pipeline/commands/displacement.h"
#include "pipeline/commands/subdivision.h"

#include <cassert>

namespace tessemu {

AnotherWay another_way_of(std::size_t patches, std::uint32_t first_face, std::string const& what)
{
    return {first_face,
            std::to_string(patches) + (patches == 1 ? " patch has " : " patches have ") + what};
}

void VertexSource::bind(DrawCall& call) const
{
    call.set_vertices(floats, read);
    call.vertex_buffers[0].stride = std::uint32_t(stride) * sizeof(float);
    if (normals.empty()) return;
    constexpr std::uint32_t kStride = 3 * PoleNormalShader::kVectors * sizeof(float);
    call.vertex_buffers.push_back({std::as_bytes(normals), kStride, 0});
    call.layout.push_back({Format::R32G32B32_FLOAT, 3, 1, 0, false, 1});
}

VertexSource positions_of(ControlMesh const& mesh)
{
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    return {{&mesh.positions.data()->x, mesh.positions.size() * 3}, 3, 3};
}

SkinBuffers skin_of(Pose const& pose)
{
    return {{pose.skin->vertices, 0, "skin"}, {pose.bones, 1, "bones"}};
}

namespace {

// To the front of `points`, vertices of RWVectorBuffer::kStride floats.
void add_skinning(CommandList& list, ControlMesh const& base, SurfaceSettings const& settings,
                  std::span<float> points, std::array<float, 3> const& origin)
{
    constexpr std::size_t kStride = RWVectorBuffer::kStride;
    std::size_t const vertices = base.positions.size();
    SkinningComputeShader cs;
    cs.skin = skin_of(*settings.pose);
    cs.rest = {positions_of(base).floats, 2, "rest_positions"};
    cs.moved = {points.first(vertices * kStride), 3, "moved_positions"};
    cs.stride = int(kStride);
    cs.origin = origin;
    list.commands.emplace_back(
        Dispatch{"skinning", bind_compute_shader(cs, settings.machine), groups_for(vertices, 64)});
}

} // namespace

VertexSource add_file_vertices(CommandList& list, ControlMesh const& base,
                               SurfaceSettings const& settings)
{
    if (!settings.pose) return positions_of(base);
    constexpr std::size_t kStride = RWVectorBuffer::kStride;
    auto const points = std::make_shared<std::vector<float>>(base.positions.size() * kStride);
    list.memory.push_back(points);
    add_skinning(list, base, settings, *points, {});
    return {*points, 3, int(kStride)};
}

VertexSource add_vertices(CommandList& list, RefinedMesh const& refined,
                          SurfaceSettings const& settings, std::size_t texels,
                          std::array<float, 3> const& origin)
{
    ControlMesh const& base = refined.base();
    if (!settings.pose && refined.steps() == 0 && origin == std::array<float, 3>{})
        return positions_of(base);
    constexpr std::size_t kStride = RWVectorBuffer::kStride;
    std::size_t const vertices = base.positions.size(),
                      first = refined.steps() ? refined.tables().back().first_face_point() : 0,
                      drawn = refined.mesh().positions.size();
    auto const points =
        std::make_shared<std::vector<float>>((first + std::max(drawn, texels)) * kStride);
    list.memory.push_back(points);
    if (settings.pose) {
        add_skinning(list, base, settings, *points, origin);
    } else {
        for (std::size_t v = 0; v < vertices; ++v)
            for (int k = 0; k < 3; ++k)
                (*points)[v * kStride + std::size_t(k)] =
                    base.positions[v][k] - origin[std::size_t(k)];
    }
    add_subdivision(list, refined.tables(), *points, settings.machine);
    return {std::span(*points).subspan(first * kStride), 3, int(kStride)};
}

VertexSource file_vertices(RefinedMesh const& mesh, VertexSource const& drawn)
{
    assert(mesh.steps() > 0);
    // At the front of the buffer whose end is drawn.
    constexpr std::size_t kStride = RWVectorBuffer::kStride;
    std::size_t const before = mesh.tables().back().first_face_point() * kStride;
    return {
        {drawn.floats.data() - before, mesh.base().positions.size() * kStride}, 3, int(kStride)};
}

std::span<float const> add_pole_normals(CommandList& list, Poles const& poles,
                                        VertexSource const& positions, Machine const& machine,
                                        char const* name)
{
    if (poles.empty()) return {};
    auto const normals =
        std::make_shared<std::vector<float>>(3 * PoleNormalShader::kVectors * poles.size());
    list.memory.push_back(normals);
    PoleNormalShader cs;
    cs.first = {poles.first, 0, "pole_starts"};
    std::uint32_t const* const faces = poles.faces.empty() ? nullptr : poles.faces.front().data();
    cs.faces = {{faces, 4 * poles.faces.size()}, 1, "pole_faces"};
    cs.positions = {positions.floats, 2, "positions"};
    cs.normals = {*normals, 3, "pole_normals"};
    cs.stride = positions.stride;
    list.commands.emplace_back(
        Dispatch{name, bind_compute_shader(cs, machine), groups_for(poles.size(), 64)});
    return *normals;
}

void add_patch_draw(CommandList& list, PatchDraw const& d, SurfaceSettings const& settings)
{
    Draw out;
    out.name = d.kind.name;
    out.kind = d.kind;
    out.patches = d.patches;
    GraphicsPipelineDesc& desc = out.pipeline;
    desc.vertex_shader = d.vertex_shader;
    desc.hull_shader = d.hull_shader;
    desc.domain_shader = d.domain_shader;
    if (settings.curvature && settings.displacement)
        throw Error("curvature is that of the smooth surface: it is not shown of a displaced one");
    if (d.domain_shader->output().holds<CurvedPoint<float>>()) {
        desc.domain_epilog =
            bind_domain_epilog(CurvedProjectionEpilog{settings.view_projection}, settings.machine);
    } else {
        SurfaceEpilog epilog = make_surface_epilog(d.patches, settings);
        desc.domain_epilog = std::visit(
            [&](auto const& e) { return bind_domain_epilog(e, settings.machine); }, epilog.shader);
        list.memory.push_back(std::move(epilog.memory));
    }
    desc.partitioning = settings.partitioning;
    desc.output_primitive = OutputPrimitive::TriangleCw;
    desc.input_control_points = d.control_points;
    out.call.control_points = d.control_points;
    d.vertices.bind(out.call);
    out.call.indices = d.indices;
    list.commands.emplace_back(std::move(out));
    list.memory.push_back(settings.pose);
}

namespace {

// Vertices of the file at a boundary edge that is not infinitely sharp. Of a vertex that was cut
// into several all are at it.
std::vector<std::uint32_t> soft_boundary(Topology const& topology)
{
    ControlMesh const& mesh = topology.mesh();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sharp;
    for (ControlMesh::Crease const& c : mesh.creases)
        if (c.sharpness >= kInfinitelySharp) sharp.push_back(ordered_edge(c.a, c.b));
    std::sort(sharp.begin(), sharp.end());
    std::vector<std::uint32_t> out;
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        if (topology.twin(h) != Topology::kNone) continue;
        std::uint32_t const a = topology.vertex_of(h), b = topology.vertex_of(topology.next(h));
        if (std::binary_search(sharp.begin(), sharp.end(), ordered_edge(a, b))) continue;
        out.push_back(mesh.file_vertex(a));
        out.push_back(mesh.file_vertex(b));
    }
    std::sort(out.begin(), out.end());
    return out;
}

} // namespace

std::vector<char> hidden_faces(RefinedMesh const& refined, std::vector<std::string>& warnings)
{
    ControlMesh const& base = refined.base();
    std::vector<char> hidden(base.faces(), 0);
    for (std::uint32_t f : base.holes) hidden[f] = 1;
    if (base.rules.boundary == BoundaryRule::None) {
        std::vector<std::uint32_t> const soft = soft_boundary(refined.base_topology());
        std::size_t dropped = 0;
        for (std::uint32_t f = 0; f < base.faces(); ++f)
            for (std::uint32_t v : base.face(f))
                if (!hidden[f] && std::binary_search(soft.begin(), soft.end(), base.file_vertex(v)))
                    hidden[f] = 1, ++dropped;
        if (dropped)
            warnings.push_back(std::to_string(dropped) +
                               " faces at the boundary are not drawn: interpolateboundary is 0");
    }
    std::vector<char> out(refined.mesh().faces());
    for (std::uint32_t f = 0; f < out.size(); ++f) out[f] = hidden[refined.place(f).face];
    return out;
}

DrawnMesh drawn_mesh(RefinedMesh const& refined, SurfaceSettings const& settings,
                     ThreadPool const& threads)
{
    CommandList list;
    VertexSource const points = add_vertices(list, refined, settings);
    DrawnMesh out{refined.mesh(), run_commands(list, threads)};
    for (std::size_t v = 0; v < out.mesh.positions.size(); ++v) {
        float const* const p = points.floats.data() + v * std::size_t(points.stride);
        out.mesh.positions[v] = {p[0], p[1], p[2]};
    }
    if (refined.steps() == 0 || out.mesh.rules.boundary != BoundaryRule::None) return out;
    std::vector<std::string> warnings;
    std::vector<char> const hidden = hidden_faces(refined, warnings);
    out.mesh.holes.clear();
    for (std::uint32_t f = 0; f < hidden.size(); ++f)
        if (hidden[f]) out.mesh.holes.push_back(f);
    return out;
}

} // namespace tessemu
