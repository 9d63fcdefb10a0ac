// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/limit_constants.h"

#include <cmath>

namespace tessemu {

namespace {

constexpr double kPi = 3.14159265358979323846;

// Taylor polynomials on [0, pi/4], where the first term left out is below 2^-60.
double cos_small(double x)
{
    double const y = x * x;
    double sum = 0;
    for (int k = 10; k >= 1; --k) sum = (1.0 - sum) * y / ((2.0 * k - 1) * (2.0 * k));
    return 1.0 - sum;
}
double sin_small(double x)
{
    double const y = x * x;
    double sum = 0;
    for (int k = 10; k >= 1; --k) sum = (1.0 - sum) * y / ((2.0 * k) * (2.0 * k + 1));
    return x * (1.0 - sum);
}

} // namespace

double cos_pi(int a, int b)
{
    a = a < 0 ? -a : a;
    a %= 2 * b;
    if (a > b) a = 2 * b - a;
    if (2 * a > b) return -cos_pi(b - a, b);
    if (2 * a == b) return 0;
    if (3 * a == b) return 0.5;
    if (4 * a <= b) return cos_small(kPi * a / b);
    return sin_small(kPi * (b - 2 * a) / (2 * b));
}

double sin_pi(int a, int b)
{
    return cos_pi(b - 2 * a, 2 * b);
}

double loop09_lambda(int n)
{
    double const c = cos_pi(2, n);
    return (5 + c + cos_pi(1, n) * std::sqrt(18 + 2 * c)) / 16;
}

double loop09_sigma(int n)
{
    double const c = cos_pi(1, n);
    return 1 / std::sqrt(4 + c * c);
}

} // namespace tessemu
