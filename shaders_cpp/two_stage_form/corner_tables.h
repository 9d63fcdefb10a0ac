// What the hull shaders of the two-stage form know of a patch: which edges of its vertices are its
// own (LOOP09 figure 8), and the numbering of the registers that close its edges.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/hull_shader.h"
#include "shaders_cpp/cubic_edges.h"
#include "shaders_cpp/pole_normals.h"
#include "shaders_cpp/tess_factor_rule.h"
#include "shaders_cpp/two_stage_form/ring_vertex.h"

namespace tessemu {

/// Vectors of a corner of a patch.
template <int kCount, class T> struct CornerVectors {
    static constexpr int kVectors = kCount;
    std::array<float3<T>, kCount> vectors;
    static constexpr auto signature() { return std::tuple{&CornerVectors::vectors}; }
};
/// p, e+, e- as every scheme has them; then the scheme's own.
struct CornerLayout {
    static constexpr int kP = 0, kEPlus = 1, kEMinus = 2, kFPlus = 3, kFMinus = 4;
};

/// \tparam kSides_  of the patch
template <int kSides_, class Weight = float> struct CornerTables {
    static constexpr int kSides = kSides_;

    Buffer<std::uint32_t> offsets; ///< [patch][corner]: edge of e+ | edge of e- << 8 | row of its
                                   ///< vertex in the ring tables << 16
    /// [patch]: bit k: edge k runs against its canonical direction; bit 8 + k: it lies on the
    /// boundary; bit 16 + k: it is collapsed; bit 24 + i: corner i is a pole.
    Buffer<std::uint32_t> edges;
    Buffer<Weight> angles;              ///< [row][2]: the vertex's cosine, and sin(2pi/n)
    Buffer<std::uint32_t> corner_poles; ///< [patch][corner]: its pole, where it is one
    PoleNormals poles;
    TessFactorRule factors;

    int control_points() const { return kSides; }
    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out{offsets.info(), edges.info(), angles.info()};
        if (corner_poles.info().elements) out.push_back(corner_poles.info());
        poles.add_to(out);
        return out;
    }

    template <class T> struct Corner {
        int_of<T> plus, minus, row;
        /// The ring's edge before and after j; on the boundary j is an inner edge.
        int_of<T> after(int_of<T> j) const
        {
            return select(j + int_of<T>(1) == row, int_of<T>(0), j + int_of<T>(1));
        }
        int_of<T> before(int_of<T> j) const
        {
            return select(j == int_of<T>(0), row - int_of<T>(1), j - int_of<T>(1));
        }
    };
    template <class T> Corner<T> corner(PatchInput patch, int_of<T> i) const
    {
        using Int = int_of<T>;
        Int const word = Int(load<T>(offsets, Int(patch.primitive_id * kSides) + i));
        return {word & Int(255), (word >> Int(8)) & Int(255), word >> Int(16)};
    }
    template <class T> T cosine(Corner<T> const& at) const
    {
        return load<T>(angles, at.row << int_of<T>(1));
    }
    template <class T> T sine(Corner<T> const& at) const
    {
        return load<T>(angles, (at.row << int_of<T>(1)) + int_of<T>(1));
    }
    template <class T> static int_of<T> next(int_of<T> i)
    {
        return select(i == int_of<T>(kSides - 1), int_of<T>(0), i + int_of<T>(1));
    }
    template <class T> static int_of<T> previous(int_of<T> i)
    {
        return select(i == int_of<T>(0), int_of<T>(kSides - 1), i - int_of<T>(1));
    }

