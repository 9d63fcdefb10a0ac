// Facts S9 to S15 and gaps G8, G9: stream output.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <cstring>

namespace tessemu::test {
namespace {

std::vector<float> floats_of(std::span<std::byte const> bytes, std::size_t filled)
{
    std::vector<float> out(filled / 4);
    if (filled) std::memcpy(out.data(), bytes.data(), 4 * out.size());
    return out;
}

// Appends to stream k while PrimitiveID < wanted[k].
struct FourStreams {
    static constexpr PrimitiveTopology kInput = PrimitiveTopology::PointList;
    static constexpr GeometryOutput kOutput = GeometryOutput::PointList;
    static constexpr int kMaxVertices = 4;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    std::array<int, 4> wanted{};
    template <class T>
    void operator()(GeometryInput<T> const& in, std::span<SceneVertex<T> const> v,
                    VertexStream<SceneVertex<T>>& out) const
    {
        for (std::size_t k = 0; k < 4; ++k)
            when<T>(T(in.primitive_id) < T(float(wanted[k])),
                    [&] { out.append(v[0], {}, int(k)); });
    }
};

std::array<StreamOutputStatistics, 4> stream_points(int points, std::array<int, 4> const& wanted,
                                                    std::size_t bytes_each)
{
    Scene s;
    s.call.topology = PrimitiveTopology::PointList;
    s.desc.geometry_shader = bind_geometry_shader(FourStreams{wanted}, {});
    StreamOutputDesc out;
    for (std::uint8_t k = 0; k < 4; ++k) out.entries.push_back({k, 4, 4, k});
    s.desc.stream_output = out;
    std::array<std::vector<std::byte>, 4> memory;
    std::array<StreamOutputBuffer, 4> buffers;
    for (std::size_t k = 0; k < 4; ++k) {
        memory[k].resize(bytes_each);
        buffers[k] = {memory[k], 0};
    }
    if (bytes_each) s.options.stream_output = buffers;
    for (int i = 0; i < points; ++i) s.add(8, 8);
    auto const statistics = s.draw().stream_output;
    for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(buffers[k].filled, 16 * statistics[k].NumPrimitivesWritten);
    return statistics;
}

TEST(StreamOutputFacts, S9WithoutBuffersNothingIsWrittenAndStorageIsAskedFor)
{
    auto const s = stream_points(5, {5, 3, 1, 0}, 0);
    EXPECT_EQ(s[0], (StreamOutputStatistics{0, 5}));
    EXPECT_EQ(s[1], (StreamOutputStatistics{0, 3}));
    EXPECT_EQ(s[2], (StreamOutputStatistics{0, 1}));
    EXPECT_EQ(s[3], (StreamOutputStatistics{0, 0}));
}

TEST(StreamOutputFacts, S10AFullBufferStopsItsStreamWhoseNeedIsCountedOn)
{
    EXPECT_EQ(stream_points(32, {16, 0, 0, 0}, 160)[0], (StreamOutputStatistics{10, 16}));
    EXPECT_EQ(stream_points(32, {3, 0, 0, 0}, 160)[0], (StreamOutputStatistics{3, 3}));
    auto const s = stream_points(32, {16, 3, 32, 10}, 160);
    EXPECT_EQ(s[1], (StreamOutputStatistics{3, 3})); // a full buffer stops its own stream alone
    EXPECT_EQ(s[2], (StreamOutputStatistics{10, 32}));
    EXPECT_EQ(s[3], (StreamOutputStatistics{10, 10}));
}

template <class T> struct ThreeColors {
    float4<T> position, color0, color1, color2;
    static constexpr auto signature()
    {
        return std::tuple{&ThreeColors::position, &ThreeColors::color0, &ThreeColors::color1,
                          &ThreeColors::color2};
    }
};
struct PaintThreeColors {
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = ThreeColors<T>;
    template <class T>
    ThreeColors<T> operator()(VertexInput<T> const&, SceneVertex<T> const& v) const
    {
        auto const color = [](float first) {
            return float4<T>(T(first), T(first + 1), T(first + 2), T(first + 3));
        };
        return {v.position, color(1), color(100), color(5)};
    }
};

TEST(StreamOutputFacts, S11AnEntryTakesTheComponentsThatItNames)
{
    Scene s;
    s.call.topology = PrimitiveTopology::PointList;
    s.desc.vertex_shader = bind_vertex_shader(PaintThreeColors{}, {});
    s.desc.stream_output = StreamOutputDesc{{{0, 4 + 2, 2, 0}, {0, 12 + 3, 1, 0}}, {12}, -1};
    std::vector<std::byte> memory(1000);
    StreamOutputBuffer buffer{memory, 0};
    s.options.stream_output = {&buffer, 1};
    s.add(8, 8).add(8, 8);
    s.draw();
    EXPECT_EQ(floats_of(memory, buffer.filled), (std::vector<float>{3, 4, 8, 3, 4, 8}));
}

constexpr std::int16_t kGap = StreamOutputEntry::kGap;

TEST(StreamOutputFacts, S12G8GapsAndOutputsInPartsAreAccepted)
{
    auto const accepted = [](StreamOutputDesc const& d) {
        EXPECT_NO_THROW(check_stream_output(d, 8));
    };
    accepted({{{0, 0, 4, 0}}, {}, 0});
    accepted({{{0, 0, 4, 0}}, {64}, 0});
    accepted({{{0, 0, 4, 0}, {0, kGap, 8, 0}, {0, 4, 4, 0}}, {64}, 0});
    accepted({{{0, 0, 4, 0}, {0, kGap, 4, 0}, {0, kGap, 4, 0}, {0, 4, 4, 0}}, {64}, 0});
    accepted({{{0, 0, 2, 0}, {0, 2, 2, 1}}, {64, 64}, 0});
    accepted({{{0, 0, 4, 0}, {0, kGap, 8, 0}, {0, kGap, 4, 0}}, {64}, 0}); // behind all data
    accepted({{{0, kGap, 2, 0}, {0, 4, 4, 0}}, {24}, 0});                  // before it
    accepted({{{0, 0, 1, 3}, {0, 1, 1, 3}, {0, 3, 1, 3}, {0, 2, 1, 3}}, {}, -1});
    accepted({{{0, 0, 4, 0}, {1, 0, 4, 1}, {2, 0, 4, 2}, {3, 0, 4, 3}}, {16, 16, 16, 16}, 3});
    accepted({{{0, 0, 4, 0}}, {16, 0, 0, 0}, 0}); // nobody writes the others
    accepted({{}, {}, 0});
}

TEST(StreamOutputFacts, S13G8DeclarationsThatDirect3DRefusesAreRefused)
{
    auto const refused = [](StreamOutputDesc const& d, char const* message) {
        try {
            check_stream_output(d, 8);
            FAIL() << message;
        } catch (Error const& e) {
            EXPECT_STREQ(e.what(), message);
        }
    };
    refused({{{0, 0, 4, 0}, {0, 0, 4, 1}}, {}, 0},
            "stream output entry 1 streams out component 0, as entry 0 does: an output goes out "
            "once");
    refused({{{0, 4, 4, 0}, {0, 4, 4, 0}}, {}, 0},
            "stream output entry 1 streams out component 4, as entry 0 does: an output goes out "
            "once");
    refused({{{0, 0, 4, 0}, {0, kGap, 1, 0}, {0, 0, 3, 0}}, {}, 0},
            "stream output entry 2 streams out component 0, as entry 0 does: an output goes out "
            "once");
    refused({{{0, 2, 4, 0}, {0, 5, 2, 1}}, {}, 0},
            "stream output entry 1 streams out component 5, as entry 0 does: an output goes out "
            "once");
    refused({{{0, 0, 4, 0}, {0, 4, 0, 0}}, {}, 0},
            "stream output entry 1 has 0 components, it needs at least 1");
    refused({{{0, 0, 4, 0}, {0, kGap, 0, 0}}, {}, 0},
            "stream output entry 1 has 0 components, it needs at least 1");
    refused({{{0, 0, 4, 0}, {0, -2, 4, 0}}, {}, 0},
            "stream output entry 1 starts at component -2, it must be 0 or more, or -1 for a gap");
    refused({{{0, 0, 4, 0}, {0, kGap, 4, 1}, {0, kGap, 4, 1}}, {}, 0},
            "stream output buffer 1 has gaps only, an output is needed");
    refused({{{0, 0, 4, 4}}, {}, 0}, "buffer slot of stream output entry 0 is 4, the limit is 3");
    refused({{{4, 0, 4, 0}}, {}, 0}, "stream of stream output entry 0 is 4, the limit is 3");
    refused({{{0, 0, 4, 0}}, {}, 4}, "rasterized stream is 4, it must be -1 to 3");
    refused({{{0, 0, 4, 0}, {0, 6, 3, 0}}, {}, 0},
            "one past the last component of stream output entry 1 is 9, the limit is 8");
    refused({{{0, 0, 4, 0}, {1, 0, 4, 0}}, {}, 0},
            "stream output buffer 0 is written by streams 0 and 1, the latter by entry 1");
    char const* const multiple = ", it must be a multiple of 4 of at least the 16 that its entries "
                                 "fill";
    for (std::uint32_t stride : {63u, 0u, 12u, 17u})
        refused({{{0, 0, 4, 0}}, {stride}, 0}, ("stride in bytes of stream output buffer 0 is " +
                                                std::to_string(stride) + multiple)
                                                   .c_str());
    refused({{{0, 0, 4, 0}, {0, kGap, 4, 0}}, {28}, 0},
            "stride in bytes of stream output buffer 0 is 28, it must be a multiple of 4 of at "
            "least the 32 that its entries fill");
    refused({{{0, 0, 4, 0}}, {2052}, 0},
            "stride in bytes of stream output buffer 0 is 2052, the limit is 2048");
}

TEST(StreamOutputFacts, S14G9DrawsAppendAndThoseBetweenThemLeaveTheBufferAlone)
{
    std::vector<std::byte> memory(4096);
    StreamOutputBuffer buffer{memory, 0};
    std::array<float, 4> const constants[] = {{0.5f, 0.25f, 0, 0}, {0, 0.125f, 0, 1}, {1, 1, 1, 0}};
    Scene s;
    s.call.topology = PrimitiveTopology::TriangleStrip;
    std::vector<float> expected;
    for (auto const& c : constants) {
        s.vertices.clear();
        s.add(0, 0, 0.5f, 1, c).add(16, 0, 0.5f, 1, c).add(0, 16, 0.5f, 1, c);
        s.add(16, 16, 0.5f, 1, c);
        s.desc.stream_output = StreamOutputDesc{{{0, 4, 4, 0}}, {}, -1};
        s.options.stream_output = {&buffer, 1};
        s.clear();
        s.draw();
        EXPECT_EQ(s.covered(), 0);
        EXPECT_EQ(s.statistics.pipeline.CInvocations, 0u);
        for (int i = 0; i < 6; ++i) expected.insert(expected.end(), c.begin(), c.end());
        ASSERT_EQ(floats_of(memory, buffer.filled), expected);
        s.desc.stream_output.reset();
        for (bool bound : {true, false}) { // a buffer that nobody declares is not written
            if (!bound) s.options.stream_output = {};
            s.draw();
            EXPECT_EQ(s.statistics.pipeline.CInvocations, 2u);
        }
    }
    EXPECT_EQ(floats_of(memory, buffer.filled), expected);
}

// The vertex buffer's number of the vertex, then its system values.
struct Ids {
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    SceneVertex<T> operator()(VertexInput<T> const& in, SceneVertex<T> const& v) const
    {
        return {v.position, {v.value.x, T(float(in.instance_id)), T(in.vertex_id), T(1)}};
    }
};

TEST(StreamOutputFacts, S15VertexAndInstanceIdsCountFromTheDrawsOwnStart)
{
    std::vector<std::byte> memory(4096);
    StreamOutputBuffer buffer{memory, 0};
    Scene s;
    s.call.topology = PrimitiveTopology::PointList;
    s.desc.vertex_shader = bind_vertex_shader(Ids{}, {});
    s.desc.stream_output = StreamOutputDesc{{{0, 4, 3, 0}}, {}, -1};
    std::vector<float> vertices;
    for (int i = 0; i < 12; ++i)
        vertices.insert(vertices.end(), {0, 0, 0, 1, float(100 + i), 0, 0, 0});
    s.call.set_vertices(vertices, 8);
    std::uint64_t primitives = 0;
    DrawOptions options;
    options.stream_output = {&buffer, 1};
    auto const draw_points = [&](DrawCall const& call) {
        DrawStatistics const d =
            draw(GraphicsPipeline(s.desc), call, nullptr, {}, ThreadPool(2), options);
        primitives += d.stream_output[0].NumPrimitivesWritten;
    };
    std::vector<float> expected;
    auto const expect = [&](int first_number, int instances, int first_id) {
        for (int instance = 0; instance < instances; ++instance)
            for (int i = 0; i < 3; ++i)
                expected.insert(expected.end(), {float(100 + first_number + i), float(instance),
                                                 float(first_id + i)});
    };
    DrawCall call = s.call; // Draw(3), two instances
    call.vertex_count = 3;
    call.instance_count = 2;
    draw_points(call);
    expect(0, 2, 0);
    call.start_vertex = 3; // Draw(3 from 3), one from instance 16 on
    call.instance_count = 1;
    call.start_instance = 16;
    draw_points(call);
    expect(3, 1, 0);
    std::vector<std::uint32_t> const high{6, 7, 8}, low{0, 1, 2};
    call = s.call; // DrawIndexed(6 7 8), two instances
    call.indices = std::span<std::uint32_t const>(high);
    call.instance_count = 2;
    draw_points(call);
    expect(6, 2, 6);
    call.indices = std::span<std::uint32_t const>(low); // DrawIndexed(0 1 2), base vertex 9
    call.base_vertex = 9;
    call.instance_count = 1;
    call.start_instance = 7;
    draw_points(call);
    expect(9, 1, 0);
    EXPECT_EQ(floats_of(memory, buffer.filled), expected);
    EXPECT_EQ(primitives, 18u);
}

} // namespace
} // namespace tessemu::test
