// A control mesh as OpenSubdiv's peers take it.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/mesh.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <memory>

namespace tessemu {

/// Catmull-Clark, boundaries as this project has them: edge and corner.
inline std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> opensubdiv_refiner(ControlMesh const& mesh)
{
    namespace osd = OpenSubdiv;
    std::vector<int> sides, indices(mesh.face_vertices.begin(), mesh.face_vertices.end());
    for (std::size_t f = 0; f < mesh.faces(); ++f) sides.push_back(int(mesh.face(f).size()));
    osd::Far::TopologyDescriptor d;
    d.numVertices = int(mesh.positions.size());
    d.numFaces = int(sides.size());
    d.numVertsPerFace = sides.data();
    d.vertIndicesPerFace = indices.data();
    osd::Sdc::Options rules;
    rules.SetVtxBoundaryInterpolation(osd::Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    using Factory = osd::Far::TopologyRefinerFactory<osd::Far::TopologyDescriptor>;
    return std::unique_ptr<osd::Far::TopologyRefiner>(
        Factory::Create(d, Factory::Options(osd::Sdc::SCHEME_CATMARK, rules)));
}

} // namespace tessemu
