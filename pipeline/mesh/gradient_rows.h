// Points and their tangents as sums over a mesh's vertices: computational entries of a pass that
// makes positions and normals at once, by gradient masks (HOLL10 2B).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/limit.h"
#include "pipeline/mesh/refined_step.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <memory>
#include <optional>

namespace tessemu {

/// Rows of weights over a mesh's vertices, as GradientPointsShader reads them.
struct GradientRows {
    std::vector<std::uint32_t> first{0}; ///< [point + 1]: where its terms begin
    std::vector<std::uint32_t> vertices; ///< of each term
    std::vector<double> weights;         ///< [term][3]: of the point and of two tangents

    /// Appends a point with tangents whose cross product points outwards.
    void add(WeightedSum const& point, WeightedSum const& tangent, WeightedSum const& other)
    {
        std::map<std::uint32_t, std::array<double, 3>> terms;
        std::size_t which = 0;
        for (WeightedSum const* sum : {&point, &tangent, &other}) {
            for (WeightedSum::Term const& t : sum->terms()) terms[t.point][which] += t.weight;
            ++which;
        }
        for (auto const& [vertex, w] : terms) {
            vertices.push_back(vertex);
            weights.insert(weights.end(), w.begin(), w.end());
        }
        first.push_back(std::uint32_t(vertices.size()));
    }
};

/// The drawn mesh's vertices as sums over the file's. \cost  the steps', of rows instead of points
template <class Masks> std::vector<WeightedSum> sums_over_base(RefinedMesh const& mesh)
{
    std::vector<WeightedSum> x;
    for (std::uint32_t v = 0; v < mesh.base().positions.size(); ++v) x.emplace_back(v);
    std::unique_ptr<ControlMesh const> made;
    std::unique_ptr<Topology const> topology;
    for (int step = 0; step < mesh.steps(); ++step) {
        Topology const& now = topology ? *topology : mesh.base_topology();
        Sharpness const sharpness(now);
        x = refined_points<Masks, WeightedSum>(now, sharpness, x);
        for (WeightedSum& sum : x) sum.merge();
        if (step + 1 == mesh.steps()) break;
        auto next = std::make_unique<ControlMesh const>(refined_mesh<Masks>(now, sharpness));
        topology = std::make_unique<Topology const>(*next);
        made = std::move(next);
    }
    return x;
}

/// Tangents of the limit surface at the vertices of a mesh that a step has made, side by side of what
/// is sharp, by OpenSubdiv's rules.
template <class Masks> class GradientMasks {
public:
    /// \param topology  outlives this
    explicit GradientMasks(Topology const& topology) : topology_(topology), sharpness_(topology) {}

    using Sums = std::array<WeightedSum, 2>;
    /// \param x      the vertices
    /// \param first  a side's first edge is the ring's edge here; of a vertex with many sides, none of
    ///               them, the tangents as though nothing inside the mesh were sharp
    Sums at(std::uint32_t v, std::optional<std::size_t> first, std::span<WeightedSum const> x)
    {
        Topology const& t = topology_;
        auto const faces = t.ring(v);
        std::vector<std::uint32_t> around{v};
        for (HalfEdge h : faces) around.push_back(t.vertex_of(t.next(h)));
        if (t.is_boundary(v)) around.push_back(t.vertex_of(t.previous(faces.back())));
        std::size_t const edges = around.size() - 1;
        if constexpr (!Masks::kKeepsTriangles)
            for (HalfEdge h : faces) around.push_back(t.vertex_of(t.next(t.next(h))));
        auto const unit = [&](std::size_t i) {
            RingWeights w(0.0, around.size());
            w[i] = 1;
            return w;
        };
        Ring<RingWeights> ring{unit(0), {}, {}};
        for (std::size_t i = 1; i < around.size(); ++i)
            (i <= edges ? ring.edge : ring.face).push_back(unit(i));
        sharpness_.around(v, sharp_);
        VertexLimit<RingWeights> limit = limits_.of(ring, sharp_);
        auto side = limit.sides.begin();
        if (limit.sides.size() > 1 && !first) {
            RingSharpness smooth;
            smooth.open = sharp_.open;
            smooth.edge.assign(sharp_.edge.size(), 0);
            if (smooth.open) smooth.edge.front() = smooth.edge.back() = kInfinitelySharp;
            limit = limits_.of(std::move(ring), smooth);
            side = limit.sides.begin();
        } else if (first) {
            side = std::find_if(side, limit.sides.end(),
                                [&](auto const& s) { return s.first_face == *first; });
            assert(side != limit.sides.end());
        }
        Sums out;
        for (std::size_t k : {0, 1})
            for (std::size_t i = 0; i < around.size(); ++i)
                if (double const w = side->tangents[k][i]; w != 0) out[k] += x[around[i]] * w;
        return out;
    }

private:
    Topology const& topology_;
    Sharpness sharpness_;
    Limits<Masks> limits_;
    RingSharpness sharp_;
};

} // namespace tessemu
