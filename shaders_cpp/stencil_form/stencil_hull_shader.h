// Hull shader of the stencil form, LOOP09 section 4.3: each output point is a row of the patch's
// stencil, a weighted sum of vertices.
//
// Rows: the control points, then the transversal fields of the edges (4 an edge), then the tangents
// of the corners (two each; among a type's tables, a pair for each place where the corner's ring
// may begin). Where rows come from is a part of its own: sums over the patch's inputs, or a buffer
// that a dispatch filled, for patches with more inputs than a patch may have.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/hull_shader.h"
#include "emu/table_rows.h"
#include "shaders_cpp/cubic_edges.h"
#include "shaders_cpp/pole_normals.h"
#include "shaders_cpp/stencil_form/stencil_row.h"
#include "shaders_cpp/tess_factor_rule.h"

namespace tessemu {

/// Bits of a patch's edges, and what tells a pole from a row.
struct EdgeBits {
    static constexpr int kReversed = 0;  ///< shift: bit k, edge k runs against its canonical one
    static constexpr int kCollapsed = 8; ///< shift: bit k, both ends of edge k are the same pole
};
inline constexpr std::int32_t kPole = 1 << 30;

/// What the hull shader knows of a patch besides its vertices; 4 + sides words each.
struct StencilPatchWords {
    static constexpr int kWeights = 0;    ///< first weight of the type's table
    static constexpr int kMasks = 1;      ///< first mask of the type's table
    static constexpr int kRows = 2;       ///< rows of the type's table
    static constexpr int kEdges = 3;      ///< EdgeBits
    static constexpr int kCornerRows = 4; ///< per corner: row of its first tangent, or kPole + pole
    static constexpr int count(int sides) { return 4 + sides; }
};

/// Rows summed over the patch's inputs, with weights by connectivity type:
///
///     row = sum over k of W[type][order[k]][row] * in[order[k]]
///
/// The sum runs in ascending global vertex id, through an order index stored per patch, so that
/// points which two patches share have equal bits in both. A bit mask per row tells the zero
/// weights apart; they are skipped.
///
/// \tparam Weight  float; double in tests of the formulas
template <int kSides, class Weight = float> struct SummedRows {
    Buffer<Weight> weights; ///< [type][input][row], then the type's constants
    /// [type][row]: bit i is set where the weight of input i is not 0.
    Buffer<std::uint32_t> zero_masks;
    Buffer<std::uint32_t> patches; ///< [patch][StencilPatchWords]
    Buffer<std::uint8_t> order;    ///< [patch][k]: inputs in ascending global vertex id

    std::vector<ResourceInfo> resources() const
    {
        return {weights.info(), zero_masks.info(), patches.info(), order.info()};
    }

    /// \param row  the table's row, per lane
    /// \cost       that of stencil_row, a term for each input with a non-zero weight
    template <class T>
    float3<T> row(PatchInput patch, ControlPoints<ControlVertex<T>> const& in, int_of<T> row) const
    {
        using Int = int_of<T>;
        std::int32_t const first_order = patch.primitive_id * in.size();
        std::int32_t const rows = word<T>(patch, StencilPatchWords::kRows);
        std::int32_t const table = word<T>(patch, StencilPatchWords::kWeights);
        std::int32_t const first_mask = word<T>(patch, StencilPatchWords::kMasks);
        if constexpr (std::same_as<T, FastLanes<lanes_of<T>>>)
            if (auto const sum = sum_table_rows<lanes_of<T>>(
                    in, {weights, table, rows, zero_masks, first_mask, order, first_order, row}))
                return *sum;
        Int const first_weight = Int(table) + row;
        Int const mask = load<T>(zero_masks, Int(first_mask) + row);
        return stencil_row<T>(in.size(), [&](int k) {
            std::int32_t const i = load<T>(order, first_order + k);
            return StencilTerm{
                mask_of<T>(((mask >> Int(i)) & Int(1)) != Int(0)),
                [=, this]() -> T { return load<T>(weights, first_weight + Int(i * rows)); },
                [=, &in]() -> float3<T> { return in[i].position; }};
        });
    }
    /// The row of control point `id`.
    template <class T>
    float3<T> point(PatchInput patch, ControlPoints<ControlVertex<T>> const& in, int_of<T> id) const
    {
        return row<T>(patch, in, id);
    }
    template <class T> std::int32_t edge_bits(PatchInput patch) const
    {
        return word<T>(patch, StencilPatchWords::kEdges);
    }
    /// The first of the corner's two tangents, or kPole + its pole.
    template <class T> int_of<T> corner_row(PatchInput patch, int_of<T> corner) const
    {
        return load<T>(patches,
                       int_of<T>(first_word(patch) + StencilPatchWords::kCornerRows) + corner);
    }
    /// Where the constants of the patch's type begin in `constants()`.
    template <class T> std::int32_t first_constant(PatchInput patch, int inputs) const
    {
        return word<T>(patch, StencilPatchWords::kWeights) +
               inputs * word<T>(patch, StencilPatchWords::kRows);
    }
    Buffer<Weight> const& constants() const { return weights; }

private:
    static std::int32_t first_word(PatchInput patch)
    {
        return patch.primitive_id * StencilPatchWords::count(kSides);
    }
    template <class T> std::int32_t word(PatchInput patch, int which) const
    {
        return load<T>(patches, first_word(patch) + which);
    }
};

/// What the hull shader knows of a patch whose rows a dispatch sums.
struct GatheredPatchWords {
    static constexpr int kEdges = 0;      ///< EdgeBits
    static constexpr int kConstant = 1;   ///< first constant of the type
    static constexpr int kCornerRows = 2; ///< per corner, as StencilPatchWords'
    static constexpr int count(int sides) { return 2 + sides; }
};

/// Rows that a dispatch has summed. The control points, first of a patch's rows, arrive as its
/// vertices and are passed on; the others are read from the buffer.
template <int kSides> struct GatheredRows {
    int rows = 0;                  ///< of a patch: control points, 4 an edge, 2 a corner
    Buffer<float> sums;            ///< [patch][row][3]
    Buffer<std::uint32_t> patches; ///< [patch][GatheredPatchWords]
    Buffer<float> type_constants;

    std::vector<ResourceInfo> resources() const
    {
        return {sums.info(), patches.info(), type_constants.info()};
    }
    template <class T>
    float3<T> row(PatchInput patch, ControlPoints<ControlVertex<T>> const&, int_of<T> row) const
    {
        using Int = int_of<T>;
        Int const first = (Int(patch.primitive_id * rows) + row) * Int(3);
        return {load<T>(sums, first), load<T>(sums, first + Int(1)), load<T>(sums, first + Int(2))};
    }
    template <class T>
    float3<T> point(PatchInput, ControlPoints<ControlVertex<T>> const& in, int_of<T> id) const
    {
        return in[id].position;
    }
    template <class T> std::int32_t edge_bits(PatchInput patch) const
    {
        return word<T>(patch, GatheredPatchWords::kEdges);
    }
    template <class T> int_of<T> corner_row(PatchInput patch, int_of<T> corner) const
    {
        return load<T>(patches,
                       int_of<T>(first_word(patch) + GatheredPatchWords::kCornerRows) + corner);
    }
    template <class T> std::int32_t first_constant(PatchInput patch, int) const
    {
        return word<T>(patch, GatheredPatchWords::kConstant);
    }
    Buffer<float> const& constants() const { return type_constants; }

private:
    static std::int32_t first_word(PatchInput patch)
    {
        return patch.primitive_id * GatheredPatchWords::count(kSides);
    }
    template <class T> std::int32_t word(PatchInput patch, int which) const
    {
        return load<T>(patches, first_word(patch) + which);
    }
};

/// \tparam kDomain_  Quad or Tri
/// \tparam Rows_     SummedRows or GatheredRows
template <TessellatorDomain kDomain_, class Rows_ = SummedRows<sides_of(kDomain_)>>
struct StencilHullShader {
    static constexpr TessellatorDomain kDomain = kDomain_;
    static constexpr int kSides = sides_of(kDomain);
    using Rows = Rows_;
    template <class T> using Input = ControlVertex<T>;
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> using PatchConstant = EdgeRegister<T>;

