// Constants of LOOP09 without a library cosine: the same bits on every machine.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tessemu {

/// cos(pi a / b), b > 0. Reduced exactly in integers to [0, pi/4], then a Taylor polynomial: within
/// 2 ulp of the cosine, and exact at multiples of pi/2 and pi/3.
double cos_pi(int a, int b);
/// sin(pi a / b) = cos(pi (b - 2a) / (2b))
double sin_pi(int a, int b);

/// (5 + cos(2pi/n) + cos(pi/n) sqrt(18 + 2 cos(2pi/n))) / 16: the subdominant eigenvalue of
/// Catmull-Clark subdivision (LOOP09 3.3).
double loop09_lambda(int n);
/// 1 / sqrt(4 + cos(pi/n)^2) (LOOP09 3.3)
double loop09_sigma(int n);

} // namespace tessemu
