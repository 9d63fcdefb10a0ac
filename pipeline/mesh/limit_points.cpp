// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/limit_points.h"

namespace tessemu {

using Vec = glm::dvec3;

Vec unit_or_zero(Vec const& v)
{
    double const length = glm::length(v);
    return length > 0 ? v / length : Vec(0);
}

Vec side_normal(Ring<Vec> const& ring, RingSharpness const& sharp, VertexRule rule,
                VertexLimit<Vec>::Side const& side)
{
    auto const& [a, b] = side.tangents;
    Vec const n = cross(a, b);
    Vec faces(0);
    for (std::size_t j = side.first_face; j < side.first_face + side.faces; ++j) {
        std::size_t const f = j % sharp.faces();
        faces += sharp.biermann
                     ? cross(ring.face[f] - ring.vertex, ring.edge_after(f) - ring.edge[f])
                     : cross(ring.edge[f] - ring.vertex, ring.edge_after(f) - ring.vertex);
    }
    if (!(dot(n, n) > 0x1p-32 * dot(a, a) * dot(b, b))) return unit_or_zero(faces);
    bool const turns = rule == VertexRule::Corner && !sharp.biermann && dot(n, faces) < 0;
    return unit_or_zero(turns ? -n : n);
}

std::vector<Vec> pole_normals(Poles const& poles, std::span<Vec const> x)
{
    std::vector<Vec> normals;
    for (std::size_t k = 0; k < poles.size(); ++k) {
        Vec area(0);
        for (std::uint32_t f = poles.first[k]; f < poles.first[k + 1]; ++f) {
            auto const& v = poles.faces[f];
            area += cross(x[v[2]] - x[v[0]], x[v[3]] - x[v[1]]);
        }
        double const length = glm::length(area);
        normals.push_back(length > 0 ? area / length : Vec(0, 0, 1));
    }
    return normals;
}

} // namespace tessemu
