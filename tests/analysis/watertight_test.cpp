// The checker finds every mistake that is planted, and nothing where there is none.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/watertight.h"

#include "analysis/mistakes.h"
#include "io/model.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/cages.h"
#include "tests/support/edges.h"
#include "tests/support/files.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
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
    Case(std::string const& model, std::string const& scheme) : Case(load_model(model).mesh, scheme)
    {
    }
    Case(ControlMesh cage, std::string const& scheme)
        : on_(test::build_watertight(find_scheme(scheme), std::move(cage)))
    {
        settings.frame.width = settings.frame.height = 256;
        settings.frame.tess_factor = 7.3f;
        settings.frame.camera = frame_points(mesh().positions, {0.4f, 0.3f, 1}, 1);
        settings.rays = 20000;
    }
    ControlMesh const& mesh() const { return on_.mesh->mesh(); }
    ControlMesh const& base() const { return on_.mesh->base(); }
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
        f.pose = std::make_shared<Pose>(SpineRig(c.base()).sway(0.3));
        Verdicts const v = c.check();
        expect_clean(v, name + ", displaced and animated");
        EXPECT_EQ(v.at("displaced").verdict, Verdict::Pass);
        f.displacement = {};
        if (scheme->info().tessellator) {
            f.adaptive = {AdaptiveFactors::Kind::Pixels, 6};
            expect_clean(c.check(), name + ", adaptive");
            f.adaptive = {};
        }
        c.settings.parity = 0.01f;
        expect_clean(c.check(), name + ", moved by parity");
    }
}

// Two closed cages of triangles: the spindle, and one of equal triangles.
std::vector<ControlMesh> triangle_cages()
{
    return {load_model("spindle").mesh, test::mesh_from(nlohmann::json::parse(test::read_text(
                                            test::golden("loop09/icosahedron.json"))))};
}

TEST(Watertight, SubstitutesPassInEveryPartitioningUnderEveryContraction)
{
    for (char const* scheme : {"pn-triangles", "phong", "flat"})
        for (ControlMesh const& cage : triangle_cages()) {
            Case c(cage, scheme);
            c.settings.rays = 2000;
            FrameSettings& f = c.settings.frame;
            std::size_t n = 0;
            for (Machine const& machine : test::contraction_policies())
                for (Partitioning p : {Partitioning::Integer, Partitioning::Pow2,
                                       Partitioning::FractionalOdd, Partitioning::FractionalEven}) {
                    if (!test::meets_case(machine, std::size_t(p), 4)) continue;
                    f.machine = machine;
                    f.partitioning = p;
                    f.adaptive = {}; // uniform, then every edge its own factor
                    expect_clean(c.check(), scheme + std::string(", uniform"));
                    f.adaptive = {AdaptiveFactors::Kind::Pixels, 6};
                    expect_clean(c.check(), scheme + std::string(", adaptive"));
                    ++n;
                }
            EXPECT_GE(n, 10u);
        }
}

