// Counted<T>: a scalar whose operators count, and the thread's execution state that the counts go
// to.
//
// An operation of a group counts once for each active lane, so a count never depends on how
// invocations were grouped into lanes; straight-line code costs a few additions per group.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/lanes.h"

#include <array>
#include <utility>

namespace tessemu {

/// Floating-point operations. Sign changes, select, abs and floor are free, as source modifiers and
/// moves are on hardware; min and max count as one comparison.
struct FlopCount {
    std::uint64_t add = 0, mul = 0, mad = 0, div = 0, sqrt = 0, rsqrt = 0, compare = 0, unused = 0;

    constexpr FlopCount& operator+=(FlopCount const& o)
    {
        add += o.add, mul += o.mul, mad += o.mad, div += o.div;
        sqrt += o.sqrt, rsqrt += o.rsqrt, compare += o.compare;
        return *this;
    }
    friend constexpr FlopCount operator+(FlopCount a, FlopCount const& b) { return a += b; }
    friend constexpr FlopCount operator*(FlopCount a, std::uint64_t n)
    {
        return {a.add * n, a.mul * n, a.mad * n, a.div * n, a.sqrt * n, a.rsqrt * n, a.compare * n};
    }
    /// Of one invocation of n that cost the same.
    friend constexpr FlopCount operator/(FlopCount a, std::uint64_t n)
    {
        return {a.add / n, a.mul / n, a.mad / n, a.div / n, a.sqrt / n, a.rsqrt / n, a.compare / n};
    }
    friend constexpr bool operator==(FlopCount const&, FlopCount const&) = default;
};

/// LOOP10's convention: multiplications and divisions count, additions do not.
constexpr std::uint64_t flops_loop10(FlopCount const& c)
{
    return c.mul + c.mad + c.div;
}

/// Fetches of one resource by one thread.
struct FetchSlot;

/// What a shader does besides straight-line arithmetic, as a bit each.
enum ShaderFeature : std::uint32_t {
    kBranches = 1,    ///< when(): invocations differ in their counts
    kFetches = 2,     ///< reads a buffer or a texture
    kDerivatives = 4, ///< looks at its 2x2 quad
};

/// The state of the group of invocations that the thread is running.
struct Execution {
    FlopCount flops{};              ///< counted per invocation
    std::uint32_t active_bits = 1;  ///< bit i: lane i runs
    std::uint32_t active_lanes = 1; ///< popcount of active_bits
    FetchSlot* buffers = nullptr;   ///< the stage's buffer slots, by slot number
    std::uint32_t buffer_slots = 0; ///< how many
    std::uint32_t features = 0;     ///< ShaderFeature bits met since the state was made

    void activate(std::uint32_t bits)
    {
        active_bits = bits;
        active_lanes = std::uint32_t(std::popcount(bits));
    }
    FlopCount take() { return std::exchange(flops, {}); }
};
// Of the initial-exec model: its address is no call, behind which lanes would have to be loaded anew.
[[gnu::tls_model("initial-exec")]] constinit inline thread_local Execution execution{};

template <class T> struct Counted {
    T value;

    Counted() = default;
    Counted(T v) : value(v) {}
    Counted(float v) requires(!std::same_as<T, float>) : value(v) {}
    explicit Counted(int_of<T> i) requires(!std::same_as<int_of<T>, std::int32_t>) : value(T(i)) {}

    friend Counted operator+(Counted a, Counted b)
    {
        execution.flops.add += execution.active_lanes;
        return T(a.value + b.value);
    }
    friend Counted operator-(Counted a, Counted b)
    {
        execution.flops.add += execution.active_lanes;
        return T(a.value - b.value);
    }
    friend Counted operator*(Counted a, Counted b)
    {
        execution.flops.mul += execution.active_lanes;
        return T(a.value * b.value);
    }
    friend Counted operator/(Counted a, Counted b)
    {
        execution.flops.div += execution.active_lanes;
        return T(a.value / b.value);
    }
    friend Counted operator-(Counted a) { return T(-a.value); }
    friend Counted mad(Counted a, Counted b, Counted c)
    {
        execution.flops.mad += execution.active_lanes;
        return T(mad(a.value, b.value, c.value));
    }
    friend Counted sqrt(Counted a)
    {
        execution.flops.sqrt += execution.active_lanes;
        return T(sqrt(a.value));
    }
    friend Counted floor(Counted a) { return T(floor(a.value)); }
    friend Counted abs(Counted a) { return T(abs(a.value)); }
    friend Counted min(Counted a, Counted b)
    {
        execution.flops.compare += execution.active_lanes;
        return T(min(a.value, b.value));
    }
    friend Counted max(Counted a, Counted b)
    {
        execution.flops.compare += execution.active_lanes;
        return T(max(a.value, b.value));
    }
    friend mask_of<T> operator<(Counted a, Counted b)
    {
        execution.flops.compare += execution.active_lanes;
        return a.value < b.value;
    }
    friend mask_of<T> operator>(Counted a, Counted b)
    {
        execution.flops.compare += execution.active_lanes;
        return a.value > b.value;
    }
    friend mask_of<T> operator<=(Counted a, Counted b)
    {
        execution.flops.compare += execution.active_lanes;
        return a.value <= b.value;
    }
    friend mask_of<T> operator>=(Counted a, Counted b)
    {
        execution.flops.compare += execution.active_lanes;
        return a.value >= b.value;
    }
    friend mask_of<T> operator==(Counted a, Counted b)
    {
        execution.flops.compare += execution.active_lanes;
        return a.value == b.value;
    }
    friend mask_of<T> operator!=(Counted a, Counted b)
    {
        execution.flops.compare += execution.active_lanes;
        return a.value != b.value;
    }
    friend Counted select(mask_of<T> m, Counted a, Counted b)
    {
        return T(select(m, a.value, b.value));
    }
};

template <class T> struct ScalarTraits<Counted<T>> : ScalarTraits<T> {
    static constexpr bool kCounted = true;
};

} // namespace tessemu
