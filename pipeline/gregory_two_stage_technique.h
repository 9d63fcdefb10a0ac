// gregory-two-stage: LOOP09's Gregory patches with a vertex shader over one-rings and a hull shader
// over sectors (sections 4.1, 4.2).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/technique.h"

namespace tessemu {

std::unique_ptr<Technique> make_gregory_two_stage_technique();

} // namespace tessemu
