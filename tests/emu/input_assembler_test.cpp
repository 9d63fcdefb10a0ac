// SPDX-License-Identifier: Apache-2.0
#include "emu/input_assembler.h"

#include "emu/error.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

// 32-point patches and 63 vertices are one patch.
TEST(InputAssembler, R29R166I23DropsPartialPrimitivesAndDoesNotCountThem)
{
    DrawCall call;
    call.control_points = 32;
    call.vertex_count = 63;
    AssembledPrimitives const p = assemble_primitives(call);
    EXPECT_EQ(p.primitives(), 1u);
    EXPECT_EQ(p.vertices.size(), 32u);
}

TEST(InputAssembler, R31TheAllOnesIndexCutsPatchListsToo)
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

using Topology = PrimitiveTopology;

std::vector<std::uint32_t> assembled(Topology t, std::uint32_t vertices)
{
    DrawCall call;
    call.topology = t;
    call.vertex_count = vertices;
    AssembledPrimitives const p = assemble_primitives(call);
    return {p.vertices.begin(), p.vertices.end()};
}

TEST(InputAssembler, R27R28TopologiesGiveTheirVerticesInOrder)
{
    using V = std::vector<std::uint32_t>;
    EXPECT_EQ(assembled(Topology::PointList, 2), (V{0, 1}));
    EXPECT_EQ(assembled(Topology::LineList, 5), (V{0, 1, 2, 3}));
    EXPECT_EQ(assembled(Topology::LineStrip, 4), (V{0, 1, 1, 2, 2, 3}));
    EXPECT_EQ(assembled(Topology::TriangleList, 7), (V{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(assembled(Topology::TriangleStrip, 5), (V{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    EXPECT_EQ(assembled(Topology::LineListAdj, 9), (V{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(assembled(Topology::LineStripAdj, 5), (V{0, 1, 2, 3, 1, 2, 3, 4}));
    EXPECT_EQ(assembled(Topology::TriangleListAdj, 6), (V{0, 1, 2, 3, 4, 5}));
    // Two triangles 0-2-4 and 2-6-4 (the leading vertex is the strip's), neighbours between.
    EXPECT_EQ(assembled(Topology::TriangleStripAdj, 8), (V{0, 1, 2, 6, 4, 3, 2, 5, 6, 7, 4, 0}));
}

TEST(InputAssembler, R29DropsIncompleteStripsToo)
{
    EXPECT_TRUE(assembled(Topology::LineStrip, 1).empty());
    EXPECT_TRUE(assembled(Topology::TriangleStrip, 2).empty());
    EXPECT_TRUE(assembled(Topology::TriangleStripAdj, 5).empty());
}

// One vertex of two elements: position per vertex, an instance's word.
struct Slots {
    std::vector<float> positions{0, 1, 2, 10, 11, 12, 20, 21, 22};
    std::vector<std::uint32_t> words{100, 200, 300};
    DrawCall call;
    Slots()
    {
        call.vertex_buffers = {{std::as_bytes(std::span(positions)), 12, 0},
                               {std::as_bytes(std::span(words)), 4, 0}};
        call.layout = {{Format::R32G32B32_FLOAT, 4, 0, 0, false, 1},
                       {Format::R32_UINT, 1, 1, 0, true, 1}};
    }
    /// As many registers as both elements have at most.
    std::array<float, 8> fetch(std::uint32_t vertex, std::uint32_t instance) const
    {
        std::array<float, 8> out{};
        fetch_vertex(call, vertex, instance, out.data());
        return out;
    }
};

std::uint32_t word(float f)
{
    return std::bit_cast<std::uint32_t>(f);
}

TEST(InputAssembler, R31R32TheBaseVertexIsAddedAfterTheCutTestAndWraps)
{
    Slots s;
    std::vector<std::uint32_t> const indices{5, 6, 7};
    s.call.topology = Topology::TriangleList;
    s.call.indices = std::span<std::uint32_t const>(indices);
    s.call.base_vertex = -5;
    AssembledPrimitives const p = assemble_primitives(s.call);
    ASSERT_EQ(p.primitives(), 1u);
    EXPECT_EQ(p.index(p.vertices[0]), 5u); // R34: VertexID is the index itself
    EXPECT_EQ(s.fetch(5, 0)[0], 0.0f);
    EXPECT_EQ(s.fetch(7, 0)[2], 22.0f);
    s.call.base_vertex = 2;
    EXPECT_EQ(s.fetch(0xffffffffu, 0)[1], 11.0f); // all ones + 2 is vertex 1
}

TEST(InputAssembler, R33InstanceDataStepOnceInStepRateInstances)
{
    Slots s;
    s.call.start_instance = 1; // offsets instance data only
    EXPECT_EQ(word(s.fetch(0, 0)[4]), 200u);
    EXPECT_EQ(word(s.fetch(1, 1)[4]), 300u);
    EXPECT_EQ(s.fetch(0, 1)[0], 0.0f);
    s.call.start_instance = 0;
    s.call.layout[1].step_rate = 2;
    EXPECT_EQ(word(s.fetch(0, 1)[4]), 100u);
    EXPECT_EQ(word(s.fetch(0, 4)[4]), 300u);
    s.call.layout[1].step_rate = 0;
    EXPECT_EQ(word(s.fetch(0, 1000)[4]), 100u);
}

TEST(InputAssembler, R35R36OutOfBoundsIsZeroAndMissingComponentsDefault)
{
    Slots s;
    EXPECT_EQ(s.fetch(1, 0)[3], 1.0f); // a missing fourth
    auto const outside = s.fetch(3, 9);
    EXPECT_EQ(outside[0], 0.0f);
    EXPECT_EQ(outside[3], 1.0f);
    EXPECT_EQ(word(outside[4]), 0u);
    s.call.vertex_buffers[0].bytes = {}; // nothing bound: no defaults
    EXPECT_EQ(s.fetch(0, 0)[3], 0.0f);
    s.call.layout[1] = {Format::R32_UINT, 4, 1, 0, false, 1};
    EXPECT_EQ(word(s.fetch(0, 0)[7]), 1u); // integer 1
    // 32-bit components pass untouched: a signalling NaN and a denormal.
    s.positions[0] = std::bit_cast<float>(0x7f800001u);
    s.positions[1] = std::bit_cast<float>(1u);
    s.call.vertex_buffers[0].bytes = std::as_bytes(std::span(s.positions));
    EXPECT_EQ(word(s.fetch(0, 0)[0]), 0x7f800001u);
    EXPECT_EQ(word(s.fetch(0, 0)[1]), 1u);
}

TEST(InputAssembler, R37R38LimitsAreNamed)
{
    auto const refused = [](auto change, char const* text) {
        Slots s;
        change(s.call);
        try {
            check_draw_call(s.call);
            FAIL() << text;
        } catch (Error const& e) {
            EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
        }
    };
    refused([](DrawCall& c) { c.vertex_buffers[0].stride = 2049; },
            "vertex stride in bytes is 2049, the limit is 2048");
    refused([](DrawCall& c) { c.layout[0].slot = 32; },
            "vertex buffer slot is 32, the limit is 31");
    refused([](DrawCall& c) { c.layout.resize(33); }, "input elements is 33, the limit is 32");
    refused([](DrawCall& c) { c.layout[0].offset = 2; }, "needs a multiple of 4");
    Slots s;
    s.call.vertex_buffers[0].stride = 0; // every vertex the same
    EXPECT_NO_THROW(check_draw_call(s.call));
    EXPECT_EQ(s.fetch(2, 0)[2], 2.0f);
}

TEST(InputAssembler, R40DrawAutoTakesWhatStreamOutputFilled)
{
    Slots s;
    s.call.set_auto({37}); // 3 whole vertices of 12 bytes
    EXPECT_EQ(s.call.vertex_count, 3u);
    s.call.vertex_buffers[0].offset = 14;
    s.call.set_auto({37});
    EXPECT_EQ(s.call.vertex_count, 1u);
    s.call.set_auto({14});
    EXPECT_EQ(s.call.vertex_count, 0u);
}

TEST(InputAssembler, WildIndicesAreNoReasonForAHugeTable)
{
    std::vector<std::uint32_t> const indices{0, 0xfffffff0u, 7, 7, 0, 0xfffffff0u};
    DrawCall call;
    call.topology = Topology::TriangleList;
    call.indices = std::span<std::uint32_t const>(indices);
    AssembledPrimitives const p = assemble_primitives(call);
    EXPECT_EQ(p.vertex_id_limit, 3u);
    EXPECT_EQ(p.index(p.vertices[1]), 0xfffffff0u);
    EXPECT_EQ(p.index(p.vertices[2]), 7u);
}

} // namespace
} // namespace tessemu
