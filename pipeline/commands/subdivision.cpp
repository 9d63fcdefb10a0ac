// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/subdivision.h"

#include "pipeline/forms/programs.h"

namespace tessemu {

namespace {

void add_step(CommandList& list, SubdivisionTables const& t, std::span<float> points,
              std::string const& step, Machine const& machine)
{
    auto const add = [&](char const* what, auto const& shader, std::size_t threads) {
        if (threads)
            list.commands.emplace_back(Dispatch{what + step, bind_compute_shader(shader, machine),
                                                groups_for(threads, shader.kThreads[0])});
    };
    // The step sees no further than its own points.
    std::span<float> const seen =
        points.first(std::size_t(t.buffer_size()) * RWVectorBuffer::kStride);
    auto const new_points = [&](int slot, std::uint32_t first, std::size_t count) {
        return NewPoints{{seen, slot, "vertices"}, std::int32_t(first), std::int32_t(count)};
    };
    std::size_t const edge_rows = t.edge_index.size() / 4,
                      vertex_rows = t.vertex_offset_valence.size() / 2,
                      face_rows = t.face_offset_valence.size() / 2,
                      quad_rows = face_rows ? 0 : t.face_index.size() / 4,
                      blended_rows = t.blended.target.size();
    FacePointShader faces;
    faces.offset_valence = {t.face_offset_valence, 0, "face_offset_valence"};
    faces.index = {t.face_index, 1, "face_index"};
    faces.out = new_points(2, t.first_face_point(), face_rows);
    add("face points", faces, face_rows);
    EdgePointShader quads;
    quads.index = {t.face_index, 0, "face_index"};
    quads.out = new_points(1, t.first_face_point(), quad_rows);
    add("face points", quads, quad_rows);
    EdgePointShader edges;
    edges.index = {t.edge_index, 0, "edge_index"};
    edges.out = new_points(1, t.first_edge_point(), edge_rows);
    add("edge points", edges, edge_rows);
    VertexPointShader vertices;
    vertices.offset_valence = {t.vertex_offset_valence, 0, "vertex_offset_valence"};
    vertices.index = {t.vertex_index, 1, "vertex_index"};
    vertices.from_new_to_old = std::int32_t(t.new_points());
    vertices.out = new_points(2, t.first_vertex_point(), vertex_rows);
    add("vertex points", vertices, vertex_rows);
    BlendedPointShader blended;
    blended.target = {t.blended.target, 0, "blended_targets"};
    blended.first = {t.blended.first, 1, "blended_starts"};
    blended.index = {t.blended.points, 2, "blended_points"};
    blended.weights = {t.blended.weights, 3, "blended_weights"};
    blended.points = {seen, 4, "vertices"};
    blended.count = std::int32_t(blended_rows);
    add("blended points", blended, blended_rows);
}

} // namespace

void add_subdivision(CommandList& list, std::span<SubdivisionTables const> tables,
                     std::span<float> points, Machine const& machine)
{
    int step = 0;
    for (SubdivisionTables const& t : tables)
        add_step(list, t, points, ", step " + std::to_string(++step), machine);
}

} // namespace tessemu
