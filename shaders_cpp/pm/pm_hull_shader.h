// Hull shader of Pm-patches (docs/math/loop09.md, 6): an invocation for each sector gives p, t+,
// t-, b211 and b121; the fork phase completes the middle, where the sectors meet.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/two_stage_form/corner_tables.h"

namespace tessemu {

/// Registers of the patch constants: transversal fields of the edges, the corners' normals, b112 of
/// each sector, the centre.
template <int m> struct PmRegisters {
    static constexpr int kMiddle = 5 * m, kCentre = 6 * m, kCount = 6 * m + 1;
};
/// Vectors of a sector, which lies between corner i and corner i+1, behind its corner's p, e+, e-.
struct PmSector {
    static constexpr int kB211 = 3, kB121 = 4;
};

/// mu = 1 - cos(2pi/m).
template <int m> inline constexpr double kPmMu = m == 4 ? 1.0 : 1.5;

/// N(a, b, c) = (a + b - 2 (1 - mu) c) / (2 mu): the C1 condition across a spoke. \cost 3 mul
template <int m, class T>
constexpr float3<T> pm_join(float3<T> const& a, float3<T> const& b, float3<T> const& c)
{
    if constexpr (m == 4) {
        float3<T> const sum = a + b;
        return T(0.5) * sum;
    } else {
        float3<T> const sum = a + b + c;
        return T(1.0 / 3) * sum;
    }
}

/// (p + 3 t) / 4. \cost 6 mul
template <class T> constexpr float3<T> pm_raised(float3<T> const& p, float3<T> const& t)
{
    float3<T> const sum = p + T(3) * t;
    return T(0.25) * sum;
}

template <TessellatorDomain kDomain_, class Weight = float>
struct PmHullShader : CornerTables<kDomain_ == TessellatorDomain::Quad ? 4 : 3, Weight> {
    static constexpr TessellatorDomain kDomain = kDomain_;
    using Tables = CornerTables<kDomain_ == TessellatorDomain::Quad ? 4 : 3, Weight>;
    static constexpr int m = Tables::kSides;
    template <class T> using Input = RingVertex<T>;
    template <class T> using ControlPoint = CornerVectors<5, T>;
    template <class T> using PatchConstant = EdgeRegister<T>;

    int patch_constants() const { return PmRegisters<m>::kCount; }

    template <class T>
    CornerVectors<5, T> control_point(PatchInput patch, ControlPoints<RingVertex<T>> const& in,
                                      int_of<T> i) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        Int const next = Tables::template next<T>(i);
        auto const a = Tables::template corner<T>(patch, i),
                   b = Tables::template corner<T>(patch, next);
        T const Ca = Tables::template cosine<T>(a), Cb = Tables::template cosine<T>(b);
        T const S = Tables::template sine<T>(a) + Tables::template sine<T>(b);
        V const pa = in.vector(i, Int(RingLayout::kP)), pb = in.vector(next, Int(RingLayout::kP));
        V const ta = in.vector(i, Int(RingLayout::kE) + a.plus),
                tb = in.vector(next, Int(RingLayout::kE) + b.minus);
        V const U0 = ta - pa, U1 = tb - ta, U2 = pb - tb;
        // h - g is half the difference of the face points on both sides of the edge.
        V const da = face_difference<T>(in, i, a.plus, a.before(a.plus));
        V const db = face_difference<T>(in, next, b.before(b.minus), b.minus);
        constexpr double mu = kPmMu<m>;
        T const k1(1 / (4 * mu)), k0(1 / (8 * mu)), k(3 / (8 * mu)), two_mu_1(2 * mu - 1), one(1);
        T const lift = k / S;
        CornerVectors<5, T> out;
        out.vectors[CornerLayout::kP] = pa;
        out.vectors[CornerLayout::kEPlus] = ta;
        out.vectors[CornerLayout::kEMinus] = in.vector(i, Int(RingLayout::kE) + a.minus);
        out.vectors[PmSector::kB211] = V(pm_raised(pa, ta) + T(k1 * T(one + Ca)) * U1 +
                                         T(k0 * T(two_mu_1 - Cb)) * U0 + lift * da);
        out.vectors[PmSector::kB121] = V(pm_raised(pb, tb) - T(k1 * T(one + Cb)) * U1 -
                                         T(k0 * T(two_mu_1 - Ca)) * U2 + lift * db);
        return out;
    }

    template <class T>
    EdgeRegister<T> patch_constant(PatchInput patch, ControlPoints<RingVertex<T>> const& in,
                                   ControlPoints<CornerVectors<5, T>> const& corners,
                                   int_of<T> id) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        using R = PmRegisters<m>;
        V const zero(T(0), T(0), T(0));
        auto const r = Tables::template field_register<T>(patch, id);
        mask_of<T> const middle = id >= Int(R::kMiddle);
        V value = when(
            !(r.on_edge | middle),
            [&]() -> V { return Tables::template corner_normal<T>(patch, in, r); }, zero);
        value = when(
            r.on_edge,
            [&]() -> V { return pm_transversal<T>(patch, in, r.corner, r.which, r.far); }, value);
        value = when(
            middle,
            [&]() -> V { return middle_point<T>(patch, in, corners, id - Int(R::kMiddle)); },
            value);
        return Tables::template packed<T>(r, value);
    }

    /// mu D - mu^ D^ without its multiples of u: vertex data only, whatever the sides of the two
    /// faces. Ends 3/2 (t_(j+1) - t_(j-1)), middles 3 (h_j - h_(j-1)) / S.
    template <class T>
    float3<T> pm_transversal(PatchInput patch, ControlPoints<RingVertex<T>> const& in, int_of<T> i,
                             int_of<T> which, mask_of<T> far) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        V const zero(T(0), T(0), T(0));
        auto const at = Tables::template corner<T>(patch, i);
        Int const j = select(far, at.minus, at.plus);
        mask_of<T> const end = (which == Int(0)) | (which == Int(3));
        V const inner = when(
            !end,
            [&]() -> V {
                Int const other =
                    select(far, Tables::template previous<T>(i), Tables::template next<T>(i));
                T const S = Tables::template sine<T>(at) +
                            Tables::template sine<T>(Tables::template corner<T>(patch, other));
                return T(T(3) / S) * face_difference<T>(in, i, j, at.before(j));
            },
            zero);
        return when(
            end, [&]() -> V { return Tables::template across<T>(in, at, i, j); }, inner);
    }

