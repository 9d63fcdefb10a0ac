// Facts S67 to S69 of other suites: group-shared memory, atomics, queries.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/compute_shader.h"
#include "tests/emu/suite_facts/quad_scene.h"
#include "tests/support/machines.h"

namespace tessemu::test {
namespace {

// Cell 0 starts as the group's number; each of 32 threads adds the number.
struct AddToOneCell {
    static constexpr std::array<int, 3> kThreads{32, 1, 1};
    static constexpr int kSharedFloats = 1;
    RWBuffer<std::uint32_t> out;
    std::vector<ResourceInfo> resources() const { return {out.info()}; }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            when<T>(in.group_index == Int(0),
                    [&] { group.store_shared_bits(Int(0), Int(in.group_id.x)); });
        });
        group.for_each_thread([&](ComputeInput<T> const& in) {
            group.atomic_shared(AtomicOp::Add, Int(0), Int(in.group_id.x));
        });
        group.for_each_thread([&](ComputeInput<T> const& in) {
            when<T>(in.group_index == Int(0),
                    [&] { store<T>(out, Int(in.group_id.x), group.shared_bits(Int(0))); });
        });
    }
};
// Each thread's cell holds twice the group's number plus one; all are added to the first of them.
struct AddCells {
    static constexpr std::array<int, 3> kThreads{32, 1, 1};
    static constexpr int kSharedFloats = 32;
    RWBuffer<std::uint32_t> out;
    std::vector<ResourceInfo> resources() const { return {out.info()}; }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            group.store_shared_bits(in.group_index, Int(2 * in.group_id.x + 1));
        });
        group.for_each_thread([&](ComputeInput<T> const& in) {
            when<T>(in.group_index == Int(0), [&] {
                Int sum(0);
                for (int i = 0; i < 32; ++i) sum = sum + group.shared_bits(Int(i));
                store<T>(out, Int(in.group_id.x), sum);
            });
        });
    }
};
// Thread i adds the cells up to its own, each of which holds the group's number.
struct AddFloats {
    static constexpr std::array<int, 3> kThreads{32, 1, 1};
    static constexpr int kSharedFloats = 32;
    RWBuffer<float> out;
    std::vector<ResourceInfo> resources() const { return {out.info()}; }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            group.store_shared(in.group_index, T(float(in.group_id.x)));
        });
        group.for_each_thread([&](ComputeInput<T> const& in) {
            T sum(0.0f);
            for (int i = 0; i < 32; ++i)
                sum = sum +
                      when(
                          in.group_index >= Int(i), [&] { return group.shared(Int(i)); }, T(0.0f));
            store<T>(out, in.dispatch_thread_id.x, sum);
        });
    }
};

TEST(ComputeShader, S67GroupsShareCellsAndAddToThem)
{
    for (Machine const& machine : machines())
        for (int threads : {1, 3}) {
            ThreadPool const pool(threads);
            std::vector<std::uint32_t> one(64), cells(32);
            AddToOneCell add;
            add.out = {one, 0, "out"};
            dispatch(bind_compute_shader(add, machine), {64, 1, 1}, pool);
            for (std::uint32_t id = 0; id < 64; ++id) EXPECT_EQ(one[id], 33 * id);
            AddCells sum;
            sum.out = {cells, 0, "out"};
            dispatch(bind_compute_shader(sum, machine), {32, 1, 1}, pool);
            for (std::uint32_t id = 0; id < 32; ++id) EXPECT_EQ(cells[id], 64 * id + 32);
            std::vector<float> floats(32 * 32);
            AddFloats prefix;
            prefix.out = {floats, 0, "out"};
            dispatch(bind_compute_shader(prefix, machine), {32, 1, 1}, pool);
            for (std::size_t i = 0; i < floats.size(); ++i)
                EXPECT_EQ(floats[i], float((i % 32 + 1) * (i / 32)));
        }
}

