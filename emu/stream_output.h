// Stream output: whole primitives of a geometry stage into buffers (rules R87 to R89).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tessemu {

inline constexpr std::size_t kMaxStreamOutputBuffers = 4;

/// Scalars `first` to `first + count - 1` of a stream's vertex go to a buffer's vertex, after what
/// earlier entries put there. With kGap as `first` they are left as they are.
struct StreamOutputEntry {
    static constexpr std::int16_t kGap = -1;

    std::uint8_t stream = 0;
    std::int16_t first = 0;
    std::uint8_t count = 4;
    std::uint8_t buffer = 0;
};

struct StreamOutputDesc {
    std::vector<StreamOutputEntry> entries;
    /// Bytes from vertex to vertex of each buffer; where nothing is said, what the entries fill.
    std::array<std::optional<std::uint32_t>, kMaxStreamOutputBuffers> stride{};
    int rasterized_stream = 0; ///< -1: nothing is rasterized (R86)
};

/// A bound buffer. Raw 32-bit data are appended at `filled` (D3D11: BufferFilledSize).
struct StreamOutputBuffer {
    std::span<std::byte> bytes; ///< empty: nothing is bound, which is a full buffer (R88)
    std::uint32_t filled = 0;
};

/// D3D11_QUERY_DATA_SO_STATISTICS of a stream.
struct StreamOutputStatistics {
    std::uint64_t NumPrimitivesWritten = 0, PrimitiveStorageNeeded = 0;
    friend bool operator==(StreamOutputStatistics const&, StreamOutputStatistics const&) = default;
};

/// Refuses what Direct3D refuses (R89): what is out of range, an entry of 0 components, an output
/// that goes out twice, a buffer of gaps alone or of two streams, a stride that is 0, no multiple
/// of 4 or less than the entries fill. Throws LimitError or Error, which name entry, value and
/// limit; entries count from 0.
/// \param scalars  of a vertex of every stream
void check_stream_output(StreamOutputDesc const& desc, int scalars);

/// The stage's state over a draw: hand in whole primitives in pipeline order.
class StreamOutput {
public:
    StreamOutput(StreamOutputDesc const& desc, std::span<StreamOutputBuffer> buffers);

    /// Writes `count` vertices of one primitive; component k of vertex i is
    /// component(i, k).
    template <class Component> void write(int stream, int count, Component const& component)
    {
        Stream& s = streams_[std::size_t(stream)];
        if (s.buffers == 0) return; // nothing of this stream is declared
        ++statistics_[std::size_t(stream)].PrimitiveStorageNeeded;
        if (s.stopped || !has_room(s, count)) {
            s.stopped = true;
            return;
        }
        ++statistics_[std::size_t(stream)].NumPrimitivesWritten;
        for (int i = 0; i < count; ++i) {
            std::array<std::uint32_t, kMaxStreamOutputBuffers> at = position();
            for (StreamOutputEntry const& e : desc_.entries) {
                if (e.stream != stream) continue;
                for (int k = 0; k < e.count; ++k, at[e.buffer] += 4)
                    if (e.first >= 0) put(e.buffer, at[e.buffer], component(i, e.first + k));
            }
            advance(s);
        }
    }

    std::array<StreamOutputStatistics, 4> const& statistics() const { return statistics_; }
    std::uint64_t bytes_written() const { return bytes_written_; }

private:
    struct Stream {
        std::uint32_t buffers = 0; ///< bit per buffer that the stream writes
        bool stopped = false;
    };
    bool has_room(Stream const& s, int count) const;
    std::array<std::uint32_t, kMaxStreamOutputBuffers> position() const;
    void put(std::size_t buffer, std::uint32_t at, float value);
    void advance(Stream const& s);

    StreamOutputDesc const& desc_;
    std::span<StreamOutputBuffer> buffers_;
    std::array<std::uint32_t, kMaxStreamOutputBuffers> stride_{};
    std::array<Stream, 4> streams_{};
    std::array<StreamOutputStatistics, 4> statistics_{};
    std::uint64_t bytes_written_ = 0;
};

} // namespace tessemu
