// What a scheme says of itself holds: its meshes, its parameters.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/scheme.h"

#include "io/model.h"
#include "pipeline/frame.h"
#include "tests/support/random_mesh.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>

#include <set>

namespace tessemu {
namespace {

class Sample final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{"sample", "-", "-", "a number and a word"};
        info.parameters = {{"gain", "a factor", 0.5, -1, 2.25},
                           {"rule", "how", 0, 0, 0, {"mean", "longest", "none"}},
                           {"free", "any number", 7},
                           {"reach", "how far, if at all", {}, 0, 8}};
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const>, Parameters const&,
                                     BuildServices const&) const override
    {
        return nullptr;
    }
};

std::string refusal(ParameterTexts const& given)
{
    try {
        resolve_parameters(Sample().info(), given);
    } catch (Error const& e) {
        return e.what();
    }
    return "";
}

TEST(SchemeParameters, DefaultsAreTheNumberAndTheFirstWord)
{
    Parameters const p = resolve_parameters(Sample().info(), {});
    EXPECT_EQ(p.number("gain"), 0.5);
    EXPECT_EQ(p.word("rule"), "mean");
    EXPECT_EQ(p.number("free"), 7);
    EXPECT_EQ(p.values().size(), 3u);
}

TEST(SchemeParameters, OneWithoutADefaultHasNoValueUnlessItIsGiven)
{
    Parameters const without = resolve_parameters(Sample().info(), {});
    EXPECT_FALSE(without.number_if_given("reach"));
    EXPECT_EQ(without.values().count("reach"), 0u);
    Parameters const with = resolve_parameters(Sample().info(), {{"reach", "2.5"}});
    EXPECT_EQ(with.number_if_given("reach"), 2.5);
    EXPECT_EQ(with.number_if_given("gain"), 0.5);
    EXPECT_EQ(refusal({{"reach", "-1"}}), "sample: reach is '-1', it must be a number from 0 to 8");
}

TEST(SchemeParameters, GivenOnesReplaceTheirDefaultsAlone)
{
    Parameters const p = resolve_parameters(Sample().info(), {{"gain", "-1"}, {"rule", "none"}});
    EXPECT_EQ(p.number("gain"), -1);
    EXPECT_EQ(p.word("rule"), "none");
    EXPECT_EQ(p.number("free"), 7);
    EXPECT_EQ(resolve_parameters(Sample().info(), {{"free", "1e300"}}).number("free"), 1e300);
    EXPECT_NE(refusal({{"gain", "2.25"}, {"rule", "none"}, {"gain", "-1"}}), "");
}

TEST(SchemeParameters, RefusalsNameTheParameterTheValueAndWhatIsAllowed)
{
    EXPECT_EQ(
        refusal({{"glow", "1"}}),
        "sample has no parameter 'glow'; there is gain, rule, free, reach, sort, coordinates");
    for (char const* text : {"", "one", "1x", "0x1", "1 ", " 1", "1,5"})
        EXPECT_EQ(refusal({{"gain", text}}),
                  "sample: gain is '" + std::string(text) + "', it must be a number");
    for (char const* text : {"-1.0001", "2.2500001", "1e9", "inf", "-inf", "nan"})
        EXPECT_EQ(refusal({{"gain", text}}), "sample: gain is '" + std::string(text) +
                                                 "', it must be a number from -1 to 2.25");
    for (char const* text : {"", "Mean", "median", "0"})
        EXPECT_EQ(refusal({{"rule", text}}),
                  "sample: rule is '" + std::string(text) + "', it must be mean, longest or none");
    EXPECT_NE(refusal({{"free", "nan"}}), "");
}

TEST(Schemes, NamesAreUniqueAndFound)
{
    std::set<std::string> names;
    for (auto const& scheme : schemes()) {
        SchemeInfo const info = scheme->info();
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_EQ(&find_scheme(info.name), scheme.get());
        EXPECT_FALSE(info.summary.empty());
        std::set<std::string> parameters;
        for (SchemeParameter const& p : info.parameters) {
            EXPECT_TRUE(parameters.insert(p.name).second) << info.name << ": " << p.name;
            EXPECT_FALSE(p.meaning.empty()) << info.name << ": " << p.name;
            if (!p.words.empty()) continue;
            EXPECT_GE(p.default_value.value_or(p.min), p.min) << info.name << ": " << p.name;
            EXPECT_LE(p.default_value.value_or(p.max), p.max) << info.name << ": " << p.name;
        }
    }
    try {
        find_scheme("bezier");
        FAIL();
    } catch (Error const& e) {
        std::string const what = e.what();
        EXPECT_NE(what.find("'bezier'"), std::string::npos);
        for (std::string const& name : names) EXPECT_NE(what.find(name), std::string::npos) << what;
    }
}

struct Sides {
    bool triangles = false, quads = false, polygons = false;
};
Sides sides_of(ControlMesh const& mesh)
{
    Sides s;
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        std::size_t const n = mesh.face(f).size();
        (n == 3 ? s.triangles : n == 4 ? s.quads : s.polygons) = true;
    }
    return s;
}

// Whether a scheme says that it takes a mesh: one of triangles cuts all others' faces.
bool takes(MeshRequirements const& t, ControlMesh const& mesh, int subdivide)
{
    Sides s = sides_of(mesh);
    if (!t.quads)
        s = {true, false, false};
    else if (subdivide + (s.polygons ? t.steps_with_polygons : t.steps) > 0)
        s = {false, true, false};
    bool const open = summarize(Topology(mesh)).boundary_edges > 0;
    return !s.polygons && (t.quads || !s.quads) && (t.triangles || !s.triangles) &&
           (t.boundary || !open);
}

