// Rules R144 and R151 to R155: compute shaders.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/compute_shader.h"
#include "tests/support/machines.h"

#include <gtest/gtest.h>

#include <numeric>

namespace tessemu {
namespace {

// Writes (GI, x, y, z of DTid) at the thread's place in the dispatch.
struct Ids {
    static constexpr std::array<int, 3> kThreads{3, 4, 5};
    RWBuffer<std::int32_t> out;
    std::vector<ResourceInfo> resources() const { return {out.info()}; }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        group.for_each_thread([&](ComputeInput<T> const& in) {
            using Int = int_of<T>;
            Int const place = (Int(in.group_id.x) * Int(60) + in.group_index) * Int(4);
            store<T>(out, place, in.group_index);
            store<T>(out, place + Int(1), in.dispatch_thread_id.x);
            store<T>(out, place + Int(2), in.dispatch_thread_id.y);
            store<T>(out, place + Int(3), in.dispatch_thread_id.z);
        });
    }
};

TEST(ComputeShader, R152R164ThreadIdsAndInvocationCounts)
{
    for (Machine const& machine : test::machines())
        for (int threads : {1, 3}) {
            std::vector<std::int32_t> out(2 * 60 * 4, -1);
            Ids shader;
            shader.out = {out, 0, "out"};
            auto const program = bind_compute_shader(shader, machine);
            DrawStatistics const n = dispatch(program, {2, 1, 1}, ThreadPool(threads));
            EXPECT_EQ(n.pipeline.CSInvocations, 120u);
            EXPECT_EQ(n.stages[0].output_bytes, 120u * 4 * 4);
            for (int g = 0; g < 2; ++g)
                for (int i = 0; i < 60; ++i) {
                    std::int32_t const* const p = out.data() + (g * 60 + i) * 4;
                    ASSERT_EQ(p[0], i); // GI = z 3 4 + y 3 + x
                    ASSERT_EQ(p[1], g * 3 + i % 3);
                    ASSERT_EQ(p[2], i / 3 % 4);
                    ASSERT_EQ(p[3], i / 12);
                }
        }
}

// Thread i reads the vector that `index` names and writes it, doubled, at place i.
struct Doubled {
    static constexpr std::array<int, 3> kThreads{8, 1, 1};
    Buffer<std::uint32_t> index;
    RWVectorBuffer in, out;
    std::vector<ResourceInfo> resources() const { return {index.info(), in.info(), out.info()}; }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        group.for_each_thread([&](ComputeInput<T> const& thread) {
            using Int = int_of<T>;
            Int const i = thread.dispatch_thread_id.x;
            float3<T> const v = load3<T>(in, Int(load<T>(index, i)));
            store3(out, i, float3<T>(v + v));
        });
    }
};

TEST(ComputeShader, R144VectorsAreReadAndWrittenWholeOrNotAtAll)
{
    // Any order, twice the same, the last one, past the end, far past it, as a negative number.
    std::vector<std::uint32_t> const index{4, 0, 4, 3, 1, 5, 0x2aaaaaab, 0xffffffff, 0,
                                           1, 2, 3, 4, 0, 1, 2,          3,          2};
    constexpr std::size_t stride = RWVectorBuffer::kStride;
    for (Machine const& machine : test::machines())
        for (int threads : {1, 3}) {
            std::vector<float> from(5 * stride), to(17 * stride, -1);
            for (std::size_t k = 0; k < from.size(); ++k) from[k] = float(k) + 0.5f;
            Doubled shader;
            shader.index = {index, 0, "index"};
            shader.in = {from, 1, "in"};
            shader.out = {to, 2, "out"};
            auto const program = bind_compute_shader(shader, machine);
            DrawStatistics const n = dispatch(program, {3, 1, 1}, ThreadPool(threads));
            for (std::size_t i = 0; i < 17; ++i) // the 18th thread writes past the end
                for (std::size_t k = 0; k < stride; ++k) {
                    bool const read = index[i] < 5 && k < 3;
                    float const expected = k == 3 ? -1 : read ? 2 * from[index[i] * stride + k] : 0;
                    ASSERT_EQ(to[i * stride + k], expected) << i << " " << k;
                }
            auto const& fetches = n.stages[0].fetches;
            EXPECT_EQ(fetches[1].count, 24u);
            EXPECT_EQ(fetches[1].bytes, 24u * 12);
            EXPECT_EQ(fetches[1].unique_bytes, 5u * 12);
            EXPECT_EQ(n.stages[0].output_bytes, 24u * 12);
        }
}

TEST(ComputeShader, R151LimitsAreNamedAndAnEmptyDispatchDoesNothing)
{
    std::vector<std::int32_t> out(480, -1);
    Ids shader;
    shader.out = {out, 0, "out"};
    auto const program = bind_compute_shader(shader, {});
    EXPECT_EQ(dispatch(program, {2, 0, 1}, ThreadPool(1)).pipeline.CSInvocations, 0u);
    EXPECT_EQ(out[0], -1);
    try {
        dispatch(program, {65536, 1, 1}, ThreadPool(1));
        FAIL();
    } catch (LimitError const& e) {
        EXPECT_EQ(e.value, 65536u);
        EXPECT_EQ(e.limit, 65535u);
    }
}

template <int x, int y, int z, int shared> struct Sized {
    static constexpr std::array<int, 3> kThreads{x, y, z};
    static constexpr int kSharedFloats = shared;
    template <class T> void operator()(ComputeGroup<T>&) const {}
};

