// Numbers by valence of Pm-patches (Myles, Ni and Peters 2008).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace tessemu {

/// PmConstants for all valences; double, to be rounded once.
std::vector<double> make_pm_constants();

} // namespace tessemu
