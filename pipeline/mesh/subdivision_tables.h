// Tables of a step of subdivision: of Catmull-Clark's LOOP10 section 3, figure 2.
//
// One vertex buffer holds a mesh's vertices and, behind them, the new points in the order faces,
// edges, vertices; of the next step these are the old vertices. Numbers in the tables are the
// buffer's.
//
//     face point     mean of face_index[offset .. offset + valence - 1]
//     edge point     mean of its four: end, face, other end, other face
//     vertex point   its edges' far ends and its faces, in turn: e_0, F_0, e_1, F_1, ...
//
// A boundary edge, and any edge that stays sharp, has both its ends twice: their middle. A vertex
// on a boundary or between two sharp edges has valence 1 and its two neighbours along them, one
// that stays where it is valence 0 and none: these are LOOP10's encodings, and sharp tags fit them.
// What does not fit is `blended`, as sums of weighted points: points between two rules where a
// sharpness ends in this step, edge points at triangles to be smoothed, and by Biermann's rules
// those that lean to an end and those that are flattened. Of other schemes all new points are such
// sums, HOLL10's computational entries, and the old faces have none.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/sharpness.h"
#include "pipeline/mesh/weighted_sum.h"

namespace tessemu {

struct SubdivisionTables {
    std::uint32_t faces = 0, edges = 0, vertices = 0; ///< F, E, V of the old mesh
    std::uint32_t first = 0;                          ///< the old vertices begin here

    /// [face][2]; empty: all faces are quads, and face_index is a table of edges' kind.
    std::vector<std::uint32_t> face_offset_valence;
    std::vector<std::uint32_t> face_index;            ///< the old vertices, face by face
    std::vector<std::uint32_t> edge_index;            ///< [edge][4]
    std::vector<std::uint32_t> vertex_offset_valence; ///< [vertex][2]
    std::vector<std::uint32_t> vertex_index;

    /// Sums over old vertices and face points, written last, over what the kernels above made. None
    /// reads a point that another one writes.
    struct Blended {
        std::vector<std::uint32_t> target;   ///< [row]: the new point
        std::vector<std::uint32_t> first{0}; ///< [row + 1]: where its terms begin
        std::vector<std::uint32_t> points;   ///< of each term
        std::vector<float> weights;          ///< of each term

        void add(std::uint32_t new_point, WeightedSum const& sum);
    };
    Blended blended;

    std::uint32_t first_face_point() const { return first + vertices; }
    std::uint32_t first_edge_point() const { return first_face_point() + faces; }
    std::uint32_t first_vertex_point() const { return first_edge_point() + edges; }
    std::uint32_t new_points() const { return faces + edges + vertices; }
    /// Vectors of the buffer after the step.
    std::uint32_t buffer_size() const { return first_face_point() + new_points(); }
};

/// The tables of a step whose new points are all weighted sums.
///
/// \param points    of the old vertices by their numbers in the buffer
/// \param vertices  old ones, whose new points are the last
SubdivisionTables weighted_tables(std::span<WeightedSum const> points, std::uint32_t vertices,
                                  std::uint32_t first);

/// \param first      of the old vertices in the buffer: 0, or an earlier step's first_face_point()
/// \param only_quads leaves face_offset_valence out: all faces are quads
/// \cost  linear in the corners of faces, and in the terms of blended points
/// Throws LimitError for a buffer of more vectors than RWVectorBuffer::kMostVectors, which keeps
/// all tables' entries below 2^31 too, and for a vertex of more than 46,340 faces, whose number the
/// vertex kernel squares in 32 bits.
SubdivisionTables catmull_clark_tables(Topology const& topology, Sharpness const& sharpness,
                                       std::uint32_t first, bool only_quads);

} // namespace tessemu
