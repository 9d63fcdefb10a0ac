// Subdivision as dispatches: LOOP10 section 3's kernels over a mesh's tables, step by step.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/command_list.h"
#include "pipeline/mesh/subdivision_tables.h"

namespace tessemu {

/// Appends for each step "face points", "edge points", "vertex points" and, where the mesh's tags
/// ask for them, "blended points", each with the step's number. The list views tables and points.
///
/// \param points  of a RWVectorBuffer: tables.back().buffer_size() vectors, of which the first
///                step's old vertices are filled before the commands run
void add_subdivision(CommandList& list, std::span<SubdivisionTables const> tables,
                     std::span<float> points, Machine const& machine);

} // namespace tessemu
