// Tally: a scalar that counts operations in a constant expression, beside the shader that it
// measures.
//
//     constexpr FlopCount cost = tally([](FlopCount* sink) { regular_quad<Tally>(...); });
//     static_assert(cost.mul == 156);
//
// A constant carries no sink, and constant-with-constant counts nothing, as in a shader compiler. A
// value rides along so that a branch is decided as the machine would decide it.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/counted.h"

namespace tessemu {

struct Tally {
    double value = 0;
    FlopCount* sink = nullptr; // null: a constant

    constexpr Tally() = default;
    constexpr Tally(double v) : value(v) {}
    constexpr Tally(double v, FlopCount* s) : value(v), sink(s) {}

    friend constexpr Tally operator+(Tally a, Tally b)
    {
        return count(a, b, &FlopCount::add, a.value + b.value);
    }
    friend constexpr Tally operator-(Tally a, Tally b)
    {
        return count(a, b, &FlopCount::add, a.value - b.value);
    }
    friend constexpr Tally operator*(Tally a, Tally b)
    {
        return count(a, b, &FlopCount::mul, a.value * b.value);
    }
    friend constexpr Tally operator/(Tally a, Tally b)
    {
        return count(a, b, &FlopCount::div, b.value == 0 ? 0 : a.value / b.value);
    }
    friend constexpr Tally operator-(Tally a) { return {-a.value, a.sink}; }
    friend constexpr Tally mad(Tally a, Tally b, Tally c)
    {
        return count(a, Tally(0, b.sink ? b.sink : c.sink), &FlopCount::mad,
                     a.value * b.value + c.value);
    }
    /// The root's value is not needed to decide anything: any positive number does.
    friend constexpr Tally sqrt(Tally a) { return count(a, a, &FlopCount::sqrt, a.value); }
    friend constexpr Tally floor(Tally a)
    {
        auto const i = static_cast<long long>(a.value);
        return {double(i) > a.value ? double(i) - 1 : double(i), a.sink};
    }
    friend constexpr Tally abs(Tally a) { return {a.value < 0 ? -a.value : a.value, a.sink}; }
    friend constexpr Tally min(Tally a, Tally b)
    {
        return count(a, b, &FlopCount::compare, a.value < b.value ? a.value : b.value);
    }
    friend constexpr Tally max(Tally a, Tally b)
    {
        return count(a, b, &FlopCount::compare, a.value > b.value ? a.value : b.value);
    }
    friend constexpr bool operator<(Tally a, Tally b)
    {
        return count(a, b, &FlopCount::compare, 0), a.value < b.value;
    }
    friend constexpr bool operator>(Tally a, Tally b) { return b < a; }
    friend constexpr bool operator<=(Tally a, Tally b) { return !(b < a); }
    friend constexpr bool operator>=(Tally a, Tally b) { return !(a < b); }
    friend constexpr bool operator==(Tally a, Tally b)
    {
        return count(a, b, &FlopCount::compare, 0), a.value == b.value;
    }
    friend constexpr bool operator!=(Tally a, Tally b) { return !(a == b); }
    friend constexpr Tally select(bool m, Tally a, Tally b)
    {
        return {m ? a.value : b.value, a.sink ? a.sink : b.sink};
    }

private:
    static constexpr Tally count(Tally a, Tally b, std::uint64_t FlopCount::*kind, double value)
    {
        FlopCount* const sink = a.sink ? a.sink : b.sink;
        if (sink) ++(sink->*kind);
        return {value, sink};
    }
};

template <> struct ScalarTraits<Tally> {
    using Storage = float;
    using Mask = bool;
    using Int = std::int32_t;
    static constexpr int kLanes = 1;
    static constexpr bool kCounted = false, kTally = true, kSites = false;
};

/// Runs `shader(sink)` and returns what it counted; the shader makes its inputs as Tally(value,
/// sink).
template <class F> constexpr FlopCount tally(F&& shader)
{
    FlopCount c;
    shader(&c);
    return c;
}

} // namespace tessemu
