// Numbers by valence of Gregory patches' vertex shader in the two-stage form.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace tessemu {

/// RingConstants with the paper's lambda(n) times `lambda_scale`; double, to be rounded once.
std::vector<double> make_ring_constants(double lambda_scale);
/// The row of one ring, as long as its edges ask for.
std::vector<double> ring_constants_of(int faces, bool boundary, double lambda_scale);

} // namespace tessemu
