// Limit position and tangents of a vertex, by any scheme's masks, whatever is tagged at it
// (docs/math/subdivision.md, 1.6 and 1.7; docs/math/loop09.md, 4).
//
// Beyond those of subdivision.h, Masks has
//
//     limit(n, v, edge, face)    of a smooth vertex: its position and two tangents, whose cross
//                                product points outwards; edge(j) and face(j) as in Ring
//     crease_limit(a, v, b)      along a crease or boundary
//     crease_across(k, v, edge, face)  of a crease vertex, into its k faces
//     crease_across_by_biermann(k, v, edge, face)  the same by his rules
//     turning(k, a, b, quarters, v, edge, face)  by his rules: of a sector of k faces, left
//                                eigenvector of 1/2 that turns by theta = pi a/b from edge to edge,
//                                from the sine of so many right angles at edge 0 on
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/ring.h"

#include <algorithm>
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
/// edge. By OpenSubdiv's rules the odd one is the smooth vertex's, for that edge and the vertex do
/// not count in it.
struct DartMasks {
    RingWeights position, even, odd;
};

/// By iteration of the transposed refinement, from the smooth vertex's masks. Exact but for
/// rounding up to a hundred edges; beyond, the even tangent is not waited for: at 500 it is 1.5
/// degrees off.
/// \cost  of order n^2, and up to 20,000 n
template <class Masks>
DartMasks dart_masks(std::size_t n, SectorRules rules = SectorRules::OpenSubdiv)
{
    std::size_t const size = (Masks::kKeepsTriangles ? 1 : 2) * n + 1;
    auto const unit = [&](std::size_t i) {
        RingWeights w(0.0, size);
        w[i] = 1;
        return w;
    };
    Ring<RingWeights> ring{unit(0), {}, {}};
    for (std::size_t j = 0; j < n; ++j) {
        ring.edge.push_back(unit(1 + j));
        if constexpr (!Masks::kKeepsTriangles) ring.face.push_back(unit(1 + n + j));
    }
    auto const edge = [&](std::size_t j) -> RingWeights const& { return ring.edge[j]; };
    auto const face = [&](std::size_t j) -> RingWeights const& { return ring.face[j]; };
    auto const smooth = Masks::limit(int(n), ring.vertex, edge, face);
    RingSharpness sharp;
    sharp.edge.assign(n, 0);
    sharp.edge[0] = kInfinitelySharp;
    sharp.biermann = rules == SectorRules::Biermann;
    Ring<RingWeights> const step = split_ring<Masks>(ring, sharp);
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
        if constexpr (!Masks::kKeepsTriangles) add_row(1 + n + j, step.face[j]);
    }
    // Converges with the ratio of the first two eigenvalues, which is 1 - O(1/n^2) for the
    // tangents.
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
    auto const mirrored = [&](RingWeights const& w) {
        RingWeights m = w;
        for (std::size_t j = 0; j < n; ++j) {
            m[1 + j] = w[1 + (n - j) % n];
            if constexpr (!Masks::kKeepsTriangles) m[1 + n + j] = w[2 * n - j];
        }
        return m;
    };
    DartMasks out;
    out.odd = smooth[2];
    if (sharp.biermann)
        out.odd = dominant(smooth[2], [&](RingWeights& w) {
            w -= mirrored(w);
            w /= std::abs(w).max();
        });
    out.position = dominant(smooth[0], [](RingWeights& w) { w /= w.sum(); });
    out.even = dominant(smooth[1], [&](RingWeights& w) {
        // Roundings would let an odd part grow, which may be the larger one.
        w += mirrored(w);
        w -= w.sum() * out.position;
        w /= std::abs(w).max();
    });
    return out;
}

