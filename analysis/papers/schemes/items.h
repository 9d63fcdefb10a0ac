// What is no single paper's: all schemes in one picture.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"

namespace tessemu {

std::vector<PaperItem> schemes_items();

} // namespace tessemu
