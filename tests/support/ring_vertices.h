// The vertex shader's vectors of every vertex of a mesh in any scalar type.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/vertex_rings.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tessemu::test {

/// \tparam Shader  RingVertexShader<F> or PmVertexShader<F>
template <class F, class Shader> class RingVertices {
public:
    RingVertices(Topology const& topology, std::vector<double> const& constants) : rings_(topology)
    {
        ControlMesh const& mesh = topology.mesh();
        std::vector<F> const rounded(constants.begin(), constants.end());
        Shader vs;
        vs.rings = {rings_.rings, 0, "rings"};
        vs.entries = {rings_.entries, 1, "entries"};
        vs.positions =
            Texture2D(rings_.positions, RingTextures::kTextureWidth, rings_.height, 2, "positions");
        vs.constants = {rounded, 3, "constants"};
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            auto const& x = mesh.positions[v];
            RingVertex<F> const out = vs.template operator()<F>(
                VertexInput<F>{std::int32_t(v)}, ControlVertex<F>{{F(x.x), F(x.y), F(x.z)}});
            for_each_scalar(out, [&](F s) { all_.push_back(s); });
        }
    }
    static constexpr std::size_t kScalars = 3 * RingLayout::kVectors;
    /// The corners of a face, as its hull shader sees them.
    std::vector<F> of_face(ControlMesh const& mesh, std::uint32_t f) const
    {
        std::vector<F> out;
        for (std::uint32_t v : mesh.face(f))
            out.insert(out.end(), all_.begin() + std::ptrdiff_t(v * kScalars),
                       all_.begin() + std::ptrdiff_t((v + 1) * kScalars));
        return out;
    }

private:
    VertexRings rings_;
    std::vector<F> all_;
};

/// Tables of one face, bound to a hull shader.
template <class F> struct FaceTables {
    std::vector<F> angles;
    std::vector<std::uint32_t> offsets, edges{0};

    FaceTables(Topology const& topology, std::uint32_t f)
    {
        ControlMesh const& mesh = topology.mesh();
        for (double c : make_ring_angles()) angles.push_back(F(c));
        for (std::uint32_t h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h)
            offsets.push_back(corner_offsets(topology, h));
    }
    template <class Hull> Hull bind() const
    {
        Hull hs;
        hs.offsets = {offsets, 0, "offsets"};
        hs.edges = {edges, 1, "edges"};
        hs.angles = {angles, 2, "angles"};
        return hs;
    }
};

template <class F> double error(float3<F> const& p, nlohmann::json const& expected)
{
    return std::max({std::abs(double(p.x) - double(expected[0])),
                     std::abs(double(p.y) - double(expected[1])),
                     std::abs(double(p.z) - double(expected[2]))});
}

} // namespace tessemu::test