/// Makes limits; keeps what it has computed of darts.
template <class Masks> class Limits {
public:
    /// \param ring   on a mesh of quads, or of triangles that the masks keep
    /// \param sharp  of the same vertex; while finite sharpness is left, and where an edge leans
    ///               away from the vertex, the ring is refined further
    /// By Biermann's rules nothing else that is flattened may share a face with the vertex.
    template <class X> VertexLimit<X> of(Ring<X> ring, RingSharpness sharp)
    {
        auto const leans_away = [](RingSharpness const& of) {
            auto const leans = of.leans();
            return std::any_of(leans.begin(), leans.end(),
                               [](Lean const& l) { return l.end == 1; });
        };
        while (sharp.is_semi_sharp() || leans_away(sharp)) {
            ring = split_ring<Masks>(ring, sharp);
            sharp = sharp.after_step();
        }
        std::size_t const n = sharp.faces();
        auto const edge = [&](std::size_t j) -> X const& {
            return ring.edge[j % ring.edge.size()];
        };
        auto const face = [&](std::size_t j) -> X const& { return ring.face[j % n]; };
        VertexRule const rule = sharp.rule();
        std::vector<RingSector> const sectors = sharp.sectors();
        auto const turning = [&](RingSector const& s, int quarters) -> X {
            if constexpr (Masks::kSectorRules)
                return Masks::turning(
                    int(s.faces), s.turn, s.of, quarters, ring.vertex,
                    [&](std::size_t j) -> X const& { return edge(s.first + j); },
                    [&](std::size_t j) -> X const& { return face(s.first + j); });
            throw Error("these masks have no rules for sectors");
        };
        bool const is_cut =
            std::any_of(sharp.edge.begin(), sharp.edge.end(), [](float s) { return s > 0; });
        if (rule == VertexRule::Dart) return dart(ring, sectors[0].first, sharp.biermann);
        if (!is_cut) {
            auto [p, a, b] = Masks::limit(int(n), ring.vertex, edge, face);
            if (rule == VertexRule::Corner) {
                p = ring.vertex;
                if (sharp.biermann) a = turning(sectors[0], 1), b = turning(sectors[0], 0);
            }
            return {p, rule, {{0, n, {a, b}}}};
        }
        auto const [a, b] = sharp.crease();
        VertexLimit<X> out{rule == VertexRule::Corner
                               ? ring.vertex
                               : Masks::crease_limit(edge(a), ring.vertex, edge(b)),
                           rule,
                           {}};
        for (RingSector const& s : sectors) {
            std::size_t const first = s.first, k = s.faces;
            X const &start = edge(first), &end = edge(first + k);
            auto const edge_of_side = [&](std::size_t j) -> X const& { return edge(first + j); };
            auto const face_of_side = [&](std::size_t j) -> X const& { return face(first + j); };
            auto const across = [&]() -> X {
                if constexpr (Masks::kSectorRules)
                    if (sharp.biermann)
                        return Masks::crease_across_by_biermann(int(k), ring.vertex, edge_of_side,
                                                                face_of_side);
                return Masks::crease_across(int(k), ring.vertex, edge_of_side, face_of_side);
            };
            // With one face the ring shrinks to the curve's plane: its eigenvalue 1/4 has one
            // eigenvector, to which the face's own difference adds more with each step.
            bool const ends = rule == VertexRule::Corner || k == 1;
            if (sharp.biermann && s.closed)
                out.sides.push_back({first, k, {start - ring.vertex, turning(s, 0)}});
            else if (s.concave)
                out.sides.push_back({first, k, {end - ring.vertex, start - ring.vertex}});
            else if (ends)
                out.sides.push_back({first, k, {start - ring.vertex, end - ring.vertex}});
            else
                out.sides.push_back({first, k, {start - end, across()}});
        }
        return out;
    }

private:
    template <class X>
    VertexLimit<X> dart(Ring<X> const& ring, std::size_t sharp_edge, bool biermann)
    {
        std::size_t const n = ring.edge.size();
        auto [found, is_new] = darts_.try_emplace({n, biermann});
        if (is_new)
            found->second =
                dart_masks<Masks>(n, biermann ? SectorRules::Biermann : SectorRules::OpenSubdiv);
        DartMasks const& masks = found->second;
        auto const apply = [&](RingWeights const& w) {
            X sum = ring.vertex * w[0];
            for (std::size_t j = 0; j < n; ++j) {
                std::size_t const i = (sharp_edge + j) % n;
                sum += ring.edge[i] * w[1 + j];
                if constexpr (!Masks::kKeepsTriangles) sum += ring.face[i] * w[1 + n + j];
            }
            return sum;
        };
        return {apply(masks.position),
                VertexRule::Dart,
                {{0, n, {apply(masks.even), apply(masks.odd)}}}};
    }

    std::map<std::pair<std::size_t, bool>, DartMasks> darts_;
};

} // namespace tessemu
