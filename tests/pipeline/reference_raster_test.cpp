// Tessellated cages: the streamed draw against the reader's rasterizer, bit for bit.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/reference_rasterizer.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

constexpr int kSize = 300;

struct Case {
    char const* model;
    float tess;
    float focal; ///< above 1: closer than the whole figure
    CullMode cull;
    Partitioning partitioning;
};

void expect_same(Case const& c, int threads, Machine const& machine = {})
{
    SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), load_model(c.model).mesh);
    Camera camera = frame_points(m.mesh->mesh().positions, {0.5f, 0.4f, 1}, 1);
    camera.focal *= c.focal;

    FrameSettings settings;
    settings.view = View::Patches;
    settings.camera = camera;
    settings.tess_factor = c.tess;
    settings.partitioning = c.partitioning;
    settings.machine = machine;
    settings.view_projection = view_projection(camera, 1);
    CommandList list = m.patches->commands(settings);
    std::vector<PixelShader> shaders; // of the draws, in order
    list.for_each_surface_draw([&](Draw& d) {
        d.pipeline.pixel_shader = make_view(d, settings);
        shaders.push_back(d.pipeline.pixel_shader);
    });
    std::array<float, 4> const background{0, 0, 0, 0};
    ThreadPool const pool(threads);
    ColorTarget color(kSize, kSize);
    DepthTarget depth(kSize, kSize);
    color.clear(background, pool);
    depth.clear(1, 0, pool);
    RasterTarget raster{{&color}, &depth, {{0, 0, kSize, kSize, 0, 1}}};
    raster.rasterizer.cull = c.cull;
    raster.rasterizer.front_counter_clockwise = true;

    DrawStatistics const drawn = run_commands(list, pool, {&raster}).total;
    std::uint64_t covered = 0;
    for (StageStatistics const& s : drawn.stages)
        if (s.stage == "rasterizer") covered += s.output_bytes / 4;
    // One picture of all draws: their pixel shaders take turns.
    test::ReferenceRasterizer sum(raster, shaders[0], background);
    std::size_t draws = 0;
    CommandOptions options;
    options.visit = [&](SurfacePatch const& p) {
        if (p.number() == 0) sum.use(shaders[draws++]);
        auto const& index = p.triangles();
        for (std::size_t t = 0; t < index.size(); t += 3)
            sum.triangle({p.scalars(index[t]), p.scalars(index[t + 1]), p.scalars(index[t + 2])},
                         std::int32_t(p.number()));
    };
    run_commands(list, pool, options);
    EXPECT_EQ(draws, shaders.size());
    SCOPED_TRACE(std::string(c.model) + " tess " + std::to_string(c.tess) + " checking " +
                 std::to_string(machine.checking));
    EXPECT_GT(sum.passed, 1000u);
    EXPECT_EQ(sum.differing_pixels(color, depth), 0u);
    EXPECT_EQ(drawn.pipeline.CInvocations, sum.clip_invocations);
    EXPECT_EQ(drawn.pipeline.CPrimitives, sum.clip_primitives);
    EXPECT_EQ(drawn.pipeline.PSInvocations, sum.passed);
    EXPECT_EQ(covered, sum.fragments);
}

TEST(TriangleStream, CagesEqualTheReadersRasterizerAtFactorsOneTo64)
{
    for (float tess : {1.0f, 2.5f, 5.0f, 10.0f, 17.0f, 25.0f, 40.3f, 64.0f})
        expect_same({"jug", tess, 1, CullMode::None, Partitioning::FractionalOdd}, 2);
    for (float tess : {3.0f, 10.0f, 17.0f, 64.0f})
        expect_same({"saddle_star", tess, 1, CullMode::Back, Partitioning::FractionalEven}, 3);
    expect_same({"spindle", 9, 1, CullMode::Front, Partitioning::Integer}, 1,
                {kNativeLanes, Contraction::None, 0, true});
}

TEST(TriangleStream, PatchesThatLeaveTheScreenEqualTheReadersRasterizer)
{
    for (float focal :
         {2.0f, 5.0f, 14.0f}) // up to patches wider than the 126 pixels of the fast way
        for (float tess : {1.0f, 4.0f, 30.0f})
            expect_same({"jug", tess, focal, CullMode::None, Partitioning::FractionalOdd}, 2);
}

} // namespace
} // namespace tessemu
