// Every fetch is counted: by resource, by lane, and each element once as unique.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/graphics_pipeline.h"
#include "emu/texture.h"
#include "tests/support/machines.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

namespace tessemu {
namespace {

template <class T> struct Point {
    float3<T> position;
    static constexpr auto signature() { return std::tuple{&Point::position}; }
};
template <class T> struct Out {
    float4<T> position;
    static constexpr auto signature() { return std::tuple{&Out::position}; }
};

struct PassThroughVertex {
    template <class T> using Input = Point<T>;
    template <class T> using Output = Point<T>;
    template <class T> Point<T> operator()(VertexInput<T> const&, Point<T> const& p) const
    {
        return p;
    }
};

struct QuadHull {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    template <class T> using Input = Point<T>;
    template <class T> using ControlPoint = Point<T>;
    template <class T> using PatchConstant = Point<T>;
    float factor = 1;
    int control_points() const { return 4; }
    int patch_constants() const { return 0; }
    template <class T>
    Point<T> control_point(PatchInput, ControlPoints<Point<T>> const& in, int_of<T> id) const
    {
        return in[id]; // a record per lane
    }
    template <class T>
    Point<T> patch_constant(PatchInput, ControlPoints<Point<T>> const&,
                            ControlPoints<Point<T>> const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<Point<T>> const&,
                                  ControlPoints<Point<T>> const&,
                                  ControlPoints<Point<T>> const&) const
    {
        T const f(factor);
        return {f, f, f, f, f, f};
    }
};

// Fetches control point 0 twice for every point, control point 1 once where u < 1/2, a buffer
// element per lane where v = 0, and a texel everywhere.
struct FetchingDomain {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 4;
    template <class T> using ControlPoint = Point<T>;
    template <class T> using PatchConstant = Point<T>;
    template <class T> using Output = Out<T>;
    Buffer<float> table;
    Texture2D texture;
    bool skip_second = false;
    std::vector<ResourceInfo> resources() const { return {table.info(), texture.info()}; }