    /// What register `id` of the patch constants holds.
    ///
    /// id = 4k + m below 4 kSides: vector W_m of edge k's transversal field, in the edge's
    /// canonical direction. A scheme makes E_0 and E_1 as corner k has them and E_2 and E_3 as
    /// corner k+1 has them, which looks at the edge from its other end: so W = (E_0, E_1, -E_2,
    /// -E_3), and of an edge that runs from corner k+1 to corner k, W = (E_3, E_2, -E_1, -E_0).
    /// From 4 kSides on: the corners' normals, and behind them what the scheme adds.
    template <class T> struct FieldRegister {
        mask_of<T> on_edge;  ///< it belongs to an edge; the other masks say something of edges only
        mask_of<T> alone;    ///< the edge lies on the boundary: this patch alone has it
        mask_of<T> reversed; ///< the edge runs against its canonical direction
        mask_of<T> collapsed; ///< both ends of the edge are the same pole
        mask_of<T> pole;      ///< the corner is a pole
        mask_of<T> negative;  ///< what is stored is -E_which
        mask_of<T> far;       ///< E_which belongs to corner k+1, else to corner k
        int_of<T> which;      ///< 0 to 3
        int_of<T> corner;     ///< whose vertex E_which or the normal is made from
    };
    template <class T> FieldRegister<T> field_register(PatchInput patch, int_of<T> id) const
    {
        using Int = int_of<T>;
        Int const bits = Int(load<T>(edges, patch.primitive_id));
        mask_of<T> const on_edge = id < Int(4 * kSides);
        Int const edge = id >> Int(2), m = id & Int(3), k = edge & Int(3);
        auto const bit = [&](Int i) { return ((bits >> i) & Int(1)) != Int(0); };
        mask_of<T> const reversed = on_edge & bit(k);
        mask_of<T> const alone = on_edge & bit(Int(8) + k);
        Int const which = select(reversed, Int(3) - m, m);
        mask_of<T> const far = which >= Int(2);
        mask_of<T> const corner = (id >= Int(4 * kSides)) & (id < Int(5 * kSides));
        return {on_edge,
                alone,
                reversed,
                mask_of<T>(on_edge & bit(Int(16) + k)),
                mask_of<T>(corner & bit(Int(24) + (id & Int(3)))),
                mask_of<T>(on_edge & (m >= Int(2))),
                far,
                which,
                select(on_edge, select(far, next<T>(edge), edge), id - Int(4 * kSides))};
    }
    template <class T>
    static EdgeRegister<T> packed(FieldRegister<T> const& r, float3<T> const& value)
    {
        float3<T> const w = select(r.collapsed, float3<T>(T(0), T(0), T(0)), value);
        return {select(r.negative, -w, w), select(r.reversed, T(1), T(0))};
    }

    /// The normal's direction at a corner: its vertex's, or its pole's.
    template <class T>
    float3<T> corner_normal(PatchInput patch, ControlPoints<RingVertex<T>> const& in,
                            FieldRegister<T> const& r) const
    {
        using Int = int_of<T>;
        return when(
            r.pole,
            [&]() -> float3<T> {
                Int const pole =
                    Int(load<T>(corner_poles, Int(patch.primitive_id * kSides) + r.corner));
                return poles.vector<T>(pole, Int(PoleNormalShader::kNormal));
            },
            in.vector(r.corner, Int(RingLayout::kNormal)));
    }

    /// 3/2 (e_(j+1) - e_(j-1)).
    template <class T>
    static float3<T> across(ControlPoints<RingVertex<T>> const& in, Corner<T> const& at,
                            int_of<T> i, int_of<T> j)
    {
        using Int = int_of<T>;
        return T(1.5) * float3<T>(in.vector(i, Int(RingLayout::kE) + at.after(j)) -
                                  in.vector(i, Int(RingLayout::kE) + at.before(j)));
    }

    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<RingVertex<T>> const&, auto const& out,
                                  ControlPoints<EdgeRegister<T>> const& registers) const
    {
        using L = CornerLayout;
        constexpr auto kDomain = kSides == 4 ? TessellatorDomain::Quad : TessellatorDomain::Tri;
        return factors.template factors<kDomain, T>(
            [&](int k) {
                int const after = (k + 1) % kSides;
                float3<T> const p0 = out.vector(k, L::kP), p1 = out.vector(k, L::kEPlus),
                                p2 = out.vector(after, L::kEMinus), p3 = out.vector(after, L::kP);
                return EdgeCurve<T>{p0, p1, p2, p3, float3<T>(p1 - p0), float3<T>(p3 - p2)};
            },
            [&](int k) { return registers[4 * k].reversed > T(0); });
    }
};

} // namespace tessemu
