// Memory as a shader sees it: typed buffers, textures and control points, every read counted.
//
// A shader reaches memory only through these views; indices are uniform or per lane. Reads out of
// range return zeros (rules R142, R143) and are counted all the same.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/control_flow.h"
#include "emu/lane_memory.h"

#include <array>
#include <atomic>
#include <cassert>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tessemu {

class ExpressionGraph;

enum class ResourceKind { Vertex, Index, ControlPoint, PatchConstant, Buffer, Texture, Shared };

/// "vertex", "index", "control_point", "patch_constant", "buffer", "texture", "shared"
char const* name_of(ResourceKind kind);

/// What a stage read of one resource. unique_bytes counts each element once per draw (control
/// points and patch constants: once per patch and stage run).
struct FetchStatistics {
    std::string resource;
    ResourceKind kind = ResourceKind::Buffer;
    std::uint64_t count = 0, bytes = 0, unique_bytes = 0;

    friend bool operator==(FetchStatistics const&, FetchStatistics const&) = default;
};

/// Shader resource slots of a stage, as in Direct3D 11.
inline constexpr int kBufferSlots = 128;

/// Elements of a resource that were read, shared by all threads of a draw.
class TouchedElements {
public:
    explicit TouchedElements(std::size_t elements) : touched_(elements) {}

    void mark(std::size_t element) { mark(touched_[element]); }
    /// Elements first + i for each set bit i of `bits`. Whether one was not marked yet.
    bool mark_run(std::size_t first, std::uint32_t bits)
    {
        std::uint8_t* const marks = touched_.data() + first;
        bool fresh = false;
        for (; bits; bits &= bits - 1) fresh |= mark(marks[std::countr_zero(bits)]);
        return fresh;
    }
    /// The elements of the lanes in `bits`, those that there are. Whether one was not marked yet.
    template <int N> bool mark_each(IntLanes<N> index, std::uint32_t bits)
    {
        std::int32_t i[N];
        store_lanes<N>(index, i);
        std::uint8_t* const marks =
            touched_.data(); // which a store of a byte might change, by rule
        std::size_t const size = touched_.size();
        bool fresh = false;
        auto const mark_lane = [&](int l) {
            if (std::size_t(i[l]) < size) fresh |= mark(marks[i[l]]);
        };
        if (bits == all_lanes<N>())
            for (int l = 0; l < N; ++l) mark_lane(l);
        else
            for (; bits; bits &= bits - 1) mark_lane(std::countr_zero(bits));
        return fresh;
    }
    /// `count` elements from `first` on, which are all there.
    void mark_all(std::size_t first, std::size_t count)
    {
        std::uint8_t* const marks = touched_.data() + first;
        for (std::size_t i = 0; i < count; ++i) mark(marks[i]);
    }
    /// The same of a run that shares no element with others: its last is marked where all are.
    /// Whether it was not.
    bool mark_own_run(std::size_t first, std::size_t count)
    {
        if (!mark(touched_[first + count - 1])) return false;
        mark_all(first, count - 1);
        return true;
    }
    /// When the threads are done.
    std::uint64_t count() const
    {
        std::uint64_t n = 0;
        for (std::uint8_t t : touched_) n += t;
        return n;
    }

private:
    // Most marks are there already: a read is cheap, a write would bounce between cores. A byte for
    // an element: bits of a word would have to be collected first, or locked one by one.
    // Returns whether it was not there.
    static bool mark(std::uint8_t& m)
    {
        std::atomic_ref<std::uint8_t> const shared(m);
        if (shared.load(std::memory_order_relaxed)) return false;
        shared.store(1, std::memory_order_relaxed);
        return true;
    }

    std::vector<std::uint8_t> touched_;
};

/// One thread's counter of one buffer slot.
struct FetchSlot {
    std::uint64_t count, written;
    TouchedElements* touched;
};

/// A buffer bound to a slot: what a stage reports its fetches under.
struct ResourceInfo {
    std::string name;
    ResourceKind kind = ResourceKind::Buffer;
    int slot = 0;
    std::size_t elements = 0;
    std::size_t element_bytes = 0;
};

