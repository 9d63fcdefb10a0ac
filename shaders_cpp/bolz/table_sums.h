// Sums of basis functions: tables times control points, BOLZ03 section 3 and figure 6.
//
// The tables of a patch type lie side by side in a texture, each of 33 x 33 texels, folded into
// rows where they are wider than a texture may be. A fragment brings the texel that it stands for
// in the first table; the others lie at constant offsets from it.
//
// Two orders. In one order for the whole mesh, patches that meet add the same products one after
// the other, and get the same bits: a control point brings its table's offset, and two points share
// the addition of their offsets. In the order of the tables nothing but their number is needed, and
// four tables share a texel; shared points then depend on the patch.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/texture.h"
#include "shaders_cpp/table_term.h"

#include <algorithm>

namespace tessemu {

/// Where tables lie in a texture.
struct TableLayout {
    static constexpr int kSide = 33; ///< texels of a table
    int tables = 0, columns = 0, rows = 0;

    /// \param tables  side by side, in rows that are no wider than a texture may be
    static constexpr TableLayout of(int tables)
    {
        int const most = ColorTarget::kMaxSize / kSide;
        int const columns = tables < most ? tables : most;
        return {tables, columns, (tables + columns - 1) / columns};
    }
    constexpr int width() const { return kSide * columns; }
    constexpr int height() const { return kSide * rows; }
    /// Texels from the first table to another.
    constexpr int x(int table) const { return kSide * (table % columns); }
    constexpr int y(int table) const { return kSide * (table / columns); }
};

namespace detail {
/// Control point i of a patch's constants, four floats each.
template <class T> float3<T> control_point(ConstantBuffer<float> const& points, int i)
{
    return {load<T>(points, 4 * i), load<T>(points, 4 * i + 1), load<T>(points, 4 * i + 2)};
}
} // namespace detail

/// Control points in one order for the whole mesh.
struct OrderedSums {
    static constexpr int kAtOnce = 2; ///< control points that share an addition
    static constexpr int kChannels = 1;

    ConstantBuffer<float> points;  ///< [control point][4]: x, y, z, 0
    ConstantBuffer<float> offsets; ///< [control point][2]: of its table, in texels
    int count = 0; ///< of control points, even: the last may be 0 and weigh anything

    /// The sums of n sets of tables, alike but for their weights.
    ///
    /// \param at  the texel of the first table, in texels
    /// \cost      for two control points 4 add, and for each set 2 fetches, 6 mul, 6 add
    template <class T, std::size_t n>
    std::array<float3<T>, n> operator()(std::array<Texture2D, n> const& tables,
                                        float2<T> const& at) const
    {
        std::array<float3<T>, n> sums;
        for (float3<T>& s : sums) s = {T(0), T(0), T(0)};
        for (int pair : loop<T>(count / 2)) {
            auto const offset = [&](int k) -> T { return load<T>(offsets, 4 * pair + k); };
            float2<T> const first{T(offset(0) + at.x), T(offset(1) + at.y)},
                second{T(offset(2) + at.x), T(offset(3) + at.y)};
            float3<T> const a = detail::control_point<T>(points, 2 * pair),
                            b = detail::control_point<T>(points, 2 * pair + 1);
            for (std::size_t i = 0; i < n; ++i)
                sums[i] = add_term(sums[i], fetch_texel<T>(tables[i], first).x, a);
            for (std::size_t i = 0; i < n; ++i)
                sums[i] = add_term(sums[i], fetch_texel<T>(tables[i], second).x, b);
        }
        return sums;
    }
};

/// Control points in the order of the tables, four of which share a texel.
struct PackedSums {
    static constexpr int kChannels = 4;

    ConstantBuffer<float> points; ///< [control point][4]: x, y, z, 0
    TableLayout layout;           ///< of texels with four tables each
    int count = 0;                ///< of control points

    /// \cost  for four control points 2 add, and for each set 1 fetch, 12 mul, 12 add
    template <class T, std::size_t n>
    std::array<float3<T>, n> operator()(std::array<Texture2D, n> const& tables,
                                        float2<T> const& at) const
    {
        std::array<float3<T>, n> sums;
        for (float3<T>& s : sums) s = {T(0), T(0), T(0)};
        for (int group : loop<T>((count + 3) / 4)) {
            float2<T> const texel{T(T(float(layout.x(group))) + at.x),
                                  T(T(float(layout.y(group))) + at.y)};
            std::array<float4<T>, n> w;
            for (std::size_t i = 0; i < n; ++i) w[i] = fetch_texel<T>(tables[i], texel);
            for (int k = 4 * group; k < std::min(count, 4 * group + 4); ++k) {
                float3<T> const p = detail::control_point<T>(points, k);
                for (std::size_t i = 0; i < n; ++i) {
                    T const weight[4] = {w[i].x, w[i].y, w[i].z, w[i].w};
                    sums[i] = add_term(sums[i], weight[k % 4], p);
                }
            }
        }
        return sums;
    }
};

} // namespace tessemu
