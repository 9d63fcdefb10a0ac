// SPDX-License-Identifier: Apache-2.0
#include "emu/input_assembler.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

TEST(InputAssembler,
     DropsPartialPrimitives) // rule R29: 32-point patches and 63 vertices are one patch
{
    DrawCall call;
    call.control_points = 32;
    call.vertex_count = 63;
    AssembledPrimitives const p = assemble_primitives(call);
    EXPECT_EQ(p.primitives(), 1u);
    EXPECT_EQ(p.vertices.size(), 32u);
}

TEST(InputAssembler, TheAllOnesIndexCutsPatchListsToo) // rule R31
{
    std::vector<std::uint16_t> const i16{0, 1, 2, 0xffff, 3, 4, 5, 6, 7};
    DrawCall call;
    call.control_points = 4;
    call.indices = std::span<std::uint16_t const>(i16);
    AssembledPrimitives p = assemble_primitives(call);
    ASSERT_EQ(p.primitives(), 1u);
    EXPECT_EQ(p.vertices[0], 3u);
    EXPECT_EQ(p.index_bytes, 2u);

    std::vector<std::uint32_t> const i32{0, 1, 2, 3, 0xffffffff, 4, 5, 6, 7, 8};
    call.indices = std::span<std::uint32_t const>(i32);
    p = assemble_primitives(call);
    ASSERT_EQ(p.primitives(), 2u);
    EXPECT_EQ(p.vertices[4], 4u);
}

TEST(InputAssembler, AddsTheBaseVertexAfterTheCutTest) // rules R31, R32
{
    std::vector<std::uint32_t> const indices{5, 6, 7};
    DrawCall call;
    call.topology = PrimitiveTopology::TriangleList;
    call.indices = std::span<std::uint32_t const>(indices);
    call.base_vertex = -5;
    AssembledPrimitives const p = assemble_primitives(call);
    ASSERT_EQ(p.primitives(), 1u);
    EXPECT_EQ(p.vertices[0], 0u);
    EXPECT_EQ(p.vertices[2], 2u);
}

} // namespace
} // namespace tessemu
