// Same input, same bytes: threads and the form of the machine change neither picture nor counters.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/colored_mesh.h"
#include "pipeline/forms/cage_form.h"
#include "pipeline/frame.h"
#include "pipeline/mesh/builtin_models.h"
#include "pipeline/schemes/scheme.h"
#include "shaders_cpp/pixel/id_view.h"
#include "tests/support/machines.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

namespace tessemu {
namespace {

struct Bytes {
    std::string pixels;
    DrawStatistics statistics;
    std::vector<CommandStatistics> commands;
};

Bytes bytes_of(ColorTarget const& color, DepthTarget const& depth, FrameSettings const& s,
               DrawStatistics const& statistics, std::vector<CommandStatistics> const& commands)
{
    Bytes out{{}, statistics, commands};
    for (int y = 0; y < s.height; ++y) {
        out.pixels.append(reinterpret_cast<char const*>(color.texel(0, y)), color.row_bytes());
        out.pixels.append(reinterpret_cast<char const*>(depth.codes() + depth.index(0, y)),
                          std::size_t(s.width * s.samples) * 4);
    }
    return out;
}

Bytes draw_bytes(PatchMesh const& patches, FrameSettings s, int threads, Machine const& machine)
{
    s.machine = machine;
    Frame const f = draw_frame(patches, s, ThreadPool(threads));
    return bytes_of(f.color, f.depth, s, f.statistics, f.commands);
}

FrameSettings settings_for(SchemeOnMesh const& m)
{
    FrameSettings s;
    s.width = 150;
    s.height = 110;
    s.tess_factor = 5.7f;
    s.camera = frame_points(m.mesh->mesh().positions, {0.5f, 0.4f, 1}, 150.0f / 110);
    return s;
}

void expect_equal(Bytes const& a, Bytes const& b)
{
    ASSERT_TRUE(a.pixels == b.pixels);
    ASSERT_EQ(a.statistics, b.statistics);
    ASSERT_EQ(a.commands.size(), b.commands.size());
    for (std::size_t i = 0; i < a.commands.size(); ++i) {
        ASSERT_EQ(a.commands[i].name, b.commands[i].name);
        ASSERT_EQ(a.commands[i].number, b.commands[i].number);
        ASSERT_EQ(a.commands[i].statistics, b.commands[i].statistics) << a.commands[i].name;
    }
}

TEST(Determinism, PictureAndCountersDoNotDependOnThreadsLanesOrForm)
{
    for (char const* name : {"jug", "spindle", "saddle_star"})
        for (Contraction contraction : {Contraction::None, Contraction::All, Contraction::Mixed}) {
            SchemeOnMesh const m =
                build_scheme(find_scheme("gregory-stencil"), load_model(name).mesh);
            std::vector<Machine> const machines = test::machines(contraction, 3);
            FrameSettings const s = settings_for(m);
            Bytes const first = draw_bytes(*m.patches, s, 1, machines[0]);
            for (int threads : {1, 2, 3, 8})
                for (Machine const& machine : machines) {
                    SCOPED_TRACE(std::string(name) + " -j " + std::to_string(threads) + " " +
                                 testing::PrintToString(machine));
                    expect_equal(first, draw_bytes(*m.patches, s, threads, machine));
                    if (HasFatalFailure()) return;
                }
        }
}

struct Variant {
    std::string name;
    std::function<void(FrameSettings&)> set;
};

// All that a frame can ask for.
std::vector<Variant> frame_variants()
{
    std::vector<Variant> variants;
    for (View view : kViews)
        variants.push_back({std::string(name_of(view)), [=](FrameSettings& s) { s.view = view; }});
    variants.push_back({"4 samples", [](FrameSettings& s) { s.samples = 4; }});
    variants.push_back({"4 samples, wire", [](FrameSettings& s) {
                            s.samples = 4;
                            s.view = View::Wire;
                        }});
    variants.push_back({"true normals", [](FrameSettings& s) { s.true_normals = true; }});
    variants.push_back({"by pixels", [](FrameSettings& s) {
                            s.adaptive = {AdaptiveFactors::Kind::Pixels, 5};
                        }});
    variants.push_back({"by distance", [](FrameSettings& s) {
                            s.adaptive = {AdaptiveFactors::Kind::Distance, 2.5f};
                        }});
    variants.push_back({"direct3d10", [](FrameSettings& s) { s.direct3d10 = true; }});
    return variants;
}

struct Cage {
    std::string name;
    ControlMesh mesh;
};

// Quads, triangles and both, with and without a boundary.
std::vector<Cage> cages()
{
    std::vector<Cage> out;
    for (BuiltinModel const& model : builtin_models())
        out.push_back({std::string(model.name), load_model(std::string(model.name)).mesh});
    out.push_back({"open spindle", load_model("spindle").mesh}); // without its last triangle
    ControlMesh& open = out.back().mesh;
    open.face_start.pop_back();
    open.face_vertices.resize(open.face_start.back());
    return out;
}

void expect_equal_on_all_machines(PatchMesh const& patches, FrameSettings const& s,
                                  std::set<std::string>& stages)
{
    std::vector<Machine> const machines = test::machines();
    Bytes const first = draw_bytes(patches, s, 1, machines[0]);
    EXPECT_GT(first.statistics.pipeline.PSInvocations, 0u);
    for (StageStatistics const& stage : first.statistics.stages) stages.insert(stage.stage);
    for (std::size_t i = 1; i < machines.size(); ++i) {
        SCOPED_TRACE(testing::PrintToString(machines[i]));
        expect_equal(first, draw_bytes(patches, s, 2, machines[i]));
        if (testing::Test::HasFatalFailure()) return;
    }
}

// The checking machine is compiled apart from the fast one, from the same text: each is the other's
// oracle, for every stage of every scheme and for all that a frame can ask for. A scheme has
// shaders for each kind of patch, with branches for boundaries: every cage is drawn that shows a
// kind which the cages before it did not show, or show with a boundary.
TEST(Determinism, TheCheckingMachineHasTheFastOnesBitsAndCountsInEveryStageOfEveryScheme)
{
    constexpr char const* kStages[] = {"input_assembler", "vertex_shader",   "hull_shader",
                                       "domain_shader",   "geometry_shader", "pixel_shader",
                                       "compute_shader"};
    std::set<std::string> stages;
    struct Drawn {
        Scheme const* scheme;
        ParameterTexts set;
    };
    std::vector<Drawn> ways; // those with shared edges of their own too
    for (auto const& scheme : schemes()) {
        ways.push_back({scheme.get(), {}});
        SchemeInfo const info = scheme->info();
        ParameterTexts const set = info.watertight_with;
        if (resolve_parameters(info, set).values() != resolve_parameters(info, {}).values())
            ways.push_back({scheme.get(), set});
    }
    for (auto const& [scheme, set] : ways) {
        std::set<std::pair<std::string, bool>> shown; // kind of patch, on an open mesh
        std::set<std::size_t> sides;
        for (Cage const& cage : cages()) {
            SchemeOnMesh m;
            try {
                m = build_scheme(*scheme, cage.mesh, {.set = set});
            } catch (MeshError const&) { // does not take it, see schemes_test.cpp
                continue;
            }
            bool const open = summarize(m.mesh->topology()).boundary_edges > 0;
            std::size_t const before = shown.size();
            for (PatchCount const& c : m.patches->patch_counts()) shown.insert({c.kind.name, open});
            if (shown.size() == before) continue;
            for (std::size_t f = 0; f < m.mesh->mesh().faces(); ++f)
                sides.insert(m.mesh->mesh().face(f).size());
            std::shared_ptr<Displacement const> maps[] = {
                nullptr, std::make_shared<Displacement>(Displacement::studs(0.2f, 0.05f)), nullptr};
            if (!m.mesh->base().coordinates.empty()) {
                HeightImage image{{}, 8, 8};
                for (int i = 0; i < 64; ++i) image.heights.push_back(float(i * 37 % 64) / 64);
                maps[2] = std::make_shared<Displacement>(m.mesh, image, 0.05f);
            }
            auto const pose = std::make_shared<Pose>(SpineRig(m.mesh->base()).sway(0.3));
            bool curved = false; // else the curvature view is refused, and of a displaced surface
            SurfaceSettings with_curvature;
            with_curvature.curvature = true;
            m.patches->commands(with_curvature).for_each_surface_draw([&](Draw const& d) {
                curved = curved || d.has_curvature();
            });
            std::vector<Variant> variants = frame_variants();
            if (!set.empty()) // pixels do not know how edges were made
                std::erase_if(variants, [](Variant const& v) {
                    return v.name != "lit" && v.name != "curvature" && v.name != "direct3d10";
                });
            if (!scheme->info().tessellator) // whose patches SV_PrimitiveID does not tell
                std::erase_if(variants, [](Variant const& v) {
                    return v.name == "valence" || v.name == "direct3d10" || v.name == "by pixels" ||
                           v.name == "by distance";
                });
            std::size_t run = 0;
            for (Variant const& v : variants)
                for (auto const& map : maps)
                    for (bool moved : {false, true}) {
                        if (!map && &map != maps) continue;
                        if (test::kSlow && run++ % 11) continue;
                        FrameSettings s = settings_for(m);
                        s.displacement = map;
                        if (moved) s.pose = pose;
                        v.set(s);
                        if (s.view == View::Curvature && (map || !curved)) continue;
                        SCOPED_TRACE(scheme->info().name + (set.empty() ? "" : ", shared edges") +
                                     " on " + cage.name + ", " + v.name +
                                     (map ? ", displaced" : "") + (moved ? ", in a pose" : ""));
                        expect_equal_on_all_machines(*m.patches, s, stages);
                        if (HasFatalFailure()) return;
                    }
        }
        SchemeInfo const info = scheme->info();
        EXPECT_FALSE(shown.empty()) << info.name << " takes no cage";
        bool const keeps = info.takes.steps == 0 || info.takes.step.keeps_triangles;
        EXPECT_EQ(sides.count(3) > 0, info.takes.triangles && keeps) << info.name;
        EXPECT_EQ(sides.count(4) > 0, info.takes.quads) << info.name;
        EXPECT_EQ(std::any_of(shown.begin(), shown.end(), [](auto const& s) { return s.second; }),
                  info.takes.boundary)
            << info.name;
    }
    for (char const* stage : kStages) EXPECT_EQ(stages.count(stage), 1u) << stage;
}

// No scheme draws quads in cage form.
struct BilinearQuad {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 4;
    template <class T> using ControlPoint = NormalVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>;
    template <class T> using Output = SurfacePoint<T>;
    template <class T>
    SurfacePoint<T> operator()(DomainInput<T> const& in,
                               ControlPoints<NormalVertex<T>> const& patch,
                               ControlPoints<ControlVertex<T>> const&) const
    {
        NormalVertex<T> const a = patch[0], b = patch[1], c = patch[2], d = patch[3];
        T const U = T(1) - in.u, V = T(1) - in.v;
        float3<T> const p = V * float3<T>(U * a.position + in.u * b.position) +
                            in.v * float3<T>(U * d.position + in.u * c.position);
        float3<T> const n = V * float3<T>(U * a.normal + in.u * b.normal) +
                            in.v * float3<T>(U * d.normal + in.u * c.normal);
        return {p, unit_or_zero(n)};
    }
};

class BilinearQuads final : public CageForm {
public:
    explicit BilinearQuads(std::shared_ptr<RefinedMesh const> mesh) : CageForm(std::move(mesh)) {}

private:
    DomainShader domain_shader(int, SurfaceSettings const& s) const override
    {
        return bind_domain_shader(BilinearQuad{}, s.machine);
    }
};

TEST(Determinism, TheCheckingMachineHasTheFastOnesBitsAndCountsOnQuadsInCageForm)
{
    SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), load_model("golem").mesh);
    BilinearQuads const quads(m.mesh);
    std::set<std::string> stages;
    for (Variant const& v : frame_variants())
        for (bool moved : {false, true}) {
            FrameSettings s = settings_for(m);
            if (moved) s.pose = std::make_shared<Pose>(SpineRig(m.mesh->base()).sway(0.3));
            v.set(s);
            if (s.view == View::Curvature) continue; // it has none
            SCOPED_TRACE(v.name + (moved ? ", in a pose" : ""));
            expect_equal_on_all_machines(quads, s, stages);
            if (HasFatalFailure()) return;
        }
}

