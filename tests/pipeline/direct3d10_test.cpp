// The Direct3D 10 path draws the same surface at its own costs.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/direct3d10.h"

#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "tests/emu/suite_facts/patches.h"
#include "tests/support/cages.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

namespace tessemu {
namespace {

// work(patches) for every scheme on every built-in cage that it takes.
template <class Work> void for_each_case(Work&& work)
{
    for (Scheme const* scheme : test::tessellated_schemes())
        for (std::string const& cage : test::cages_of(*scheme)) {
            SCOPED_TRACE(scheme->info().name + " on " + cage);
            work(build_scheme(*scheme, load_model(cage).mesh));
            if (testing::Test::HasFatalFailure()) return;
        }
}

// Everything that the domain shader wrote, patch by patch.
std::vector<std::vector<std::uint32_t>> surface(SchemeOnMesh const& m, FrameSettings const& s)
{
    std::vector<std::vector<std::uint32_t>> out;
    visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& p) {
        std::vector<std::uint32_t> bits{p.number(), p.place().face};
        for (std::size_t i = 0; i < p.points(); ++i)
            for (float x : p.scalars(i)) bits.push_back(std::bit_cast<std::uint32_t>(x));
        out.push_back(std::move(bits));
    });
    return out;
}

StageStatistics stage(DrawStatistics const& d, std::string const& name)
{
    for (StageStatistics const& s : d.stages)
        if (s.stage == name) return s;
    ADD_FAILURE() << "no stage " << name;
    return {};
}

TEST(Direct3D10, GivesEverySchemesSurfaceBitForBit)
{
    for_each_case([](SchemeOnMesh const& m) {
        for (Contraction contraction : {Contraction::None, Contraction::Mixed})
            for (bool moved : {false, true}) {
                FrameSettings s;
                s.tess_factor = 5.7f;
                s.machine.contraction = contraction;
                s.machine.seed = 3;
                if (moved) {
                    s.pose = std::make_shared<Pose>(SpineRig(m.mesh->base()).sway(0.3));
                    s.displacement =
                        std::make_shared<Displacement>(Displacement::studs(0.2f, 0.05f));
                }
                auto const eleven = surface(m, s);
                s.direct3d10 = true;
                ASSERT_FALSE(eleven.empty());
                ASSERT_EQ(surface(m, s), eleven);
            }
    });
}

struct ShowsAFactor : test::PatchDomain<TessellatorDomain::Quad> {
    template <class T>
    test::SceneVertex<T> operator()(DomainInput<T> const& in,
                                    ControlPoints<test::SceneVertex<T>> const& points,
                                    ControlPoints<test::Constant<T>> const& constants,
                                    TessFactorInput<T> const& factors) const
    {
        auto o = PatchDomain::operator()(in, points, constants);
        o.value.x = factors[0].value;
        return o;
    }
};

// No stage of it has them.
TEST(Direct3D10, RefusesADomainShaderThatReadsTessFactors)
{
    PatchPlace const place{};
    Draw d;
    d.patches = {&place, 1};
    d.pipeline = test::PatchScene().use_patches(test::PatchHull<TessellatorDomain::Quad>{}).desc;
    CommandList list;
    list.commands.emplace_back(d);
    EXPECT_EQ(instanced(std::move(list), {}).commands.size(), 2u);
    d.pipeline.domain_shader = bind_domain_shader(ShowsAFactor{}, {});
    list = {};
    list.commands.emplace_back(d);
    EXPECT_THROW(instanced(std::move(list), {}), Error);
}

TEST(Direct3D10, DrawsTheSamePicture)
{
    for_each_case([](SchemeOnMesh const& m) {
        FrameSettings s;
        s.width = s.height = 200;
        s.tess_factor = 3;
        s.camera = frame_points(m.mesh->mesh().positions, {0.5f, 0.5f, 1}, 1);
        ThreadPool const threads;
        Frame const eleven = draw_frame(*m.patches, s, threads);
        s.direct3d10 = true;
        Frame const ten = draw_frame(*m.patches, s, threads);
        for (int y = 0; y < s.height; ++y)
            ASSERT_EQ(std::memcmp(eleven.color.texel(0, y), ten.color.texel(0, y),
                                  eleven.color.row_bytes()),
                      0)
                << "row " << y;
        EXPECT_EQ(ten.statistics.pipeline.HSInvocations, 0u);
        EXPECT_EQ(ten.statistics.pipeline.DSInvocations, 0u);
        EXPECT_EQ(ten.statistics.pipeline.CPrimitives, eleven.statistics.pipeline.CPrimitives);
        EXPECT_EQ(ten.statistics.pipeline.PSInvocations, eleven.statistics.pipeline.PSInvocations);
    });
}

// The same operations in other stages: the hull shader's in the geometry shader, the domain
// shader's in the vertex shader; and the same reads of control points, from a buffer.
TEST(Direct3D10, MovesTheCostsToOtherStages)
{
    for_each_case([](SchemeOnMesh const& m) {
        FrameSettings s;
        s.tess_factor = 4;
        s.vertex_cache = vertex_cache_from_name("infinite");
        DrawStatistics const eleven = visit_surface(*m.patches, s, ThreadPool(), {}).total;
        s.direct3d10 = true;
        DrawStatistics const ten = visit_surface(*m.patches, s, ThreadPool(), {}).total;
        EXPECT_EQ(ten.pipeline.GSInvocations, eleven.pipeline.HSInvocations);
        EXPECT_EQ(stage(ten, "geometry_shader").flops, stage(eleven, "hull_shader").flops);
        FlopCount sum = stage(eleven, "vertex_shader").flops;
        sum += stage(eleven, "domain_shader").flops;
        EXPECT_EQ(stage(ten, "vertex_shader").flops, sum);
        EXPECT_EQ(ten.pipeline.VSInvocations,
                  eleven.pipeline.VSInvocations + eleven.pipeline.DSInvocations);
        auto const reads = [](StageStatistics const& st, std::string const& name) {
            for (FetchStatistics const& f : st.fetches)
                if (f.resource == name) return std::tuple(f.count, f.bytes);
            return std::tuple(std::uint64_t(0), std::uint64_t(0));
        };
        for (char const* name : {"control_points", "patch_constants"})
            EXPECT_EQ(reads(stage(ten, "vertex_shader"), name),
                      reads(stage(eleven, "domain_shader"), name))
                << name;
        EXPECT_EQ(reads(stage(ten, "geometry_shader"), "vertices"),
                  reads(stage(eleven, "hull_shader"), "input_control_points"));
        // What was streamed out is the patches' control points and constants.
        std::uint64_t streamed = 0;
        m.patches->commands({}).for_each_surface_draw([&](Draw const& d) {
            HullShader const& h = d.pipeline.hull_shader;
            streamed += d.patches.size() * std::uint64_t(h.patch_floats() + h.constant_floats()) *
                        sizeof(float);
        });
        EXPECT_EQ(stage(ten, "stream_output").output_bytes, streamed);
    });
}

TEST(Direct3D10, RefusesAdaptiveFactors)
{
    SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), load_model("jug").mesh);
    FrameSettings s;
    s.direct3d10 = true;
    s.adaptive.kind = AdaptiveFactors::Kind::Pixels;
    EXPECT_THROW(visit_surface(*m.patches, s, ThreadPool(), {}), Error);
}

} // namespace
} // namespace tessemu
