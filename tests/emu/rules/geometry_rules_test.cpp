// Rules R1 to R7, R39, R41 to R55 and R80 to R89, R156 to R166: stages before the rasterizer.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/machines.h"
#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <cstring>

namespace tessemu::test {
namespace {

// Geometry shaders on scene vertices.

// Hands a triangle on, its PrimitiveID doubled, its viewport chosen by value.w of the leading
// vertex.
struct PassTriangle {
    static constexpr PrimitiveTopology kInput = PrimitiveTopology::TriangleList;
    static constexpr GeometryOutput kOutput = GeometryOutput::TriangleStrip;
    static constexpr int kMaxVertices = 3;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    void operator()(GeometryInput<T> const& in, std::span<SceneVertex<T> const> v,
                    VertexStream<SceneVertex<T>>& out) const
    {
        using Int = int_of<T>;
        for (std::size_t k = 0; k < 3; ++k) {
            // Only the leading vertex's values count.
            Int const viewport = k == 0 ? in.primitive_id : Int(7);
            out.append(v[k], {in.primitive_id + in.primitive_id, viewport});
        }
    }
};
struct ShowId {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        return {T(p.primitive_id) + T(1), T(1), T(1), T(1)};
    }
};

TEST(GeometryShader, R7R85R99LeadingVertexGivesPrimitiveIdAndViewport)
{
    Scene s(32, 32);
    s.desc.geometry_shader = bind_geometry_shader(PassTriangle{}, {});
    s.use(ShowId{});
    s.target.viewports = {{0, 0, 16, 16, 0, 1}, {16, 0, 16, 16, 0, 1}, {0, 16, 16, 16, 0, 1}};
    for (int i = 0; i < 5; ++i) s.add_full(0.5f - float(i) / 16);
    DrawStatistics const& n = s.draw();
    EXPECT_EQ(s.at(20, 4), 2.0f * 1 + 1); // primitive 1 in viewport 1
    EXPECT_EQ(s.at(4, 20), 2.0f * 2 + 1);
    EXPECT_EQ(s.at(20, 20), 0.0f); // viewport 3 is all zeros
    EXPECT_EQ(n.pipeline.GSInvocations, 5u);
    EXPECT_EQ(n.pipeline.GSPrimitives, 5u);
}

// Viewports that a geometry shader chose do not linger in the memory of the next draw.
TEST(GeometryShader, R99WithoutOneAllGoesToViewportZero)
{
    DrawMemory memory;
    Scene s(32, 32);
    s.options.memory = &memory;
    s.target.viewports = {{0, 0, 16, 16, 0, 1}, {16, 0, 16, 16, 0, 1}};
    for (int i = 0; i < 2; ++i) s.add_full(0.5f);
    s.desc.geometry_shader = bind_geometry_shader(PassTriangle{}, {});
    s.draw();
    EXPECT_EQ(s.covered(), 2 * 16 * 16);
    s.clear();
    s.desc.geometry_shader = nullptr;
    s.draw();
    EXPECT_EQ(s.covered(), 16 * 16);
    EXPECT_EQ(s.at(20, 4), 0.0f);
}

TEST(GeometryShader, R99AnIndexOutOfRangeActsAsZero)
{
    Scene s(16, 16);
    s.desc.geometry_shader = bind_geometry_shader(PassTriangle{}, {});
    s.use(ShowId{});
    s.target.viewports = {{0, 0, 16, 16, 0, 1}};
    for (int i = 0; i < 17; ++i) s.add_full(0.9f - float(i) / 32);
    s.draw();
    EXPECT_EQ(s.at(3, 3), 33.0f); // primitive 16, nearest, drawn in viewport 0
}

// A point becomes a strip of value.x vertices, cut after value.y of them; twice, as instances.
struct Strips {
    static constexpr PrimitiveTopology kInput = PrimitiveTopology::PointList;
    static constexpr GeometryOutput kOutput = GeometryOutput::TriangleStrip;
    static constexpr int kMaxVertices = 6, kInstances = 2;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    void operator()(GeometryInput<T> const& in, std::span<SceneVertex<T> const> v,
                    VertexStream<SceneVertex<T>>& out) const
    {
        for (int i = 0; i < 9; ++i) {
            when<T>(v[0].value.x > T(float(i)), [&] {
                SceneVertex<T> o = v[0];
                o.value.z = T(float(i));
                o.value.w = T(float(in.instance_id));
                out.append(o);
            });
            when<T>(v[0].value.y == T(float(i + 1)), [&] { out.restart_strip(); });
        }
    }
};

struct Streamed {
    std::vector<float> values;
    DrawStatistics statistics;
};
Streamed stream_strips(std::vector<std::array<float, 2>> const& points, std::size_t bytes = 1 << 16,
                       Machine const& machine = {}, int threads = 2)
{
    Scene s;
    s.threads = threads;
    s.call.topology = PrimitiveTopology::PointList;
    s.desc.geometry_shader = bind_geometry_shader(Strips{}, machine);
    s.desc.stream_output = StreamOutputDesc{{{0, 6, 2, 0}}, {}, -1}; // value.zw
    std::vector<std::byte> memory(bytes);
    StreamOutputBuffer buffer{memory, 0};
    s.options.stream_output = {&buffer, 1};
    for (auto const& p : points) s.add(8, 8, 0.5f, 1, {p[0], p[1], 0, 0});
    Streamed r;
    r.statistics = s.draw();
    r.values.resize(buffer.filled / 4);
    if (buffer.filled) std::memcpy(r.values.data(), memory.data(), buffer.filled);
    return r;
}

TEST(GeometryShader, R83R84R85R87StripsCutStopAndExpandInInstanceOrder)
{
    // 4 vertices: triangles 0-1-2 and, with the winding kept, 1-3-2; a second instance follows.
    Streamed const s = stream_strips({{4, 0}, {2, 0}, {9, 0}, {5, 3}});
    auto const at = [&](std::size_t i) { return std::pair(s.values[2 * i], s.values[2 * i + 1]); };
    using P = std::pair<float, float>;
    std::vector<P> expected;
    auto const strip = [&](std::vector<int> corners, float instance) {
        for (int c : corners) expected.emplace_back(float(c), instance);
    };
    for (float i : {0.0f, 1.0f}) strip({0, 1, 2, 1, 3, 2}, i);
    // Two vertices are no triangle; nine stop at six (R84): four triangles.
    for (float i : {0.0f, 1.0f}) strip({0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4}, i);
    for (float i : {0.0f, 1.0f}) strip({0, 1, 2}, i); // cut after 3; the rest is incomplete
    ASSERT_EQ(s.values.size(), 2 * expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(at(i), expected[i]) << i;
    EXPECT_EQ(s.statistics.pipeline.GSInvocations, 4u * 2);             // R161
    EXPECT_EQ(s.statistics.pipeline.GSPrimitives, expected.size() / 3); // complete ones only
    EXPECT_EQ(s.statistics.stream_output[0].NumPrimitivesWritten, expected.size() / 3);
    EXPECT_EQ(s.statistics.pipeline.CInvocations, 0u); // nothing is rasterized
}

TEST(StreamOutput, R1R88AFullBufferStopsTheStreamAndCountingGoesOn)
{
    Streamed const all = stream_strips({{4, 0}, {4, 0}, {4, 0}});
    // 24 bytes a triangle: room for 7 of 12 and a part of one.
    Streamed const some = stream_strips({{4, 0}, {4, 0}, {4, 0}}, 24 * 7 + 20);
    EXPECT_EQ(some.statistics.stream_output[0].NumPrimitivesWritten, 7u);
    EXPECT_EQ(some.statistics.stream_output[0].PrimitiveStorageNeeded, 12u);
    ASSERT_EQ(some.values.size(), 7u * 6);
    EXPECT_TRUE(std::equal(some.values.begin(), some.values.end(), all.values.begin()));
    EXPECT_EQ(stream_strips({{4, 0}}, 0).statistics.stream_output[0].NumPrimitivesWritten, 0u);
    // R1: any threads, any machine.
    std::vector<std::array<float, 2>> many;
    for (int i = 0; i < 2000; ++i) many.push_back({float(i % 10), float(i % 4)});
    std::vector<float> const first = stream_strips(many, 1 << 20, {}, 1).values;
    for (Machine const& machine : machines())
        for (int threads : {1, 2, 5}) {
            std::vector<float> const other = stream_strips(many, 1 << 20, machine, threads).values;
            ASSERT_TRUE(other.size() == first.size() &&
                        std::memcmp(other.data(), first.data(), 4 * first.size()) == 0);
        }
}

// Points to two streams.
struct TwoStreams {
    static constexpr PrimitiveTopology kInput = PrimitiveTopology::PointList;
    static constexpr GeometryOutput kOutput = GeometryOutput::PointList;
    static constexpr int kMaxVertices = 3;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    void operator()(GeometryInput<T> const&, std::span<SceneVertex<T> const> v,
                    VertexStream<SceneVertex<T>>& out) const
    {
        out.append(v[0], {}, 0);
        out.append(v[0], {}, 1);
        out.append(v[0], {}, 1);
    }
};

TEST(StreamOutput, R86R88StreamsAreIndependentAndOneIsRasterized)
{
    for (int rasterized : {0, 1}) {
        Scene s;
        s.call.topology = PrimitiveTopology::PointList;
        s.desc.geometry_shader = bind_geometry_shader(TwoStreams{}, {});
        s.desc.stream_output = StreamOutputDesc{{{0, 4, 1, 0}, {1, 4, 1, 1}}, {}, rasterized};
        std::vector<std::byte> zero(4), one(400);
        StreamOutputBuffer buffers[2] = {{zero, 0}, {one, 0}};
        s.options.stream_output = buffers;
        for (int i = 0; i < 5; ++i) s.add(2.5f + float(i), 3.5f, 0.5f, 1, {float(i + 1), 0, 0, 0});
        DrawStatistics const& n = s.draw();
        EXPECT_EQ(n.stream_output[0].NumPrimitivesWritten, 1u);
        EXPECT_EQ(n.stream_output[0].PrimitiveStorageNeeded, 5u);
        EXPECT_EQ(n.stream_output[1].NumPrimitivesWritten, 10u);
        EXPECT_EQ(n.pipeline.CInvocations, rasterized ? 10u : 5u);
        EXPECT_EQ(s.covered(), 5);
    }
    Scene bad; // more than one stream needs points
    bad.desc.geometry_shader = bind_geometry_shader(PassTriangle{}, {});
    bad.desc.stream_output = StreamOutputDesc{{{1, 4, 1, 0}}, {}, 0};
    bad.add_full();
    EXPECT_THROW(bad.draw(), Error);
}

TEST(StreamOutput, R87R89GapsStridesAndLimits)
{
    Scene s;
    s.call.topology = PrimitiveTopology::LineStrip;
    // y, a gap of two, x; into 24 bytes a vertex.
    s.desc.stream_output = StreamOutputDesc{
        {{0, 5, 1, 2}, {0, -1, 2, 2}, {0, 4, 1, 2}}, {std::nullopt, std::nullopt, 24}, -1};
    std::vector<std::byte> memory(1000, std::byte{0xaa});
    StreamOutputBuffer buffers[3] = {{}, {}, {memory, 0}};
    s.options.stream_output = buffers;
    for (int i = 0; i < 3; ++i) s.add(1, 1, 0.5f, 1, {float(i), float(10 * i), 0, 0});
    s.draw();
    EXPECT_EQ(buffers[2].filled, 4u * 24); // two lines
    auto const read = [&](std::size_t at) {
        float f;
        std::memcpy(&f, memory.data() + at, 4);
        return f;
    };
    EXPECT_EQ(read(24), 10.0f);
    EXPECT_EQ(read(24 + 12), 1.0f);
    EXPECT_EQ(memory[24 + 4], std::byte{0xaa}); // the gap is not written
    EXPECT_EQ(read(48), 10.0f);                 // the second line starts at vertex 1
    auto const refused = [](StreamOutputDesc const& d) {
        EXPECT_THROW(check_stream_output(d, 128), Error);
    };
    refused({{{0, 0, 129, 0}}, {}, 0});
    refused({{{0, 0, 4, 4}}, {}, 0});
    refused({{{0, 0, 4, 0}}, {2052}, 0});
    refused({{{0, 0, 4, 0}}, {8}, 0});
    refused({{{0, 126, 4, 0}}, {}, 0});
    refused({{{0, 0, 4, 0}, {1, 0, 4, 0}}, {}, 0});
    EXPECT_NO_THROW(check_stream_output({{{0, 0, 128, 0}}, {512}, 0}, 128));
}

TEST(StreamOutput, R39R40R76DrawAutoDrawsWhatWasStreamed)
{
    Scene s;
    s.call.topology = PrimitiveTopology::TriangleStrip;
    s.desc.stream_output = StreamOutputDesc{{{0, 0, 8, 0}}, {}, -1};
    std::vector<std::byte> memory(4096);
    StreamOutputBuffer buffer{memory, 0};
    s.options.stream_output = {&buffer, 1};
    s.add(0, 0).add(16, 0).add(0, 16).add(16, 16).add(16, 16); // the last one is degenerate
    s.draw();
    EXPECT_EQ(buffer.filled, 3u * 3 * 32);
    Scene again;
    again.add_full();
    again.draw(); // for the layout
    again.clear();
    again.call.vertex_buffers = {{memory, 32, 0}};
    again.call.set_auto({buffer.filled});
    DrawStatistics const n =
        draw(GraphicsPipeline(again.desc), again.call, &again.target, {}, ThreadPool(1));
    EXPECT_EQ(n.pipeline.CInvocations, 3u); // R39: the degenerate one too
    EXPECT_EQ(again.covered(), 256);
}

// Patches straight into a geometry shader: all control points at once.
struct PatchToPoint {
    static constexpr PrimitiveTopology kInput = PrimitiveTopology::PatchList;
    static constexpr int kControlPoints = 5;
    static constexpr GeometryOutput kOutput = GeometryOutput::PointList;
    static constexpr int kMaxVertices = 1;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    void operator()(GeometryInput<T> const&, std::span<SceneVertex<T> const> v,
                    VertexStream<SceneVertex<T>>& out) const
    {
        SceneVertex<T> o = v[0];
        for (std::size_t k = 1; k < 5; ++k) o.value.x = o.value.x + v[k].value.x;
        out.append(o);
    }
};

TEST(Pipeline, R3R4I29PatchesWithoutTessellationGoToGeometryShaderOrStreamOutputOnly)
{
    Scene s;
    s.call.topology = PrimitiveTopology::PatchList;
    s.call.control_points = 5;
    for (int i = 0; i < 10; ++i)
        s.add(3.5f + float(i / 5), 2.5f, 0.5f, 1, {float(1 << i), 0, 0, 0});
    EXPECT_THROW(s.draw(), Error);
    s.desc.geometry_shader = bind_geometry_shader(PatchToPoint{}, {});
    EXPECT_EQ(s.draw().pipeline.GSInvocations, 2u);
    EXPECT_EQ(s.at(3, 2), 31.0f);
    EXPECT_EQ(s.at(4, 2), 31.0f * 32);
    s.desc.geometry_shader = nullptr; // R87: each control point is a vertex
    s.desc.stream_output = StreamOutputDesc{{{0, 4, 1, 0}}, {}, -1};
    std::vector<std::byte> memory(400);
    StreamOutputBuffer buffer{memory, 0};
    s.options.stream_output = {&buffer, 1};
    EXPECT_EQ(s.draw().stream_output[0].NumPrimitivesWritten, 2u);
    EXPECT_EQ(buffer.filled, 40u);
}

TEST(GeometryShader, R83R84LimitsAreNamed)
{
    Scene s;
    s.desc.geometry_shader = bind_geometry_shader(PassTriangle{}, {});
    EXPECT_NO_THROW(GraphicsPipeline{s.desc});
    s.call.topology = PrimitiveTopology::LineList; // not what it takes
    s.add_full();
    EXPECT_THROW(s.draw(), Error);
}

// Adjacency: a line's neighbours reach the geometry shader, and nothing else.
struct Adjacent {
    static constexpr PrimitiveTopology kInput = PrimitiveTopology::LineListAdj;
    static constexpr GeometryOutput kOutput = GeometryOutput::PointList;
    static constexpr int kMaxVertices = 1;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    void operator()(GeometryInput<T> const&, std::span<SceneVertex<T> const> v,
                    VertexStream<SceneVertex<T>>& out) const
    {
        SceneVertex<T> o = v[1];
        o.value = float4<T>(v[0].value.x, v[3].value.x, T(1), T(1));
        out.append(o);
    }
};

TEST(GeometryShader, R28R82AdjacencyReachesTheGeometryShaderOnly)
{
    Scene s;
    s.call.topology = PrimitiveTopology::LineListAdj;
    for (int i = 0; i < 4; ++i) s.add(3.5f + float(2 * i), 2.5f, 0.5f, 1, {float(i + 1), 0, 0, 0});
    s.draw();
    EXPECT_EQ(s.at(5, 2), 2.0f); // the line from vertex 1 to 2, its end not drawn
    EXPECT_EQ(s.covered(), 2);
    s.clear();
    s.desc.geometry_shader = bind_geometry_shader(Adjacent{}, {});
    s.draw();
    EXPECT_EQ(s.at(5, 2), 1.0f);
    EXPECT_EQ(s.at(5, 2, 1), 4.0f);
}

// Instances: IDs and per-instance data.
struct InstanceShader {
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    SceneVertex<T> operator()(VertexInput<T> const& in, SceneVertex<T> const& v) const
    {
        SceneVertex<T> o = v;
        o.value = float4<T>(T(in.vertex_id), T(float(in.instance_id)), T(1), T(1));
        return o;
    }
};

TEST(InputAssembler, R30R34InstancesRestartTheirIds)
{
    Scene s;
    s.call.topology = PrimitiveTopology::PointList;
    s.call.start_vertex = 0;
    s.desc.vertex_shader = bind_vertex_shader(InstanceShader{}, {});
    s.desc.stream_output = StreamOutputDesc{{{0, 4, 2, 0}}, {}, -1};
    std::vector<std::byte> memory(1000);
    StreamOutputBuffer buffer{memory, 0};
    s.options.stream_output = {&buffer, 1};
    s.call.instance_count = 3;
    s.call.start_instance = 7;
    for (int i = 0; i < 2; ++i) s.add(1, 1);
    PipelineStatistics const p = s.draw().pipeline;
    EXPECT_EQ(p.IAVertices, 6u);
    EXPECT_EQ(p.VSInvocations, 6u);
    float out[12];
    std::memcpy(out, memory.data(), sizeof out);
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(out[2 * i], float(i % 2));
        EXPECT_EQ(out[2 * i + 1], float(i / 2)); // StartInstanceLocation is not added
    }
}

TEST(PipelineStatistics, R42R156R157StripsAndListsOfEqualIndices)
{
    auto const run = [](PrimitiveTopology t, std::size_t n, VertexCacheModel cache, bool indexed) {
        Scene s;
        s.call.topology = t;
        for (std::size_t i = 0; i < n; ++i) s.add(1, 1);
        if (indexed) s.indices.assign(n, 0);
        s.options.vertex_cache = cache;
        return s.draw().pipeline;
    };
    VertexCacheModel const none{VertexCacheModel::Kind::None, 0},
        infinite{VertexCacheModel::Kind::Infinite, 0};
    auto const strip = PrimitiveTopology::TriangleStrip, list = PrimitiveTopology::TriangleList;
    PipelineStatistics p = run(strip, 6, none, true);
    EXPECT_EQ(p.IAVertices, 6u);
    EXPECT_EQ(p.IAPrimitives, 4u);
    EXPECT_EQ(p.VSInvocations, 6u);
    EXPECT_EQ(run(strip, 6, infinite, true).VSInvocations, 1u);
    p = run(list, 12, none, true);
    EXPECT_EQ(p.IAVertices, 12u);
    EXPECT_EQ(p.IAPrimitives, 4u);
    EXPECT_EQ(p.VSInvocations, 12u);
    EXPECT_EQ(run(list, 12, infinite, true).VSInvocations, 1u);
    EXPECT_EQ(run(strip, 6, none, false).VSInvocations, 6u);
    EXPECT_EQ(run(list, 12, infinite, false).VSInvocations, 12u);
}

TEST(PipelineStatistics, R162ClippingCountsWhatGoesInAndWhatComesOut)
{
    Scene s;
    s.add_full();                                         // whole
    s.add(0, 0, -0.5f).add(32, 0, 0.5f).add(0, 32, 0.5f); // cut into two
    s.add(0, 0, 2).add(32, 0, 2).add(0, 32, 2);           // outside
    PipelineStatistics const p = s.draw().pipeline;
    EXPECT_EQ(p.CInvocations, 3u);
    EXPECT_EQ(p.CPrimitives, 1u + 2 + 0);
}

} // namespace
} // namespace tessemu::test