// With its face's normal at all three corners a triangle lies in all three tangent planes, and every
// substitute is flat: shading breaks at each edge, positions differ by a rounding at most, and those
// of flat, which does not look at normals, not at all.
TEST(Watertight, OfFacesNormalsSubstitutesAreFacetsThatBreakTheNormalVerdict)
{
    for (std::string const scheme : {"pn-triangles", "phong", "flat"})
        for (ControlMesh const& cage : triangle_cages()) {
            SchemeOnMesh const on =
                build_scheme(find_scheme(scheme), cage, {.set = {{"normals", "faces"}}});
            WatertightSettings settings;
            settings.frame.tess_factor = 7.3f;
            settings.frame.camera = frame_points(cage.positions, {0.4f, 0.3f, 1}, 1);
            settings.rays = 0;
            auto const verdicts = check_watertight(*on.patches, settings, ThreadPool());
            EXPECT_EQ(verdicts[0].verdict, Verdict::Pass) << scheme; // topology
            EXPECT_EQ(verdicts[2].verdict, Verdict::Fail) << scheme; // normal
            EXPECT_EQ(verdicts[2].failures, verdicts[2].checked) << scheme;
            if (scheme != "pn-triangles") { // which may round either way
                EXPECT_EQ(verdicts[1].verdict, scheme == "flat" ? Verdict::Pass : Verdict::Fail)
                    << scheme;
            }
            // 16 units of 2^-24 of the largest coordinate, 2 here: more than any sum rounds by.
            visit_surface(*on.patches, settings.frame, ThreadPool(), [&](SurfacePatch const& p) {
                auto const face = cage.face(p.place().face);
                glm::dvec3 const a(cage.positions[face[0]]), b(cage.positions[face[1]]),
                    c(cage.positions[face[2]]), normal = normalize(cross(b - a, c - a));
                for (std::size_t i = 0; i < p.points(); ++i) {
                    EXPECT_NEAR(dot(glm::dvec3(p.vertex(i).position) - a, normal), 0, 0x1p-19)
                        << scheme;
                    EXPECT_NEAR(dot(glm::dvec3(p.vertex(i).normal), normal), 1, 1e-6) << scheme;
                }
            });
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

// A box of quads, or of quads with their own vertices.
ControlMesh box(glm::vec3 low, glm::vec3 high, bool own_vertices = false)
{
    static constexpr std::uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    ControlMesh m;
    auto const corner = [&](std::uint32_t v) {
        return glm::vec3(v & 1 ? high.x : low.x, v & 2 ? high.y : low.y, v & 4 ? high.z : low.z);
    };
    if (!own_vertices)
        for (std::uint32_t v = 0; v < 8; ++v) m.positions.push_back(corner(v));
    for (auto const& f : kFaces) {
        std::vector<std::uint32_t> face(f, f + 4);
        if (own_vertices)
            for (std::uint32_t& v : face) {
                m.positions.push_back(corner(v));
                v = std::uint32_t(m.positions.size() - 1);
            }
        m.add_face(face);
    }
    return m;
}

TEST(Watertight, NoVerdictPassesOnNothing)
{
    Case open(box(glm::vec3(-1), glm::vec3(1), true), "gregory-stencil");
    open.settings.frame.displacement =
        std::make_shared<Displacement>(Displacement::studs(0.2f, 0.02f));
    auto const all = check_watertight(open.patches(), open.settings, ThreadPool());
    EXPECT_FALSE(any_checked(all));
    for (CheckedVerdict const& v : all) {
        EXPECT_EQ(v.verdict, Verdict::Skipped) << v.name;
        EXPECT_EQ(v.checked, 0u) << v.name;
        EXPECT_NE(v.reason.find("24 open edges of the mesh lie on others with other vertices"),
                  std::string::npos)
            << v.name << ": " << v.reason;
    }
    // A factor of 1 puts no point inside an edge, and its corners are checked all the same.
    Case coarse("golem", "gregory-stencil");
    coarse.settings.frame.tess_factor = 1;
    Verdicts const v = coarse.check();
    EXPECT_EQ(v.at("topology").verdict, Verdict::Skipped);
    EXPECT_EQ(v.at("position").verdict, Verdict::Pass);
    expect_clean(v, "factor 1");
}

TEST(Watertight, CoverageIsSkippedWhereNoSampleIsCovered)
{
    Case c(box({-0.01f, -150, -0.01f}, {0.01f, 150, 0.01f}), "gregory-stencil"); // a mast
    Verdicts const v = c.check();
    EXPECT_EQ(v.at("coverage").verdict, Verdict::Skipped);
    EXPECT_EQ(v.at("coverage").reason, "no sample was covered");
    EXPECT_EQ(v.at("raycast").verdict, Verdict::Pass);
}

// Behind the eye the surface is cut off, and what is in front of it does not balance.
TEST(Watertight, CoverageIsSkippedWhereTheEyeIsInsideOrGeometryBehindIt)
{
    Case c("golem", "gregory-stencil");
    Camera& camera = c.settings.frame.camera;
    glm::vec3 const outside = camera.eye;
    for (glm::vec3 eye : {glm::vec3(0.1f, 0.2f, 0.1f), glm::vec3(-0.2f, 0.3f, 0)}) {
        camera.eye = eye;
        camera.target = {1, 0.3f, 0.5f};
        fit_depth_range(camera, c.mesh().positions);
        Verdicts const v = c.check();
        EXPECT_EQ(v.at("coverage").verdict, Verdict::Skipped);
        EXPECT_NE(v.at("coverage").reason.find("eye"), std::string::npos);
        EXPECT_EQ(v.at("raycast").verdict, Verdict::Pass);
        EXPECT_NE(v.at("raycast").reason.find("no picture is compared"), std::string::npos);
        EXPECT_TRUE(all_hold(check_watertight(c.patches(), c.settings, ThreadPool())));
    }
    camera.eye = outside; // all of it behind: nothing is seen
    camera.target = 2.0f * outside;
    EXPECT_EQ(c.check().at("coverage").verdict, Verdict::Skipped);
    camera.target = {0, 0, 0};
    // Through the middle of it: that cuts the picture, and coverage is counted without the plane.
    camera.near_plane = glm::length(outside);
    Verdicts const cut = c.check();
    EXPECT_EQ(cut.at("coverage").verdict, Verdict::Pass);
    EXPECT_EQ(cut.at("raycast").verdict, Verdict::Pass);
    EXPECT_NE(cut.at("raycast").reason.find("no picture is compared"), std::string::npos);
}

// Bodies where single precision keeps few bits of their size.
TEST(Watertight, NothingFailsFarFromTheOrigin)
{
    for (float far : {1e4f, 1e5f, 1e6f, 1e7f}) {
        glm::vec3 const middle(far, -0.7f * far, 0.4f * far);
        Case c(box(middle - 5.0f, middle + 5.0f), "gregory-stencil");
        Verdicts const v = c.check();
        expect_clean(v, std::to_string(far));
        EXPECT_EQ(v.at("raycast").verdict, Verdict::Pass) << far;
        EXPECT_EQ(v.at("raycast").reason.find("no picture is compared") == std::string::npos,
                  far < 1e5f)
            << v.at("raycast").reason;
    }
}

TEST(Watertight, NothingFailsOfTinyAndLargeBodies)
{
    for (int exponent : {-60, -40, -27, 0, 20, 40}) {
        float const size = std::ldexp(1.0f, exponent);
        Case c(box(glm::vec3(-size), glm::vec3(size)), "gregory-stencil");
        Verdicts const v = c.check();
        expect_clean(v, std::to_string(exponent));
        EXPECT_EQ(v.at("raycast").verdict, Verdict::Pass) << exponent;
        EXPECT_EQ(v.at("raycast").reason.find("Embree missed 0 rays"), 0u) << exponent;
    }
}

// Patches whose points have no normal.
class WithoutNormals final : public PatchMesh {
public:
    explicit WithoutNormals(PatchMesh const& patches, float normal)
        : PatchMesh(patches.shared_mesh()),
          patches_(patches),
          normal_(normal)
    {
    }
    CommandList commands(SurfaceSettings const& settings) const override
    {
        CommandList list = patches_.commands(settings);
        list.for_each_surface_draw([&](Draw& d) {
            d.pipeline.domain_epilog =
                bind_domain_epilog(Epilog{settings.view_projection, normal_}, settings.machine);
        });
        return list;
    }
    std::vector<PatchCount> patch_counts() const override { return patches_.patch_counts(); }

private:
    struct Epilog {
        template <class T> using Input = SurfacePoint<T>;
        template <class T> using Output = ShadedVertex<T>;
        Matrix4 view_projection = kIdentity;
        float normal = 0;
        template <class T>
        ShadedVertex<T> operator()(DomainInput<T> const&, SurfacePoint<T> const& s) const
        {
            return {transform(view_projection, s.position), {T(normal), T(normal), T(normal)}};
        }
    };
    PatchMesh const& patches_;
    float normal_;
};

TEST(Watertight, EqualZerosAndNansAreNoEqualNormals)
{
    Case c("golem", "gregory-stencil");
    c.settings.rays = 0;
    for (float normal : {0.0f, -0.0f, NAN, INFINITY}) {
        auto const verdicts =
            check_watertight(WithoutNormals(c.patches(), normal), c.settings, ThreadPool());
        CheckedVerdict const& v = verdicts[2];
        EXPECT_EQ(v.name, "normal");
        EXPECT_EQ(v.verdict, Verdict::Skipped) << normal;
        EXPECT_NE(v.reason.find("left out"), std::string::npos) << v.reason;
    }
    auto const verdicts =
        check_watertight(WithoutNormals(c.patches(), 1), c.settings, ThreadPool());
    EXPECT_EQ(verdicts[2].verdict, Verdict::Pass);
}

TEST(Mistakes, ThatCannotBeFoundAreSaidNotToBe)
{
    auto const why = [](Case const& c, Mistake m) {
        return why_not_found(m, check_watertight(c.patches(), c.settings, ThreadPool()));
    };
    Case open("jug", "gregory-stencil");
    for (Mistake m : {Mistake::Fold, Mistake::TopLeft}) {
        open.plant(m);
        EXPECT_NE(why(open, m).find("skipped, the surface is open"), std::string::npos)
            << why(open, m);
    }
    Case closed("golem", "gregory-stencil");
    closed.settings.rays = 2000;
    for (Mistake m : {Mistake::Order, Mistake::Contraction, Mistake::Fold, Mistake::TopLeft}) {
        closed.plant(m);
        EXPECT_EQ(why(closed, m), "") << name_of(m);
    }
    closed.settings.frame.tess_factor = 1;
    for (Mistake m : {Mistake::Order, Mistake::Contraction}) {
        closed.plant(m);
        EXPECT_NE(why(closed, m).find("the same bits"), std::string::npos) << name_of(m);
    }
    EXPECT_EQ(why(closed, Mistake::None), "");
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

// Of two-stage forms a vertex belongs to all patches, which have no weights of their own; cage forms
// have no weights at all, and no edges of the stencil forms' kind. Those mistakes are refused.
bool can_have(std::string const& scheme, Mistake mistake)
{
    static std::set<Mistake> const of_cage_form{Mistake::Order, Mistake::Contraction,
                                                Mistake::Normals, Mistake::Weights};
    static std::map<std::string, std::set<Mistake>> const without{
        {"gregory-two-stage", {Mistake::Weights}},
        {"pm", {Mistake::Weights}},
        {"pn-triangles", of_cage_form},
        {"phong", of_cage_form},
        {"flat", of_cage_form},
        {"tables-catmull-clark", of_cage_form},
        {"tables-loop", of_cage_form},
        {"tables-butterfly", of_cage_form},
        {"qas", of_cage_form},
        {"bolz",
         {Mistake::Order, Mistake::Contraction, Mistake::Factors, Mistake::Normals, Mistake::Fold,
          Mistake::Weights}}};
    auto const found = without.find(scheme);
    return found == without.end() || !found->second.count(mistake);
}

TEST(Watertight, EachMistakeFlipsTheVerdictsThatItMust)
{
    constexpr char const* kNames[] = {"topology",  "position", "normal",
                                      "displaced", "coverage", "raycast"};
    for (auto const& of : schemes()) {
        std::string const scheme = of->info().name;
        // One of those whose patches are triangles with no edges of their own.
        if (test::kSlow && !of->info().takes.quads && scheme != "tables-loop") continue;
        for (Expected const& e : kMatrix) {
            Case c(test::closed_cage_of(*of), scheme);
            c.settings.parity = e.parity;
            // Of one corner of one patch: a crack of a few pixels.
            if (e.mistake == Mistake::Weights)
                c.settings.frame.width = c.settings.frame.height = 512;
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

// Rays that run exactly through vertices, among them one whose neighbours all lie to one side.
TEST(RayCheck, BalancesAtVertices)
{
    RayMesh octahedron;
    octahedron.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    octahedron.triangles = {0, 1, 2, 1, 3, 2, 3, 4, 2, 4, 0, 2, 1, 0, 5, 3, 1, 5, 4, 3, 5, 0, 4, 5};
    RayCheck const c = check_rays(octahedron, RayAim::Vertices, 200000, 1, ThreadPool());
    EXPECT_GT(c.misses, 1000u) << "Embree loses rays at vertices"; // else little is decided exactly
    EXPECT_TRUE(c.confirmed.empty());
}

// A mesh on a lattice so coarse that every float involved is exact: in its own frame it is the same
// mesh wherever it lies and whatever its size, and so are the rays.
TEST(RayCheck, DoesNotDependOnWhereTheMeshLiesOrOnItsSize)
{
    RayMesh sphere = uv_sphere();
    for (glm::vec3& p : sphere.positions) p = glm::round(p * 1024.0f) / 1024.0f;
    ThreadPool const threads;
    RayCheck const here = check_rays(sphere, RayAim::Vertices, 10000, 3, threads);
    EXPECT_GT(here.misses, 0u);
    EXPECT_TRUE(here.confirmed.empty());
    auto const expect_same = [&](auto const& move, char const* what) {
        RayMesh moved = sphere;
        for (glm::vec3& p : moved.positions) p = move(p);
        RayCheck const there = check_rays(moved, RayAim::Vertices, 10000, 3, threads);
        EXPECT_EQ(there.misses, here.misses) << what;
        EXPECT_EQ(there.refuted, here.refuted) << what;
        EXPECT_EQ(there.folds, here.folds) << what;
        EXPECT_TRUE(there.confirmed.empty()) << what;
    };
    expect_same([](glm::vec3 p) { return p + glm::vec3(8192, -4096, 2048); }, "far");
    expect_same([](glm::vec3 p) { return p * 0x1p-90f; }, "tiny");
    expect_same([](glm::vec3 p) { return p * 0x1p90f; }, "huge");
    expect_same([](glm::vec3 p) { return 0x1p-60f * (p + glm::vec3(0, 4096, 0)); }, "both");
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
        int const seeds = test::kSlow ? 2 : 100;
        expect_clean(c.check(), std::string(scheme) + " on " + GetParam());
        c.settings.rays = 0;
        c.settings.frame.machine.contraction = Contraction::Mixed;
        glm::vec3 low(INFINITY), high(-INFINITY);
        for (glm::vec3 const& p : c.mesh().positions) low = min(low, p), high = max(high, p);
        float const size = glm::length(high - low);
        auto const map = std::make_shared<Displacement>(Displacement::studs(size / 16, size / 100));
        SpineRig const rig(c.base());
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

// Two-sided cards: the picture may show either sheet.
TEST(Watertight, SheetsThatLieOnEachOtherRaiseNoAlarm)
{
    ControlMesh flat = test::cube().mesh;
    for (glm::vec3& p : flat.positions) p.z = 0;
    ControlMesh thin = test::uv_sphere(12, 6).mesh;
    for (glm::vec3& p : thin.positions) p.z *= 1e-5f;
    for (ControlMesh const& mesh : {flat, thin}) {
        SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), mesh);
        WatertightSettings s;
        s.frame.width = s.frame.height = 96;
        s.frame.tess_factor = 5;
        s.frame.camera = frame_points(mesh.positions, {0.5f, 0.4f, 1}, 1);
        s.rays = 2000;
        for (CheckedVerdict const& v : check_watertight(*m.patches, s, ThreadPool(2)))
            EXPECT_NE(v.verdict, Verdict::Fail) << v.name << ": " << v.reason;
    }
}

} // namespace
} // namespace tessemu
