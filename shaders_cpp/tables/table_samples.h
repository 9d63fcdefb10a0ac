// Where a point of a patch lies among the samples of its tables.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"

namespace tessemu {

/// Where a point lies among the samples of a table: three of them with weights, or one.
template <class T, int n> struct TablePlace {
    int_of<T> sample[n];
    T weight[n]; ///< of one sample: 1
};

/// Of a whole number from 0 to 2^23 - 1.
template <class T> int_of<T> whole(T const& x)
{
    return asuint(T(x + T(0x1p23f))) & int_of<T>(0x7fffff);
}

/// Samples of a triangle's tables, row after row of v (TableGrid).
struct TriangleSamples {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Tri;
    static constexpr int kCorners = 3;

    int segments = 0;

    /// A multiple of 1/segments.
    template <class T> TablePlace<T, 1> at(DomainInput<T> const& in) const
    {
        T const n = T(float(segments));
        return {{index<T>(T(in.u * n), T(in.v * n))}, {T(1)}};
    }
    /// Any: linear between the three samples around, so on a side between two of them. All of it is
    /// exact: u and v are multiples of 2^-16.
    ///
    /// \cost  2 mul, 7 add, 3 comparisons
    template <class T> TablePlace<T, 3> between(DomainInput<T> const& in) const
    {
        using Int = int_of<T>;
        T const n = T(float(segments)), last = n - T(1);
        T const x = in.u * n, y = in.v * n;
        T const i = min(floor(x), last), j = min(floor(y), last);
        T const fx = x - i, fy = y - j, sum = fx + fy;
        mask_of<T> const upper = sum > T(1);
        Int const first = index<T>(i, j), right = first + Int(1),
                  above = first + Int(segments + 1) - whole<T>(j);
        T const gx = T(1) - fx, gy = T(1) - fy, rest = T(1) - sum;
        return {{select(upper, above + Int(1), first), right, above},
                {select(upper, T(-rest), rest), select(upper, gy, fx), select(upper, gx, fy)}};
    }

private:
    template <class T> int_of<T> index(T const& i, T const& j) const
    {
        using Int = int_of<T>;
        Int const column = whole<T>(i), row = whole<T>(j);
        return column + row * Int(segments + 1) - ((row * (row - Int(1))) >> Int(1));
    }
};

/// Samples of a quad's tables, row after row of v.
struct QuadSamples {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kCorners = 4;

    int segments = 0;

    /// A multiple of 1/segments.
    template <class T> TablePlace<T, 1> at(DomainInput<T> const& in) const
    {
        using Int = int_of<T>;
        T const n = T(float(segments));
        return {{whole<T>(T(in.u * n)) + whole<T>(T(in.v * n)) * Int(segments + 1)}, {T(1)}};
    }
    /// Any: bilinear between the four samples around, so on a side between two of them, with exact
    /// weights there: u and v are multiples of 2^-16.
    ///
    /// \cost  6 mul, 5 add, 2 comparisons
    template <class T> TablePlace<T, 4> between(DomainInput<T> const& in) const
    {
        using Int = int_of<T>;
        T const n = T(float(segments)), last = n - T(1);
        T const x = in.u * n, y = in.v * n;
        T const i = min(floor(x), last), j = min(floor(y), last);
        T const fx = x - i, fy = y - j, gx = T(1) - fx, gy = T(1) - fy;
        Int const first = whole<T>(i) + whole<T>(j) * Int(segments + 1),
                  above = first + Int(segments + 1);
        return {{first, first + Int(1), above, above + Int(1)},
                {T(gx * gy), T(fx * gy), T(gx * fy), T(fx * fy)}};
    }
};

} // namespace tessemu
