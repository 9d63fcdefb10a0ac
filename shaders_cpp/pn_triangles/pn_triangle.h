// PN triangles (Vlachos, Peters, Boyd, Mitchell 2001; docs/math/subdivision.md, 6.5): a cubic
// Bezier triangle of positions and a quadratic one of normals.
//
//                 P2                  b_ij = (2 P_i + P_j - ((P_j - P_i) . N_i) N_i) / 3
//               /    \                b111 = E + (E - V)/2, E the mean of the six b_ij,
//            b20      b21                                   V the mean of the three P_i
//           /            \            n_ij = N_i + N_j - v_ij (P_j - P_i), of length 1,
//        b02     b111     b12         v_ij = 2 (P_j - P_i) . (N_i + N_j) / |P_j - P_i|^2
//       /                    \        .
//     P0 ---- b01 ---- b10 ---- P1    u is 1 at P0, v at P1, w at P2
//
// Control points: corners 0, 1, 2 with their normals. Patch constants: PnRegisters.
//
// Edges have equal bits from both sides: b_ij is a routine of the edge's ends in order, and of n_ij
// every step is the same with i and j exchanged, but for signs that cancel. On an edge the third
// weight is 0, and what is left are two sums of two rounded terms each, which do not depend on
// their order, and the sum of the two sums. So every product has a name, as in phong_triangle.h.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "shaders_cpp/cage_form/cage_shaders.h"

namespace tessemu {

/// Registers of the patch constants, for edge k from corner k to corner k+1.
struct PnRegisters {
    static constexpr int kNear = 0;   ///< b_(k)(k+1), which lies near corner k
    static constexpr int kFar = 3;    ///< b_(k+1)(k), which lies near corner k+1
    static constexpr int kNormal = 6; ///< n_(k)(k+1)
    static constexpr int kCentre = 9; ///< b111
    static constexpr int kCount = 10;
};

/// b_ij, a third of the way from a = P_i to b = P_j, on the tangent plane of a.
/// \cost 12 mul, 11 add
template <class T>
constexpr float3<T> pn_edge_point(NormalVertex<T> const& a, NormalVertex<T> const& b)
{
    Routine<T> const here("pn_edge_point");
    T const w_ij = dot(float3<T>(b.position - a.position), a.normal);
    float3<T> const sum = T(2) * a.position + b.position - w_ij * a.normal;
    return T(1.0 / 3) * sum;
}

/// n_ij: the mean of the ends' normals, mirrored in the plane across the edge's middle; mean alone
/// where the edge has no length, 0 where that is 0. \cost 16 mul, 15 add, 2 div, 1 sqrt, 2
/// comparisons
template <class T>
constexpr float3<T> pn_edge_normal(NormalVertex<T> const& a, NormalVertex<T> const& b)
{
    Routine<T> const here("pn_edge_normal");
    float3<T> const edge = b.position - a.position, sum = a.normal + b.normal;
    T const squared = dot(edge, edge), along = dot(edge, sum);
    T const v_ij = T(2) * along / select(squared > T(0), squared, T(1));
    return unit_or_zero(float3<T>(sum - v_ij * edge));
}

/// b111. With S = P_0 + P_1 + P_2 the terms 2 P_i + P_j of the six b_ij add up to 6 S, so that
/// E = S/3 - (sum of (S - 3 P_i) . N_i N_i)/18. \cost 33 mul, 33 add
template <class T> constexpr float3<T> pn_centre(ControlPoints<NormalVertex<T>> const& corners)
{
    Routine<T> const here("pn_centre");
    NormalVertex<T> const a = corners[0], b = corners[1], c = corners[2];
    float3<T> const sum = a.position + b.position + c.position;
    float3<T> pull(T(0), T(0), T(0));
    for (NormalVertex<T> const& i : {a, b, c}) {
        T const height = dot(float3<T>(sum - T(3) * i.position), i.normal);
        pull = pull + height * i.normal;
    }
    return T(1.0 / 3) * sum - T(1.0 / 12) * pull;
}

/// Hands the vertices on; the fork phase makes the other control points, one an instance.
struct PnHullShader : CageHullShader<TessellatorDomain::Tri> {
    int patch_constants() const { return PnRegisters::kCount; }
    template <class T>
    ControlVertex<T> patch_constant(PatchInput, Points<T> const&, Points<T> const& corners,
                                    int_of<T> instance) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        using R = PnRegisters;
        mask_of<T> const on_edge = instance < Int(R::kNormal), centre = instance == Int(R::kCentre),
                         far = on_edge & (instance >= Int(R::kFar));
        Int const k = instance - select(on_edge, select(far, Int(R::kFar), Int(R::kNear)),
                                        select(centre, Int(R::kCentre), Int(R::kNormal)));
        Int const next = select(k == Int(2), Int(0), k + Int(1));
        NormalVertex<T> const i = corners[select(far, next, k)], j = corners[select(far, k, next)];
        V b = when(
            on_edge, [&]() -> V { return pn_edge_point<T>(i, j); }, V(T(0), T(0), T(0)));
        b = when(
            !(on_edge | centre), [&]() -> V { return pn_edge_normal<T>(i, j); }, b);
        b = when(
            centre, [&]() -> V { return pn_centre<T>(corners); }, b);
        return {b};
    }
};

struct PnTriangle {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Tri;
    static constexpr int kControlPoints = 3;
    template <class T> using ControlPoint = NormalVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>;
    template <class T> using Output = SurfacePoint<T>;

    /// \cost  74 mul, 44 add, 1 div, 1 sqrt, 1 comparison; 13 fetches
    template <class T>
    constexpr SurfacePoint<T> operator()(DomainInput<T> const& in,
                                         ControlPoints<NormalVertex<T>> const& patch,
                                         ControlPoints<ControlVertex<T>> const& constants) const
    {
        using V = float3<T>;
        using R = PnRegisters;
        NormalVertex<T> const P[] = {patch[0], patch[1], patch[2]};
        T const weight[] = {in.u, in.v, in.w};
        T square[3], thrice[3], product[3];
        V corner[3], corner_normal[3], edge[3], edge_normal[3];
        for (int k : loop<T>(3)) {
            square[k] = weight[k] * weight[k];
            thrice[k] = T(3) * square[k];
            product[k] = weight[k] * weight[(k + 1) % 3];
        }
        for (int k : loop<T>(3)) {
            int const next = (k + 1) % 3;
            T const cube = square[k] * weight[k];
            corner[k] = cube * P[k].position;
            corner_normal[k] = square[k] * P[k].normal;
            // 3 u^2 v b01 + 3 u v^2 b10
            T const of_near = thrice[k] * weight[next], of_far = thrice[next] * weight[k];
            V const near = of_near * constants[R::kNear + k].position,
                    far = of_far * constants[R::kFar + k].position;
            edge[k] = near + far;
            edge_normal[k] = product[k] * constants[R::kNormal + k].position;
        }
        T const six_uvw = T(6) * T(product[0] * weight[2]);
        V const centre = six_uvw * constants[R::kCentre].position;
        V const corners = corner[0] + corner[1] + corner[2], edges = edge[0] + edge[1] + edge[2];
        V const at_corners = corner_normal[0] + corner_normal[1] + corner_normal[2],
                at_edges = edge_normal[0] + edge_normal[1] + edge_normal[2];
        V const p = corners + edges;
        // Where all cancel there is z, the same from both sides of an edge.
        V const normal = unit_or(V(at_corners + at_edges), [] { return V(T(0), T(0), T(1)); });
        return {V(p + centre), normal};
    }
};

} // namespace tessemu
