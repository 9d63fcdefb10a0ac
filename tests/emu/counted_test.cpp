// SPDX-License-Identifier: Apache-2.0
#include "emu/tally.h"

#include "emu/control_flow.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

// A shader with a branch: the counts under the mask are those of its lanes only.
struct Branchy {
    template <class T> constexpr T operator()(T x) const
    {
        T const y = x * x + T(1);
        return when(
            x < T(4), [&] { return T(sqrt(y) / (x + T(2))); }, y);
    }
};

template <int N> FlopCount count_branchy(int invocations)
{
    execution = Execution{};
    for (int first = 0; first < invocations; first += N) {
        int const active = std::min(N, invocations - first);
        execution.activate((1u << active) - 1);
        Lanes<N> x(0.0f);
        for (int i = 0; i < active; ++i) x.raw[i] = float((first + i) % 7);
        (void)Branchy{}(Counted<Lanes<N>>(x));
    }
    return execution.take();
}

TEST(Counted, CountsDoNotDependOnHowInvocationsAreGrouped)
{
    for (int n : {1, 7, 16, 33, 1000, 1003}) {
        execution = Execution{};
        for (int i = 0; i < n; ++i) (void)Branchy{}(Counted<float>(float(i % 7)));
        FlopCount const scalar = execution.take();
        EXPECT_EQ(count_branchy<4>(n), scalar) << n;
        EXPECT_EQ(count_branchy<8>(n), scalar) << n;
        EXPECT_EQ(count_branchy<16>(n), scalar) << n;
        FlopCount expected{
            .add = std::uint64_t(n), .mul = std::uint64_t(n), .compare = std::uint64_t(n)};
        for (int i = 0; i < n; ++i)
            if (i % 7 < 4) ++expected.add, ++expected.div, ++expected.sqrt;
        EXPECT_EQ(scalar, expected) << n;
    }
}

TEST(Counted, ValuesEqualTheUncountedOnes)
{
    for (int i = 0; i < 9; ++i)
        EXPECT_EQ(Branchy{}(Counted<float>(float(i))).value, Branchy{}(float(i)));
}

TEST(When, SkipsWorkThatNoLaneNeedsAndNests)
{
    using T = Counted<Lanes<8>>;
    execution = Execution{};
    execution.activate(0xff);
    T const x(Lanes<8>(1.0f));
    int runs = 0;
    (void)when(
        x.value > Lanes<8>(2.0f), [&] { return ++runs, x; }, x);
    EXPECT_EQ(runs, 0);
    Lanes<8> ramp;
    for (int i = 0; i < 8; ++i) ramp.raw[i] = float(i);
    T const r = when(
        ramp > Lanes<8>(1.0f),
        [&] {
            return when(
                ramp < Lanes<8>(5.0f), [&] { return T(x + x); }, T(x * x));
        },
        x);
    FlopCount const c = execution.take();
    EXPECT_EQ(c.add, 3u); // lanes 2, 3, 4
    EXPECT_EQ(c.mul, 6u); // lanes 2 to 7 evaluated the other side
    EXPECT_EQ(r.value.raw[0], 1.0f);
    EXPECT_EQ(r.value.raw[3], 2.0f);
    EXPECT_EQ(r.value.raw[7], 1.0f);
}

constexpr FlopCount branchy_cost(double x)
{
    return tally([&](FlopCount* sink) { (void)Branchy{}(Tally(x, sink)); });
}
static_assert(branchy_cost(1) == FlopCount{.add = 2, .mul = 1, .div = 1, .sqrt = 1, .compare = 1});
static_assert(branchy_cost(5) == FlopCount{.add = 1, .mul = 1, .compare = 1});

// Constants among themselves cost nothing, as in a shader compiler.
static_assert(tally([](FlopCount* sink) {
                  Tally const x(3, sink);
                  (void)(x * (Tally(2) * Tally(3) + Tally(1)));
              }) == FlopCount{.mul = 1});

TEST(Tally, EqualsTheRunTimeCount)
{
    for (float x : {1.0f, 5.0f}) {
        execution = Execution{};
        (void)Branchy{}(Counted<float>(x));
        EXPECT_EQ(execution.take(), branchy_cost(double(x)));
    }
}

} // namespace
} // namespace tessemu
