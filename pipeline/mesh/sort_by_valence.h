// A control mesh in the order of its valences: LOOP10 section 3's remedy for threads of a group that
// wait for each other.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/subdivision_tables.h"

namespace tessemu {

/// Sorts faces by their sides and vertices by the valence that the vertex kernel reads, 0 of one
/// that stays, 1 on a curve, else its faces; those of one valence keep their order. The surface is
/// the same: tags, holes, slits, texture coordinates and numbers in the file follow.
///
/// \param tables  of the mesh's first step
/// \cost  n log n
ControlMesh sort_by_valence(ControlMesh const& mesh, SubdivisionTables const& tables);

} // namespace tessemu
