// Which edges of its patch a domain point lies on, and where: the one place that knows, for shaders
// and checkers. pipeline/mesh/patch_place.cpp names points of the mesh by the same edges.
//
//     quad   3 <-k=2-- 2        tri    2          edge k runs from corner k to corner k+1;
//        k=3 |         ^            k=2| \ k=1    quad: u along edge 0, v along edge 3 backwards
//            v         | k=1           v   \      tri: weights u, v, w at corners 0, 1, 2
//            0 --k=0-> 1               0 -> 1
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"

namespace tessemu {

template <int N, class T> struct DomainEdges {
    mask_of<T> on[N]; ///< on[k]: the point lies on edge k
    T t[N];           ///< its parameter on edge k, from corner k to corner k+1
};

inline constexpr int sides_of(TessellatorDomain domain)
{
    return domain == TessellatorDomain::Quad ? 4 : 3;
}

/// \param U, V  1 - u, 1 - v
template <class T> constexpr DomainEdges<4, T> quad_edges(T u, T v, T U, T V)
{
    return {{v == T(0), u == T(1), v == T(1), u == T(0)}, {u, v, U, V}};
}
template <class T> constexpr DomainEdges<3, T> triangle_edges(T u, T v, T w)
{
    return {{w == T(0), u == T(0), v == T(0)}, {v, w, u}};
}

/// Of a shape that is known at run time alone; a triangle's fourth edge repeats its second.
template <class T> constexpr DomainEdges<4, T> domain_edges(int sides, T u, T v, T w, T U, T V)
{
    if (sides == 4) return quad_edges<T>(u, v, U, V);
    return {{w == T(0), u == T(0), v == T(0), u == T(0)}, {v, w, u, V}};
}

/// \tparam kDomain  Quad or Tri. \cost quad 4 comparisons, 2 add; tri 3 comparisons
template <TessellatorDomain kDomain, class T> constexpr auto domain_edges(DomainInput<T> const& in)
{
    if constexpr (kDomain == TessellatorDomain::Quad)
        return quad_edges<T>(in.u, in.v, T(1) - in.u, T(1) - in.v);
    else
        return triangle_edges<T>(in.u, in.v, in.w);
}

} // namespace tessemu
