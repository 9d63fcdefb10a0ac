// Pm-patch (Myles, Ni, Peters 2008; docs/math/loop09.md, 6): m quartic Bezier triangles that meet
// at a centre; 6m + 1 coefficients, 25 for a quad and 19 for a triangle.
//
// A domain point lies in one sector, which needs 14 of the coefficients. Which ones depends on
// (u,v), so the shader reads all of them, as LOOP09 counts: 5 vectors of each sector, and b112 of
// each sector and the centre from the patch constants.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/pm/pm_hull_shader.h"
#include "shaders_cpp/two_stage_form/by_corners.h"

namespace tessemu {

/// A point in its sector: barycentric coordinates of corner i, corner i+1 and the centre.
template <int m, class T> struct PmSectorPoint {
    T a, b, c;
    mask_of<T> in[m]; ///< in[i]: the point lies in sector i
};

/// The domain map (tessellator to sector). \cost 2 comparisons, 1 mul
template <class T> constexpr PmSectorPoint<4, T> pm_sector_of_quad(T u, T v)
{
    T const sum = u + v, difference = u - v, one(1);
    mask_of<T> const below = v <= u, left = sum <= one, above = !below, right = !left;
    T const rest = one - sum;
    // The distance to the sector's edge is a quarter of the way round from sector to sector.
    T const height = select(below, select(left, v, T(one - u)), select(left, u, T(one - v)));
    T const a =
        select(below, select(left, rest, difference), select(left, T(-difference), T(-rest)));
    T const b =
        select(below, select(left, difference, T(-rest)), select(left, rest, T(-difference)));
    return {a,
            b,
            T(2) * height,
            {mask_of<T>(below & left), mask_of<T>(below & right), mask_of<T>(above & right),
             mask_of<T>(above & left)}};
}
template <class T> constexpr PmSectorPoint<3, T> pm_sector_of_triangle(T b0, T b1, T b2)
{
    mask_of<T> const not_0 = b2 <= b0, not_1 = b2 <= b1, under_1 = b0 <= b1;
    mask_of<T> const two = not_0 & not_1; // b2 is smallest: sector 0
    mask_of<T> const other = !two, zero = other & under_1, one = !(two | zero);
    T const least = select(two, b2, select(zero, b0, b1));
    T const first = select(two, b0, select(zero, b1, b2));
    T const second = select(two, b1, select(zero, b2, b0));
    return {first - least, second - least, T(3) * least, {two, zero, one}};
}

/// \returns  position, and a quarter of the derivatives towards the two corners of the sector
/// \cost     225 mul with the map for a quad (232 with the cross product)
template <int m, class T>
constexpr TangentFrame<T> pm_patch(ControlPoints<CornerVectors<5, T>> const& corners,
                                   ControlPoints<EdgeRegister<T>> const& registers,
                                   PmSectorPoint<m, T> const& at)
{
    using V = float3<T>;
    using R = PmRegisters<m>;
    Routine<T> const here("pm_patch");
    V all[m][6];
    for (int i = 0; i < m; ++i) {
        for (int k = 0; k < 5; ++k) all[i][k] = corners.vector(i, k);
        all[i][5] = registers[R::kMiddle + i].vector;
    }
    V const centre = registers[R::kCentre].vector;
    // Vector k of the sector that lies `turn` after the point's.
    auto const of = [&](int turn, int k) -> V {
        V v = all[turn % m][k];
        for (int i = 1; i < m; ++i) v = select(at.in[i], all[(i + turn) % m][k], v);
        return v;
    };
    constexpr int kBefore = m - 1, kB112 = 5;
    using S = CornerLayout;
    V const p0 = of(0, S::kP), p1 = of(1, S::kP), t0 = of(0, S::kEPlus), t1 = of(1, S::kEMinus);
    V const x = of(0, PmSector::kB211), y = of(0, PmSector::kB121), z = of(0, kB112);
    V const b310 = pm_raised(p0, t0), b130 = pm_raised(p1, t1);
    V const b301 = pm_join<m>(b310, pm_raised(p0, of(0, S::kEMinus)), p0);
    V const b202 = pm_join<m>(x, of(kBefore, PmSector::kB121), b301);
    V const b103 = pm_join<m>(z, of(kBefore, kB112), b202);
    V const b031 = pm_join<m>(pm_raised(p1, of(1, S::kEPlus)), b130, p1);
    V const b022 = pm_join<m>(of(1, PmSector::kB211), y, b031);
    V const b013 = pm_join<m>(of(1, kB112), z, b022);
    V const t_sum = t0 + t1;
    V const b[5][5] = {{p0},
                       {b310, b301},
                       {V(T(0.5) * t_sum), x, b202},
                       {b130, y, z, b103},
                       {p1, b031, b022, b013, centre}};
    return quartic_triangle<T>(b, at.a, at.b, at.c);
}

template <int m> struct PmInside : CubicEdges<m> {
    static constexpr TessellatorDomain kDomain =
        m == 4 ? TessellatorDomain::Quad : TessellatorDomain::Tri;
    static constexpr int kControlPoints = m;
    template <class T> using ControlPoint = CornerVectors<5, T>;
    template <class T> using Corners = ControlPoints<CornerVectors<5, T>>;
    template <class T> using View = CornersAsPatch<m, 5, T>;

    template <class T>
    static constexpr TangentFrame<T> evaluate(Corners<T> const& corners,
                                              ControlPoints<EdgeRegister<T>> const& registers,
                                              DomainInput<T> const& in)
    {
        if constexpr (m == 4)
            return pm_patch<m, T>(corners, registers, pm_sector_of_quad<T>(in.u, in.v));
        else
            return pm_patch<m, T>(corners, registers, pm_sector_of_triangle<T>(in.u, in.v, in.w));
    }
    template <class T> static constexpr EdgeCurve<T> edge(Corners<T> const& corners, int k)
    {
        return cubic_edge<m>(View<T>(corners), k);
    }
    template <class T> static constexpr float3<T> corner(Corners<T> const& corners, int i)
    {
        return corners.vector(i, CornerLayout::kP);
    }
    template <class T>
    static constexpr float3<T> corner_normal(ControlPoints<EdgeRegister<T>> const& registers, int i)
    {
        return registers[4 * m + i].vector;
    }
};

using PmQuadDomainShader = WatertightPatch<PmInside<4>>;
using PmTriangleDomainShader = WatertightPatch<PmInside<3>>;

} // namespace tessemu
