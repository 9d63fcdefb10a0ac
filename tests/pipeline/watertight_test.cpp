// Shared edges have equal bits from both sides; the naive edge rules do not.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "shaders_cpp/gregory/domain_shaders.h"
#include "tests/support/edges.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace tessemu {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSlow = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kSlow = true;
#else
constexpr bool kSlow = false;
#endif
#else
constexpr bool kSlow = false;
#endif

struct Loaded {
    PreparedMesh mesh;
    std::unique_ptr<PatchMesh> patches;
};

Loaded load_patches(std::string const& model, char const* scheme = "gregory-stencil")
{
    Technique const& technique = find_technique(scheme);
    Loaded out;
    out.mesh = prepare_mesh(load_model(model).mesh, technique);
    out.patches = technique.build(*out.mesh.topology, {});
    return out;
}

std::vector<Machine> contraction_policies()
{
    std::vector<Machine> out(2);
    out[1].contraction = Contraction::All;
    for (std::uint64_t seed = 1; seed <= 10; ++seed)
        out.push_back({kNativeLanes, Contraction::Mixed, seed});
    return out;
}

void expect_closed(std::string const& model, char const* scheme = "gregory-stencil")
{
    Loaded const m = load_patches(model, scheme);
    ThreadPool const threads;
    for (Machine const& machine : contraction_policies())
        for (float factor :
             kSlow ? std::vector{1.0f, 4.0f, 7.3f} : std::vector{1.0f, 4.0f, 7.3f, 16.0f, 64.0f}) {
            FrameSettings s;
            s.tess_factor = factor;
            s.machine = machine;
            test::EdgeComparison const c =
                test::compare_edges(*m.mesh.mesh, *m.patches, s, threads);
            ASSERT_GT(c.shared_points, 0u);
            ASSERT_EQ(c.lonely_points, 0u) << model << " factor " << factor;
            ASSERT_EQ(c.differing_positions, 0u)
                << model << " factor " << factor << " policy " << int(machine.contraction)
                << " seed " << machine.seed << ": " << c.first_difference;
            ASSERT_EQ(c.differing_normals, 0u)
                << model << " factor " << factor << " policy " << int(machine.contraction)
                << " seed " << machine.seed << ": " << c.first_difference;
        }
}

TEST(GregoryStencil, R68V16SharedEdgesOfBuiltInCagesHaveEqualBits)
{
    for (char const* model : {"jug", "spindle", "saddle_star"}) expect_closed(model);
}

// Factors from the camera: neighbours agree on them, and on every point.
void expect_closed_adaptive(std::string const& model, char const* scheme)
{
    Loaded const m = load_patches(model, scheme);
    FrameSettings s;
    s.height = 512;
    s.camera = frame_points(m.mesh.mesh->positions, {0.5f, 0.4f, 1}, 1);
    for (Machine const& machine : contraction_policies())
        for (AdaptiveFactors const adaptive :
             {AdaptiveFactors{AdaptiveFactors::Kind::Pixels, 6},
              AdaptiveFactors{AdaptiveFactors::Kind::Distance, 2.5f}}) {
            s.machine = machine;
            s.adaptive = adaptive;
            s.tess_factor = 12;
            test::EdgeComparison const c =
                test::compare_edges(*m.mesh.mesh, *m.patches, s, ThreadPool());
            ASSERT_GT(c.shared_edge_coordinates, 1000u);
            ASSERT_EQ(c.lonely_points, 0u) << model << " " << scheme;
            ASSERT_EQ(c.differing_positions, 0u) << model << " " << scheme;
            ASSERT_EQ(c.differing_normals, 0u) << model << " " << scheme;
        }
}

TEST(AdaptiveFactors, EverySchemeStaysClosed)
{
    for (char const* scheme : {"gregory-stencil", "gregory-two-stage"})
        for (char const* model : {"jug", "spindle", "saddle_star"})
            expect_closed_adaptive(model, scheme);
    expect_closed_adaptive("saddle_star", "acc");
    expect_closed_adaptive("spindle", "pm");
    if (std::filesystem::exists(test::shared("models/bigguy.obj")))
        for (char const* scheme : {"gregory-stencil", "gregory-two-stage", "acc", "pm"})
            expect_closed_adaptive(test::shared("models/bigguy.obj").string(), scheme);
}

