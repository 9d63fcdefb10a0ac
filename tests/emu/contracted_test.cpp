// SPDX-License-Identifier: Apache-2.0
#include "emu/contracted.h"

#include "emu/control_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace tessemu {
namespace {

using C = Contracted<float>;

// The thread's rule, and none again afterwards.
class Under {
public:
    explicit Under(Contraction contraction, std::uint64_t seed = 0)
    {
        site_state = {contraction, seed};
    }
    ~Under() { site_state = {}; }
};

float const a = 1.0f + 0x1p-12f,
            c = -(1.0f + 0x1p-11f); // a * a + c: 0 in two roundings, 2^-24 in one

TEST(Contracted, AllFusesAProductThatFeedsASum)
{
    Under const all(Contraction::All);
    C const x(a), y(c);
    EXPECT_EQ(C(x * x + y).value, 0x1p-24f);
    EXPECT_EQ(C(y + x * x).value, 0x1p-24f);
    EXPECT_EQ(C(x * x - C(-c)).value, 0x1p-24f);
    EXPECT_EQ(C(C(-c) - x * x).value, -0x1p-24f);
    C const rounded = x * x; // a named product is rounded
    EXPECT_EQ(C(rounded + y).value, 0.0f);
    EXPECT_EQ(a * a + c, 0.0f);
}

TEST(Contracted, NoneRoundsTwiceAndCountsAProductAndASum)
{
    using T = Contracted<Counted<float>>;
    execution = Execution{};
    T const x{Counted<float>(a)}, y{Counted<float>(c)};
    EXPECT_EQ(T(x * x + y).value.value, 0.0f);
    EXPECT_EQ(T(y - x * x).value.value, c - a * a);
    EXPECT_EQ(execution.take(), (FlopCount{.add = 2, .mul = 2}));
}

TEST(Contracted, VectorsFuseComponentByComponent)
{
    Under const all(Contraction::All);
    float3<C> const v{C(c), C(c), C(0.0f)};
    float3<C> const w{C(a), C(a), C(a)};
    float3<C> const r = C(a) * w + v;
    EXPECT_EQ(r.x.value, 0x1p-24f);
    EXPECT_EQ(r.z.value, a * a);
}

TEST(Contracted, CountsFusedSumsAsMads)
{
    using T = Contracted<Counted<float>>;
    Under const all(Contraction::All);
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
        Under const mixed(Contraction::Mixed, seed);
        float const first = shared_routine(C(a)).value;
        C const other = C(a) * C(a) + C(c); // other sums before it
        (void)other;
        EXPECT_EQ(shared_routine(C(a)).value, first) << seed;
    }
}

TEST(Mixed, SeedsDecideDifferently)
{
    std::set<float> results;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Under const mixed(Contraction::Mixed, seed);
        results.insert(C(C(a) * C(a) + C(c)).value);
    }
    site_state = {};
    EXPECT_EQ(results, (std::set<float>{0.0f, 0x1p-24f}));
}

// Turns of a loop are one place in the source.
TEST(Mixed, EveryTurnOfALoopDecidesAlike)
{
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Under const mixed(Contraction::Mixed, seed);
        std::set<float> turns;
        for (int i : loop<C>(8)) {
            (void)i;
            turns.insert(C(C(a) * C(a) + C(c)).value);
        }
        EXPECT_EQ(turns.size(), 1u) << seed;
    }
}

// What follows a branch or a loop does not depend on whether the branch ran or how often the loop
// turned.
TEST(Mixed, SitesAfterABranchDoNotMove)
{
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        float after[2];
        for (int taken = 0; taken < 2; ++taken) {
            Under const mixed(Contraction::Mixed, seed);
            C const x(a), y(c);
            (void)when(
                taken != 0, [&] { return C(x * x + y); }, x);
            for (int i : loop<C>(taken ? 3 : 0)) (void)i, (void)C(x * x + y);
            after[taken] = C(x * x + y).value;
        }
        EXPECT_EQ(after[0], after[1]) << seed;
    }
}

} // namespace
} // namespace tessemu
