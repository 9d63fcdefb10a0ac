// Domain shaders of biseptic patches (biseptic_quad.h): as in the paper, the same formula
// everywhere; and with edges that have equal bits from both sides (docs/biseptic.md).
//
//     e_1 --outer-- f_0
//      |             |        v
//    spoke         outer      |     Corner 0 is the extraordinary vertex EV; edges 0 and 3 are
//      |             |        +-u   spokes, edges 1 and 2 outer edges.
//      EV --spoke-- e_0
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/biseptic/biseptic_quad.h"
#include "shaders_cpp/cubic_edges.h"
#include "shaders_cpp/isolated/packed_points.h"
#include "shaders_cpp/plain_patch.h"

namespace tessemu {

/// Bezier points K to a record: point 8 i + j is number i along u, j along v, behind kNet others.
template <int K, int kNet> struct PackedBiseptic {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kPacked = K;
    template <class T> using ControlPoint = PackedPoints<K, T>;
    template <class T> using Patch = ControlPoints<ControlPoint<T>>;

    template <class T>
    static constexpr TangentFrame<T> evaluate(Patch<T> const& patch, DomainInput<T> const& in, bool)
    {
        UnpackedPoints<K, T> const points(patch);
        return biseptic_quad<T>(
            [&](int i, int j) { return points[kNet + kBisepticSide * i + j].position; }, in.u,
            in.v);
    }
    template <class T>
    static constexpr SecondOrderFrame<T> second_order(Patch<T> const& patch,
                                                      DomainInput<T> const& in)
    {
        return second_order_of<T>(UnpackedPoints<K, T>(patch), [&](auto const& near) {
            return biseptic_second_order<T>(
                [&](int i, int j) { return near[kNet + kBisepticSide * i + j].position; }, in.u,
                in.v);
        });
    }
};

/// As in the paper, two to a record.
struct BisepticInside : PackedBiseptic<2, 0> {
    static constexpr int kPoints = kBisepticSide * kBisepticSide;
    static constexpr int kControlPoints = kPoints / kPacked;
};
using BisepticDomainShader = PlainPatch<BisepticInside>;

/// The same with what edges are made of. Outer edges and corners come from vertex data, as in all
/// patches of the stencil form: the cubic (p, e+, e-, p) and its normal field, whose degree the
/// patch raises to 7, and the limit normals. A spoke is no cubic: both of its patches have its eight
/// points, and the eight vectors across it that make its normal, of one of them.
struct BisepticRowsInside : PackedBiseptic<3, 12>, TangentPairCorners<4> {
    /// Rows: p, e+, e-; the net; vectors across edge 0, and across edge 3 as the other patch there
    /// has them; one of zeros.
    static constexpr int kNet = 12, kAcross = kNet + BisepticInside::kPoints,
                         kRows = kAcross + 2 * kBisepticSide + 1;
    static constexpr int kControlPoints = kRows / kPacked;
    static_assert(kRows % kPacked == 0 && kControlPoints <= kMaxControlPoints);

    template <class T> static constexpr EdgeCurve<T> edge(Patch<T> const& patch, int k)
    {
        return cubic_edge<4>(UnpackedPoints<kPacked, T>(patch), k);
    }
    template <class T> static constexpr float3<T> corner(Patch<T> const& patch, int i)
    {
        return UnpackedPoints<kPacked, T>(patch)[i].position;
    }
    static constexpr bool has_own_edge(int k) { return k == 0 || k == 3; }
    template <class T>
    static constexpr SurfacePoint<T> own_edge(Patch<T> const& patch, DomainInput<T> const&, int k,
                                              T t)
    {
        UnpackedPoints<kPacked, T> const points(patch);
        int const step = k == 0 ? kBisepticSide : 1;
        int const across = kAcross + (k == 0 ? 0 : kBisepticSide);
        // Edge 3 runs towards EV.
        return biseptic_spoke<T>([&](int i) { return points[kNet + step * i].position; },
                                 [&](int i) { return points[across + i].position; },
                                 k == 0 ? t : T(T(1) - t));
    }
};
using BisepticRowsDomainShader = WatertightPatch<BisepticRowsInside>;

} // namespace tessemu