// Segments of a flat square seen head on are as long as asked for.
TEST(AdaptiveFactors, PixelsAreTheLengthOfASegmentInThePicture)
{
    Loaded const m = load_patches("saddle_star");
    for (float pixels : {4.0f, 16.0f}) {
        FrameSettings s;
        s.height = 512;
        s.camera = frame_points(m.mesh.mesh->positions, {0, 0, 1}, 1);
        s.adaptive = {AdaptiveFactors::Kind::Pixels, pixels};
        TessFactorRule const r = tess_factor_rule(s.adaptive, s.camera, s.height, 1);
        glm::vec3 const to = s.camera.target - s.camera.eye;
        float const distance = std::sqrt(to.x * to.x + to.y * to.y + to.z * to.z);
        // 100 pixels long at the target, across the view.
        float const length = 100 * 2 * distance / (s.camera.focal * 512);
        glm::vec3 const right = s.camera.right(), c = s.camera.target;
        auto const at = [&](float t) {
            glm::vec3 const p = c + right * (t * length);
            return float3<float>(p.x, p.y, p.z);
        };
        float const f = r.edge_factor<float>(at(-0.5f), at(-1.0f / 6), at(1.0f / 6), at(0.5f));
        EXPECT_NEAR(f, 100 / pixels, 1e-4f * 100 / pixels);
    }
}

// A chart of its own for every face, at a random place in the texture: every edge is a seam.
void add_charts(ControlMesh& mesh)
{
    std::uint32_t state = 7;
    auto const random = [&] {
        return float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f;
    };
    for (std::size_t i = 0; i < mesh.face_vertices.size(); ++i) {
        mesh.face_coordinates.push_back(std::uint32_t(i));
        mesh.coordinates.emplace_back(3 * random() - 1, 3 * random() - 1);
    }
}

// A sampler's weights have 8 bits: only in a large image does a coordinate's last bit show often.
HeightImage noise(int size)
{
    HeightImage image{{}, size, size};
    std::uint32_t state = 3;
    for (int i = 0; i < size * size; ++i)
        image.heights.push_back(float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f);
    return image;
}

void expect_closed_displaced(std::string const& model, char const* scheme)
{
    Technique const& technique = find_technique(scheme);
    ControlMesh mesh = load_model(model).mesh;
    mesh.face_coordinates.clear();
    mesh.coordinates.clear();
    add_charts(mesh);
    PreparedMesh const prepared = prepare_mesh(std::move(mesh), technique);
    auto const patches = technique.build(*prepared.topology, {});
    std::shared_ptr<Displacement const> const maps[] = {
        std::make_shared<Displacement>(Displacement::studs(0.1f, 0.05f)),
        std::make_shared<Displacement>(*prepared.topology, noise(2048), 0.05f)};
    for (Machine const& machine : contraction_policies())
        for (auto const& map : maps) {
            FrameSettings s;
            s.tess_factor = 7.3f;
            s.machine = machine;
            s.displacement = map;
            test::EdgeComparison const c =
                test::compare_edges(*prepared.mesh, *patches, s, ThreadPool());
            ASSERT_GT(c.shared_points, 100u);
            ASSERT_EQ(c.differing_positions, 0u)
                << model << " " << scheme << ": " << c.first_difference;
            ASSERT_EQ(c.differing_normals, 0u) << model << " " << scheme;
        }
}

TEST(Displacement, EverySchemeStaysClosedAcrossTextureSeams)
{
    for (char const* scheme : {"gregory-stencil", "gregory-two-stage"})
        for (char const* model : {"jug", "spindle", "saddle_star"})
            expect_closed_displaced(model, scheme);
    expect_closed_displaced("saddle_star", "acc");
    expect_closed_displaced("spindle", "pm");
    if (std::filesystem::exists(test::shared("models/bigguy.obj")))
        for (char const* scheme : {"gregory-stencil", "gregory-two-stage", "acc", "pm"})
            expect_closed_displaced(test::shared("models/bigguy.obj").string(), scheme);
}

void expect_closed_animated(std::string const& model, char const* scheme)
{
    Loaded const m = load_patches(model, scheme);
    SpineRig const rig(*m.mesh.mesh);
    auto const studs = std::make_shared<Displacement>(Displacement::studs(0.2f, 0.02f));
    for (Machine const& machine : contraction_policies())
        for (double phase : {0.0, 0.2, 0.7}) {
            FrameSettings s;
            s.tess_factor = 5.4f;
            s.machine = machine;
            s.pose = std::make_shared<Pose>(rig.sway(phase));
            s.displacement = phase > 0.5 ? studs : nullptr;
            test::EdgeComparison const c =
                test::compare_edges(*m.mesh.mesh, *m.patches, s, ThreadPool());
            ASSERT_GT(c.shared_points, 100u);
            ASSERT_EQ(c.differing_positions, 0u) << model << " " << scheme << " " << phase;
            ASSERT_EQ(c.differing_normals, 0u) << model << " " << scheme << " " << phase;
        }
}

