// pm: Pm-patches (Myles, Ni, Peters 2008) in two-stage form, as LOOP09 ran them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/technique.h"

namespace tessemu {

std::unique_ptr<Technique> make_pm_technique();

/// PmConstants for all valences; double, to be rounded once.
std::vector<double> make_pm_constants();

} // namespace tessemu
