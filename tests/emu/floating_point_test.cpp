// SPDX-License-Identifier: Apache-2.0
#include "emu/floating_point.h"

#include <gtest/gtest.h>

#include <thread>

namespace tessemu {
namespace {

// The build's flags: with contraction the sum below is 2^-24.
TEST(FloatingPoint, TheCompilerDoesNotContract)
{
    volatile float const a = 1.0f + 0x1p-12f, c = -(1.0f + 0x1p-11f);
    EXPECT_EQ(a * a + c, 0.0f);
}

TEST(DenormalMode, FlushesInputsAndResultsAndIsRestored)
{
    volatile float tiny = 1e-40f, small = 2e-38f, half = 0.5f;
    EXPECT_NE(tiny * 1.0f, 0.0f);
    {
        DenormalMode const flush(DenormalMode::Flush);
        EXPECT_EQ(tiny * 1.0f, 0.0f);
        EXPECT_EQ(small * half, 0.0f); // 1e-38 is denormal
        {
            DenormalMode const keep(DenormalMode::Keep);
            EXPECT_NE(tiny * 1.0f, 0.0f);
        }
        EXPECT_EQ(tiny * 1.0f, 0.0f);
    }
    EXPECT_NE(tiny * 1.0f, 0.0f);
}

TEST(DenormalMode, BelongsToTheThread)
{
    bool kept = false;
    std::thread worker([&] { DenormalMode const flush(DenormalMode::Flush); });
    worker.join();
    volatile float tiny = 1e-40f;
    kept = tiny * 1.0f != 0.0f;
    EXPECT_TRUE(kept);
}

} // namespace
} // namespace tessemu