TEST(Animation, EverySchemeStaysClosedInEveryFrame)
{
    for (char const* scheme : {"gregory-stencil", "gregory-two-stage"})
        for (char const* model : {"jug", "spindle", "saddle_star"})
            expect_closed_animated(model, scheme);
    expect_closed_animated("saddle_star", "acc");
    expect_closed_animated("spindle", "pm");
    if (std::filesystem::exists(test::shared("models/bigguy.obj")))
        for (char const* scheme : {"gregory-stencil", "gregory-two-stage", "acc", "pm"})
            expect_closed_animated(test::shared("models/bigguy.obj").string(), scheme);
}

// Where every face has a chart of its own, each patch's own coordinates would tear the surface.
TEST(Displacement, OwnCoordinatesDifferAcrossASeamAndOwnedOnesDoNot)
{
    ControlMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
    mesh.add_face(std::array<std::uint32_t, 4>{0, 1, 4, 3});
    mesh.add_face(std::array<std::uint32_t, 4>{1, 2, 5, 4});
    mesh.coordinates = {{0, 0},     {.25f, 0},   {.25f, .25f}, {0, .25f},
                        {.5f, .5f}, {.75f, .5f}, {.75f, .75f}, {.5f, .75f}};
    mesh.face_coordinates = {0, 1, 2, 3, 4, 5, 6, 7};
    Topology const topology(mesh);
    Displacement const d(topology, noise(16), 1);
    auto const at = [&](std::size_t corner, std::size_t pair, std::size_t k) {
        return d.corners()[corner * 8 + pair * 2 + k];
    };
    // Edge 1-4 belongs to face 0: corners 1 and 2 there. Face 1 has it as corner 7 (vertex 4) to
    // corner 4 (vertex 1); canonical from vertex 1 to vertex 4.
    EXPECT_EQ(at(7, 0, 0), .5f);  // own
    EXPECT_EQ(at(7, 1, 0), .25f); // owner at vertex 1
    EXPECT_EQ(at(7, 1, 1), 0.0f);
    EXPECT_EQ(at(7, 2, 1), .25f); // owner at vertex 4
    EXPECT_EQ(at(7, 3, 1), .25f); // vertex 4 belongs to face 0
    EXPECT_EQ(at(4, 3, 0), .25f);
    EXPECT_EQ(at(5, 1, 0), .75f); // an edge of face 1 alone
    for (std::size_t pair = 1; pair < 3; ++pair)
        for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(at(1, pair, k), at(7, pair, k));
}

// P' = P + scale h N of what the shader hands on, recomputed.
TEST(Displacement, MovesPointsAlongTheNormalByTheMap)
{
    Technique const& technique = find_technique("gregory-stencil");
    ControlMesh mesh = load_model("jug").mesh;
    add_charts(mesh);
    PreparedMesh const prepared = prepare_mesh(std::move(mesh), technique);
    auto const patches = technique.build(*prepared.topology, {});
    FrameSettings s;
    s.tess_factor = 5;
    s.displacement = std::make_shared<Displacement>(*prepared.topology, noise(32), 0.25f);
    HeightMap const map = s.displacement->height_map();
    std::size_t inside = 0, moved = 0;
    DrawStatistics const statistics =
        visit_surface(*patches, s, ThreadPool(), [&](DrawPass const&, ShadedPatch const& p) {
            auto const& t = p.points->patch;
            for (std::size_t i = 0; i < t.points(); ++i) {
                auto const out = [&](std::size_t k) { return p.outputs[k * p.stride + i]; };
                if (t.u[i] == 0 || t.v[i] == 0 || t.u[i] + t.v[i] == kFixedOne ||
                    t.u[i] == kFixedOne || t.v[i] == kFixedOne)
                    continue;
                ++inside;
                float const h = 0.25f * map(float3<float>(out(7), out(8), out(9)),
                                            float2<float>(out(10), out(11)));
                for (std::size_t k = 0; k < 3; ++k) {
                    float const along = h * out(4 + k); // rounds apart from the sum
                    ASSERT_EQ(out(k), out(7 + k) + along);
                }
                moved += h != 0;
            }
        });
    EXPECT_GT(inside, 1000u);
    EXPECT_GT(moved, inside * 9 / 10);
    // Inside a quad: its four corners' own coordinates. Every point reads 1 to 4 texels.
    for (StageStatistics const& stage : statistics.stages)
        for (FetchStatistics const& f : stage.fetches)
            if (f.resource == "height_map") {
                EXPECT_LE(f.count, 4 * stage.invocations);
                EXPECT_GE(f.count, stage.invocations);
            }
}

