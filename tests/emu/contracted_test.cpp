// SPDX-License-Identifier: Apache-2.0
#include "emu/contracted.h"

#include "emu/control_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace tessemu {
namespace {

using All = Contracted<float, policy::All>;
using Mixed = Contracted<float, policy::Mixed>;

float const a = 1.0f + 0x1p-12f,
            c = -(1.0f + 0x1p-11f); // a * a + c: 0 in two roundings, 2^-24 in one

TEST(Contracted, AllFusesAProductThatFeedsASum)
{
    All const x(a), y(c);
    EXPECT_EQ(All(x * x + y).value, 0x1p-24f);
    EXPECT_EQ(All(y + x * x).value, 0x1p-24f);
    EXPECT_EQ(All(x * x - All(-c)).value, 0x1p-24f);
    EXPECT_EQ(All(All(-c) - x * x).value, -0x1p-24f);
    All const rounded = x * x; // a named product is rounded
    EXPECT_EQ(All(rounded + y).value, 0.0f);
    EXPECT_EQ(a * a + c, 0.0f);
}

TEST(Contracted, VectorsFuseComponentByComponent)
{
    float3<All> const v{All(c), All(c), All(0.0f)};
    float3<All> const w{All(a), All(a), All(a)};
    float3<All> const r = All(a) * w + v;
    EXPECT_EQ(r.x.value, 0x1p-24f);
    EXPECT_EQ(r.z.value, a * a);
}

TEST(Contracted, CountsFusedSumsAsMads)
{
    using T = Contracted<Counted<float>, policy::All>;
    execution = Execution{};
    T const x{Counted<float>(a)}, y{Counted<float>(c)};
    (void)T(x * x + y);
    (void)T(x * x);
    EXPECT_EQ(execution.take(), (FlopCount{.mul = 1, .mad = 1}));
}

// A routine with three sums in a row and a loop.
template <class T> T shared_routine(T x)
{
    Routine<T> const here("shared_routine");
    T s = x * x + x;
    for (int i : loop<T>(5)) s = s * x + T(float(i));
    return s * x + x;
}

TEST(Mixed, ARoutineDecidesAlikeForEveryCaller)
{
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        site_state = {seed, 0, 0};
        float const first = shared_routine(Mixed(a)).value;
        Mixed const other = Mixed(a) * Mixed(a) + Mixed(c); // other sums before it
        (void)other;
        EXPECT_EQ(shared_routine(Mixed(a)).value, first) << seed;
    }
    site_state = {};
}

TEST(Mixed, SeedsDecideDifferently)
{
    std::set<float> results;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        site_state = {seed, 0, 0};
        results.insert(Mixed(Mixed(a) * Mixed(a) + Mixed(c)).value);
    }
    site_state = {};
    EXPECT_EQ(results, (std::set<float>{0.0f, 0x1p-24f}));
}

// Turns of a loop are one place in the source.
TEST(Mixed, EveryTurnOfALoopDecidesAlike)
{
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        site_state = {seed, 0, 0};
        std::set<float> turns;
        for (int i : loop<Mixed>(8)) {
            (void)i;
            turns.insert(Mixed(Mixed(a) * Mixed(a) + Mixed(c)).value);
        }
        EXPECT_EQ(turns.size(), 1u) << seed;
    }
    site_state = {};
}

// What follows a branch or a loop does not depend on whether the branch ran or how often the loop
// turned.
TEST(Mixed, SitesAfterABranchDoNotMove)
{
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        float after[2];
        for (int taken = 0; taken < 2; ++taken) {
            site_state = {seed, 0, 0};
            Mixed const x(a), y(c);
            (void)when(
                taken != 0, [&] { return Mixed(x * x + y); }, x);
            for (int i : loop<Mixed>(taken ? 3 : 0)) (void)i, (void)Mixed(x * x + y);
            after[taken] = Mixed(x * x + y).value;
        }
        EXPECT_EQ(after[0], after[1]) << seed;
    }
    site_state = {};
}

} // namespace
} // namespace tessemu
