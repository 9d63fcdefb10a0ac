// Gap G5: very many patches of which few are kept.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/emu/suite_facts/patches.h"

#include <gtest/gtest.h>

#include <limits>

namespace tessemu::test {
namespace {

using D = TessellatorDomain;
using O = OutputPrimitive;

constexpr int kPatches = 1 << 19, kKeptOf = 8, kKept = kPatches / kKeptOf, kSide = 256;
static_assert(kKept == kSide * kSide);

// Seven patches of eight are culled, each by another edge or another value.
std::vector<TessFactors> one_of_eight()
{
    std::vector<TessFactors> factors(kKeptOf, uniform(1));
    float const nan = std::numeric_limits<float>::quiet_NaN();
    float const culling[] = {0, -1, nan, -0.0f, -64, 0, nan};
    for (std::size_t i = 0; i < 7; ++i) factors[i < 5 ? i : i + 1][i % 4] = culling[i];
    return factors;
}
constexpr int kKeptPlace = 5;

// Kept patch k covers pixel k.
void add_pixels(Scene& s, int patches)
{
    for (int i = 0; i < patches; ++i) {
        int const k = i / kKeptOf % kKept;
        s.add(float(k % kSide), float(k / kSide + 1), 0.5f, 1, {float(i), 0, 0, 0});
    }
}

TEST(CulledPatches, G5MostlyCulledPatchesEachReachTheirPixelWithTheirOwnId)
{
    std::vector<std::byte> first;
    for (int threads : {1, 2, 4}) {
        PatchScene s(kSide, kSide);
        s.use_patches(PatchHull<D::Quad>{1, one_of_eight()}, PatchDomain<D::Quad>{2.0f / kSide});
        s.use(ShowPrimitiveId{});
        s.threads = threads;
        add_pixels(s, kPatches);
        PipelineStatistics const p = s.draw().pipeline;
        EXPECT_EQ(p.HSInvocations, std::uint64_t(kPatches));
        EXPECT_EQ(p.DSInvocations, std::uint64_t(4 * kKept));
        EXPECT_EQ(p.CInvocations, std::uint64_t(2 * kKept));
        for (int k = 0; k < kKept; ++k)
            ASSERT_EQ(s.at(k % kSide, k / kSide), float(kKeptOf * k + kKeptPlace + 1)) << k;

        s.desc.output_primitive = O::Point;
        s.stream_out(4, 3, std::size_t(kKept) * 4 * 12);
        s.draw();
        auto const points = s.streamed();
        ASSERT_EQ(points.size(), std::size_t(4 * kKept));
        for (std::size_t i = 0; i < points.size(); ++i) {
            auto const id = float(std::size_t(kKeptOf) * (i / 4) + kKeptPlace);
            ASSERT_EQ(points[i], (std::vector<float>{id, id, id})) << i;
        }
        if (first.empty()) first = s.streamed_bytes;
        EXPECT_TRUE(s.streamed_bytes == first) << threads;
    }
}

TEST(CulledPatches, G5InstancesOfMostlyCulledPatchesRestartTheId)
{
    constexpr int kInstances = 8, kEach = kPatches / kInstances;
    for (int threads : {1, 2, 4}) {
        PatchScene s;
        s.use_patches(PatchHull<D::Quad>{1, one_of_eight()});
        s.desc.output_primitive = O::Point;
        s.threads = threads;
        s.call.instance_count = kInstances;
        add_pixels(s, kEach);
        s.stream_out(4, 3, std::size_t(kKept) * 4 * 12);
        s.draw();
        auto const points = s.streamed();
        ASSERT_EQ(points.size(), std::size_t(4 * kKept));
        for (std::size_t i = 0; i < points.size(); ++i) {
            std::size_t const kept = i / 4 % std::size_t(kEach / kKeptOf);
            auto const id = float(std::size_t(kKeptOf) * kept + kKeptPlace);
            ASSERT_EQ(points[i], (std::vector<float>{id, id, id})) << i;
        }
    }
}

// Factors from the control point, which is an instance's own.
struct FactorOfInstance : PatchHull<D::Quad> {
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<SceneVertex<T>> const& in,
                                  ControlPoints<SceneVertex<T>> const&,
                                  ControlPoints<Constant<T>> const&) const
    {
        T const f = in[0].value.y;
        return {f, f, f, f, f, f};
    }
};

TEST(CulledPatches, G5HalfAMillionInstancesMostlyCulledAllReachTheirPixel)
{
    std::vector<float> instances; // position, then the value
    for (int i = 0; i < kPatches; ++i) {
        int const k = i / kKeptOf;
        instances.insert(instances.end(),
                         {2 * (float(k % kSide) + 0.5f) / kSide - 1,
                          1 - 2 * (float(k / kSide) + 0.5f) / kSide, 0.5f, 1, float(i % 251 + 1),
                          i % kKeptOf == kKeptPlace ? 1.0f : 0.0f, 0, 0});
    }
    for (int threads : {1, 2}) {
        PatchScene s(kSide, kSide);
        s.use_patches(PatchHull<D::Quad>{});
        s.desc.hull_shader = bind_hull_shader(FactorOfInstance{}, {});
        s.desc.output_primitive = O::Point;
        s.desc.pixel_shader = bind_pixel_shader(ShowValue{}, {});
        s.call.set_vertices(instances, 8);
        for (InputElement& e : s.call.layout) e.per_instance = true;
        s.call.vertex_count = 1;
        s.call.instance_count = kPatches;
        DrawStatistics const d =
            draw(GraphicsPipeline(s.desc), s.call, &s.target, {}, ThreadPool(threads));
        EXPECT_EQ(d.pipeline.DSInvocations, std::uint64_t(4 * kKept));
        for (int k = 0; k < kKept; ++k) {
            auto const c = s.color.load(k % kSide, k / kSide);
            int const i = kKeptOf * k + kKeptPlace;
            ASSERT_EQ(c, (std::array<float, 4>{0, 0, float(i % 251 + 1), 0})) << k;
        }
    }
}

} // namespace
} // namespace tessemu::test