TEST(Displacement, AMeshWithoutTextureCoordinatesTakesNoImage)
{
    ControlMesh const mesh = load_model("spindle").mesh;
    Topology const topology(mesh);
    EXPECT_THROW(Displacement(topology, noise(4), 1), Error);
    EXPECT_THROW(Displacement::studs(0, 1), Error);
}

TEST(Acc, SharedEdgesOfBuiltInCagesHaveEqualBits)
{
    expect_closed("saddle_star", "acc");
}

TEST(Pm, SharedEdgesOfBuiltInCagesHaveEqualBits)
{
    expect_closed("spindle", "pm");
}

TEST(GregoryTwoStage, SharedEdgesOfBuiltInCagesHaveEqualBits)
{
    for (char const* model : {"jug", "spindle", "saddle_star"})
        expect_closed(model, "gregory-two-stage");
}

using SchemeAndModel = std::pair<std::string, std::string>;
class SchemeOn : public testing::TestWithParam<SchemeAndModel> {};

TEST_P(SchemeOn, SharedEdgesHaveEqualBitsUnderEveryContraction)
{
    auto const [scheme, model] = GetParam();
    std::string const file = std::string("models/") + model + ".obj";
    TESSEMU_NEEDS_SHARED(file);
    expect_closed(test::shared(file).string(), scheme.c_str());
}
INSTANTIATE_TEST_SUITE_P(
    Models, SchemeOn,
    testing::Values(SchemeAndModel{"gregory-stencil", "bigguy"},
                    SchemeAndModel{"gregory-stencil", "monsterfrog"},
                    SchemeAndModel{"gregory-stencil", "suzanne"}, SchemeAndModel{"acc", "bigguy"},
                    SchemeAndModel{"acc", "monsterfrog"},
                    SchemeAndModel{"gregory-two-stage", "bigguy"},
                    SchemeAndModel{"gregory-two-stage", "monsterfrog"},
                    SchemeAndModel{"gregory-two-stage", "suzanne"}, SchemeAndModel{"pm", "bigguy"},
                    SchemeAndModel{"pm", "monsterfrog"}),
    [](auto const& test) {
        std::string name = std::string(test.param.first) + "_" + test.param.second;
        std::replace(name.begin(), name.end(), '-', '_');
        return name;
    });

enum class EdgeRule { LeftToRight, MirrorPairs };

// Every patch evaluates its edges in its own direction.
template <EdgeRule kRule, class Inside> struct NaiveEdges {
    static constexpr TessellatorDomain kDomain = Inside::kDomain;
    static constexpr int kControlPoints = Inside::kControlPoints;
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> using PatchConstant = EdgeRegister<T>;
    template <class T> using Output = ShadedVertex<T>;

    template <class T>
    ShadedVertex<T> operator()(DomainInput<T> const& in,
                               ControlPoints<ControlVertex<T>> const& patch,
                               ControlPoints<EdgeRegister<T>> const&) const
    {
        constexpr int N = kDomain == TessellatorDomain::Quad ? 4 : 3;
        mask_of<T> on[4];
        T t[4];
        if constexpr (N == 4) {
            on[0] = in.v == T(0), on[1] = in.u == T(1), on[2] = in.v == T(1), on[3] = in.u == T(0);
            t[0] = in.u, t[1] = in.v, t[2] = T(1) - in.u, t[3] = T(1) - in.v;
        } else {
            on[0] = in.w == T(0), on[1] = in.u == T(0), on[2] = in.v == T(0);
            t[0] = in.v, t[1] = in.w, t[2] = in.u;
        }
        float3<T> p = Inside::template evaluate<T>(patch, in, false).position;
        for (int k = 0; k < N; ++k) {
            float3<T> const p0 = patch[k].position, p1 = patch[N + k].position;
            float3<T> const p2 = patch[2 * N + (k + 1) % N].position,
                            p3 = patch[(k + 1) % N].position;
            T const s = T(1) - t[k], ss = s * s, tt = t[k] * t[k];
            T const m = T(3) * T(s * t[k]);
            T const b0 = ss * s, b1 = m * s, b2 = m * t[k], b3 = tt * t[k];
            float3<T> q;
            if constexpr (kRule == EdgeRule::LeftToRight)
                q = b0 * p0 + b1 * p1 + b2 * p2 + b3 * p3;
            else
                q = (b0 * p0 + b3 * p3) + (b1 * p1 + b2 * p2);
            p = select(on[k], q, p);
        }
        return {float4<T>(p, T(1)), float3<T>(T(0), T(0), T(0))};
    }
};

