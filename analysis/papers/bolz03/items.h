// What of BOLZ03 can be reproduced: the numbers of section 3.1.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"

namespace tessemu {

std::vector<PaperItem> bolz03_items();

} // namespace tessemu
