// Frames as HOLL10 drew them: an instance of a uniform refinement pattern for each face.
//
// Level L makes 4^L triangles of a triangle of M0, so a scheme that takes a step of subdivision
// first has 2^(L-1) segments on an edge of its patches, any other 2^L.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/cost.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"

namespace tessemu {

/// A scheme of the paper's comparison, by its name there and in the registry.
struct Holl10Scheme {
    char const* paper;
    char const* scheme;
};
inline constexpr Holl10Scheme kHoll10Schemes[] = {{"SM", "tables-loop"},
                                                  {"QAS", "qas"},
                                                  {"PN-Tri.", "pn-triangles"},
                                                  {"PT", "phong"},
                                                  {"Flat", "flat"}};

/// SM with the paper's mesher.
SchemeOnMesh build_holl10(Holl10Scheme const& scheme, ControlMesh const& mesh);
/// Settings of a level: the Direct3D 10 path, uniform patterns, segments.
FrameSettings at_level(FrameSettings settings, SchemeOnMesh const& on, int level);

/// A frame's geometry, without rasterization.
struct Holl10Frame {
    std::size_t triangles = 0, triangles_of_m0 = 0;
    DrawStatistics all;
    DrawStatistics initial; ///< of the passes before the one that shows the surface
};
Holl10Frame count_frame(SchemeOnMesh const& on, FrameSettings const& settings, int level,
                        ThreadPool const& threads);

} // namespace tessemu