namespace detail {
/// The counter of a slot; null outside a stage, and for a slot that the shader did not name among
/// its resources.
inline FetchSlot* bound_slot(int slot)
{
    return std::uint32_t(slot) < execution.buffer_slots ? execution.buffers + slot : nullptr;
}

template <class T> void count_fetch(int slot, std::int32_t index, std::size_t size)
{
    if constexpr (ScalarTraits<T>::kCounted) {
        execution.features |= kFetches;
        FetchSlot* const s = bound_slot(slot);
        if (!s) return;
        s->count += execution.active_lanes;
        if (s->touched && std::size_t(index) < size) s->touched->mark(std::size_t(index));
    }
}
/// Neighbouring elements for neighbouring lanes, none out of range: a vector load.
template <int N> bool is_run(IntLanes<N> index, std::size_t size)
{
    auto const first = std::size_t(index.raw[0]);
    return first < size && size - first >= std::size_t(N) &&
           all(index - IntLanes<N>::iota() == IntLanes<N>(index.raw[0]));
}

template <class T, int N> void count_fetch(int slot, IntLanes<N> index, bool run = false)
{
    if constexpr (ScalarTraits<T>::kCounted) {
        execution.features |= kFetches;
        FetchSlot* const s = bound_slot(slot);
        if (!s) return;
        s->count += execution.active_lanes;
        if (!s->touched) return;
        if (run)
            s->touched->mark_run(std::size_t(index.raw[0]), execution.active_bits);
        else
            s->touched->mark_each(index, execution.active_bits);
    }
}
} // namespace detail

/// Typed buffer (D3D11: Buffer<float>, Buffer<uint>): `E` is float, double or an unsigned integer.
template <class E> class Buffer {
public:
    Buffer() = default;
    /// Into a `recording` a shader that runs on Graph records its loads, known by slot and index.
    /// It goes on with the value where there is none, and where E is an integer.
    Buffer(std::span<E const> elements, int slot, std::string name,
           ExpressionGraph* recording = nullptr)
        : elements_(elements),
          slot_(slot),
          name_(std::move(name)),
          recording_(recording)
    {
        assert(slot >= 0 && slot < kBufferSlots);
    }

    std::span<E const> elements() const { return elements_; }
    int slot() const { return slot_; }
    ExpressionGraph* recording() const { return recording_; }
    ResourceInfo info() const
    {
        return {name_, ResourceKind::Buffer, slot_, elements_.size(), sizeof(E)};
    }

private:
    std::span<E const> elements_;
    int slot_ = 0;
    std::string name_;
    ExpressionGraph* recording_ = nullptr;
};

/// buffer[i], the same element for every invocation; 0 when i is out of range.
template <class T, class E> auto load(Buffer<E> const& buffer, std::int32_t i)
{
    using Result = std::conditional_t<std::floating_point<E>, T, std::int32_t>;
    std::span<E const> const e = buffer.elements();
    detail::count_fetch<T>(buffer.slot(), i, e.size());
    if constexpr (RecordingScalar<T>) {
        if (buffer.recording()) {
            T const loaded = T::load(*buffer.recording(), buffer.slot(), i);
            if constexpr (std::floating_point<E>) return loaded;
        }
    }
    E const value = std::size_t(i) < e.size() ? e[std::size_t(i)] : E(0);
    if constexpr (std::floating_point<E>)
        return Result(storage_of<T>(value));
    else
        return Result(value);
}

/// buffer[i], an element per lane; 0 in the lanes whose i is out of range.
template <class T, class E, int N> auto load(Buffer<E> const& buffer, IntLanes<N> i)
{
    std::span<E const> const e = buffer.elements();
    bool const run = sizeof(E) == 4 && detail::is_run(i, e.size());
    detail::count_fetch<T>(buffer.slot(), i, run);
    std::conditional_t<std::floating_point<E>, Lanes<N>, IntLanes<N>> r(0);
    if (run) {
        __builtin_memcpy(&r.raw, e.data() + i.raw[0], sizeof r.raw);
    } else if constexpr (sizeof(E) == 4) {
        IntLanes<N> const bits = gather_or_zero<N>(e.data(), e.size(), i);
        __builtin_memcpy(&r.raw, &bits.raw, sizeof r.raw);
    } else {
        for (int k = 0; k < N; ++k)
            if (std::size_t(i.raw[k]) < e.size()) r.raw[k] = e[std::size_t(i.raw[k])];
    }
    if constexpr (std::floating_point<E>)
        return T(r);
    else
        return r;
}

