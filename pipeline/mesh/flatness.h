// Flatness by Biermann's rules: after a step, the ring of a vertex moves into a plane, or part of
// the way (docs/math/subdivision.md, 5.2).
//
//     p <- (1 - s) p + s (a0 + a1 x1 + a2 x2)      a_i = left_i . p, x1, x2 the subdominant pair
//
// Beyond those of ring.h and limit.h, Masks has
//
//     mode_on_face(lambda, cos_half_theta)  what face i has of an eigenvector of lambda, where edge
//                                           j has cos(j theta) or sin(j theta) and face i this times
//                                           that of (i + 1/2) theta
//     concave_eigenvalue(k)                 the largest but 1 of a concave sector of k faces
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/limit.h"
#include "pipeline/mesh/limit_constants.h"

#include <algorithm>
#include <type_traits>

namespace tessemu {

/// How the new ring of a vertex is flattened. Points are numbered as in Ring::point.
struct FlatRing {
    struct Sector {
        double flatness;
        std::array<RingWeights, 3> left;  ///< a_i by weights of the ring's points
        std::array<RingWeights, 2> modes; ///< x1 and x2 by point
        std::vector<std::size_t> points;  ///< those that move
    };
    std::vector<Sector> sectors; ///< no point moves in two of them

    /// \param at  point i of the new ring, which stays as it is meanwhile
    /// \param by  called with points that move, and by how much
    template <class At, class By> void moves(At const& at, By const& by) const
    {
        using X = std::decay_t<decltype(at(0))>;
        for (Sector const& s : sectors) {
            auto const apply = [&](RingWeights const& w) {
                std::size_t i = 0;
                while (w[i] == 0) ++i; // as a mask it is not zero
                X sum = at(i) * w[i];
                while (++i < w.size())
                    if (w[i] != 0) sum += at(i) * w[i];
                return sum;
            };
            X const a[3] = {apply(s.left[0]), apply(s.left[1]), apply(s.left[2])};
            for (std::size_t i : s.points) {
                X move = a[0] * s.flatness;
                move += a[1] * (s.flatness * s.modes[0][i]);
                move += a[2] * (s.flatness * s.modes[1][i]);
                move += at(i) * -s.flatness;
                by(i, std::move(move));
            }
        }
    }
};

/// Whether a step flattens the ring of a vertex with n faces. What a step makes along creases is
/// never: two faces on each side.
inline bool is_flattened(RingSharpness const& sharp, std::size_t n)
{
    if (!sharp.biermann || sharp.is_semi_sharp()) return false;
    auto const sectors = sharp.sectors();
    auto const any = [&](auto const& is) {
        return std::any_of(sectors.begin(), sectors.end(), is);
    };
    if (!sharp.flatness) return any([](RingSector const& s) { return s.concave; });
    if (*sharp.flatness == 0) return false;
    switch (sharp.rule()) {
    case VertexRule::Smooth:
        return n > 2 && n != 4;
    case VertexRule::Dart:
        return n > 2;
    case VertexRule::Crease:
        return any([](RingSector const& s) { return s.faces > 2; });
    case VertexRule::Corner:
        return any([](RingSector const& s) { return !s.closed || s.faces > 2; });
    }
    return false;
}

/// \param n       faces around the vertex
/// \param limits  reused from call to call
template <class Masks>
FlatRing flat_ring(RingSharpness const& sharp, std::size_t n, Limits<Masks>& limits)
{
    std::size_t const e = sharp.edge.size(), size = 1 + e + n;
    Ring<RingWeights> unit{RingWeights(0.0, size),
                           std::vector<RingWeights>(e, RingWeights(0.0, size)),
                           std::vector<RingWeights>(n, RingWeights(0.0, size))};
    for (std::size_t i = 0; i < size; ++i) unit.point(i)[i] = 1;
    RingSharpness alone = sharp; // a step ago: nothing else is sharp now
    alone.far_cos_theta.clear();
    VertexLimit<RingWeights> const limit = limits.of(unit, alone);
    VertexRule const rule = sharp.rule();
    FlatRing out;
    bool has_curve = rule == VertexRule::Crease;
    std::vector<RingSector> const sectors = sharp.sectors();
    for (std::size_t i = 0; i < sectors.size(); ++i) {
        RingSector const& s = sectors[i];
        int const a = s.turn, b = s.of;
        FlatRing::Sector flat;
        flat.flatness = sharp.flatness ? *sharp.flatness
                        : s.concave    ? 1 - 1 / (4 * Masks::concave_eigenvalue(int(s.faces)))
                                       : 0;
        bool const has_plane = s.closed ? s.faces > 2 : rule == VertexRule::Corner || s.faces > 1;
        if (flat.flatness == 0 || !has_plane) continue;
        double const lambda = rule == VertexRule::Smooth ? loop09_lambda(int(n)) : 0.5,
                     on_face = Masks::mode_on_face(lambda, cos_pi(a, 2 * b));
        flat.modes[0] = flat.modes[1] = RingWeights(0.0, size);
        auto const set = [&](std::size_t point, int half_turns, double weight) {
            flat.modes[0][point] = weight * cos_pi(half_turns * a, 2 * b);
            flat.modes[1][point] = weight * sin_pi(half_turns * a, 2 * b);
        };
        std::size_t const edges = s.closed ? s.faces : s.faces + 1;
        bool const is_corner = rule == VertexRule::Corner;
        if (!is_corner && (s.closed || has_curve)) flat.points.push_back(0);
        for (std::size_t k = 0; k < edges; ++k) {
            std::size_t const j = (s.first + k) % e;
            set(1 + j, int(2 * k), 1);
            bool const is_inside = !(sharp.edge[j] > 0);
            if (is_inside || (!is_corner && (s.closed || has_curve))) flat.points.push_back(1 + j);
        }
        for (std::size_t k = 0; k < s.faces; ++k) {
            std::size_t const point = 1 + e + (s.first + k) % n;
            set(point, int(2 * k + 1), on_face);
            flat.points.push_back(point);
        }
        if (!s.closed) has_curve = false; // moved with the first side
        // Any two vectors that span the left eigenspace will do: their multiples that are dual.
        auto const& [t1, t2] = limit.sides[i].tangents;
        double const m[2][2] = {{(t1 * flat.modes[0]).sum(), (t1 * flat.modes[1]).sum()},
                                {(t2 * flat.modes[0]).sum(), (t2 * flat.modes[1]).sum()}};
        double const determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        flat.left = {limit.position, (m[1][1] * t1 - m[0][1] * t2) / determinant,
                     (m[0][0] * t2 - m[1][0] * t1) / determinant};
        out.sectors.push_back(std::move(flat));
    }
    return out;
}

} // namespace tessemu
