// Compute shader stage: groups, shared memory, barriers (rules R151 to R155).
//
// A compute shader is
//
//     struct S {
//         static constexpr std::array<int, 3> kThreads{x, y, z};  // [numthreads]
//         static constexpr int kSharedFloats = ...;               // optional, at most 8192
//         static constexpr bool kOrdered = true;                  // optional, see below
//         template <class T> void operator()(ComputeGroup<T>& group) const
//         {
//             group.for_each_thread([&](ComputeInput<T> const& in) { ... });  // to the barrier
//             group.for_each_thread([&](ComputeInput<T> const& in) { ... });
//         }
//     };
//
// Each for_each_thread runs all threads of the group, lanes across threads; its end is
// GroupMemoryBarrierWithGroupSync, which so lies in uniform control flow by construction. Groups
// run on any thread in any order unless the shader is ordered; a shader whose groups meet in memory
// (atomics, append) must be, and then runs in serial order (I-24).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/bound_shader.h"
#include "emu/parallel.h"
#include "emu/statistics.h"

#include <algorithm>
#include <cassert>

namespace tessemu {

inline constexpr int kMaxSharedFloats = 8192; // 32 KiB (R153)
inline constexpr std::uint32_t kMaxDispatch = 65535;

template <class I> struct int3 {
    I x, y, z;
};

template <class T> struct ComputeInput {
    int3<std::int32_t> group_id;        ///< SV_GroupID
    int3<int_of<T>> group_thread_id;    ///< SV_GroupThreadID
    int3<int_of<T>> dispatch_thread_id; ///< SV_DispatchThreadID (R152)
    int_of<T> group_index;              ///< SV_GroupIndex (R152)
};

/// A buffer that shaders write (D3D11: RWBuffer): out-of-range loads give 0, out-of-range stores
/// and atomics do nothing (R144). `E` is float, std::int32_t or std::uint32_t.
template <class E> class RWBuffer {
public:
    RWBuffer() = default;
    RWBuffer(std::span<E> elements, int slot, std::string name)
        : elements_(elements),
          slot_(slot),
          name_(std::move(name))
    {
        assert(slot >= 0 && slot < kBufferSlots);
    }
    std::span<E> elements() const { return elements_; }
    int slot() const { return slot_; }
    ResourceInfo info() const
    {
        return {name_, ResourceKind::Buffer, slot_, elements_.size(), sizeof(E)};
    }

private:
    std::span<E> elements_;
    int slot_ = 0;
    std::string name_;
};

/// A buffer of vectors of three floats that shaders read and write, each by one fetch of 12 bytes
/// (D3D11: a raw buffer by Load3 and Store3, which the input assembler may read as well). Vectors lie
/// at every fourth float; what lies between them is neither read nor written.
/// Out-of-range loads give 0, out-of-range stores do nothing (R144).
class RWVectorBuffer {
public:
    static constexpr int kStride = 4; ///< floats from vector to vector
    static constexpr std::uint32_t kMostVectors = 0x7fffffff / kStride;

