// SPDX-License-Identifier: Apache-2.0
#include "emu/stream_output.h"

#include "emu/error.h"

#include <cstring>

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
    auto const limit = [](char const* thing, std::uint64_t value, std::uint64_t most) {
        if (value > most) throw LimitError(thing, value, most);
    };
    std::uint64_t all = 0;
    std::array<int, kMaxStreamOutputBuffers> stream_of{-1, -1, -1, -1};
    for (StreamOutputEntry const& e : desc.entries) {
        limit("stream output buffer slot", e.buffer, kMaxStreamOutputBuffers - 1);
        limit("stream", e.stream, 3);
        if (e.first >= 0)
            limit("last scalar of a stream output entry", std::uint64_t(e.first) + e.count,
                  std::uint64_t(scalars));
        int& owner = stream_of[e.buffer];
        if (owner >= 0 && owner != e.stream)
            throw Error("stream output buffer " + std::to_string(e.buffer) +
                        " is written by streams " + std::to_string(owner) + " and " +
                        std::to_string(e.stream));
        owner = e.stream;
        all += e.count;
    }
    limit("stream output scalars per vertex", all, 128);
    auto const filled = filled_bytes(desc);
    for (std::size_t b = 0; b < kMaxStreamOutputBuffers; ++b) {
        limit("bytes of a vertex in a stream output buffer", filled[b], 512);
        limit("stream output stride in bytes", desc.stride[b], 2048);
        if (desc.stride[b] && desc.stride[b] < filled[b])
            throw Error("stream output stride is " + std::to_string(desc.stride[b]) +
                        ", its entries need " + std::to_string(filled[b]));
    }
    if (desc.rasterized_stream < -1 || desc.rasterized_stream >= 4)
        throw Error("rasterized stream is " + std::to_string(desc.rasterized_stream) +
                    ", it must be -1 to 3");
}

StreamOutput::StreamOutput(StreamOutputDesc const& desc, std::span<StreamOutputBuffer> buffers)
    : desc_(desc),
      buffers_(buffers),
      stride_(desc.stride)
{
    auto const filled = filled_bytes(desc);
    for (std::size_t b = 0; b < kMaxStreamOutputBuffers; ++b)
        if (stride_[b] == 0) stride_[b] = filled[b];
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
