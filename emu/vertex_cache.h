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
        if (model_.kind == VertexCacheModel::Kind::Lru) return access_lru(vertex);
        // What entered n misses ago is n from the door: without a branch, for hits follow no pattern.
        std::uint64_t& entered = entered_[vertex];
        bool const hit = misses_ - entered < entries_;
        misses_ += !hit;
        entered = hit ? entered : misses_;
        return hit;
    }

private:
    bool access_lru(std::uint32_t vertex);
    void unlink(std::uint32_t vertex);
    void link_newest(std::uint32_t vertex);

    static constexpr std::uint32_t kNone = 0xffffffffu;
    VertexCacheModel model_;
    // Other than Lru: the miss at which a vertex last entered; the first is number entries_ + 1, so
    // that 0 is as good as never.
    std::uint64_t entries_ = 0, misses_ = 0;
    std::vector<std::uint64_t> entered_;
    // Lru: a list from oldest to newest.
    std::vector<char> resident_;
    std::vector<std::uint32_t> newer_, older_;
    std::uint32_t oldest_ = kNone, newest_ = kNone, size_ = 0;
};

} // namespace tessemu