    template <class T>
    Out<T> operator()(DomainInput<T> const& in, ControlPoints<Point<T>> const& patch,
                      ControlPoints<Point<T>> const&) const
    {
        using Int = int_of<T>;
        float3<T> p = patch[0].position;
        if (!skip_second) p = p + patch[0].position;
        p = when(
            in.u < T(0.5), [&]() -> float3<T> { return p + patch[1].position; }, p);
        T const extra = when(
            in.v == T(0),
            [&]() -> T { return load<T>(table, select(in.u == T(0), Int(2), Int(99))); }, T(0));
        float4<T> const texel = load<T>(texture, Int(1), Int(0));
        return {float4<T>(p, T(extra + texel.x))};
    }
};

struct Counts {
    std::uint64_t control_points, control_point_bytes, unique_control_point_bytes, table,
        unique_table, texels;
    std::uint64_t unique_texels;
};

Counts run(Machine const& machine, int threads, bool skip_second)
{
    std::vector<float> const vertices{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0};
    std::vector<std::uint32_t> const indices{0, 1, 2, 3, 1, 4, 5, 2};
    std::vector<float> const table{1, 2, 3, 4}, texels(8, 0.5f);
    FetchingDomain ds;
    ds.table = {table, 0, "table"};
    ds.texture = {texels, 2, 1, 3, "texture"};
    ds.skip_second = skip_second;
    GraphicsPipelineDesc desc;
    desc.vertex_shader = bind_vertex_shader(PassThroughVertex{}, machine);
    desc.hull_shader = bind_hull_shader(QuadHull{4}, machine);
    desc.domain_shader = bind_domain_shader(ds, machine);
    desc.partitioning = Partitioning::Integer;
    desc.input_control_points = 4;
    DrawCall call;
    call.control_points = 4;
    call.set_vertices(vertices, 3);
    call.indices = std::span<std::uint32_t const>(indices);
    DrawStatistics const s = draw(GraphicsPipeline(desc), call, nullptr, {}, ThreadPool(threads));
    Counts c{};
    for (StageStatistics const& stage : s.stages) {
        if (stage.stage != "domain_shader") continue;
        for (FetchStatistics const& f : stage.fetches) {
            if (f.resource == "control_points")
                c.control_points = f.count, c.control_point_bytes = f.bytes,
                c.unique_control_point_bytes = f.unique_bytes;
            if (f.resource == "table") c.table = f.count, c.unique_table = f.unique_bytes;
            if (f.resource == "texture") c.texels = f.count, c.unique_texels = f.unique_bytes;
        }
    }
    return c;
}

// Factor 4: 25 points a patch, 10 of them with u < 1/2, 5 with v = 0. Two patches.
TEST(Fetches, AreCountedExactlyUnderMasksAndPerLane)
{
    for (Machine const& machine : test::machines())
        for (int threads : {1, 3}) {
            Counts const c = run(machine, threads, false);
            EXPECT_EQ(c.control_points, 2u * (2 * 25 + 10)) << testing::PrintToString(machine);
            EXPECT_EQ(c.control_point_bytes, 12 * c.control_points);
            EXPECT_EQ(c.unique_control_point_bytes, 2u * 2 * 12); // two records of each patch
            EXPECT_EQ(c.table, 2u * 5);
            EXPECT_EQ(c.unique_table, 4u); // element 2; element 99 is out of range
            EXPECT_EQ(c.texels, 2u * 25);
            EXPECT_EQ(c.unique_texels, 16u);
        }
}

TEST(Fetches, ARemovedFetchIsMissed)
{
    EXPECT_EQ(run({}, 1, true).control_points, run({}, 1, false).control_points - 50);
}

// Rules R142, R143.
TEST(Buffer, OutOfRangeReadsGiveZero)
{
    std::vector<float> const values{1, 2, 3};
    std::vector<std::uint32_t> const whole{7, 8, 9};
    Buffer<float> const b(values, 0, "b");
    Buffer<std::uint32_t> const w(whole, 1, "w");
    EXPECT_EQ(load<float>(b, 2), 3.0f);
    EXPECT_EQ(load<float>(b, 3), 0.0f);
    EXPECT_EQ(load<float>(b, -1), 0.0f);
    EXPECT_EQ(load<float>(w, 1), 8);
    EXPECT_EQ(load<float>(w, 3), 0);
    IntLanes<4> index(0);
    index.raw[1] = 2, index.raw[2] = 3, index.raw[3] = -5;
    Lanes<4> const r = load<Lanes<4>>(b, index);
    EXPECT_EQ(r.raw[0], 1.0f);
    EXPECT_EQ(r.raw[1], 3.0f);
    EXPECT_EQ(r.raw[2], 0.0f);
    EXPECT_EQ(r.raw[3], 0.0f);
    EXPECT_EQ(load<Lanes<4>>(w, index).raw[1], 9);
    std::vector<float> const texels(16, 1.0f);
    Texture2D const t(texels, 2, 2, 0, "t");
    EXPECT_EQ(load<float>(t, 1, 1).x, 1.0f);
    EXPECT_EQ(load<float>(t, 2, 1).x, 0.0f);
    EXPECT_EQ(load<float>(t, 0, -1).w, 0.0f);
}

// Runs of neighbouring elements take a faster way; it must read and count like the slow one.
RC_GTEST_PROP(Buffer, PerLaneLoadsReadAndCountLikeSingleOnes, ())
{
    using T = Counted<Lanes<16>>;
    std::vector<float> values(std::size_t(*rc::gen::inRange(1, 300)));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i) + 0.5f;
    Buffer<float> const buffer(values, 2, "b");
    TouchedElements touched(values.size());
    std::array<FetchSlot, kBufferSlots> slots{};
    slots[2].touched = &touched;
    execution = Execution{};
    execution.buffers = slots.data();
    execution.buffer_slots = std::uint32_t(slots.size());
    std::set<std::int32_t> expected;
    std::uint64_t fetches = 0;
    for (int turn = 0; turn < 4; ++turn) {
        std::int32_t const first = *rc::gen::inRange(-20, 320);
        bool const run = *rc::gen::arbitrary<bool>();
        IntLanes<16> index(0);
        for (int l = 0; l < 16; ++l) index.raw[l] = run ? first + l : *rc::gen::inRange(-20, 320);
        std::uint32_t const active = *rc::gen::inRange(1u, 0x10000u);
        execution.activate(active);
        Lanes<16> const r = load<T>(buffer, index).value;
        for (int l = 0; l < 16; ++l) {
            bool const inside = index.raw[l] >= 0 && std::size_t(index.raw[l]) < values.size();
            RC_ASSERT(r.raw[l] == (inside ? values[std::size_t(index.raw[l])] : 0.0f));
            if (!(active >> l & 1)) continue;
            ++fetches;
            if (inside) expected.insert(index.raw[l]);
        }
    }
    execution = Execution{};
    RC_ASSERT(slots[2].count == fetches);
    RC_ASSERT(touched.count() == expected.size());
}

} // namespace
} // namespace tessemu
