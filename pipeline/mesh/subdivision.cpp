// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/subdivision.h"

namespace tessemu {

EdgeNumbers::EdgeNumbers(Topology const& topology)
{
    std::size_t const corners = topology.mesh().face_vertices.size();
    number_.resize(corners);
    std::vector<char> met(corners);
    for (HalfEdge corner = 0; corner < corners; ++corner) {
        HalfEdge const h = topology.previous(corner), other = topology.twin(h);
        if (met[h]) continue;
        auto const e = std::uint32_t(first_.size());
        first_.push_back(h);
        number_[h] = e, met[h] = 1;
        if (other != Topology::kNone) number_[other] = e, met[other] = 1;
    }
}

PointNumbers::PointNumbers(Topology const& topology, bool keeps_triangles) : edges_(topology)
{
    ControlMesh const& mesh = topology.mesh();
    first_edge_ = 0;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        if (keeps_triangles) faces_.push_back(first_edge_);
        first_edge_ += !keeps_triangles || mesh.face(f).size() != 3;
    }
}

} // namespace tessemu
