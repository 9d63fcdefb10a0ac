// All schemes in one picture: error against cost, on one cage and one GPU; and what a point of each
// takes.
//
// A scheme is measured against the limit surface of its own rules. What is drawn counts, facets
// included: schemes of limit surfaces fall with the square of the tess factor, approximations until
// their own distance is left. Which is which nobody says here: it is measured.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"

#include <span>

namespace tessemu {

/// Segments on an edge of a face of the cage; the table is of the last but one.
inline constexpr int kSchemesFactors[] = {1, 2, 4, 8, 16};

/// A panel of schemes that draw quads, one of schemes that draw triangles alone.
///
/// \param mesh     schemes that do not take it are left out, with a remark
/// \param gpu      that has all stages of all schemes
/// \param factors  powers of two, rising; a scheme begins where its patches have one segment
/// \param table_factor  one of them
PaperPlots reproduce_schemes(ControlMesh const& mesh, GpuModel const& gpu, Machine const& machine,
                             ThreadPool const& threads, PaperProgress const& progress,
                             std::span<int const> factors = kSchemesFactors, int table_factor = 8);

} // namespace tessemu
