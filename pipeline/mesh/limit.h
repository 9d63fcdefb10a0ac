// Limit position and tangents of a vertex, by any scheme's masks, whatever is tagged at it
// (docs/math/subdivision.md, 1.6 and 1.7; docs/math/loop09.md, 4).
//
// Beyond those of subdivision.h, Masks has
//
//     limit(n, v, edge, face)    of a smooth vertex: its position and two tangents, whose cross
//                                product points outwards; edge(j) and face(j) as in Ring
//     crease_limit(a, v, b)      along a crease or boundary
//     crease_across(k, v, edge, face)  of a crease vertex, into its k faces
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/subdivision.h"

#include <cmath>
#include <map>
#include <valarray>

namespace tessemu {

template <class X> struct VertexLimit {
    /// Faces between two infinitely sharp edges, or all.
    struct Side {
        std::size_t first_face, faces;
        X tangents[2]; ///< their cross product points outwards
    };
    X position;
    VertexRule rule;         ///< of what is infinitely sharp
    std::vector<Side> sides; ///< in the order of the ring, from the first sharp edge on
};

/// Weights for a ring: the vertex, its edges' far ends, its faces' opposite vertices.
using RingWeights = std::valarray<double>;

/// Left eigenvectors of a ring of n faces with one infinitely sharp edge, edge 0, under refinement:
/// of the limit position, and the dominant ones that are even and odd under reflection in that
/// edge. The odd one is the smooth vertex's, for that edge and the vertex do not count in it.
struct DartMasks {
    RingWeights position, even, odd;
};

/// By iteration of the transposed refinement, from the smooth vertex's masks. Exact but for rounding
/// up to a hundred edges; beyond, the even tangent is not waited for: at 500 it is 1.5 degrees off.
/// \cost  of order n^2, and up to 20,000 n
template <class Masks> DartMasks dart_masks(std::size_t n)
{
    std::size_t const size = 2 * n + 1;
    auto const unit = [&](std::size_t i) {
        RingWeights w(0.0, size);
        w[i] = 1;
        return w;
    };
    Ring<RingWeights> ring{unit(0), {}, {}};
    for (std::size_t j = 0; j < n; ++j) {
        ring.edge.push_back(unit(1 + j));
        ring.face.push_back(unit(1 + n + j));
    }
    auto const edge = [&](std::size_t j) -> RingWeights const& { return ring.edge[j]; };
    auto const face = [&](std::size_t j) -> RingWeights const& { return ring.face[j]; };
    auto const smooth = Masks::limit(int(n), ring.vertex, edge, face);
    RingSharpness sharp;
    sharp.edge.assign(n, 0);
    sharp.edge[0] = kInfinitelySharp;
    Ring<RingWeights> const step = refined_ring<Masks>(ring, sharp);
    struct Entry {
        std::size_t row, column;
        double weight;
    };
    std::vector<Entry> entries;
    auto const add_row = [&](std::size_t row, RingWeights const& w) {
        for (std::size_t c = 0; c < size; ++c)
            if (w[c] != 0) entries.push_back({row, c, w[c]});
    };
    add_row(0, step.vertex);
    for (std::size_t j = 0; j < n; ++j) {
        add_row(1 + j, step.edge[j]);
        add_row(1 + n + j, step.face[j]);
    }
    // Converges with the ratio of the first two eigenvalues, which is 1 - O(1/n^2) for the tangents.
    constexpr int kMostSteps = 20000;
    auto const dominant = [&](RingWeights w, auto const& normalise) {
        normalise(w);
        double last = 2;
        for (int i = 0; i < kMostSteps; ++i) {
            RingWeights next(0.0, size);
            for (Entry const& e : entries) next[e.column] += w[e.row] * e.weight;
            normalise(next);
            double const change = std::abs(next - w).max();
            w = std::move(next);
            if (change < 0x1p-52 || (change < 0x1p-48 && change >= last)) break;
            last = change;
        }
        return w;
    };
    DartMasks out;
    out.odd = smooth[2];
    out.position = dominant(smooth[0], [](RingWeights& w) { w /= w.sum(); });
    out.even = dominant(smooth[1], [&](RingWeights& w) {
        // Roundings would let an odd part grow, which may be the larger one.
        RingWeights mirrored = w;
        for (std::size_t j = 0; j < n; ++j) {
            mirrored[1 + j] = w[1 + (n - j) % n];
            mirrored[1 + n + j] = w[2 * n - j];
        }
        w += mirrored;
        w -= w.sum() * out.position;
        w /= std::abs(w).max();
    });
    return out;
}

/// Makes limits; keeps what it has computed of darts.
template <class Masks> class Limits {
public:
    /// \param ring   on a mesh of quads
    /// \param sharp  of the same vertex; while finite sharpness is left the ring is refined further
    template <class X> VertexLimit<X> of(Ring<X> ring, RingSharpness sharp)
    {
        while (sharp.is_semi_sharp()) {
            ring = refined_ring<Masks>(ring, sharp);
            sharp = sharp.after_step();
        }
        std::size_t const n = ring.faces();
        auto const edge = [&](std::size_t j) -> X const& {
            return ring.edge[j % ring.edge.size()];
        };
        auto const face = [&](std::size_t j) -> X const& { return ring.face[j % n]; };
        VertexRule const rule = sharp.rule();
        std::vector<std::size_t> cuts;
        for (std::size_t j = 0; j < sharp.edge.size(); ++j)
            if (sharp.edge[j] > 0) cuts.push_back(j);
        if (!sharp.open && !cuts.empty()) cuts.push_back(cuts[0] + n); // round to the first
        if (rule == VertexRule::Dart) return dart(ring, cuts[0]);
        if (cuts.empty()) {
            auto [p, a, b] = Masks::limit(int(n), ring.vertex, edge, face);
            if (rule == VertexRule::Corner) p = ring.vertex;
            return {p, rule, {{0, n, {a, b}}}};
        }
        auto const [a, b] = sharp.crease();
        VertexLimit<X> out{rule == VertexRule::Corner
                               ? ring.vertex
                               : Masks::crease_limit(edge(a), ring.vertex, edge(b)),
                           rule,
                           {}};
        for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
            std::size_t const first = cuts[i], k = cuts[i + 1] - first;
            X const &start = edge(first), &end = edge(first + k);
            auto const edge_of_side = [&](std::size_t j) -> X const& { return edge(first + j); };
            auto const face_of_side = [&](std::size_t j) -> X const& { return face(first + j); };
            // With one face the ring shrinks to the curve's plane: its eigenvalue 1/4 has one
            // eigenvector, to which the face's own difference adds more with each step.
            bool const ends = rule == VertexRule::Corner || k == 1;
            out.sides.push_back(
                ends ? Side<X>{first, k, {start - ring.vertex, end - ring.vertex}}
                     : Side<X>{first,
                               k,
                               {start - end, Masks::crease_across(int(k), ring.vertex, edge_of_side,
                                                                  face_of_side)}});
        }
        return out;
    }

private:
    template <class X> using Side = typename VertexLimit<X>::Side;

    template <class X> VertexLimit<X> dart(Ring<X> const& ring, std::size_t sharp_edge)
    {
        std::size_t const n = ring.faces();
        auto [found, is_new] = darts_.try_emplace(n);
        if (is_new) found->second = dart_masks<Masks>(n);
        DartMasks const& masks = found->second;
        auto const apply = [&](RingWeights const& w) {
            X sum = ring.vertex * w[0];
            for (std::size_t j = 0; j < n; ++j) {
                std::size_t const i = (sharp_edge + j) % n;
                sum += ring.edge[i] * w[1 + j];
                sum += ring.face[i] * w[1 + n + j];
            }
            return sum;
        };
        return {apply(masks.position),
                VertexRule::Dart,
                {{0, n, {apply(masks.even), apply(masks.odd)}}}};
    }

    std::map<std::size_t, DartMasks> darts_;
};

} // namespace tessemu
