// Bernstein polynomials of any degree, and tensor-product patches of any basis.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/records.h"

#include <utility>

namespace tessemu {

/// The polynomials of degree n at t by the triangular recurrence, and the directions of their
/// derivatives
///
///     B^0_0 = 1,     B^k_j = (1 - t) B^(k-1)_j + t B^(k-1)_(j-1)
///     d/dt B^n_j = n (B^(n-1)_(j-1) - B^(n-1)_j)
///
/// \cost  n (n + 1) mul
template <int n, class T> struct BernsteinBasis {
    static constexpr int kFunctions = n + 1;
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

/// Tensor-product patch S = U b V of two bases of N functions.
///
/// \param net  net(i, j): control point i along u, j along v; asked for once each
/// \returns    position and the derivatives along u and v, in the bases' units
/// \cost       6 N (N + 1) + 3 N mul
template <class T, class Net, class Basis>
constexpr TangentFrame<T> tensor_product(Net const& net, Basis const& U, Basis const& V)
{
    constexpr int N = Basis::kFunctions;
    auto const sum = [](T const(&weight)[N], T const(&x)[N]) -> T {
        return [&]<int... j>(std::integer_sequence<int, j...>)->T
        {
            return (... + (weight[j] * x[j]));
        }
        (std::make_integer_sequence<int, N>());
    };
    TangentFrame<T> s;
    unrolled<N>([&](auto i) {
        float3<T> b[N];
        unrolled<N>([&](auto j) { b[j] = net(i, j); });
        components([&](auto of) {
            T x[N];
            unrolled<N>([&](auto j) { x[j] = of(b[j]); });
            T const row = sum(V.b, x), row_dv = sum(V.d, x);
            if constexpr (i == 0) {
                of(s.position) = U.b[0] * row;
                of(s.du) = U.d[0] * row;
                of(s.dv) = U.b[0] * row_dv;
            } else {
                of(s.position) = of(s.position) + U.b[i] * row;
                of(s.du) = of(s.du) + U.d[i] * row;
                of(s.dv) = of(s.dv) + U.b[i] * row_dv;
            }
        });
    });
    return s;
}

} // namespace tessemu
