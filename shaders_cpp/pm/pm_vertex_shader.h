// Vertex shader of Pm-patches (Myles, Ni, Peters 2008; docs/math/loop09.md, 6), over one-ring
// textures as LOOP09 section 4.1 has them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/two_stage_form/ring_vertex.h"

namespace tessemu {

/// Numbers that depend on a vertex's valence n alone, a row of kRow floats each:
///
///     [0], [1], [2]   p = [0] v + [1] sum d_j + [2] sum y_j     n^2, 4 and 1 over n (n+5)
///     then four for each edge j:
///     [0]             A += [0] g_j                              cos(2pi j/n) / (n lambda(n))
///     [1]             B += [1] g_j                              the sine in its place
///     [2], [3]        t_j = p + [2] A + [3] B                   cos(2pi j/n), sin(2pi j/n)
///
/// d_j: far end of edge j. y_j: vertex opposite in face j. g_j: edge j's mean of the face points.
struct PmConstants {
    static constexpr int kEach = 4;
    static constexpr int kRow = 3 + kEach * RingLayout::kEdges;
};

/// Puts out p, the normal A x B, edge points t_j and, as the ring's second vectors, face points
/// h_j. Interior vertices only.
///
/// \tparam Weight  float; double in tests of the formulas
template <class Weight = float> struct PmVertexShader : RingTextures {
    template <class T> using Input = ControlVertex<T>;
    template <class T> using Output = RingVertex<T>;

    Buffer<Weight> constants; ///< PmConstants

    std::vector<ResourceInfo> resources() const
    {
        return {rings.info(), entries.info(), positions.info(), constants.info()};
    }

    /// \cost  21n + 18 mul, and 3 more for each triangle of the ring: per face 6 for h_j, 3 for
    ///        g_j, 6 for A and B, 6 for t_j; 3 for 4v, 9 for p, 6 for the normal
    template <class T>
    RingVertex<T> operator()(VertexInput<T> const& in, ControlVertex<T> const& stream) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        constexpr int kEdges = RingLayout::kEdges;
        V const v = stream.position, zero(T(0), T(0), T(0));
        RingTextures::Ring<T> const at = RingTextures::ring<T>(in.vertex_id);
        Int const n = at.n, row = n * Int(PmConstants::kRow);
        auto const constant = [&](int i) -> T { return load<T>(constants, row + Int(i)); };
        auto const of_edge = [&](int j, int k) -> T {
            return constant(3 + PmConstants::kEach * j + k);
        };
        V d[kEdges + 1];
        for (int j : loop<T>(kEdges))
            d[j] = when(
                Int(j) < n, [&]() -> V { return far_end<T>(at, j); }, zero);
        d[kEdges] = zero;
        // y_j: the diagonal vertex; in a triangle the middle of the opposite edge.
        V h[kEdges], last_h = zero, sum_d = zero, sum_y = zero;
        V const v4 = T(4) * v;
        for (int j : loop<T>(kEdges)) {
            auto const here = Int(j) < n;
            V const next = select(Int(j + 1) == n, d[0], d[j + 1]);
            V const y = when(
                here,
                [&]() -> V {
                    Int const across = diagonal<T>(at, j);
                    auto const quad = across != Int(-1);
                    V const middle = when(
                        !quad, [&]() -> V { return T(0.5) * V(d[j] + next); }, zero);
                    return when(
                        quad, [&]() -> V { return position<T>(across); }, middle);
                },
                zero);
            h[j] = when(
                here,
                [&]() -> V {
                    V const sum = v4 + T(2) * V(d[j] + next) + y;
                    return T(1.0 / 9) * sum;
                },
                zero);
            last_h = select(Int(j) == n - Int(1), h[j], last_h);
            sum_d = when(
                here, [&]() -> V { return sum_d + d[j]; }, sum_d);
            sum_y = when(
                here, [&]() -> V { return sum_y + y; }, sum_y);
        }
        V const p = constant(0) * v + constant(1) * sum_d + constant(2) * sum_y;
        V A = zero, B = zero;
        for (int j : loop<T>(kEdges)) {
            auto const here = Int(j) < n;
            V const g = when(
                here,
                [&]() -> V { return T(0.5) * V((j == 0 ? last_h : h[j == 0 ? 0 : j - 1]) + h[j]); },
                zero);
            A = when(
                here, [&]() -> V { return A + of_edge(j, 0) * g; }, A);
            B = when(
                here, [&]() -> V { return B + of_edge(j, 1) * g; }, B);
        }
        RingVertex<T> out;
        out.vectors.fill(zero);
        out.vectors[RingLayout::kP] = p;
        out.vectors[RingLayout::kNormal] = cross(A, B);
        for (int j : loop<T>(kEdges)) {
            out.vectors[std::size_t(RingLayout::kE + j)] = when(
                Int(j) < n, [&]() -> V { return p + of_edge(j, 2) * A + of_edge(j, 3) * B; }, zero);
            out.vectors[std::size_t(RingLayout::kSecond + j)] = h[j];
        }
        return out;
    }
};

} // namespace tessemu