/// Constants that an earlier command wrote, as CopyResource fills a constant buffer; what is known
/// when the command is made is a member of the shader. A shader reads it by a uniform index: an
/// operand of an instruction, so neither a fetch nor a slot.
template <class E> class ConstantBuffer {
public:
    ConstantBuffer() = default; ///< nothing bound: reads give 0
    /// Into a `recording` a shader that runs on Graph records its reads: a node for each constant.
    /// Buffers are told apart by their address.
    explicit ConstantBuffer(std::span<E const> elements, ExpressionGraph* recording = nullptr)
        : elements_(elements),
          recording_(recording)
    {
    }

    std::span<E const> elements() const { return elements_; }
    ExpressionGraph* recording() const { return recording_; }

private:
    std::span<E const> elements_;
    ExpressionGraph* recording_ = nullptr;
};

/// constants[i], the same for every invocation; 0 when i is out of range (R141).
template <class T> T load(ConstantBuffer<float> const& constants, std::int32_t i)
{
    std::span<float const> const e = constants.elements();
    if constexpr (RecordingScalar<T>)
        if (constants.recording()) return T::uniform(*constants.recording(), e.data(), i);
    return T(storage_of<T>(std::size_t(i) < e.size() ? e[std::size_t(i)] : 0.0f));
}

