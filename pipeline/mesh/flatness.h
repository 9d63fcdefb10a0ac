// Flatness by Biermann's rules: after a step, the ring of a vertex moves into a plane, or part of
// the way (docs/math/subdivision.md, 5.2).
//
//     p <- (1 - s) p + s (a0 + a1 x1 + a2 x2)      a_i = left_i . p, x1, x2 the subdominant pair
//
// Beyond those of ring.h and limit.h, Masks has
//
//     mode_on_face(lambda, cos_half_theta)  of an eigenvector of lambda: where edge j has the
//                                cosine or sine of j theta, face i has this times that of
//                                (i + 1/2) theta
//     concave_eigenvalue(k)      the largest but 1 of a concave sector of k faces
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/limit.h"
#include "pipeline/mesh/limit_constants.h"
#include "pipeline/mesh/weighted_sum.h"

#include <algorithm>
#include <array>
#include <type_traits>

namespace tessemu {

/// How the new ring of a vertex is flattened. Points are numbered as in Ring::point.
struct FlatRing {
    struct Point {
        std::size_t number;
        double x1, x2;
    };
    struct Sector {
        double flatness;
        std::array<std::vector<WeightedSum::Term>, 3> left; ///< a_i by the ring's points
        std::vector<Point> points;                          ///< those that move
    };
    std::vector<Sector> sectors; ///< no point moves in two of them

    /// \param at  point i of the new ring, which stays as it is meanwhile
    /// \param by  called with points that move, and by how much
    template <class At, class By> void moves(At const& at, By const& by) const
    {
        using X = std::decay_t<decltype(at(0))>;
        for (Sector const& s : sectors) {
            auto const apply = [&](std::vector<WeightedSum::Term> const& terms) {
                X sum = at(terms[0].point) * terms[0].weight;
                for (std::size_t i = 1; i < terms.size(); ++i)
                    sum += at(terms[i].point) * terms[i].weight;
                return sum;
            };
            X const a[3] = {apply(s.left[0]), apply(s.left[1]), apply(s.left[2])};
            for (Point const& p : s.points) {
                X move = a[0] * s.flatness;
                move += a[1] * (s.flatness * p.x1);
                move += a[2] * (s.flatness * p.x2);
                move += at(p.number) * -s.flatness;
                by(p.number, std::move(move));
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
    Ring<WeightedSum> ring{{}, std::vector<WeightedSum>(e), std::vector<WeightedSum>(n)};
    for (std::uint32_t i = 0; i < size; ++i) ring.point(i) = WeightedSum(i);
    RingSharpness alone = sharp; // a step ago: nothing else is sharp now
    alone.far_cos_theta.clear();
    VertexLimit<WeightedSum> const limit = limits.of(std::move(ring), std::move(alone));
    VertexRule const rule = sharp.rule();
    FlatRing out;
    std::vector<FlatRing::Point> x(size, FlatRing::Point{}); // of the sector in turn
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
        std::size_t const edges = s.closed ? s.faces : s.faces + 1;
        bool const is_corner = rule == VertexRule::Corner,
                   moves_all = !is_corner && (s.closed || has_curve);
        std::vector<FlatRing::Point> all;
        auto const add = [&](std::size_t point, std::size_t half_turns, double weight, bool moves) {
            all.push_back({point, weight * cos_pi(int(half_turns) * a, 2 * b),
                           weight * sin_pi(int(half_turns) * a, 2 * b)});
            if (moves) flat.points.push_back(all.back());
            x[point] = all.back();
        };
        add(0, 0, 0, moves_all);
        for (std::size_t k = 0; k < edges; ++k) {
            std::size_t const j = (s.first + k) % e;
            add(1 + j, 2 * k, 1, moves_all || !(sharp.edge[j] > 0));
        }
        for (std::size_t k = 0; k < s.faces; ++k)
            add(1 + e + (s.first + k) % n, 2 * k + 1, on_face, true);
        if (!s.closed) has_curve = false; // moved with the first side
        // Any two vectors that span the left eigenspace will do: their multiples that are dual.
        double m[2][2] = {};
        for (int t : {0, 1})
            for (WeightedSum::Term const& term : limit.sides[i].tangents[t].terms()) {
                m[t][0] += term.weight * x[term.point].x1;
                m[t][1] += term.weight * x[term.point].x2;
            }
        for (FlatRing::Point const& p : all) x[p.number] = {};
        double const determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        auto const& [t1, t2] = limit.sides[i].tangents;
        auto const not_zero = [](WeightedSum const& sum) {
            auto terms = sum.terms();
            std::erase_if(terms, [](WeightedSum::Term const& t) { return t.weight == 0; });
            return terms;
        };
        flat.left = {not_zero(limit.position),
                     not_zero((m[1][1] * t1 - m[0][1] * t2) / determinant),
                     not_zero((m[0][0] * t2 - m[1][0] * t1) / determinant)};
        out.sectors.push_back(std::move(flat));
    }
    return out;
}

} // namespace tessemu
