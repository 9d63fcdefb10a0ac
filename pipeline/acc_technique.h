// acc: approximate Catmull-Clark patches (Loop and Schaefer 2008) in stencil form, as LOOP09 ran
// them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/technique.h"

namespace tessemu {

std::unique_ptr<Technique> make_acc_technique();

} // namespace tessemu