// Of pictures that are no scheme's: which patch a pixel shows, by number, and meshes with colours
// of their own.
TEST(Determinism, TheCheckingMachineHasTheFastOnesBitsAndCountsInNumbersAndColoredMeshes)
{
    ThreadPool const threads(2);
    for (Cage const& cage : cages()) {
        SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), cage.mesh);
        ColoredMesh const colored = control_mesh_picture(m.mesh->topology());
        FrameSettings s = settings_for(m);
        auto const numbers = [&](Machine const& machine) -> Bytes {
            ColorTarget color(s.width, s.height, Format::R32G32B32A32_FLOAT, s.samples);
            DepthTarget depth(s.width, s.height, Format::D32_FLOAT, s.samples);
            color.clear({-1, -1, -1, -1}, threads);
            depth.clear(1, 0, threads);
            RasterTarget raster{{&color}, &depth, {{0, 0, float(s.width), float(s.height), 0, 1}}};
            s.machine = machine;
            CommandList list = m.patches->commands(seen_surface(s));
            float draws = 0;
            list.for_each_surface_draw([&](Draw& d) {
                d.pipeline.pixel_shader = bind_pixel_shader(IdPixelShader{draws}, machine);
                ++draws;
            });
            CommandOptions options;
            options.raster = &raster;
            ListStatistics const counted = run_commands(list, threads, options);
            return bytes_of(color, depth, s, counted.total, counted.commands);
        };
        auto const picture = [&](Machine const& machine) -> Bytes {
            s.machine = machine;
            Frame frame(s);
            draw_colored_mesh(colored, s, 0.7f, threads, frame);
            return bytes_of(frame.color, frame.depth, s, frame.statistics, frame.commands);
        };
        for (int samples : {1, 4}) {
            s.samples = samples;
            std::vector<Machine> const machines = test::machines();
            Bytes const first[] = {numbers(machines[0]), picture(machines[0])};
            for (Bytes const& b : first) EXPECT_GT(b.statistics.pipeline.PSInvocations, 0u);
            for (std::size_t i = 1; i < machines.size(); ++i) {
                SCOPED_TRACE(cage.name + ", " + std::to_string(samples) + " samples, " +
                             testing::PrintToString(machines[i]));
                expect_equal(first[0], numbers(machines[i]));
                expect_equal(first[1], picture(machines[i]));
                if (HasFatalFailure()) return;
            }
        }
    }
}

} // namespace
} // namespace tessemu
