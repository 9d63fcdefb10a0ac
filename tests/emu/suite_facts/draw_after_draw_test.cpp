// Gap G4: draws that follow other draws.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/emu/suite_facts/patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>

namespace tessemu::test {
namespace {

using D = TessellatorDomain;
using P = Partitioning;
using O = OutputPrimitive;

// What a draw leaves: what it counted, and what it streamed out, drew or showed.
struct Left {
    DrawStatistics statistics;
    std::vector<std::byte> bytes;

    friend bool operator==(Left const&, Left const&) = default;
};
void append(std::vector<std::byte>& to, void const* from, std::size_t bytes)
{
    auto const* const b = static_cast<std::byte const*>(from);
    to.insert(to.end(), b, b + bytes);
}

enum class Look { StreamOut, Raster, RasterAndVisit, CountsOnly };

// A draw that can be repeated: its pipeline is made once.
class RepeatedDraw {
public:
    /// \param set  gives shaders, state and vertices to a scene
    template <class Set>
    RepeatedDraw(std::string name, Look look, Set const& set)
        : name_(std::move(name)),
          look_(look),
          scene_(std::make_unique<PatchScene>(24, 24))
    {
        set(*scene_);
        if (look == Look::StreamOut) scene_->stream_out(0, 8, 1 << 17);
        scene_->call.set_vertices(scene_->vertices, 8);
        scene_->call.vertex_count = std::uint32_t(scene_->vertices.size() / 8);
        pipeline_ = std::make_unique<GraphicsPipeline>(scene_->desc);
    }
    Left draw(DrawMemory& memory, ThreadPool const& threads) const
    {
        Left left;
        PatchScene& s = *scene_;
        s.clear();
        s.buffer.filled = 0;
        DrawOptions options = s.options;
        options.memory = &memory;
        bool const raster = look_ == Look::Raster || look_ == Look::RasterAndVisit;
        PatchVisitor visit;
        if (look_ == Look::RasterAndVisit)
            visit = [&](ShadedPatch const& p) {
                append(left.bytes, &p.primitive_id, sizeof p.primitive_id);
                for (std::size_t k = 0; k < 8; ++k)
                    append(left.bytes, p.outputs + k * p.stride, 4 * p.points->patch.points());
            };
        left.statistics = tessemu::draw(*pipeline_, s.call, raster ? &s.target : nullptr, visit,
                                        threads, options);
        append(left.bytes, s.streamed_bytes.data(), s.buffer.filled);
        for (int y = 0; raster && y < s.height; ++y) {
            append(left.bytes, s.color.texel(0, y), s.color.row_bytes());
            append(left.bytes, s.depth.codes() + s.depth.index(0, y), std::size_t(4 * s.width));
        }
        return left;
    }
    std::string const& name() const { return name_; }

private:
    std::string name_;
    Look look_;
    std::unique_ptr<PatchScene> scene_;
    std::unique_ptr<GraphicsPipeline> pipeline_;
};

void add_vertices(Scene& s, int count)
{
    for (int i = 0; i < count; ++i)
        s.add(float(2 + 5 * i % 17), float(3 + 7 * i % 19), 0.25f + float(i % 8) / 16, 1,
              {float(i + 1), 2, 3, 4});
}

template <D domain>
void add_patches(std::vector<RepeatedDraw>& to, P partitioning, int points, bool as_points,
                 Look look)
{
    std::string const name = std::string(name_of(domain)) + " " +
                             std::string(name_of(partitioning)) + " of " + std::to_string(points) +
                             (as_points ? " as points" : "") + ", look " +
                             std::to_string(int(look));
    to.emplace_back(name, look, [&](PatchScene& s) {
        // Most factors are the same everywhere, so that a cache that takes one pattern for another
        // is found out; the first are each partitioning's own.
        TessFactors const mixed{1.5f, 4.2f, 2, 3.7f, 2.6f, 5};
        float const own = 2.3f + 1.5f * float(int(partitioning));
        s.use_patches(PatchHull<domain>{points, {uniform(own), mixed, uniform(0), uniform(1)}},
                      PatchDomain<domain>{0.75f});
        s.desc.partitioning = partitioning;
        if (as_points) s.desc.output_primitive = O::Point;
        add_vertices(s, 10 * points + 1);
    });
}

// Every domain, partitioning and patch size, and every topology without tessellation; every way
// that a draw's results are looked at.
std::vector<RepeatedDraw> draws()
{
    std::vector<RepeatedDraw> all;
    for (Look look : {Look::StreamOut, Look::Raster, Look::RasterAndVisit, Look::CountsOnly}) {
        for (P p : {P::Integer, P::Pow2, P::FractionalOdd, P::FractionalEven})
            for (int points : {1, 4, 32}) {
                if (points > 1 && look > Look::Raster) continue;
                add_patches<D::Quad>(all, p, points, false, look);
                add_patches<D::Tri>(all, p, points, false, look);
                add_patches<D::Isoline>(all, p, points, false, look);
            }
        add_patches<D::Quad>(all, P::FractionalOdd, 4, true, look);
        add_patches<D::Tri>(all, P::FractionalOdd, 3, true, look);
        add_patches<D::Isoline>(all, P::Integer, 2, true, look);
        if (look == Look::RasterAndVisit) continue; // only patches are visited
        for (auto t : {PrimitiveTopology::PointList, PrimitiveTopology::LineList,
                       PrimitiveTopology::LineStrip, PrimitiveTopology::TriangleList,
                       PrimitiveTopology::TriangleStrip})
            all.emplace_back("topology " + std::to_string(int(t)) + ", look " +
                                 std::to_string(int(look)),
                             look, [&](PatchScene& s) {
                                 s.call.topology = t;
                                 add_vertices(s, 11);
                             });
    }
    return all;
}

// A sequence of 0 to n - 1 in which each number follows each, itself too, once around.
std::vector<std::size_t> every_pair(std::size_t n)
{
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < n; ++i) {
        out.push_back(i);
        for (std::size_t j = i + 1; j < n; ++j) out.insert(out.end(), {i, j});
    }
    out.push_back(0);
    return out;
}

TEST(DrawAfterDraw, G4ADrawGivesWhatItGivesAloneWhateverWasDrawnBefore)
{
    std::vector<RepeatedDraw> const all = draws();
    ThreadPool const threads(2);
    std::vector<Left> alone;
    for (RepeatedDraw const& d : all) {
        DrawMemory fresh;
        alone.push_back(d.draw(fresh, threads));
    }
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    DrawMemory memory;
    std::size_t before = all.size();
    for (std::size_t i : every_pair(all.size())) {
        Left const left = all[i].draw(memory, threads);
        ASSERT_EQ(left.statistics, alone[i].statistics)
            << all[i].name() << " after "
            << (before < all.size() ? all[before].name() : std::string("none"));
        ASSERT_TRUE(left.bytes == alone[i].bytes)
            << all[i].name() << " after "
            << (before < all.size() ? all[before].name() : std::string("none"));
        if (before < all.size()) pairs.emplace(before, i);
        before = i;
    }
    EXPECT_EQ(pairs.size(), all.size() * all.size());
    // Two draws that are the same would prove nothing.
    for (auto l = alone.begin(); l != alone.end(); ++l)
        EXPECT_TRUE(std::none_of(alone.begin(), l, [&](Left const& o) { return o == *l; }))
            << all[std::size_t(l - alone.begin())].name();
}

} // namespace
} // namespace tessemu::test