TEST(Schemes, DrawTheMeshesTheySayAndNameOthersForTheRest)
{
    struct Mesh {
        std::string name;
        ControlMesh mesh;
    };
    std::vector<Mesh> meshes;
    for (char const* model : {"golem", "spindle", "saddle_star", "jug"})
        meshes.push_back({model, load_model(model).mesh});
    meshes.push_back({"prism", test::prism(5)});
    meshes.push_back({"joined jug", test::join_faces(load_model("jug").mesh, 3)});
    ControlMesh open = load_model("spindle").mesh; // triangles alone, open
    open.face_start.pop_back();
    open.face_vertices.resize(open.face_start.back());
    meshes.push_back({"open spindle", open});
    if (test::kSlow) meshes.erase(meshes.begin() + 2, meshes.end() - 2);
    std::size_t drawn = 0, refused = 0;
    for (auto const& [name, mesh] : meshes)
        for (int steps : {0, 1}) {
            if (test::kSlow && steps) continue;
            std::vector<std::string> others;
            for (auto const& scheme : schemes())
                if (takes(scheme->info().takes, mesh, steps)) others.push_back(scheme->info().name);
            for (auto const& scheme : schemes()) {
                SchemeInfo const info = scheme->info();
                SCOPED_TRACE(info.name + " on " + name + ", " + std::to_string(steps) + " steps");
                if (takes(info.takes, mesh, steps)) {
                    SchemeOnMesh const m = build_scheme(*scheme, mesh, {.subdivide = steps});
                    std::set<std::uint32_t> faces;
                    std::size_t patches = 0;
                    visit_surface(*m.patches, {}, ThreadPool(1), [&](SurfacePatch const& p) {
                        faces.insert(p.place().face);
                        ++patches;
                        EXPECT_FALSE(p.triangles().empty());
                    });
                    EXPECT_EQ(faces.size(), m.mesh->base().faces());
                    EXPECT_EQ(patches, m.mesh->mesh().faces());
                    EXPECT_EQ(patches, m.patches->commands({}).patches());
                    std::size_t counted = 0;
                    for (PatchCount const& c : m.patches->patch_counts()) counted += c.patches;
                    EXPECT_EQ(patches, counted);
                    ++drawn;
                    continue;
                }
                try {
                    build_scheme(*scheme, mesh, {.subdivide = steps});
                    ADD_FAILURE() << "is drawn";
                } catch (MeshError const& e) {
                    std::string const what = e.what();
                    EXPECT_EQ(what.find(info.name + " draws "), 0u) << what;
                    std::string list;
                    for (std::string const& other : others)
                        list += (list.empty() ? "" : ", ") + other;
                    ASSERT_FALSE(others.empty());
                    std::string const end = "; schemes that draw this mesh: " + list;
                    EXPECT_EQ(what.substr(what.size() - std::min(what.size(), end.size())), end);
                    ++refused;
                }
            }
        }
    EXPECT_GT(drawn, 20u);
    EXPECT_GT(refused, test::kSlow ? 3u : 5u); // with sanitizers of four meshes, not of seven
}

TEST(Schemes, TagsThatAreNotHonouredAreWarnedOf)
{
    for (auto const& scheme : schemes()) {
        SchemeInfo const info = scheme->info();
        for (bool tagged : {false, true}) {
            ControlMesh mesh = load_model("golem").mesh;
            if (!takes(info.takes, mesh, 0)) mesh = load_model("spindle").mesh;
            if (!takes(info.takes, mesh, 0)) continue;
            auto const face = mesh.face(0);
            if (tagged) {
                mesh.creases = {{face[0], face[1], 2}, {face[1], face[2], 10}};
                mesh.corners = {{face[0], 3}};
            }
            std::size_t creases = 0, corners = 0;
            for (std::string const& w : build_scheme(*scheme, mesh).warnings) {
                bool const helps =
                    w.ends_with("; bolz, tables-catmull-clark, tables-loop draw them");
                creases += helps && w.starts_with("2 crease edges are drawn smooth");
                corners += helps && w.starts_with("1 sharp corner is drawn smooth");
            }
            EXPECT_EQ(creases, tagged && !info.takes.creases ? 1u : 0u) << info.name;
            EXPECT_EQ(corners, tagged && !info.takes.corners ? 1u : 0u) << info.name;
        }
    }
}

TEST(Schemes, RequirementsInWords)
{
    MeshRequirements t;
    EXPECT_EQ(in_words(t), "quads and triangles, larger faces after 1 step of subdivision; "
                           "creases and corners are drawn smooth");
    t.steps_with_polygons = 0;
    EXPECT_EQ(in_words(t), "quads and triangles; creases and corners are drawn smooth");
    t.triangles = t.boundary = false;
    t.creases = true;
    EXPECT_EQ(in_words(t), "quads, closed meshes only; corners are drawn smooth");
    t.corners = true;
    EXPECT_EQ(in_words(t), "quads, closed meshes only");
    t.steps = 2;
    EXPECT_EQ(in_words(t), "quads, after 2 steps of subdivision, closed meshes only");
}

} // namespace
} // namespace tessemu
