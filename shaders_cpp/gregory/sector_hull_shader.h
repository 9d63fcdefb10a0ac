// Hull shader of the two-stage form, LOOP09 section 4.2: an invocation for each sector of a patch
// assembles the corner's control points from what the vertex shader made of its vertices.
//
// The offsets texture (figure 8) tells which of a vertex's edges is the patch's.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/hull_shader.h"
#include "shaders_cpp/gregory/ring_vertex_shader.h"
#include "shaders_cpp/watertight_patch.h"

namespace tessemu {

/// A corner's control points: p, e+, e-, f+ and, in an irregular patch, f-.
template <int kCount, class T> struct SectorOf {
    static constexpr int kVectors = kCount;
    std::array<float3<T>, kCount> vectors;
    static constexpr auto signature() { return std::tuple{&SectorOf::vectors}; }
};
struct SectorLayout {
    static constexpr int kP = 0, kEPlus = 1, kEMinus = 2, kFPlus = 3, kFMinus = 4;
};

/// \tparam kDomain_   Quad or Tri
/// \tparam kVectors   5; 4 in a regular patch, whose f- equals f+
template <TessellatorDomain kDomain_, int kVectors, class Weight = float> struct SectorHullShader {
    static constexpr TessellatorDomain kDomain = kDomain_;
    static constexpr int kSides = kDomain == TessellatorDomain::Quad ? 4 : 3;
    template <class T> using Input = RingVertex<T>;
    template <class T> using ControlPoint = SectorOf<kVectors, T>;
    template <class T> using PatchConstant = EdgeRegister<T>;

    Buffer<std::uint32_t> offsets; ///< [patch][corner]: edge of e+ | edge of e- << 8 | row of its
                                   ///< vertex in RingConstants << 16
    Buffer<std::uint32_t> edges;   ///< [patch]: bit k: edge k runs against its canonical direction;
                                   ///< bit 8 + k: it lies on the boundary
    Buffer<Weight> cosines;        ///< [row of RingConstants]
    std::array<float, 6> factors{1, 1, 1, 1, 1, 1}; ///< uniform tess factors

    int control_points() const { return kSides; }
    int patch_constants() const { return 5 * kSides; }
    std::vector<ResourceInfo> resources() const
    {
        return {offsets.info(), edges.info(), cosines.info()};
    }

    /// \cost  12 mul a face point
    template <class T>
    SectorOf<kVectors, T> control_point(PatchInput patch, ControlPoints<RingVertex<T>> const& in,
                                        int_of<T> i) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        Int const next = select(i == Int(kSides - 1), Int(0), i + Int(1));
        Int const previous = select(i == Int(0), Int(kSides - 1), i - Int(1));
        Corner<T> const at = corner<T>(patch, i), after = corner<T>(patch, next);
        V const p = in.vector(i, Int(RingLayout::kP));
        V const e_plus = in.vector(i, Int(RingLayout::kE) + at.plus);
        V const e_minus = in.vector(i, Int(RingLayout::kE) + at.minus);
        T const d(kSides == 4 ? 3.0 : 4.0), share(kSides == 4 ? 1.0 / 3 : 1.0 / 4);
        auto const face_point = [&](T c_other, V const& e, V const& e_other, V const& r) -> V {
            T const c2 = at.C + at.C;
            V const sum = c_other * p + T(d - c2 - c_other) * e + c2 * e_other + r;
            return share * sum;
        };
        SectorOf<kVectors, T> out;
        out.vectors[SectorLayout::kP] = p;
        out.vectors[SectorLayout::kEPlus] = e_plus;
        out.vectors[SectorLayout::kEMinus] = e_minus;
        out.vectors[SectorLayout::kFPlus] =
            face_point(after.C, e_plus, in.vector(next, Int(RingLayout::kE) + after.minus),
                       in.vector(i, Int(RingLayout::kR) + at.plus));
        if constexpr (kVectors == 5) {
            Corner<T> const before = corner<T>(patch, previous);
            // r of the other edge is seen from its other side.
            out.vectors[SectorLayout::kFMinus] = face_point(
                before.C, e_minus, in.vector(previous, Int(RingLayout::kE) + before.plus),
                -in.vector(i, Int(RingLayout::kR) + at.minus));
        }
        return out;
    }

