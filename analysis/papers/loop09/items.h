// What of LOOP09 can be reproduced: tables 1 to 3, figures 1, 3, 9, 10, 11, 12.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"

namespace tessemu {

std::vector<PaperItem> loop09_items();

} // namespace tessemu
