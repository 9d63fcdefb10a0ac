// SPDX-License-Identifier: Apache-2.0
#include "emu/vertex_cache.h"

#include "emu/error.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <deque>
#include <set>

namespace tessemu {
namespace {

using Kind = VertexCacheModel::Kind;

// The models as their definitions say, without tricks.
class Reference {
public:
    explicit Reference(VertexCacheModel m) : model_(m) {}
    bool access(std::uint32_t v)
    {
        if (model_.kind == Kind::None) return false;
        auto const it = std::find(held_.begin(), held_.end(), v);
        bool const hit = it != held_.end();
        if (hit && model_.kind == Kind::Lru) {
            held_.erase(it);
            held_.push_back(v);
        }
        if (!hit) {
            if (model_.kind != Kind::Infinite && held_.size() == model_.entries) held_.pop_front();
            held_.push_back(v);
        }
        return hit;
    }

private:
    VertexCacheModel model_;
    std::deque<std::uint32_t> held_;
};

RC_GTEST_PROP(VertexCache, R41I3HitsAndMissesEqualTheDefinition, ())
{
    auto const kind = *rc::gen::element(Kind::None, Kind::Fifo, Kind::Lru, Kind::Infinite);
    VertexCacheModel const model{kind, *rc::gen::inRange(1u, 9u)};
    auto const accesses =
        *rc::gen::container<std::vector<std::uint32_t>>(rc::gen::inRange(0u, 15u));
    VertexCache cache(model, 15);
    Reference reference(model);
    for (std::uint32_t v : accesses) RC_ASSERT(cache.access(v) == reference.access(v));
}

TEST(VertexCache, NamesRoundTripAndBadOnesAreRefused)
{
    for (char const* name : {"none", "fifo:16", "lru:3", "infinite"})
        EXPECT_EQ(name_of(vertex_cache_from_name(name)), name);
    for (char const* name : {"", "fifo", "fifo:", "fifo:0", "fifo:-1", "fifo:1x", "cache:4"})
        EXPECT_THROW(vertex_cache_from_name(name), Error) << name;
}

} // namespace
} // namespace tessemu
