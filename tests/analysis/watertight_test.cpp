// The checker finds every mistake that is planted, and nothing where there is none.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/watertight.h"

#include "analysis/mistakes.h"
#include "io/model.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/cages.h"
#include "tests/support/files.h"
#include "tests/support/stencil_patch.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

namespace tessemu {
namespace {

class Case {
public:
    Case(std::string const& model, std::string const& scheme)
        : on_(build_scheme(find_scheme(scheme), load_model(model).mesh))
    {
        settings.frame.width = settings.frame.height = 256;
        settings.frame.tess_factor = 7.3f;
        settings.frame.camera = frame_points(mesh().positions, {0.4f, 0.3f, 1}, 1);
        settings.rays = 20000;
    }
    ControlMesh const& mesh() const { return on_.mesh->mesh(); }
    PatchMesh const& patches() const { return mistaken_ ? *mistaken_ : *on_.patches; }
    /// For the settings as they are.
    void plant(PlantedMistake const& mistake)
    {
        mistaken_ = with_mistake(*on_.patches, mistake, settings.frame);
    }
    void plant(Mistake kind) { plant(plant_mistake(*on_.mesh, kind)); }
    std::map<std::string, CheckedVerdict> check() const
    {
        std::map<std::string, CheckedVerdict> out;
        for (CheckedVerdict& v : check_watertight(patches(), settings, ThreadPool()))
            out[v.name] = std::move(v);
        return out;
    }