// One thread: an operation on each cell in turn; what was there goes to `before`.
struct Interlocked {
    static constexpr std::array<int, 3> kThreads{1, 1, 1};
    static constexpr bool kOrdered = true;
    RWBuffer<std::uint32_t> cells, before;
    std::vector<ResourceInfo> resources() const { return {cells.info(), before.info()}; }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const&) {
            int cell = 0;
            auto const one = [&](AtomicOp op, std::int32_t value) {
                Int const was = atomic<T>(op, cells, Int(cell), Int(value));
                store<T>(before, Int(cell++), was);
            };
            one(AtomicOp::And, 1);
            store<T>(before, Int(cell),
                     atomic_compare_exchange<T>(cells, Int(cell), Int(0), Int(1)));
            ++cell;
            one(AtomicOp::Add, 1);
            one(AtomicOp::Or, 1);
            one(AtomicOp::IMax, -1);
            one(AtomicOp::IMin, -1);
            one(AtomicOp::UMax, 1);
            one(AtomicOp::UMin, 1);
            one(AtomicOp::Xor, 1);
            one(AtomicOp::Exchange, 7);
            // No match, no exchange; out of range nothing happens and 0 comes back.
            store<T>(before, Int(cell),
                     atomic_compare_exchange<T>(cells, Int(cell), Int(4), Int(1)));
            store<T>(before, Int(cell + 1), atomic<T>(AtomicOp::Add, cells, Int(99), Int(1)));
        });
    }
};

TEST(ComputeShader, S68InterlockedOperationsGiveWhatWasThere)
{
    std::vector<std::uint32_t> const start{0xffff, 0, 1, 0, 0, 0, 0, 0, 0xff, 3, 5, 9};
    std::vector<std::uint32_t> const after{1, 1, 2, 1, 0, ~0u, 1, 0, 0xfe, 7, 5, 9};
    for (Machine const& machine : machines()) {
        std::vector<std::uint32_t> cells = start, before(12, 99);
        Interlocked shader;
        shader.cells = {cells, 0, "cells"};
        shader.before = {before, 1, "before"};
        dispatch(bind_compute_shader(shader, machine), {1, 1, 1}, ThreadPool(1));
        EXPECT_EQ(cells, after);
        std::vector<std::uint32_t> expected = start;
        expected.back() = 0; // out of range
        EXPECT_EQ(before, expected);
    }
}

TEST(PipelineStatistics, S69AQuadCountsItsVerticesPrimitivesAndPixels)
{
    Scene s(640, 480);
    set_quad(s);
    DrawStatistics const& n = s.draw();
    PipelineStatistics expected;
    expected.IAVertices = expected.VSInvocations = 4;
    expected.IAPrimitives = expected.CInvocations = expected.CPrimitives = 2;
    expected.PSInvocations = 640 * 480; // the suite: at least
    EXPECT_EQ(n.pipeline, expected);
    EXPECT_EQ(n.samples_passed, 640u * 480);
    set_quad(s, {1, 1, 1, 1}, 0.5f); // behind the first
    EXPECT_EQ(s.draw().samples_passed, 0u);
}

TEST(PipelineStatistics, S69G16OcclusionHas64Bits)
{
    // A query runs over 100 draws of one quad; draws of equal input count alike (R1), so one is
    // added 100 times.
    Scene s(8, 8);
    s.target.color.clear();
    s.target.depth = nullptr;
    s.target.viewports = {{0, 0, 8192, 8192, 0, 1}};
    s.desc.pixel_shader = nullptr; // the depth test is on and has no buffer: all samples pass
    set_quad(s);
    DrawStatistics const one = s.draw();
    EXPECT_EQ(one.samples_passed, 8192ull * 8192);
    DrawStatistics all;
    for (int i = 0; i < 100; ++i) all += one;
    EXPECT_EQ(all.samples_passed, 0x190000000ull);
}

} // namespace
} // namespace tessemu::test