private:
    /// h of face j less h of face k.
    template <class T>
    static float3<T> face_difference(ControlPoints<RingVertex<T>> const& in, int_of<T> i,
                                     int_of<T> j, int_of<T> k)
    {
        using Int = int_of<T>;
        return float3<T>(in.vector(i, Int(RingLayout::kSecond) + j) -
                         in.vector(i, Int(RingLayout::kSecond) + k));
    }

    /// sum over the corners of w p + 9 h + 3 (g at both ends of the corner's + edge), over m
    /// (15+w).
    template <class T>
    float3<T> centre(PatchInput patch, ControlPoints<RingVertex<T>> const& in) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        constexpr double w = m == 3 ? 2 : 1, all = m * (15 + w);
        V p(T(0), T(0), T(0)), h = p, g2 = p;
        for (int i : loop<T>(m)) {
            Int const here(i), next((i + 1) % m);
            auto const a = Tables::template corner<T>(patch, here),
                       b = Tables::template corner<T>(patch, next);
            auto const face = [&](Int corner, Int j) -> V {
                return in.vector(corner, Int(RingLayout::kSecond) + j);
            };
            p = p + in.vector(here, Int(RingLayout::kP));
            V const ha = face(here, a.plus), hb = face(next, b.before(b.minus));
            h = h + ha;
            // g is the mean of the face points on both sides.
            g2 = g2 + ha + face(here, a.before(a.plus)) + hb + face(next, b.minus);
        }
        return T(w / all) * p + T(9 / all) * h + T(1.5 / all) * g2;
    }

    /// b112 of sector i, and the centre for i = m.
    template <class T>
    float3<T> middle_point(PatchInput patch, ControlPoints<RingVertex<T>> const& in,
                           ControlPoints<CornerVectors<5, T>> const& corners, int_of<T> i) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        V const cen = centre<T>(patch, in);
        return when(
            i < Int(m),
            [&]() -> V {
                Int const after = Tables::template next<T>(i),
                          opposite = Tables::template next<T>(after);
                auto const x = [&](Int k) -> V { return corners.vector(k, Int(PmSector::kB211)); };
                auto const y = [&](Int k) -> V { return corners.vector(k, Int(PmSector::kB121)); };
                if constexpr (m == 4) {
                    Int const before = Tables::template previous<T>(i);
                    V const xi = x(i), yi = y(i), xn = x(after), yn = y(after), xp = x(before),
                            yp = y(before), xo = x(opposite), yo = y(opposite);
                    V const near = xi + yi - yn - xp, far = xn + yp - xo - yo;
                    return cen + T(3.0 / 16) * near + T(1.0 / 16) * far;
                } else { // (3 cen - s_(i+2)) / 2
                    V const p = corners.vector(opposite, Int(CornerLayout::kP));
                    V const b310 =
                        pm_raised(p, corners.vector(opposite, Int(CornerLayout::kEPlus)));
                    V const b130 =
                        pm_raised(p, corners.vector(opposite, Int(CornerLayout::kEMinus)));
                    V const b301 = pm_join<m>(b310, b130, p);
                    V const s = pm_join<m>(x(opposite), y(after), b301);
                    return T(1.5) * cen - T(0.5) * s;
                }
            },
            cen);
    }
};

/// A regular face of the scheme: the bicubic of p, t+, t-, h, and the scheme's edges.
template <class Weight = float>
struct PmRegularHullShader : PmHullShader<TessellatorDomain::Quad, Weight> {
    using Pm = PmHullShader<TessellatorDomain::Quad, Weight>;
    using Tables = typename Pm::Tables;
    template <class T> using ControlPoint = CornerVectors<4, T>;

    int patch_constants() const { return 5 * Pm::m; }

    template <class T>
    CornerVectors<4, T> control_point(PatchInput patch, ControlPoints<RingVertex<T>> const& in,
                                      int_of<T> i) const
    {
        using Int = int_of<T>;
        auto const a = Tables::template corner<T>(patch, i);
        return {{in.vector(i, Int(RingLayout::kP)), in.vector(i, Int(RingLayout::kE) + a.plus),
                 in.vector(i, Int(RingLayout::kE) + a.minus),
                 in.vector(i, Int(RingLayout::kSecond) + a.plus)}};
    }

    template <class T>
    EdgeRegister<T> patch_constant(PatchInput patch, ControlPoints<RingVertex<T>> const& in,
                                   ControlPoints<CornerVectors<4, T>> const&, int_of<T> id) const
    {
        using V = float3<T>;
        V const zero(T(0), T(0), T(0));
        auto const r = Tables::template field_register<T>(patch, id);
        V const normal = when(
            !r.on_edge, [&]() -> V { return Tables::template corner_normal<T>(patch, in, r); },
            zero);
        return Tables::template packed<T>(r, when(
                                                 r.on_edge,
                                                 [&]() -> V {
                                                     return Pm::template pm_transversal<T>(
                                                         patch, in, r.corner, r.which, r.far);
                                                 },
                                                 normal));
    }
};

} // namespace tessemu