    WatertightSettings settings;

private:
    SchemeOnMesh on_;
    std::unique_ptr<PatchMesh> mistaken_;
};

using Verdicts = std::map<std::string, CheckedVerdict>;

void expect_clean(Verdicts const& verdicts, std::string const& what)
{
    for (auto const& [name, v] : verdicts) {
        EXPECT_NE(v.verdict, Verdict::Fail)
            << what << ": " << name << (v.sites.empty() ? "" : ": " + v.sites[0].text);
        if (v.verdict == Verdict::Skipped) {
            EXPECT_FALSE(v.reason.empty()) << name;
        } else {
            EXPECT_GT(v.checked, 0u) << what << ": " << name;
        }
    }
}

TEST(Watertight, EverySchemePassesPlainDisplacedAnimatedAndAdaptive)
{
    for (auto const& scheme : schemes()) {
        std::string const name = scheme->info().name;
        Case c(test::closed_cage_of(*scheme), name);
        FrameSettings& f = c.settings.frame;
        for (Contraction contraction : {Contraction::None, Contraction::All, Contraction::Mixed}) {
            f.machine.contraction = contraction;
            f.machine.seed = 11;
            Verdicts const v = c.check();
            expect_clean(v, name);
            EXPECT_EQ(v.at("displaced").verdict, Verdict::Skipped);
            EXPECT_EQ(v.at("coverage").verdict, Verdict::Pass);
            EXPECT_EQ(v.at("raycast").verdict, Verdict::Pass);
        }
        f.displacement = std::make_shared<Displacement>(Displacement::studs(0.2f, 0.02f));
        f.pose = std::make_shared<Pose>(SpineRig(c.mesh()).sway(0.3));
        Verdicts const v = c.check();
        expect_clean(v, name + ", displaced and animated");
        EXPECT_EQ(v.at("displaced").verdict, Verdict::Pass);
        f.displacement = {};
        f.adaptive = {AdaptiveFactors::Kind::Pixels, 6};
        expect_clean(c.check(), name + ", adaptive");
        f.adaptive = {};
        c.settings.parity = 0.01f;
        expect_clean(c.check(), name + ", moved by parity");
    }
}

TEST(Watertight, OpenSurfacesSkipWhatDoesNotApply)
{
    Case c("jug", "gregory-stencil");
    Verdicts const v = c.check();
    expect_clean(v, "jug");
    EXPECT_EQ(v.at("position").verdict, Verdict::Pass);
    EXPECT_EQ(v.at("coverage").verdict, Verdict::Skipped);
    EXPECT_EQ(v.at("raycast").verdict, Verdict::Skipped);
    EXPECT_NE(v.at("coverage").reason.find("open"), std::string::npos);
}

// F: must fail. P: must pass. '-': either; a crack of a last bit may fall between samples and rays.
// In the order topology, position, normal, displaced, coverage, raycast.
struct Expected {
    Mistake mistake;
    bool displaced;
    float parity;
    char const* verdicts;
};
constexpr Expected kMatrix[] = {
    {Mistake::Order, false, 0, "PFF---"},
    {Mistake::Order, false, 0.02f, "PFF-FF"},
    {Mistake::Order, true, 0, "PFFF--"},
    {Mistake::Contraction, false, 0, "PFP---"},
    {Mistake::Contraction, false, 0.02f, "PFP-FF"},
    {Mistake::Factors, false, 0, "FPP---"},
    {Mistake::Factors, true, 0.02f, "FPPPF-"},
    {Mistake::Normals, false, 0, "PPF-PP"},
    {Mistake::Normals, true, 0, "PPFF--"},
    {Mistake::Fold, false, 0, "PPP-FF"},
    {Mistake::Weights, false, 0, "PF----"},
    {Mistake::Weights, false, 0.05f, "PF--F-"},
    {Mistake::TopLeft, false, 0, "PPP-FP"},
};

// Of two-stage forms a vertex belongs to all patches, which have no weights of their own; phong has
// no weights at all, and edges that are no cubics. Those mistakes are refused.
bool can_have(std::string const& scheme, Mistake mistake)
{
    static std::map<std::string, std::set<Mistake>> const without{
        {"gregory-two-stage", {Mistake::Weights}},
        {"pm", {Mistake::Weights}},
        {"phong", {Mistake::Order, Mistake::Contraction, Mistake::Normals, Mistake::Weights}}};
    auto const found = without.find(scheme);
    return found == without.end() || !found->second.count(mistake);
}

TEST(Watertight, EachMistakeFlipsTheVerdictsThatItMust)
{
    constexpr char const* kNames[] = {"topology",  "position", "normal",
                                      "displaced", "coverage", "raycast"};
    for (auto const& of : schemes())
        for (Expected const& e : kMatrix) {
            std::string const scheme = of->info().name;
            Case c(test::closed_cage_of(*of), scheme);
            c.settings.parity = e.parity;
            if (e.displaced)
                c.settings.frame.displacement =
                    std::make_shared<Displacement>(Displacement::studs(0.2f, 0.05f));
            if (!can_have(scheme, e.mistake)) {
                EXPECT_THROW(c.plant(e.mistake), Error) << scheme << ", " << name_of(e.mistake);
                continue;
            }
            c.plant(e.mistake);
            Verdicts const v = c.check();
            for (std::size_t i = 0; i < 6; ++i) {
                Verdict const is = v.at(kNames[i]).verdict;
                std::string const what = scheme + ", " + std::string(name_of(e.mistake)) +
                                         (e.displaced ? ", displaced" : "") +
                                         (e.parity != 0 ? ", parity: " : ": ") + kNames[i];
                if (e.verdicts[i] == 'F') {
                    EXPECT_EQ(is, Verdict::Fail) << what;
                    EXPECT_FALSE(v.at(kNames[i]).sites.empty()) << what;
                }
                if (e.verdicts[i] == 'P') {
                    EXPECT_EQ(is, Verdict::Pass) << what;
                }
            }
        }
}

TEST(Mistakes, AreRefusedWhereTheyCannotBePlanted)
{
    Case c("golem", "gregory-two-stage");
    EXPECT_THROW(c.plant(Mistake::Weights), Error) << "its vertices belong to all patches";
    c.settings.frame.direct3d10 = true;
    EXPECT_THROW(c.plant(Mistake::Factors), Error) << "the tessellator's";
    EXPECT_THROW(c.plant(Mistake::Fold), Error);
    EXPECT_NO_THROW(c.plant(Mistake::Order));
    SchemeOnMesh const phong =
        build_scheme(find_scheme("phong"), test::mesh_from(nlohmann::json::parse(test::read_text(
                                               test::golden("loop09/tetrahedron.json")))));
    for (Mistake m : {Mistake::Order, Mistake::Contraction, Mistake::Normals, Mistake::Weights})
        EXPECT_THROW(with_mistake(*phong.patches, {m, 0}, {}), Error) << name_of(m);
    EXPECT_NO_THROW(with_mistake(*phong.patches, {Mistake::Fold, 0}, {}));
}

// A mistake that no patch has would read as one that the checker missed.
TEST(Mistakes, ArePlantedInAFaceThatIsDrawn)
{
    ControlMesh mesh = load_model("golem").mesh;
    for (std::uint32_t f = 0; f < 12; ++f) mesh.holes.push_back(f);
    for (char const* scheme : {"gregory-stencil", "gregory-two-stage"}) {
        SchemeOnMesh const on = build_scheme(find_scheme(scheme), mesh);
        for (Mistake m : {Mistake::Factors, Mistake::Fold, Mistake::Weights}) {
            EXPECT_THROW(with_mistake(*on.patches, {m, 3}, {}), Error) << name_of(m);
            PlantedMistake const planted = plant_mistake(*on.mesh, m);
            EXPECT_GE(planted.face, 12u);
            if (m == Mistake::Weights && scheme == std::string_view("gregory-two-stage")) continue;
            EXPECT_NO_THROW(with_mistake(*on.patches, planted, {})) << name_of(m);
        }
    }
}

TEST(Watertight, AFailureNamesPatchesEdgeValuesAndDistance)
{
    Case c("golem", "gregory-stencil");
    c.settings.rays = 0;
    c.plant(Mistake::Order);
    Verdicts const order = c.check();
    EXPECT_EQ(order.at("raycast").verdict, Verdict::Skipped);
    CrackSite const& site = order.at("position").sites.at(0);
    EXPECT_NE(site.face[0], site.face[1]);
    EXPECT_LT(site.vertex[0], site.vertex[1]);
    // Both values, and how many floats it is from one to the other.
    EXPECT_NE(site.bits[0], site.bits[1]);
    float const from = std::bit_cast<float>(site.bits[0]), to = std::bit_cast<float>(site.bits[1]);
    std::uint64_t steps = 0;
    for (float at = from; at != to && steps <= site.ulp; ++steps) at = std::nextafter(at, to);
    EXPECT_EQ(site.ulp, steps) << site.text;
    char values[64];
    std::snprintf(values, sizeof values, "0x%08x and 0x%08x, %u ulp", unsigned(site.bits[0]),
                  unsigned(site.bits[1]), unsigned(site.ulp));
    EXPECT_NE(site.text.find(values), std::string::npos) << site.text;

    // Mistakes of one patch are found at that patch and nowhere else.
    for (Mistake m : {Mistake::Factors, Mistake::Weights}) {
        c.plant({m, 30});
        Verdicts const v = c.check();
        CheckedVerdict const& failed = v.at(m == Mistake::Factors ? "topology" : "position");
        ASSERT_EQ(failed.verdict, Verdict::Fail) << name_of(m);
        std::set<std::uint32_t> const corners = [&] {
            auto const face = c.mesh().face(30);
            return std::set<std::uint32_t>(face.begin(), face.end());
        }();
        for (CrackSite const& s : failed.sites)
            EXPECT_TRUE(corners.count(s.vertex[0]) && corners.count(s.vertex[1])) << s.text;
    }
    c.plant(Mistake::Fold);
    ColorTarget const picture =
        draw_cracks(c.patches(), c.settings,
                    check_watertight(c.patches(), c.settings, ThreadPool()), ThreadPool());
    std::size_t red = 0;
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) {
            auto const p = picture.load(x, y);
            red += p[0] > 0.85f && p[1] < 0.1f;
        }
    EXPECT_GT(red, 20u);
}

// 400 x 200: 79,602 vertices, 159,200 triangles.
RayMesh uv_sphere()
{
    constexpr int kAround = 400, kRows = 200;
    RayMesh m;
    auto const point = [&](int i, int j) {
        double const a = 2 * M_PI * i / kAround, b = M_PI * j / kRows;
        return glm::vec3(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b));
    };
    m.positions.push_back(point(0, 0));
    for (int j = 1; j < kRows; ++j)
        for (int i = 0; i < kAround; ++i) m.positions.push_back(point(i, j));
    m.positions.push_back(point(0, kRows));
    auto const id = [&](int i, int j) {
        return j == 0       ? 0u
               : j == kRows ? std::uint32_t(m.positions.size() - 1)
                            : std::uint32_t(1 + (j - 1) * kAround + i % kAround);
    };
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kAround; ++i) {
            if (j + 1 < kRows)
                m.triangles.insert(m.triangles.end(), {id(i, j), id(i, j + 1), id(i + 1, j + 1)});
            if (j > 0)
                m.triangles.insert(m.triangles.end(), {id(i, j), id(i + 1, j + 1), id(i + 1, j)});
        }
    return m;
}