template <EdgeRule kRule> double differing_share(Contraction contraction, float factor)
{
    Loaded const m = load_patches(test::shared("models/bigguy.obj").string());
    FrameSettings s;
    s.tess_factor = factor;
    s.machine.contraction = contraction;
    auto const replace = [&](DrawPass const& pass) -> std::shared_ptr<DomainProgram const> {
        if (pass.pipeline.desc().domain_shader->control_points() == 16)
            return make_domain_program(NaiveEdges<kRule, RegularQuadInside>{}, s.machine);
        return make_domain_program(NaiveEdges<kRule, GregoryQuadInside>{}, s.machine);
    };
    test::EdgeComparison const c =
        test::compare_edges(*m.mesh.mesh, *m.patches, s, ThreadPool(), replace);
    double const share = double(c.differing_edge_coordinates) / double(c.shared_edge_coordinates);
    std::printf("factor %g: %.1f %% of edge coordinates differ\n", double(factor), 100 * share);
    return share;
}

// Bounds: the measured shares of lanes_experiment (38.9 to 47.9 %, 16.8 to 28.8 %) with room for
// other meshes.
TEST(NaiveEdgeRule, LeftToRightSumsCrackThirtyToFiftyPercent)
{
    TESSEMU_NEEDS_SHARED("models/bigguy.obj");
    for (float factor : {4.0f, 7.3f, 16.0f, 64.0f}) {
        double const share = differing_share<EdgeRule::LeftToRight>(Contraction::None, factor);
        EXPECT_GE(share, 0.30) << factor;
        EXPECT_LE(share, 0.50) << factor;
    }
}

TEST(NaiveEdgeRule, MirrorPairsCrackTenToThirtyFivePercentWhenContracted)
{
    TESSEMU_NEEDS_SHARED("models/bigguy.obj");
    for (float factor : {4.0f, 7.3f, 16.0f, 64.0f}) {
        double const share = differing_share<EdgeRule::MirrorPairs>(Contraction::All, factor);
        EXPECT_GE(share, 0.10) << factor;
        EXPECT_LE(share, 0.35) << factor;
    }
}

TEST(NaiveEdgeRule, MirrorPairsHoldWithSeparateRounding)
{
    TESSEMU_NEEDS_SHARED("models/bigguy.obj");
    EXPECT_EQ(differing_share<EdgeRule::MirrorPairs>(Contraction::None, 16.0f), 0.0);
}

std::vector<std::vector<float>> interiors(PatchMesh const& patches, Machine const& machine)
{
    std::vector<std::vector<float>> out;
    FrameSettings s;
    s.tess_factor = 8;
    s.machine = machine;
    visit_surface(patches, s, ThreadPool(), [&](DrawPass const&, ShadedPatch const& p) {
        std::vector<float> inside;
        auto const& t = p.points->patch;
        for (std::size_t k = 0; k < t.points(); ++k)
            if (t.u[k] && t.v[k] && t.u[k] != kFixedOne && t.v[k] != kFixedOne)
                for (std::size_t c = 0; c < 3; ++c) inside.push_back(p.outputs[c * p.stride + k]);
        out.push_back(std::move(inside));
    });
    return out;
}

TEST(Contraction, EveryPolicyChangesTheInteriorOfNearlyEveryPatch)
{
    Loaded const m = load_patches("jug");
    auto const machines = contraction_policies();
    std::vector<std::vector<std::vector<float>>> results;
    for (std::size_t i = 0; i < 4; ++i) results.push_back(interiors(*m.patches, machines[i]));
    for (std::size_t i = 0; i < results.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            std::size_t changed = 0;
            for (std::size_t p = 0; p < results[i].size(); ++p)
                changed += results[i][p] != results[k][p];
            EXPECT_GE(changed, results[i].size() * 95 / 100) << "policies " << k << " and " << i;
        }
}

} // namespace
} // namespace tessemu
