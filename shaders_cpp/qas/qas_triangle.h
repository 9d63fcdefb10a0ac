// QAS: quadratic approximation of a subdivision surface (Boubekeur and Schlick 2007;
// docs/math/subdivision.md, 6.5).
//
//     b_200 = L_0, b_020 = L_1, b_002 = L_2        limits of the triangle's vertices
//     b_110 = 2 M_01 - (L_0 + L_1)/2, ...           that the middles of its edges go through M
//     p = u^2 b_200 + v^2 b_020 + w^2 b_002 + 2 (uv b_110 + vw b_011 + wu b_101)
//
// and a quadratic triangle of normals of the same kind. The paper gives the idea; coefficients
// follow from interpolation.
//
// Edges have equal bits from both sides: control points there are sums of two, and on an edge the
// terms that are left are one of two squares and one product. Products are named, so that no
// contraction fuses one.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "shaders_cpp/cage_form/cage_shaders.h"

namespace tessemu {

/// Limit points L_0, L_1, L_2, M_01, M_12, M_20 to control points, in that order.
struct QasHullShader {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Tri;
    static constexpr int kPoints = 6;
    template <class T> using Input = NormalVertex<T>;
    template <class T> using ControlPoint = NormalVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>; // none
    template <class T> using Points = ControlPoints<NormalVertex<T>>;

    TessFactorRule factors;

    int control_points() const { return kPoints; }
    int patch_constants() const { return 0; }
    /// \cost 12 mul, 12 add; 3 fetches
    template <class T>
    NormalVertex<T> control_point(PatchInput, Points<T> const& in, int_of<T> id) const
    {
        using Int = int_of<T>;
        Int const edge = id - ((id + Int(5)) >> Int(3)) * Int(3); // id mod 3
        Int const next = (Int(9) >> (edge + edge)) & Int(3);      // 1, 2, 0
        NormalVertex<T> const at = in[id], a = in[edge], b = in[next];
        auto const is_corner = id < Int(3);
        auto const through = [&](float3<T> const& m, float3<T> const& p, float3<T> const& q) {
            float3<T> const ends = p + q;
            return float3<T>(T(2) * m - T(0.5) * ends); // both products are exact
        };
        return select_record(is_corner, at,
                             NormalVertex<T>{through(at.position, a.position, b.position),
                                             through(at.normal, a.normal, b.normal)});
    }
    template <class T>
    ControlVertex<T> patch_constant(PatchInput, Points<T> const&, Points<T> const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, Points<T> const& in, Points<T> const&,
                                  ControlPoints<ControlVertex<T>> const&) const
    {
        return cage_factors<kDomain, T>(factors, [&](int k) { return in[k].position; });
    }
};

struct QasTriangle {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Tri;
    static constexpr int kControlPoints = QasHullShader::kPoints;
    template <class T> using ControlPoint = NormalVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>;
    template <class T> using Output = SurfacePoint<T>;

    /// \cost  51 mul, 32 add, 1 div, 1 sqrt, 1 comparison; 6 fetches
    template <class T>
    constexpr SurfacePoint<T> operator()(DomainInput<T> const& in,
                                         ControlPoints<NormalVertex<T>> const& b,
                                         ControlPoints<ControlVertex<T>> const&) const
    {
        T const uu = in.u * in.u, vv = in.v * in.v, ww = in.w * in.w;
        T const uv = in.u * in.v, vw = in.v * in.w, wu = in.w * in.u;
        T const weight[6] = {uu, vv, ww, T(T(2) * uv), T(T(2) * vw), T(T(2) * wu)};
        float3<T> p[6], n[6];
        for (int i = 0; i < 6; ++i) {
            NormalVertex<T> const c = b[i];
            p[i] = weight[i] * c.position;
            n[i] = weight[i] * c.normal;
        }
        auto const sum = [](float3<T> const(&x)[6]) {
            float3<T> const squares = x[0] + x[1] + x[2], products = x[3] + x[4] + x[5];
            return float3<T>(squares + products);
        };
        return {sum(p), unit_or(sum(n), [] { return float3<T>(T(0), T(0), T(1)); })};
    }
};

} // namespace tessemu