    RWVectorBuffer() = default;
    RWVectorBuffer(std::span<float> floats, int slot, std::string name)
        : floats_(floats),
          slot_(slot),
          name_(std::move(name))
    {
        assert(slot >= 0 && slot < kBufferSlots && vectors() <= kMostVectors);
    }
    std::span<float> floats() const { return floats_; }
    int slot() const { return slot_; }
    std::size_t vectors() const { return floats_.size() / kStride; }
    ResourceInfo info() const
    {
        return {name_, ResourceKind::Buffer, slot_, vectors(), 3 * sizeof(float)};
    }

private:
    std::span<float> floats_;
    int slot_ = 0;
    std::string name_;
};

/// buffer[i] per lane, as memory is now.
template <class T, int N> float3<T> load3(RWVectorBuffer const& b, IntLanes<N> i)
{
    detail::count_fetch<T>(b.slot(), i);
    Mask<N> const inside = (IntLanes<N>(-1) < i) & (i < IntLanes<N>(std::int32_t(b.vectors())));
    Lanes<N> v[3] = {0.0f, 0.0f, 0.0f};
    if (any(inside)) {
        load_vectors<N>(b.floats().data(),
                        select(inside, i, IntLanes<N>(0)) * IntLanes<N>(b.kStride), v);
        if (!all(inside))
            for (Lanes<N>& x : v) x = select(inside, x, Lanes<N>(0.0f));
    }
    return {T(v[0]), T(v[1]), T(v[2])};
}

namespace detail {
/// work(lane, element) for each active lane whose element exists; counts the writes.
template <class T, class E, int N, class Work>
void for_each_written(RWBuffer<E> const& b, IntLanes<N> i, Work const& work)
{
    if constexpr (ScalarTraits<T>::kCounted) {
        execution.features |= kFetches;
        if (FetchSlot* const s = bound_slot(b.slot())) s->written += execution.active_lanes;
    }
    for (std::uint32_t bits = execution.active_bits; bits; bits &= bits - 1) {
        int const l = std::countr_zero(bits);
        if (std::size_t(i.raw[l]) < b.elements().size())
            work(l, b.elements()[std::size_t(i.raw[l])]);
    }
}
} // namespace detail

/// buffer[i] per lane, as memory is now.
template <class T, class E, int N> auto load(RWBuffer<E> const& b, IntLanes<N> i)
{
    return load<T>(Buffer<E>(std::span<E const>(b.elements()), b.slot(), ""), i);
}
/// buffer[i] = value in the active lanes, the highest lane last.
template <class T, int N> void store(RWBuffer<float> const& b, IntLanes<N> i, T const& value)
{
    Lanes<N> const v = lanes_value(value);
    detail::for_each_written<T>(b, i, [&](int l, float& e) { e = v.raw[l]; });
}
template <class T, class E, int N>
requires std::integral<E>
void store(RWBuffer<E> const& b, IntLanes<N> i, IntLanes<N> value)
{
    detail::for_each_written<T>(b, i, [&](int l, E& e) { e = E(value.raw[l]); });
}
/// buffer[i] = value in the active lanes, the highest lane last.
template <class T, int N>
void store3(RWVectorBuffer const& b, IntLanes<N> i, float3<T> const& value)
{
    if constexpr (ScalarTraits<T>::kCounted) {
        execution.features |= kFetches;
        if (FetchSlot* const s = detail::bound_slot(b.slot())) s->written += execution.active_lanes;
    }
    Lanes<N> const v[3] = {lanes_value(value.x), lanes_value(value.y), lanes_value(value.z)};
    if (execution.active_bits == all_lanes<N>() && detail::is_run(i, b.vectors())) {
        float* out = b.floats().data() + std::size_t(i.raw[0]) * b.kStride;
        for (int l = 0; l < N; ++l, out += b.kStride)
            for (int k = 0; k < 3; ++k) out[k] = v[k].raw[l];
        return;
    }
    for (std::uint32_t bits = execution.active_bits; bits; bits &= bits - 1) {
        int const l = std::countr_zero(bits);
        if (std::size_t(i.raw[l]) >= b.vectors()) continue;
        float* const out = b.floats().data() + std::size_t(i.raw[l]) * b.kStride;
        for (int k = 0; k < 3; ++k) out[k] = v[k].raw[l];
    }
}
/// HLSL's Interlocked operations; I and U take their operands for signed and unsigned.
enum class AtomicOp : std::uint8_t { Add, And, Or, Xor, IMax, IMin, UMax, UMin, Exchange };

/// What an operation leaves in memory. 32 bits, sums wrap.
constexpr std::uint32_t apply(AtomicOp op, std::uint32_t before, std::uint32_t value)
{
    auto const a = std::int32_t(before), b = std::int32_t(value);
    switch (op) {
    case AtomicOp::Add:
        return before + value;
    case AtomicOp::And:
        return before & value;
    case AtomicOp::Or:
        return before | value;
    case AtomicOp::Xor:
        return before ^ value;
    case AtomicOp::IMax:
        return std::uint32_t(std::max(a, b));
    case AtomicOp::IMin:
        return std::uint32_t(std::min(a, b));
    case AtomicOp::UMax:
        return std::max(before, value);
    case AtomicOp::UMin:
        return std::min(before, value);
    default:
        return value;
    }
}

/// An operation on buffer[i] in the active lanes in order; gives the values before, 0 out of range.
template <class T, class E, int N>
requires std::integral<E> IntLanes<N> atomic(AtomicOp op, RWBuffer<E> const& b, IntLanes<N> i,
                                             IntLanes<N> value)
{
    IntLanes<N> before(0);
    detail::for_each_written<T>(b, i, [&](int l, E& e) {
        before.raw[l] = std::int32_t(e);
        e = E(apply(op, std::uint32_t(e), std::uint32_t(value.raw[l])));
    });
    return before;
}
/// InterlockedCompareExchange: `value` where buffer[i] is `comparand`; gives the values before.
template <class T, class E, int N>
requires std::integral<E> IntLanes<N> atomic_compare_exchange(RWBuffer<E> const& b, IntLanes<N> i,
                                                              IntLanes<N> comparand,
                                                              IntLanes<N> value)
{
    IntLanes<N> before(0);
    detail::for_each_written<T>(b, i, [&](int l, E& e) {
        before.raw[l] = std::int32_t(e);
        if (before.raw[l] == comparand.raw[l]) e = E(value.raw[l]);
    });
    return before;
}

/// A group of threads in lock step, and its shared memory.
template <class T> class ComputeGroup {
    static constexpr int N = lanes_of<T>;

public:
    ComputeGroup(std::array<int, 3> size, std::span<float> shared) : size_(size), shared_(shared) {}

    template <class Work> void for_each_thread(Work const& work)
    {
        int const threads = size_[0] * size_[1] * size_[2];
        for (int first = 0; first < threads; first += N) {
            begin_group<T>((1u << std::min(N, threads - first)) - 1, phase_);
            IntLanes<N> const index = IntLanes<N>(first) + IntLanes<N>::iota();
            auto const [x, y, z] = threads_at(index);
            ComputeInput<T> const in{group_id_,
                                     {x, y, z},
                                     {x + IntLanes<N>(group_id_.x * size_[0]),
                                      y + IntLanes<N>(group_id_.y * size_[1]),
                                      z + IntLanes<N>(group_id_.z * size_[2])},
                                     index};
            work(in);
        }
        ++phase_;
    }

    /// groupshared memory; out-of-range loads give 0, stores do nothing and are reported (I-26).
    T shared(IntLanes<N> i)
    {
        loads_ += execution.active_lanes;
        Lanes<N> v(0.0f);
        for (int l = 0; l < N; ++l)
            if (std::size_t(i.raw[l]) < shared_.size()) v.raw[l] = shared_[std::size_t(i.raw[l])];
        return T(v);
    }
    void store_shared(IntLanes<N> i, T const& value)
    {
        Lanes<N> const v = lanes_value(value);
        for_each_stored(i, [&](int l, float& element) { element = v.raw[l]; });
    }
    /// The same memory as integers.
    IntLanes<N> shared_bits(IntLanes<N> i)
    {
        return typename IntLanes<N>::Raw(lanes_value(shared(i)).raw);
    }
    void store_shared_bits(IntLanes<N> i, IntLanes<N> value)
    {
        for_each_stored(
            i, [&](int l, float& element) { element = std::bit_cast<float>(value.raw[l]); });
    }
    /// An operation on the integer at i in the active lanes in order; gives the values before.
    IntLanes<N> atomic_shared(AtomicOp op, IntLanes<N> i, IntLanes<N> value)
    {
        loads_ += execution.active_lanes;
        IntLanes<N> before(0);
        for_each_stored(i, [&](int l, float& element) {
            before.raw[l] = std::bit_cast<std::int32_t>(element);
            element = std::bit_cast<float>(
                apply(op, std::uint32_t(before.raw[l]), std::uint32_t(value.raw[l])));
        });
        return before;
    }

    // For the stage.
    void begin(int3<std::int32_t> id)
    {
        group_id_ = id;
        phase_ = 0;
        // Undefined at the start of a group (R153): a pattern that shows (I-27).
        std::fill(shared_.begin(), shared_.end(), std::bit_cast<float>(0x7fc0deadu));
    }
    std::uint64_t shared_loads() const { return loads_; }
    std::uint64_t shared_stores() const { return stores_; }
    std::uint64_t shared_out_of_range() const { return out_of_range_; }

private:
    // The threads of a group by number, x fastest.
    int3<IntLanes<N>> threads_at(IntLanes<N> index) const
    {
        if (size_[1] == 1 && size_[2] == 1) return {index, 0, 0};
        // By way of arrays: g++ 12 takes elements written one by one for uninitialised.
        std::int32_t at[3][N];
        for (int l = 0; l < N; ++l) {
            int const i = index.raw[l];
            at[0][l] = i % size_[0];
            at[1][l] = i / size_[0] % size_[1];
            at[2][l] = i / (size_[0] * size_[1]);
        }
        return {load_lanes<N>(at[0]), load_lanes<N>(at[1]), load_lanes<N>(at[2])};
    }
    // work(lane, element) for each active lane whose element exists.
    template <class Work> void for_each_stored(IntLanes<N> i, Work const& work)
    {
        stores_ += execution.active_lanes;
        for (std::uint32_t bits = execution.active_bits; bits; bits &= bits - 1) {
            int const l = std::countr_zero(bits);
            if (std::size_t(i.raw[l]) < shared_.size())
                work(l, shared_[std::size_t(i.raw[l])]);
            else
                ++out_of_range_;
        }
    }

    std::array<int, 3> size_;
    std::span<float> shared_;
    int3<std::int32_t> group_id_{0, 0, 0};
    std::uint64_t phase_ = 0, loads_ = 0, stores_ = 0, out_of_range_ = 0;
};

class ComputeProgram : public ShaderProgram {
public:
    virtual std::array<int, 3> threads() const = 0;
    virtual int shared_floats() const = 0;
    virtual bool ordered() const = 0;
    /// Runs groups first to first + count - 1 of a dispatch, x fastest.
    virtual void run(ShaderBinding const& binding, std::array<std::uint32_t, 3> const& groups,
                     std::uint64_t first, std::uint64_t count, StageCounters& counters,
                     StageBuffers const& buffers) const = 0;
};

template <class Shader, class T>
class ComputeProgramOn final : public CompiledProgram<ComputeProgram, Shader> {
public:
    std::array<int, 3> threads() const override { return Shader::kThreads; }
    int shared_floats() const override
    {
        if constexpr (requires { Shader::kSharedFloats; }) return Shader::kSharedFloats;
        return 0;
    }
    bool ordered() const override
    {
        if constexpr (requires { Shader::kOrdered; }) return Shader::kOrdered;
        return false;
    }

