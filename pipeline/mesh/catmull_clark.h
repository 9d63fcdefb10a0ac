// Catmull-Clark subdivision: masks, limits, and the step that splits every n-gon into n quads.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/limit_constants.h"
#include "pipeline/mesh/refined_step.h"

#include <glm/vec3.hpp>

#include <cmath>

namespace tessemu {

/// F = mean of the face, E = (a + b + F + F')/4, V = (n-2)/n V + mean(d)/n + mean(F)/n (LOOP10
/// section 3; docs/math/subdivision.md, 1.1); along a boundary or crease midpoints and (1,6,1)/8.
struct CatmullClark {
    static constexpr bool kKeepsTriangles = false, kSectorRules = true;

    template <class X> static X face(X const& sum, int sides) { return sum / double(sides); }
    /// At triangles to be smoothed the faces' points weigh 0.47 on a triangle's side and 1/4 on
    /// another's, each the mean of both (OpenSubdiv's smoothtriangles).
    template <class X>
    static X edge(X const& a, X const& b, X const& left, X const& right, int triangles)
    {
        if (triangles == 0) return (a + b + left + right) / 4.0;
        double const w = triangles == 2 ? 0.47 : 0.5 * (0.47 + 0.25);
        return (a + b) * (0.5 * (1 - 2 * w)) + (left + right) * w;
    }
    template <class X> static X vertex(int n, X const& v, X const& edges, X const& faces)
    {
        double const k = n;
        return (k - 2) / k * v + edges / (k * k) + faces / (k * k);
    }
    template <class X> static X crease_edge(X const& a, X const& b) { return (a + b) / 2.0; }
    template <class X> static X crease_vertex(X const& a, X const& v, X const& b)
    {
        return (a + 6.0 * v + b) / 8.0;
    }
    /// 3/8 - gamma (docs/math/subdivision.md, 5.2)
    static double lean(double cos_theta) { return cos_theta / 4; }

    /// (n^2 v + 4 sum d + sum x) / (n (n + 5)) and LOOP09 3.3's two tangents; on a mesh of quads.
    template <class X, class Edge, class Face>
    static std::array<X, 3> limit(int n, X const& v, Edge const& edge, Face const& face)
    {
        double const k = n, sigma = loop09_sigma(n);
        double const on_edge = 1 + sigma * cos_pi(1, n), on_face = sigma;
        X p = k * k * v, a = 0.0 * v, b = a;
        for (int j = 0; j < n; ++j) {
            X const &d = edge(std::size_t(j)), &x = face(std::size_t(j));
            p += 4.0 * d + x;
            a += on_edge * cos_pi(2 * j, n) * d + on_face * cos_pi(2 * j + 1, n) * x;
            b += on_edge * sin_pi(2 * j, n) * d + on_face * sin_pi(2 * j + 1, n) * x;
        }
        p /= k * (k + 5);
        return {p, a, b};
    }
    template <class X> static X crease_limit(X const& a, X const& v, X const& b)
    {
        return (a + 4.0 * v + b) / 6.0;
    }
    /// The left eigenvector of the largest sine mode, k > 1 (docs/math/loop09.md, 4: the plain
    /// rule's).
    template <class X, class Edge, class Face>
    static X crease_across(int k, X const& v, Edge const& edge, Face const& face)
    {
        double const c = cos_pi(1, k), lambda = (5 + c + std::sqrt((c + 9) * (c + 1))) / 16;
        double edges = 0, faces = 0;
        X out = 0.0 * v;
        for (int j = 0; j < k; ++j) {
            double const on_edge = 4 * (4 * lambda - 1) * sin_pi(j, k),
                         on_face = sin_pi(j, k) + sin_pi(j + 1, k);
            if (j > 0) out += on_edge * edge(std::size_t(j));
            out += on_face * face(std::size_t(j));
            edges += on_edge, faces += on_face;
        }
        double const to_end = (4 * lambda - 1) * sin_pi(1, k) / 4 + sin_pi(1, k) / 4,
                     to_vertex = 3 * edges / 8 + faces / 4,
                     determinant = (lambda - 0.5) * (lambda - 0.75) - 0.125;
        out += (to_end * (lambda - 0.75) + to_vertex / 8) / determinant *
               (edge(0) + edge(std::size_t(k)));
        out += (to_vertex * (lambda - 0.5) + to_end) / determinant * v;
        return out;
    }
    /// sum 4 sin(t_j) e_j + (sin(t_j) + sin(t_(j+1))) f_j, j = 0 to k - 1,
    /// t_j = j pi a/b + quarters pi/2 (docs/math/subdivision.md, 5.3)
    template <class X, class Edge, class Face>
    static X turning(int k, int a, int b, int quarters, X const& v, Edge const& edge,
                     Face const& face)
    {
        auto const sine = [&](int j) { return sin_pi(2 * a * j + quarters * b, 2 * b); };
        X out = 0.0 * v;
        for (int j = 0; j < k; ++j) {
            if (double const w = sine(j); w != 0) out += 4 * w * edge(std::size_t(j));
            out += (sine(j) + sine(j + 1)) * face(std::size_t(j));
        }
        return out;
    }
    /// k > 1 (docs/math/subdivision.md, 5.3)
    template <class X, class Edge, class Face>
    static X crease_across_by_biermann(int k, X const& v, Edge const& edge, Face const& face)
    {
        double const c = cos_pi(1, k), s = sin_pi(1, k);
        X out = turning(k, 1, k, 0, v, edge, face);
        out -= 4 * s * v;
        out -= (1 + c) / s * (1 + 2 * c) * (edge(0) + edge(std::size_t(k)));
        return out;
    }
    /// Of [[gamma + c/8, h/8], [h/2, 1/4]] with (1, b), c = cos(theta), h = cos(theta/2).
    static double mode_on_face(double lambda, double cos_half_theta)
    {
        return cos_half_theta / (2 * (lambda - 0.25));
    }
    /// The larger one of [[gamma + c/8, h/8], [h/2, 1/4]], c = cos(pi/k), h = cos(pi/2k), gamma of
    /// theta = 3 pi/2k: of the mode sin(j pi/k).
    static double concave_eigenvalue(int k)
    {
        double const on_edge = 0.375 - lean(cos_pi(3, 2 * k)) + cos_pi(1, k) / 8,
                     h = cos_pi(1, 2 * k), apart = on_edge - 0.25;
        return (on_edge + 0.25 + std::sqrt(apart * apart + h * h / 4)) / 2;
    }
};

/// With the mesh's creases, corners and boundary rule. Tags go on to the new edges and vertices,
/// decremented; the quads of holes are holes. `first` above 0: all faces are quads, for a step has
/// made them. The tables are those by which LOOP10's kernels make the same points.
RefinedStep take_catmull_clark_step(Topology const& topology, std::uint32_t first);
extern LimitRules const catmull_clark_limits;
inline constexpr RefinementStep catmull_clark_step{take_catmull_clark_step, false, "Catmull-Clark",
                                                   &catmull_clark_limits};

} // namespace tessemu
