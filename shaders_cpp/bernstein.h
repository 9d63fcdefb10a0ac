// Bernstein polynomials of any degree.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/records.h"

namespace tessemu {

/// The polynomials of degree n at t by the triangular recurrence, and the directions of their
/// derivatives
///
///     B^0_0 = 1,     B^k_j = (1 - t) B^(k-1)_j + t B^(k-1)_(j-1)
///     d/dt B^n_j = n (B^(n-1)_(j-1) - B^(n-1)_j)
///
/// \cost  n (n + 1) mul
template <int n, class T> struct BernsteinBasis {
    T b[n + 1]; ///< the polynomials
    T d[n + 1]; ///< their derivatives, without the factor n

    constexpr explicit BernsteinBasis(T t)
    {
        T const s = T(1) - t;
        b[0] = T(1);
        unrolled<n>([&](auto degree) {
            if constexpr (degree == n - 1) differences(b, d);
            constexpr int k = degree + 1;
            b[k] = t * b[k - 1];
            unrolled<k - 1>([&](auto j) { b[k - 1 - j] = s * b[k - 1 - j] + t * b[k - 2 - j]; });
            b[0] = s * b[0];
        });
    }

protected:
    /// d_j = b_(j-1) - b_j of the polynomials of degree n - 1.
    static constexpr void differences(T const* lower, T (&d)[n + 1])
    {
        d[0] = -lower[0];
        unrolled<n - 1>([&](auto j) { d[j + 1] = lower[j] - lower[j + 1]; });
        d[n] = lower[n - 1];
    }
};

/// The same with second derivatives, without the factor n (n - 1).
template <int n, class T> struct SecondOrderBernsteinBasis : BernsteinBasis<n, T> {
    T dd[n + 1];

    constexpr explicit SecondOrderBernsteinBasis(T t) : BernsteinBasis<n, T>(t)
    {
        this->differences(BernsteinBasis<n - 1, T>(t).d, dd);
    }
};

} // namespace tessemu
