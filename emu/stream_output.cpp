// SPDX-License-Identifier: Apache-2.0
#include "emu/stream_output.h"

#include "emu/error.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace tessemu {

namespace {
// Bytes that the entries fill of each buffer's vertex.
std::array<std::uint32_t, kMaxStreamOutputBuffers> filled_bytes(StreamOutputDesc const& desc)
{
    std::array<std::uint32_t, kMaxStreamOutputBuffers> n{};
    for (StreamOutputEntry const& e : desc.entries) n[e.buffer] += 4u * e.count;
    return n;
}
} // namespace

void check_stream_output(StreamOutputDesc const& desc, int scalars)
{
    auto const limit = [](std::string const& thing, std::uint64_t value, std::uint64_t most) {
        if (value > most) throw LimitError(thing, value, most);
    };
    auto const number = [](std::size_t n) { return std::to_string(n); };
    std::uint64_t all = 0;
    std::array<int, kMaxStreamOutputBuffers> stream_of{-1, -1, -1, -1};
    std::array<bool, kMaxStreamOutputBuffers> has_data{};
    for (std::size_t i = 0; i < desc.entries.size(); ++i) {
        StreamOutputEntry const& e = desc.entries[i];
        std::string const entry = "stream output entry " + number(i);
        limit("buffer slot of " + entry, e.buffer, kMaxStreamOutputBuffers - 1);
        limit("stream of " + entry, e.stream, 3);
        if (e.count == 0) throw Error(entry + " has 0 components, it needs at least 1");
        if (e.first < StreamOutputEntry::kGap)
            throw Error(entry + " starts at component " + std::to_string(e.first) +
                        ", it must be 0 or more, or -1 for a gap");
        int& owner = stream_of[e.buffer];
        if (owner >= 0 && owner != e.stream)
            throw Error("stream output buffer " + number(e.buffer) + " is written by streams " +
                        std::to_string(owner) + " and " + number(e.stream) + ", the latter by " +
                        "entry " + number(i));
        owner = e.stream;
        limit("stream output scalars per vertex", all += e.count, 128);
        if (e.first == StreamOutputEntry::kGap) continue;
        has_data[e.buffer] = true;
        limit("one past the last component of " + entry, std::uint64_t(e.first) + e.count,
              std::uint64_t(scalars));
        for (std::size_t k = 0; k < i; ++k) {
            StreamOutputEntry const& o = desc.entries[k];
            bool const apart = e.stream != o.stream || o.first == StreamOutputEntry::kGap ||
                               e.first >= o.first + o.count || o.first >= e.first + e.count;
            if (!apart)
                throw Error(entry + " streams out component " +
                            std::to_string(std::max(e.first, o.first)) + ", as entry " + number(k) +
                            " does: an output goes out once");
        }
    }
    auto const filled = filled_bytes(desc);
    for (std::size_t b = 0; b < kMaxStreamOutputBuffers; ++b) {
        std::string const buffer = "stream output buffer " + number(b);
        if (filled[b] && !has_data[b]) throw Error(buffer + " has gaps only, an output is needed");
        limit("bytes of a vertex in " + buffer, filled[b], 512);
        if (!desc.stride[b]) continue;
        std::uint32_t const stride = *desc.stride[b];
        limit("stride in bytes of " + buffer, stride, 2048);
        if (stride % 4 || stride < filled[b])
            throw Error("stride in bytes of " + buffer + " is " + number(stride) +
                        ", it must be a multiple of 4 of at least the " + number(filled[b]) +
                        " that its entries fill");
    }
    if (desc.rasterized_stream < -1 || desc.rasterized_stream >= 4)
        throw Error("rasterized stream is " + std::to_string(desc.rasterized_stream) +
                    ", it must be -1 to 3");
}

StreamOutput::StreamOutput(StreamOutputDesc const& desc, std::span<StreamOutputBuffer> buffers)
    : desc_(desc),
      buffers_(buffers),
      stride_(filled_bytes(desc))
{
    for (std::size_t b = 0; b < kMaxStreamOutputBuffers; ++b)
        if (desc.stride[b]) stride_[b] = *desc.stride[b];
    for (StreamOutputEntry const& e : desc.entries) streams_[e.stream].buffers |= 1u << e.buffer;
}

bool StreamOutput::has_room(Stream const& s, int count) const
{
    for (std::size_t b = 0; b < kMaxStreamOutputBuffers; ++b) {
        if (!(s.buffers >> b & 1)) continue;
        std::uint64_t const need = std::uint64_t(stride_[b]) * std::uint64_t(count);
        if (b >= buffers_.size() || buffers_[b].filled + need > buffers_[b].bytes.size())
            return false;
    }
    return true;
}

std::array<std::uint32_t, kMaxStreamOutputBuffers> StreamOutput::position() const
{
    std::array<std::uint32_t, kMaxStreamOutputBuffers> at{};
    for (std::size_t b = 0; b < buffers_.size(); ++b) at[b] = buffers_[b].filled;
    return at;
}

void StreamOutput::put(std::size_t buffer, std::uint32_t at, float value)
{
    std::memcpy(buffers_[buffer].bytes.data() + at, &value, 4);
    bytes_written_ += 4;
}

void StreamOutput::advance(Stream const& s)
{
    for (std::size_t b = 0; b < buffers_.size(); ++b)
        if (s.buffers >> b & 1) buffers_[b].filled += stride_[b];
}

} // namespace tessemu
