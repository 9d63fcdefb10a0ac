// The Direct3D 10 path draws the same surface at its own costs.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/direct3d10.h"

#include "io/model.h"
#include "pipeline/commands/refinement_pattern.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "tests/emu/suite_facts/patches.h"
#include "tests/support/cages.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <map>
#include <set>

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
    if (test::kSlow) GTEST_SKIP() << "with sanitizers Determinism draws every scheme so";
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

// Twice the signed area of a pattern's triangle in (u, v).
double doubled_area(DomainPoints const& p, std::size_t triangle)
{
    auto const at = [&](std::size_t k) { return p.patch.indices[3 * triangle + k]; };
    auto const side = [&](std::size_t k) {
        return std::pair(double(p.u[at(k)]) - double(p.u[at(0)]),
                         double(p.v[at(k)]) - double(p.v[at(0)]));
    };
    auto const [a, b] = side(1);
    auto const [c, d] = side(2);
    return a * d - b * c;
}

TEST(UniformPattern, IsSquareManyTrianglesOfOneSizeThatMeetOnceAlongEachEdge)
{
    for (auto const& [domain, of_one, points_of] :
         {std::tuple(TessellatorDomain::Tri, 1, 2), std::tuple(TessellatorDomain::Quad, 2, 1)})
        for (int n = 1; n <= 64; n *= 2) {
            SCOPED_TRACE(n);
            auto const p = uniform_pattern(domain, n);
            std::size_t const triangles = p->patch.indices.size() / 3;
            EXPECT_EQ(triangles, std::size_t(of_one * n * n));
            EXPECT_EQ(p->u.size(),
                      std::size_t((n + 1) * (n + (points_of == 2 ? 2 : 1)) / points_of));
            std::set<std::pair<float, float>> places;
            for (std::size_t i = 0; i < p->u.size(); ++i) {
                places.emplace(p->u[i], p->v[i]);
                EXPECT_EQ(p->u[i] * float(n), std::floor(p->u[i] * float(n)));
                EXPECT_EQ(p->v[i] * float(n), std::floor(p->v[i] * float(n)));
                EXPECT_EQ(p->patch.u[i], std::uint32_t(p->u[i] * float(kFixedOne)));
                EXPECT_EQ(p->patch.v[i], std::uint32_t(p->v[i] * float(kFixedOne)));
            }
            EXPECT_EQ(places.size(), p->u.size());
            std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
            for (std::size_t t = 0; t < triangles; ++t) {
                EXPECT_EQ(doubled_area(*p, t), 1.0 / (n * n)); // powers of two
                for (std::size_t k = 0; k < 3; ++k)
                    EXPECT_TRUE(edges
                                    .emplace(p->patch.indices[3 * t + k],
                                             p->patch.indices[3 * t + (k + 1) % 3])
                                    .second);
            }
        }
}

// The first pass's hull shader and the second's vertex shader know nothing of the pattern.
TEST(UniformPattern, HasTheDomainShadersPoints)
{
    auto const points = [](SchemeOnMesh const& m, FrameSettings const& s) {
        std::map<std::tuple<std::string, std::uint32_t, float, float>, std::vector<float>> out;
        visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& p) {
            for (std::size_t i = 0; i < p.points(); ++i)
                out[{p.kind().name, p.number(), p.domain().u[i], p.domain().v[i]}] = p.scalars(i);
        });
        return out;
    };
    for_each_case([&](SchemeOnMesh const& m) {
        FrameSettings s;
        s.tess_factor = 16;
        s.partitioning = Partitioning::Integer;
        auto const eleven = points(m, s);
        s.direct3d10 = true;
        s.pattern = RefinementPattern::Uniform;
        s.tess_factor = 8.5f; // is rounded up
        auto const ten = points(m, s);
        std::size_t inside = 0;
        for (auto const& [at, point] : ten)
            if (auto const same = eleven.find(at); same != eleven.end()) {
                ASSERT_EQ(point, same->second);
                auto const [u, v] = std::pair(std::get<2>(at), std::get<3>(at));
                inside += u > 0 && v > 0 && u + v < 1;
            }
        EXPECT_GT(inside, 0u);
        std::size_t triangles = 0, expected = 0;
        CommandList const list = frame_commands(*m.patches, s, surface_settings(s));
        list.for_each_surface_draw([&](Draw const& d) {
            triangles += d.patches.size() * d.grid->patch.indices.size() / 3;
        });
        m.patches->commands(s).for_each_surface_draw([&](Draw const& d) {
            bool const quads = d.pipeline.domain_shader->domain() == TessellatorDomain::Quad;
            expected += d.patches.size() * (quads ? 2u : 1u) * 16 * 16;
        });
        EXPECT_EQ(triangles, expected);
    });
}

} // namespace
} // namespace tessemu