TEST(ComputeShader, R151R153GroupSizeAndSharedMemoryLimits)
{
    auto const run = [](auto shader) {
        dispatch(bind_compute_shader(shader, {}), {1, 1, 1}, ThreadPool(1));
    };
    EXPECT_NO_THROW(run(Sized<1024, 1, 1, 8192>{}));
    EXPECT_NO_THROW(run(Sized<4, 4, 64, 0>{}));
    EXPECT_THROW(run(Sized<1025, 1, 1, 0>{}), LimitError);
    EXPECT_THROW(run(Sized<1, 1, 65, 0>{}), LimitError);
    EXPECT_THROW(run(Sized<32, 33, 1, 0>{}), LimitError);
    EXPECT_THROW(run(Sized<1, 1, 1, 8193>{}), LimitError);
    EXPECT_THROW(run(Sized<0, 1, 1, 0>{}), Error);
}

// A sum over the group by halves, with a barrier after each.
struct Reduce {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    static constexpr int kSharedFloats = 64;
    Buffer<float> in;
    RWBuffer<float> out, first_seen;
    std::vector<ResourceInfo> resources() const
    {
        return {in.info(), out.info(), first_seen.info()};
    }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& i) {
            when<T>(i.group_index == Int(0),
                    [&] { store<T>(first_seen, Int(i.group_id.x), group.shared(Int(5))); });
        });
        group.for_each_thread([&](ComputeInput<T> const& i) {
            group.store_shared(i.group_index, load<T>(in, i.dispatch_thread_id.x));
        });
        for (int half = 32; half > 0; half /= 2)
            group.for_each_thread([&](ComputeInput<T> const& i) {
                when<T>(i.group_index < Int(half), [&] {
                    T const a = group.shared(i.group_index),
                            b = group.shared(i.group_index + Int(half));
                    group.store_shared(i.group_index, T(a + b));
                });
            });
        group.for_each_thread([&](ComputeInput<T> const& i) {
            when<T>(i.group_index == Int(0),
                    [&] { store<T>(out, Int(i.group_id.x), group.shared(Int(0))); });
        });
    }
};

TEST(ComputeShader, R153R154I27BarriersMakeSharedMemoryVisibleAndGroupsStartPoisoned)
{
    std::vector<float> in(64 * 5), out(5), seen(5);
    std::iota(in.begin(), in.end(), 1.0f);
    for (Machine const& machine : test::machines()) {
        Reduce shader;
        shader.in = {in, 0, "in"};
        shader.out = {out, 1, "out"};
        shader.first_seen = {seen, 2, "seen"};
        DrawStatistics const n =
            dispatch(bind_compute_shader(shader, machine), {5, 1, 1}, ThreadPool(3));
        for (int g = 0; g < 5; ++g) {
            EXPECT_EQ(out[std::size_t(g)], float(64 * (64 * g) + 64 * 65 / 2));
            EXPECT_TRUE(seen[std::size_t(g)] != seen[std::size_t(g)]); // not the last group's
        }
        StageStatistics const& s = n.stages[0];
        EXPECT_EQ(s.flops.add, 5u * 63);
        EXPECT_EQ(s.fetches[0].count, 5u * 64);
        EXPECT_EQ(s.fetches.back().kind, ResourceKind::Shared);
        EXPECT_EQ(s.fetches.back().count, 5u * (1 + 2 * 63 + 1));
    }
}

// Every thread takes a ticket and leaves its number there.
struct Append {
    static constexpr std::array<int, 3> kThreads{10, 1, 1};
    static constexpr bool kOrdered = true;
    RWBuffer<std::uint32_t> counter, list;
    std::vector<ResourceInfo> resources() const { return {counter.info(), list.info()}; }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            when<T>((in.dispatch_thread_id.x & Int(1)) == Int(0), [&] {
                Int const at = atomic<T>(AtomicOp::Add, counter, Int(0), Int(1));
                store<T>(list, at, in.dispatch_thread_id.x);
            });
        });
    }
};

TEST(ComputeShader, R144R154R155I24AtomicsRunInSerialOrderAndOutOfRangeStoresDoNothing)
{
    std::vector<std::uint32_t> first;
    for (Machine const& machine : test::machines())
        for (int threads : {1, 4}) {
            std::vector<std::uint32_t> counter{0}, list(40, 999);
            Append shader;
            shader.counter = {counter, 0, "counter"};
            shader.list = {list, 1, "list"};
            dispatch(bind_compute_shader(shader, machine), {10, 1, 1}, ThreadPool(threads));
            EXPECT_EQ(counter[0], 50u); // ten of them found no room
            for (std::uint32_t i = 0; i < 40; ++i) ASSERT_EQ(list[i], 2 * i);
        }
}

struct OutOfShared {
    static constexpr std::array<int, 3> kThreads{8, 1, 1};
    static constexpr int kSharedFloats = 4;
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        group.for_each_thread(
            [&](ComputeInput<T> const& in) { group.store_shared(in.group_index, T(1)); });
    }
};

TEST(ComputeShader, R155I26StoresPastSharedMemoryAreDroppedAndReported)
{
    DrawStatistics const n =
        dispatch(bind_compute_shader(OutOfShared{}, {}), {3, 1, 1}, ThreadPool(2));
    EXPECT_EQ(n.shared_out_of_range, 3u * 4);
}

} // namespace
} // namespace tessemu
