// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/qas/limit_rows.h"

#include "pipeline/mesh/loop.h"

namespace tessemu {

GradientRows loop_limit_rows(Topology const& topology)
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
    GradientRows out;
    for (std::uint32_t v = 0; v < x.size(); ++v) {
        auto const faces = t.ring(v);
        if (faces.empty()) {
            out.add(x[v], {}, {});
            continue;
        }
        Ring<WeightedSum> ring{x[v], {}, {}};
        for (HalfEdge h : faces) ring.edge.push_back(x[t.vertex_of(t.next(h))]);
        if (t.is_boundary(v)) ring.edge.push_back(x[t.vertex_of(t.previous(faces.back()))]);
        left.around(v, sharp);
        VertexLimit<WeightedSum> const limit = limits.of(std::move(ring), sharp);
        out.add(limit.position, limit.sides[0].tangents[0], limit.sides[0].tangents[1]);
    }
    return out;
}

} // namespace tessemu