    /// Transversal fields of the edges in canonical direction, then the corners' normals. Reversing
    /// an edge reverses the order of its four vectors and their signs, W_m = +-E_(3-m).
    template <class T>
    EdgeRegister<T> patch_constant(PatchInput patch, ControlPoints<RingVertex<T>> const& in,
                                   ControlPoints<SectorOf<kVectors, T>> const& sectors,
                                   int_of<T> id) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        V const zero(T(0), T(0), T(0));
        Int const bits = Int(load<T>(edges, patch.primitive_id));
        auto const on_edge = id < Int(4 * kSides);
        Int const edge = id >> Int(2), m = id & Int(3);
        auto const reversed = on_edge & (((bits >> (edge & Int(3))) & Int(1)) != Int(0));
        auto const alone = on_edge & (((bits >> (Int(8) + (edge & Int(3)))) & Int(1)) != Int(0));
        Int const which = select(reversed, Int(3) - m, m);
        auto const far = which >= Int(2);
        Int const next = select(edge == Int(kSides - 1), Int(0), edge + Int(1));
        Int const i = select(on_edge, select(far, next, edge), id - Int(4 * kSides));

        V value = when(
            !on_edge, [&]() -> V { return in.vector(i, Int(RingLayout::kNormal)); }, zero);
        value = when(
            on_edge & !alone,
            [&]() -> V {
                Corner<T> const at = corner<T>(patch, i);
                Int const j = select(far, at.minus, at.plus);
                return when((which == Int(1)) | (which == Int(2)),
                            [&]() -> V { return in.vector(i, Int(RingLayout::kR) + j); },
                            when((which == Int(0)) | (which == Int(3)),
                                 [&]() -> V {
                                     Int const up = select(j + Int(1) == at.n, Int(0), j + Int(1));
                                     Int const down =
                                         select(j == Int(0), at.n - Int(1), j - Int(1));
                                     return T(1.5) * V(in.vector(i, Int(RingLayout::kE) + up) -
                                                       in.vector(i, Int(RingLayout::kE) + down));
                                 },
                                 zero));
            },
            value);
        if constexpr (kVectors == 5) {
            // An edge with one patch: its own inward field.
            value = when(
                alone,
                [&]() -> V {
                    auto const end = (which == Int(0)) | (which == Int(3));
                    Int const from =
                        select(end, Int(SectorLayout::kP),
                               select(far, Int(SectorLayout::kEMinus), Int(SectorLayout::kEPlus)));
                    Int const to = select(
                        end, select(far, Int(SectorLayout::kEPlus), Int(SectorLayout::kEMinus)),
                        select(far, Int(SectorLayout::kFMinus), Int(SectorLayout::kFPlus)));
                    T const scale = select(end, T(3), T(kSides == 4 ? 3 : 4));
                    V const inward = scale * V(sectors.vector(i, to) - sectors.vector(i, from));
                    return select(far, -inward, inward);
                },
                value);
        }
        auto const negative = on_edge & (m >= Int(2));
        return {select(negative, -value, value), select(reversed, T(1), T(0))};
    }

    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<RingVertex<T>> const&,
                                  ControlPoints<SectorOf<kVectors, T>> const&,
                                  ControlPoints<EdgeRegister<T>> const&) const
    {
        return {T(factors[0]), T(factors[1]), T(factors[2]),
                T(factors[3]), T(factors[4]), T(factors[5])};
    }

private:
    template <class T> struct Corner {
        int_of<T> plus, minus, n; ///< n: edges of an interior ring; past the last of a boundary's
        T C;
    };
    template <class T> Corner<T> corner(PatchInput patch, int_of<T> i) const
    {
        using Int = int_of<T>;
        Int const word = Int(load<T>(offsets, Int(patch.primitive_id * kSides) + i));
        Int const row = word >> Int(16);
        return {word & Int(255), (word >> Int(8)) & Int(255),
                select(row < Int(RingConstants::kBoundaryRows), row, Int(2 * RingLayout::kEdges)),
                T(load<T>(cosines, row))};
    }
};

} // namespace tessemu