    void run(ShaderBinding const& binding, std::array<std::uint32_t, 3> const& groups,
             std::uint64_t first, std::uint64_t count, StageCounters& counters,
             StageBuffers const& buffers) const override
    {
        Shader const& shader = binding.as<Shader>();
        StageScope const scope(counters, buffers, binding.sites());
        std::vector<float> shared(static_cast<std::size_t>(shared_floats()));
        ComputeGroup<T> group(Shader::kThreads, shared);
        for (std::uint64_t g = first; g < first + count; ++g) {
            group.begin({std::int32_t(g % groups[0]), std::int32_t(g / groups[0] % groups[1]),
                         std::int32_t(g / groups[0] / groups[1])});
            shader(group);
        }
        auto const& t = Shader::kThreads;
        counters.invocations += count * std::uint64_t(t[0] * t[1] * t[2]);
        counters.shared_loads += group.shared_loads();
        counters.shared_stores += group.shared_stores();
        counters.shared_out_of_range += group.shared_out_of_range();
    }
};

using ComputeShader = BoundShader<ComputeProgram>;

template <class Shader>
ComputeShader bind_compute_shader(Shader const& shader, Machine const& machine)
{
    return bind_shader<ComputeProgramOn, ComputeProgram>(shader, machine);
}

/// Groups of `per_group` threads on x for so many threads: on y too where x, which has at most
/// 65,535 groups, is too short. linear_thread numbers the threads.
inline std::array<std::uint32_t, 3> groups_for(std::uint64_t threads, int per_group)
{
    std::uint64_t const all = (threads + std::uint64_t(per_group) - 1) / std::uint64_t(per_group);
    auto const x = std::uint32_t(std::min<std::uint64_t>(all, kMaxDispatch));
    return {x, x ? std::uint32_t((all + x - 1) / x) : 0, 1};
}
/// The number of a thread of groups_for, up to 2^31.
template <class Shader, class T> int_of<T> linear_thread(ComputeInput<T> const& in)
{
    return in.dispatch_thread_id.x +
           int_of<T>(in.group_id.y * std::int32_t(kMaxDispatch) * Shader::kThreads[0]);
}

/// Runs x * y * z groups; any 0 does nothing (R151). Throws LimitError past D3D11's limits.
DrawStatistics dispatch(ComputeShader const& shader, std::array<std::uint32_t, 3> groups,
                        ThreadPool const& threads);

} // namespace tessemu