TEST(RayCheck, FindsOneDeletedTriangleOfASphere)
{
    RayMesh sphere = uv_sphere();
    ASSERT_EQ(sphere.positions.size(), 79602u);
    ASSERT_EQ(sphere.triangles.size(), 3 * 159200u);
    ThreadPool const threads;
    RayCheck const whole = check_rays(sphere, RayAim::Inside, 500000, 1, threads);
    EXPECT_TRUE(whole.confirmed.empty());
    // Near the equator, where triangles are largest.
    std::size_t const deleted = 3 * 80000;
    glm::vec3 const at = (sphere.positions[sphere.triangles[deleted]] +
                          sphere.positions[sphere.triangles[deleted + 1]] +
                          sphere.positions[sphere.triangles[deleted + 2]]) /
                         3.0f;
    sphere.triangles.erase(sphere.triangles.begin() + std::ptrdiff_t(deleted),
                           sphere.triangles.begin() + std::ptrdiff_t(deleted + 3));
    // Rays at the segments around the hole enter it, since they aim beside it by a rounding, and
    // rays at what lies behind it.
    for (std::size_t i = 0; i + 2 < sphere.triangles.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            sphere.targets.insert(sphere.targets.end(),
                                  {sphere.triangles[i + k], sphere.triangles[i + (k + 1) % 3]});
    RayCheck const holed = check_rays(sphere, RayAim::Segments, 2000000, 1, threads);
    ASSERT_FALSE(holed.confirmed.empty());
    for (RayMiss const& m : holed.confirmed)
        EXPECT_LT(glm::length(m.target - at), 0.03f) << "two triangles' size";
}

TEST(RayCheck, RaysAtVerticesAccuseEmbreeNotTheSurface)
{
    RayCheck const c = check_rays(uv_sphere(), RayAim::Vertices, 100000, 1, ThreadPool());
    EXPECT_GT(c.misses, 100u) << "Embree loses rays at vertices";
    EXPECT_EQ(c.misses, c.refuted + c.folds + c.past);
    EXPECT_TRUE(c.confirmed.empty());
    EXPECT_GT(c.refuted, c.misses / 2);
}

// Two triangles side by side, seen head on: what the picture shows must be what rays hit, or lie
// beside an edge.
TEST(Visibility, ExplainsEdgesAndNothingElse)
{
    RayMesh m;
    m.positions = {{-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {1, 1, 0}};
    m.triangles = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
    std::vector<std::uint32_t> const face{7, 7, 9, 9};
    Camera camera;
    camera.eye = {0, 0, 4};
    constexpr int kSize = 64;
    auto const seen = [&](int shift) { // the left half shows face 7, the right one face 9
        std::vector<std::int64_t> out;
        float const half = camera.focal / 4 * kSize / 2; // of a unit at the target, in pixels
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                float const px = float(x - shift) + 0.5f - kSize / 2,
                            py = float(y) + 0.5f - kSize / 2;
                bool const inside = std::abs(px) < half && std::abs(py) < half;
                out.push_back(!inside ? -1 : px < 0 ? 7 : 9);
            }
        return out;
    };
    ThreadPool const threads;
    VisibilityCheck const good = check_visibility(m, face, seen(0), camera, kSize, kSize, threads);
    EXPECT_GT(good.pixels, 1000u);
    EXPECT_TRUE(good.unexplained.empty());
    VisibilityCheck const bad = check_visibility(m, face, seen(1), camera, kSize, kSize, threads);
    EXPECT_GT(bad.unexplained.size(), 30u) << "a column of pixels shows the wrong face";
}

TEST(RayCheck, DoesNotDependOnThreads)
{
    RayMesh const sphere = uv_sphere();
    RayCheck const a = check_rays(sphere, RayAim::Vertices, 20000, 5, ThreadPool(1)),
                   b = check_rays(sphere, RayAim::Vertices, 20000, 5, ThreadPool(3));
    EXPECT_EQ(a.misses, b.misses);
    EXPECT_EQ(a.refuted, b.refuted);
    EXPECT_THROW(check_rays({}, RayAim::Inside, 1, 1, ThreadPool(1)), Error);
}

class OnModels : public testing::TestWithParam<char const*> {};
TEST_P(OnModels, GregorySchemesPassUnderAHundredContractions)
{
    std::string const file = std::string("models/") + GetParam() + ".obj";
    TESSEMU_NEEDS_SHARED(file);
    for (char const* scheme : {"gregory-stencil", "gregory-two-stage"}) {
        Case c(test::shared(file).string(), scheme);
        c.settings.frame.tess_factor = 3.4f;
        c.settings.rays = 2000;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        int const seeds = 2;
#else
        int const seeds = 100;
#endif
        expect_clean(c.check(), std::string(scheme) + " on " + GetParam());
        c.settings.rays = 0;
        c.settings.frame.machine.contraction = Contraction::Mixed;
        glm::vec3 low(INFINITY), high(-INFINITY);
        for (glm::vec3 const& p : c.mesh().positions) low = min(low, p), high = max(high, p);
        float const size = glm::length(high - low);
        auto const map = std::make_shared<Displacement>(Displacement::studs(size / 16, size / 100));
        SpineRig const rig(c.mesh());
        FrameSettings& f = c.settings.frame;
        for (int seed = 0; seed < seeds; ++seed) { // plain, displaced, animated, adaptive in turn
            f.machine.seed = std::uint64_t(seed);
            f.displacement = seed % 4 == 1 ? map : nullptr;
            f.pose = seed % 4 == 2 ? std::make_shared<Pose>(rig.sway(seed * 0.01)) : nullptr;
            f.adaptive = {
                seed % 4 == 3 ? AdaptiveFactors::Kind::Pixels : AdaptiveFactors::Kind::None, 8};
            expect_clean(c.check(), std::string(scheme) + " on " + GetParam());
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Shared, OnModels,
                         testing::Values("bigguy", "monsterfrog", "spot_control", "two_hole",
                                         "suzanne"),
                         [](auto const& test) { return std::string(test.param); });

} // namespace
} // namespace tessemu