    int points = 20; ///< output control points that are rows
    Rows rows;
    PoleNormals poles;
    TessFactorRule factors;

    int control_points() const { return points; }
    int patch_constants() const { return 6 * kSides; }
    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out = rows.resources();
        poles.add_to(out);
        return out;
    }

    template <class T>
    ControlVertex<T> control_point(PatchInput patch, ControlPoints<ControlVertex<T>> const& in,
                                   int_of<T> id) const
    {
        return {rows.template point<T>(patch, in, id)};
    }

    /// Edge registers in canonical direction. Rows E_2 and E_3 are as corner k+1 has them, which
    /// looks at the edge from its other end: W = (E_0, E_1, -E_2, -E_3), and of an edge that runs
    /// from corner k+1 to corner k, W = (E_3, E_2, -E_1, -E_0).
    template <class T>
    EdgeRegister<T> patch_constant(PatchInput patch, ControlPoints<ControlVertex<T>> const& in,
                                   auto const&, int_of<T> id) const
    {
        using Int = int_of<T>;
        Int const bits = Int(rows.template edge_bits<T>(patch));
        Int const edge = id >> Int(2), m = id & Int(3);
        auto const on_edge = id < Int(4 * kSides);
        auto const bit = [&](int shift) {
            return on_edge & (((bits >> (Int(shift) + (edge & Int(3)))) & Int(1)) != Int(0));
        };
        auto const reversed = bit(EdgeBits::kReversed);
        Int const edge_row = Int(points) + (edge << Int(2)) + select(reversed, Int(3) - m, m);
        Int const corner = select(on_edge, Int(0), (id - Int(4 * kSides)) >> Int(1));
        Int const corner_row = rows.template corner_row<T>(patch, corner);
        mask_of<T> const pole = (corner_row >= Int(kPole)) & (id >= Int(4 * kSides));
        Int const own_row = select(pole, Int(points), corner_row + (id & Int(1)));
        float3<T> const row = rows.template row<T>(patch, in, select(on_edge, edge_row, own_row));
        auto const collapsed = bit(EdgeBits::kCollapsed);
        float3<T> const v = when(
            pole | collapsed,
            [&]() -> float3<T> {
                float3<T> const tangent = poles.vector<T>(
                    corner_row - Int(kPole), Int(PoleNormalShader::kTangents) + (id & Int(1)));
                return select(pole, tangent, float3<T>(T(0), T(0), T(0)));
            },
            row);
        auto const negative = on_edge & (m >= Int(2));
        return {select(negative, -v, v), select(reversed, T(1), T(0))};
    }

    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<ControlVertex<T>> const&,
                                  auto const& out,
                                  ControlPoints<EdgeRegister<T>> const& registers) const
    {
        return factors.template factors<kDomain, T>(
            [&](int k) { return cubic_edge<kSides>(out, k); },
            [&](int k) { return registers[4 * k].reversed > T(0); });
    }
};
template <class Rows>
using StencilQuadHullShader = StencilHullShader<TessellatorDomain::Quad, Rows>;
template <class Rows> using StencilTriHullShader = StencilHullShader<TessellatorDomain::Tri, Rows>;

} // namespace tessemu
