// What of HOLL10 can be reproduced: table I, figures 5 to 8.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"

namespace tessemu {

/// Table I's models by what stands for them here. Frog and Big Guy are the paper's own, their quads
/// cut into triangles; of the others another cage is counted, as if it had the paper's triangles.
struct Holl10Model {
    char const* paper; ///< its name there
    char const* ours;  ///< NAME.obj
    bool own;          ///< otherwise a stand-in
    int triangles;     ///< the paper's, of M0

    /// "Head (stand-in)"
    std::string caption() const;
};
inline constexpr Holl10Model kHoll10Models[] = {{"Head", "spot_control", false, 524},
                                                {"Guy", "knight_tri_1k", false, 1168},
                                                {"Frog", "monsterfrog", true, 2584},
                                                {"Big Guy", "bigguy", true, 2900}};
/// What to say of the stand-ins.
std::string holl10_models_remark();

std::vector<PaperItem> holl10_items();

} // namespace tessemu
