// Hull shader of the stencil form, LOOP09 section 4.3: each output point is a weighted sum of the
// patch's input vertices, with weights by connectivity type.
//
//     out_row = sum over k of W[type][order[k]][row] * in[order[k]]
//
// The sum runs in ascending global vertex id, through an order index stored per patch, so that
// points which two patches share have equal bits in both. A bit mask per row tells the zero weights
// apart; they are skipped. Rows: the control points, then the transversal fields of the edges (4 an
// edge), then the tangents of the corners (a pair for each place where the corner's ring may
// begin).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/hull_shader.h"
#include "shaders_cpp/cubic_edges.h"
#include "shaders_cpp/tess_factor_rule.h"

namespace tessemu {

/// What the hull shader knows of a patch besides its vertices; 4 + sides words each.
struct StencilPatchWords {
    static constexpr int kWeights = 0;    ///< first weight of the type's table
    static constexpr int kMasks = 1;      ///< first mask of the type's table
    static constexpr int kRows = 2;       ///< rows of the type's table
    static constexpr int kReversed = 3;   ///< bit k: edge k runs against its canonical direction
    static constexpr int kCornerRows = 4; ///< per corner: row of its first tangent
    static constexpr int count(int sides) { return 4 + sides; }
};

/// \tparam Weight     float; double in tests of the formulas
/// \tparam kDomain_   Quad or Tri
template <TessellatorDomain kDomain_, class Weight = float> struct StencilHullShader {
    static constexpr TessellatorDomain kDomain = kDomain_;
    static constexpr int kSides = sides_of(kDomain);
    template <class T> using Input = ControlVertex<T>;
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> using PatchConstant = EdgeRegister<T>;

    int points = 20;        ///< output control points that are sums
    Buffer<Weight> weights; ///< [type][input][row], then the type's constants
    /// [type][row]: bit i is set where the weight of input i is not 0.
    Buffer<std::uint32_t> zero_masks;
    Buffer<std::uint32_t> patches; ///< [patch][StencilPatchWords]
    Buffer<std::uint8_t> order;    ///< [patch][k]: inputs in ascending global vertex id
    TessFactorRule factors;

    int control_points() const { return points; }
    int patch_constants() const { return 6 * kSides; }
    std::vector<ResourceInfo> resources() const
    {
        return {weights.info(), zero_masks.info(), patches.info(), order.info()};
    }

    /// Where the constants of the patch's type begin among the weights.
    template <class T> std::int32_t constants(PatchInput patch, int inputs) const
    {
        std::int32_t const words = patch.primitive_id * StencilPatchWords::count(kSides);
        return load<T>(patches, words + StencilPatchWords::kWeights) +
               inputs * load<T>(patches, words + StencilPatchWords::kRows);
    }

    /// One row of the stencil.
    ///
    /// \param row  the table's row, per lane
    /// \cost       3 mul, 3 add for each input with a non-zero weight
    template <class T>
    float3<T> stencil_row(PatchInput patch, ControlPoints<ControlVertex<T>> const& in,
                          int_of<T> row) const
    {
        using Int = int_of<T>;
        Routine<T> const here("stencil_row");
        std::int32_t const id = patch.primitive_id;
        std::int32_t const words = id * StencilPatchWords::count(kSides);
        std::int32_t const rows = load<T>(patches, words + StencilPatchWords::kRows);
        Int const first_weight = Int(load<T>(patches, words + StencilPatchWords::kWeights)) + row;
        Int const mask =
            load<T>(zero_masks, Int(load<T>(patches, words + StencilPatchWords::kMasks)) + row);
        float3<T> sum(T(0), T(0), T(0));
        for (int k : loop<T>(in.size())) {
            std::int32_t const i = load<T>(order, id * in.size() + k);
            sum = when(((mask >> Int(i)) & Int(1)) != Int(0),
                       [&]() -> float3<T> {
                           T const w = load<T>(weights, first_weight + Int(i * rows));
                           return sum + w * in[i].position;
                       },
                       sum);
        }
        return sum;
    }

    template <class T>
    ControlVertex<T> control_point(PatchInput patch, ControlPoints<ControlVertex<T>> const& in,
                                   int_of<T> id) const
    {
        return {stencil_row<T>(patch, in, id)};
    }

    /// Edge registers in canonical direction. Rows E_2 and E_3 are as corner k+1 has them, which
    /// looks at the edge from its other end: W = (E_0, E_1, -E_2, -E_3), and of an edge that runs
    /// from corner k+1 to corner k, W = (E_3, E_2, -E_1, -E_0).
    template <class T>
    EdgeRegister<T> patch_constant(PatchInput patch, ControlPoints<ControlVertex<T>> const& in,
                                   auto const&, int_of<T> id) const
    {
        using Int = int_of<T>;
        std::int32_t const words = patch.primitive_id * StencilPatchWords::count(kSides);
        Int const bits = Int(load<T>(patches, words + StencilPatchWords::kReversed));
        Int const edge = id >> Int(2), m = id & Int(3);
        auto const on_edge = id < Int(4 * kSides);
        auto const reversed = on_edge & (((bits >> (edge & Int(3))) & Int(1)) != Int(0));
        Int const edge_row = Int(points) + (edge << Int(2)) + select(reversed, Int(3) - m, m);
        Int const corner = select(on_edge, Int(0), (id - Int(4 * kSides)) >> Int(1));
        Int const corner_row =
            load<T>(patches, Int(words + StencilPatchWords::kCornerRows) + corner) + (id & Int(1));
        float3<T> const v = stencil_row<T>(patch, in, select(on_edge, edge_row, corner_row));
        auto const negative = on_edge & (m >= Int(2));
        return {select(negative, -v, v), select(reversed, T(1), T(0))};
    }

    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<ControlVertex<T>> const&,
                                  ControlPoints<ControlVertex<T>> const& out,
                                  ControlPoints<EdgeRegister<T>> const& registers) const
    {
        return factors.template factors<kDomain, T>(
            [&](int k) { return cubic_edge<kSides>(out, k); },
            [&](int k) { return registers[4 * k].reversed > T(0); });
    }
};

} // namespace tessemu
