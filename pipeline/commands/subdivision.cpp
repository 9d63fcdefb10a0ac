// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/subdivision.h"

#include "pipeline/forms/programs.h"

namespace tessemu {

namespace {

void add_step(CommandList& list, SubdivisionTables const& t, RWVectorBuffer const& points,
              std::string const& step, Machine const& machine)
{
    auto const add = [&](char const* what, auto const& shader, std::uint32_t threads) {
        if (threads)
            list.commands.emplace_back(Dispatch{what + step, bind_compute_shader(shader, machine),
                                                groups_for(threads, shader.kThreads[0])});
    };
    auto const bound = [&](int slot) {
        return RWVectorBuffer(points.floats(), points.stride(), slot, "vertices");
    };
    auto const new_points = [&](int slot, std::uint32_t first, std::uint32_t count) {
        return NewPoints{bound(slot), std::int32_t(first), std::int32_t(count)};
    };
    if (t.face_offset_valence.empty()) {
        EdgePointShader faces;
        faces.index = {t.face_index, 0, "face_index"};
        faces.out = new_points(1, t.first_face_point(), t.faces);
        add("face points", faces, t.faces);
    } else {
        FacePointShader faces;
        faces.offset_valence = {t.face_offset_valence, 0, "face_offset_valence"};
        faces.index = {t.face_index, 1, "face_index"};
        faces.out = new_points(2, t.first_face_point(), t.faces);
        add("face points", faces, t.faces);
    }
    EdgePointShader edges;
    edges.index = {t.edge_index, 0, "edge_index"};
    edges.out = new_points(1, t.first_edge_point(), t.edges);
    add("edge points", edges, t.edges);
    VertexPointShader vertices;
    vertices.offset_valence = {t.vertex_offset_valence, 0, "vertex_offset_valence"};
    vertices.index = {t.vertex_index, 1, "vertex_index"};
    vertices.from_new_to_old = std::int32_t(t.new_points());
    vertices.out = new_points(2, t.first_vertex_point(), t.vertices);
    add("vertex points", vertices, t.vertices);
    auto const rows = std::uint32_t(t.blended.target.size());
    BlendedPointShader blended;
    blended.target = {t.blended.target, 0, "blended_targets"};
    blended.first = {t.blended.first, 1, "blended_starts"};
    blended.index = {t.blended.points, 2, "blended_points"};
    blended.weights = {t.blended.weights, 3, "blended_weights"};
    blended.points = bound(4);
    blended.count = std::int32_t(rows);
    add("blended points", blended, rows);
}

} // namespace

void add_subdivision(CommandList& list, std::span<SubdivisionTables const> tables,
                     std::span<float> points, int stride, Machine const& machine)
{
    int step = 0;
    for (SubdivisionTables const& t : tables)
        add_step(list, t, {points, stride, 0, "vertices"}, ", step " + std::to_string(++step),
                 machine);
}

} // namespace tessemu
