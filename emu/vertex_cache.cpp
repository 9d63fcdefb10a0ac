// SPDX-License-Identifier: Apache-2.0
#include "emu/vertex_cache.h"

#include "emu/error.h"

#include <algorithm>
#include <charconv>

namespace tessemu {

using Kind = VertexCacheModel::Kind;

std::string name_of(VertexCacheModel const& m)
{
    switch (m.kind) {
    case Kind::None:
        return "none";
    case Kind::Fifo:
        return "fifo:" + std::to_string(m.entries);
    case Kind::Lru:
        return "lru:" + std::to_string(m.entries);
    default:
        return "infinite";
    }
}

VertexCacheModel vertex_cache_from_name(std::string_view name)
{
    if (name == "none") return {Kind::None, 0};
    if (name == "infinite") return {Kind::Infinite, 0};
    std::size_t const colon = name.find(':');
    std::string_view const word = name.substr(0, colon);
    if (colon != std::string_view::npos && (word == "fifo" || word == "lru")) {
        std::string_view const digits = name.substr(colon + 1);
        std::uint32_t n = 0;
        auto const [end, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
        if (ec == std::errc() && end == digits.data() + digits.size() && n > 0)
            return {word == "fifo" ? Kind::Fifo : Kind::Lru, n};
    }
    throw Error("vertex cache is '" + std::string(name) +
                "', it must be none, fifo:N, lru:N (N at least 1) or infinite");
}

VertexCache::VertexCache(VertexCacheModel model, std::uint32_t vertex_id_limit) : model_(model)
{
    if (model.kind == Kind::Lru) {
        resident_.resize(vertex_id_limit);
        newer_.resize(vertex_id_limit);
        older_.resize(vertex_id_limit);
        return;
    }
    entries_ = model.kind == Kind::Infinite ? std::uint64_t(1) << 62
               : model.kind == Kind::None   ? 0
                                            : model.entries;
    misses_ = entries_;
    entered_.resize(vertex_id_limit);
}

void VertexCache::unlink(std::uint32_t v)
{
    (older_[v] == kNone ? oldest_ : newer_[older_[v]]) = newer_[v];
    (newer_[v] == kNone ? newest_ : older_[newer_[v]]) = older_[v];
}

void VertexCache::link_newest(std::uint32_t v)
{
    older_[v] = newest_;
    newer_[v] = kNone;
    (newest_ == kNone ? oldest_ : newer_[newest_]) = v;
    newest_ = v;
}

bool VertexCache::access_lru(std::uint32_t vertex)
{
    bool const hit = resident_[vertex];
    resident_[vertex] = 1;
    if (hit) {
        unlink(vertex);
    } else if (size_ == model_.entries) {
        resident_[oldest_] = 0;
        unlink(oldest_);
    } else {
        ++size_;
    }
    link_newest(vertex);
    return hit;
}

} // namespace tessemu
