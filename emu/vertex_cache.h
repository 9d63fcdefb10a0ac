// Post-transform vertex cache: decides how often the vertex shader runs, never what comes out
// (R41).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tessemu {

struct VertexCacheModel {
    enum class Kind { None, Fifo, Lru, Infinite };
    Kind kind = Kind::Fifo;
    std::uint32_t entries = 16; ///< of Fifo and Lru

    friend bool operator==(VertexCacheModel const&, VertexCacheModel const&) = default;
};

/// "none", "fifo:16", "lru:16", "infinite"
std::string name_of(VertexCacheModel const& model);
/// Throws Error for another word or for zero entries.
VertexCacheModel vertex_cache_from_name(std::string_view name);

/// The cache's state over a draw. Constant time per access.
class VertexCache {
public:
    /// Vertex ids are below `vertex_id_limit`.
    VertexCache(VertexCacheModel model, std::uint32_t vertex_id_limit);

    /// True if `vertex` is found; otherwise it enters and the vertex shader must run.
    bool access(std::uint32_t vertex)
    {
        if (model_.kind != VertexCacheModel::Kind::Fifo) return access_other(vertex);
        if (resident_[vertex]) return true;
        resident_[vertex] = 1;
        std::uint32_t& oldest = ring_[next_];
        if (oldest != kNone) resident_[oldest] = 0;
        oldest = vertex;
        next_ = next_ + 1 == ring_.size() ? 0 : next_ + 1;
        return false;
    }

private:
    bool access_other(std::uint32_t vertex);
    void unlink(std::uint32_t vertex);
    void link_newest(std::uint32_t vertex);

    static constexpr std::uint32_t kNone = 0xffffffffu;
    VertexCacheModel model_;
    std::vector<char> resident_;
    std::vector<std::uint32_t> ring_; // of Fifo, the oldest at next_
    std::size_t next_ = 0;
    std::vector<std::uint32_t> newer_, older_; // of Lru, a list from oldest to newest
    std::uint32_t oldest_ = kNone, newest_ = kNone, size_ = 0;
};

} // namespace tessemu
