// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/qas/limit_rows.h"

#include "pipeline/mesh/loop.h"

#include <map>

namespace tessemu {

LimitRows loop_limit_rows(Topology const& topology)
{
    Sharpness const sharpness(topology);
    std::vector<WeightedSum> x;
    for (std::uint32_t v = 0; v < topology.mesh().positions.size(); ++v) x.emplace_back(v);
    x = refined_points<Loop, WeightedSum>(topology, sharpness, x);
    ControlMesh const fine =
        split_mesh(topology, sharpness, std::vector<glm::dvec3>(x.size()), Loop::kKeepsTriangles);
    Topology const t(fine);
    Sharpness const left(t);
    Limits<Loop> limits;
    RingSharpness sharp;
    LimitRows out;
    for (std::uint32_t v = 0; v < x.size(); ++v) {
        auto const faces = t.ring(v);
        std::map<std::uint32_t, std::array<double, 3>> terms;
        auto const add = [&](WeightedSum const& sum, std::size_t which) {
            for (WeightedSum::Term const& term : sum.terms())
                terms[term.point][which] += term.weight;
        };
        if (faces.empty()) {
            add(x[v], 0);
        } else {
            Ring<WeightedSum> ring{x[v], {}, {}};
            for (HalfEdge h : faces) ring.edge.push_back(x[t.vertex_of(t.next(h))]);
            if (t.is_boundary(v)) ring.edge.push_back(x[t.vertex_of(t.previous(faces.back()))]);
            left.around(v, sharp);
            VertexLimit<WeightedSum> const limit = limits.of(std::move(ring), sharp);
            add(limit.position, 0);
            for (std::size_t i : {0, 1}) add(limit.sides[0].tangents[i], 1 + i);
        }
        for (auto const& [vertex, weights] : terms) {
            out.vertices.push_back(vertex);
            out.weights.insert(out.weights.end(), weights.begin(), weights.end());
        }
        out.first.push_back(std::uint32_t(out.vertices.size()));
    }
    return out;
}

} // namespace tessemu
