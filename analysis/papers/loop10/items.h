// What of LOOP10 can be reproduced: figure 2, table 1, figures 4 and 5.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"

namespace tessemu {

/// The paper's four models by what stands for them here: Bigguy and Monsterfrog are the paper's
/// own; Twohole is another surface with two holes, Cat another mesh of triangles.
struct Loop10Model {
    char const* paper; ///< its name there
    char const* ours;  ///< NAME.obj
    bool own;          ///< otherwise a stand-in
    int steps;         ///< of subdivision that isolate its extraordinary vertices

    /// "Cat (stand-in knight_tri_1k)"
    std::string caption() const;
};
inline constexpr Loop10Model kLoop10Models[] = {{"Twohole", "two_hole", false, 1},
                                                {"Bigguy", "bigguy", true, 1},
                                                {"Monsterfrog", "monsterfrog", true, 1},
                                                {"Cat", "knight_tri_1k", false, 2}};
/// What to say of the stand-ins.
std::string loop10_models_remark();

std::vector<PaperItem> loop10_items();

} // namespace tessemu