/// Records of one patch (HLSL: InputPatch, OutputPatch, patch constants).
///
/// Each [] is a counted fetch of a whole record. A record that is an array of vectors (it declares
/// kVectors) is read by vector(), a counted fetch of 3 scalars each.
///
/// \tparam P  record, templated on the shader's scalar
template <class P> class ControlPoints {
    using T = scalar_of<P>;
    static constexpr bool kCounted = ScalarTraits<T>::kCounted;
    static constexpr int vectors()
    {
        if constexpr (requires { P::kVectors; })
            return P::kVectors;
        else
            return 1;
    }
    static constexpr int kVectors = vectors();

public:
    /// What a fetch reads.
    static constexpr int kFetchScalars = kVectors > 1 ? 3 : scalar_count<P>();

    /// `count` records from `memory`, the same patch for every lane.
    constexpr ControlPoints(storage_of<T> const* memory, int count) : memory_(memory), count_(count)
    {
    }
    /// For a compile-time tally: records with any values; fetches are added to `*fetches`.
    constexpr ControlPoints(FlopCount* sink, int count,
                            std::uint64_t* fetches = nullptr) requires(ScalarTraits<T>::kTally)
        : sink_(sink),
          fetch_sink_(fetches),
          count_(count)
    {
    }

    /// For a recording: records without values; a fetch gives the nodes that stand for it.
    ControlPoints(ExpressionGraph& recording, int count) requires(RecordingScalar<T>)
        : recording_{&recording, T::new_view(recording)},
          count_(count)
    {
    }

    static constexpr int kScalars = scalar_count<P>();
    static constexpr std::size_t kRecordBytes = std::size_t(kScalars) * sizeof(storage_of<T>);

    constexpr int size() const { return count_; }

    constexpr P operator[](std::int32_t i) const
    {
        assert(i >= 0 && i < count_);
        touch(i);
        if constexpr (ScalarTraits<T>::kTally) {
            if (fetch_sink_) ++*fetch_sink_;
            P p{};
            int k = i * kScalars;
            for_each_scalar(p, [&](auto& x) { x = tallied(k++); });
            return p;
        } else if constexpr (RecordingScalar<T>) {
            return recorded<P>(i * kScalars);
        } else {
            return load_record<P>(memory_ + i * kScalars);
        }
    }

    /// A record per lane.
    template <int N> P operator[](IntLanes<N> i) const
    {
        if constexpr (kCounted) {
            fetches_ += execution.active_lanes;
            for (std::uint32_t bits = execution.active_bits; bits; bits &= bits - 1)
                mark(i.raw[std::countr_zero(bits)] & 127);
        }
        P p{};
        int k = 0;
        for_each_scalar(p, [&](auto& s) {
            Lanes<N> v;
            for (int lane = 0; lane < N; ++lane) {
                int const index = i.raw[lane] >= 0 && i.raw[lane] < count_ ? i.raw[lane] : 0;
                v.raw[lane] = memory_[index * kScalars + k];
            }
            s = T(v);
            ++k;
        });
        return p;
    }

    /// Vector k of record i, the same for every lane.
    constexpr float3<T> vector(std::int32_t i, std::int32_t k) const
    {
        assert(i >= 0 && i < count_ && k >= 0 && k < kVectors);
        touch(i * kVectors + k);
        if constexpr (ScalarTraits<T>::kTally) {
            if (fetch_sink_) ++*fetch_sink_;
            int const first = i * kScalars + 3 * k;
            return {tallied(first), tallied(first + 1), tallied(first + 2)};
        } else if constexpr (RecordingScalar<T>) {
            return recorded<float3<T>>(i * kScalars + 3 * k);
        } else {
            return load_record<float3<T>>(memory_ + i * kScalars + 3 * k);
        }
    }
    /// Vector k of record i per lane; zeros out of range.
    template <int N> float3<T> vector(IntLanes<N> i, IntLanes<N> k) const
    {
        Lanes<N> v[3] = {0.0f, 0.0f, 0.0f};
        for (int lane = 0; lane < N; ++lane) {
            std::int32_t const record = i.raw[lane], at = k.raw[lane];
            if (record < 0 || record >= count_ || at < 0 || at >= kVectors) continue;
            if (kCounted && (execution.active_bits >> lane & 1)) mark(record * kVectors + at);
            for (int c = 0; c < 3; ++c) v[c].raw[lane] = memory_[record * kScalars + 3 * at + c];
        }
        if constexpr (kCounted) fetches_ += execution.active_lanes;
        return {T(v[0]), T(v[1]), T(v[2])};
    }

    /// The records, for what reads them at once; it counts its fetches, of whole records: how many,
    /// and which of the first 32.
    storage_of<T> const* memory() const requires(kCounted) { return memory_; }
    void count(std::uint64_t fetches, std::uint32_t records) const requires(kCounted)
    {
        static_assert(kVectors == 1);
        fetches_ += fetches;
        touched_[0] |= records;
    }

    /// Fetches counted through this view.
    constexpr std::uint64_t fetches() const { return fetches_; }
    /// How many different records, or vectors, were read.
    constexpr std::uint64_t touched() const
    {
        std::uint64_t n = 0;
        for (std::uint64_t word : touched_) n += std::uint64_t(std::popcount(word));
        return n;
    }

private:
    /// The value that stands for scalar k in a tally: above 0, and like no other's nearby, so that
    /// points span a surface.
    constexpr T tallied(int k) const { return T(double(1 + (5 * k + k * k) % 23), sink_); }
    /// Nodes for the scalars from `first` on; without a recording their values.
    template <class V> V recorded(int first) const
    {
        if (!recording_.graph) return load_record<V>(memory_ + first);
        V v{};
        for_each_scalar(v, [&](T& s) {
            s = T::fetch(*recording_.graph, recording_.view, first / kFetchScalars,
                         first % kFetchScalars);
            ++first;
        });
        return v;
    }
    constexpr void mark(std::int32_t unit) const
    {
        touched_[std::size_t(unit) / 64 % touched_.size()] |= std::uint64_t(1) << (unit % 64);
    }
    constexpr void touch(std::int32_t unit) const
    {
        if constexpr (kCounted) {
            fetches_ += execution.active_lanes;
            mark(unit);
        }
    }

    storage_of<T> const* memory_ = nullptr;
    FlopCount* sink_ = nullptr;           // of a tally
    std::uint64_t* fetch_sink_ = nullptr; // of a tally
    struct NoRecording {};
    struct Recording {
        ExpressionGraph* graph = nullptr;
        int view = 0;
    };
    [[no_unique_address]] std::conditional_t<RecordingScalar<T>, Recording, NoRecording> recording_;
    int count_ = 0;
    mutable std::uint64_t fetches_ = 0;
    // At most 128 patch constants; 32 records of at most 32 vectors.
    mutable std::array<std::uint64_t, kVectors == 1 ? 2 : 16> touched_{};
};

} // namespace tessemu
