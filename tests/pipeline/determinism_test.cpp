// Same input, same bytes: threads and the form of the machine change neither picture nor counters.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/machines.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace tessemu {
namespace {

struct Bytes {
    std::string pixels;
    DrawStatistics statistics;
    std::vector<CommandStatistics> commands;
};

Bytes draw_bytes(PatchMesh const& patches, FrameSettings s, int threads, Machine const& machine)
{
    s.machine = machine;
    Frame const f = draw_frame(patches, s, ThreadPool(threads));
    Bytes out{{}, f.statistics, f.commands};
    for (int y = 0; y < s.height; ++y) {
        out.pixels.append(reinterpret_cast<char const*>(f.color.texel(0, y)), f.color.row_bytes());
        out.pixels.append(reinterpret_cast<char const*>(f.depth.codes() + f.depth.index(0, y)),
                          std::size_t(s.width * s.samples) * 4);
    }
    return out;
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

// The checking machine is compiled apart from the fast one, from the same text: each is the other's
// oracle, for every stage of every scheme and for all that a frame can ask for.
TEST(Determinism, TheCheckingMachineHasTheFastOnesBitsAndCountsInEveryStageOfEveryScheme)
{
    struct Variant {
        std::string name;
        std::function<void(FrameSettings&)> set;
    };
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
    variants.push_back({"parity", [](FrameSettings& s) { s.finish.parity = 0.01f; }});

    constexpr char const* kStages[] = {"input_assembler", "vertex_shader",   "hull_shader",
                                       "domain_shader",   "geometry_shader", "pixel_shader",
                                       "compute_shader"};
    std::set<std::string> stages;
    for (auto const& scheme : schemes())
        for (char const* model : {"golem", "spindle"}) {
            SchemeOnMesh m;
            try {
                m = build_scheme(*scheme, load_model(model).mesh);
            } catch (MeshError const&) { // one of the two it draws, see schemes_test.cpp
                continue;
            }
            if (std::string(model) == "spindle" && scheme->info().takes.quads) continue;
            std::shared_ptr<Displacement const> maps[] = {
                nullptr, std::make_shared<Displacement>(Displacement::studs(0.2f, 0.05f)), nullptr};
            if (!m.mesh->base().coordinates.empty()) {
                HeightImage image{{}, 8, 8};
                for (int i = 0; i < 64; ++i) image.heights.push_back(float(i * 37 % 64) / 64);
                maps[2] = std::make_shared<Displacement>(m.mesh->base_topology(), image, 0.05f);
            }
            auto const pose = std::make_shared<Pose>(SpineRig(m.mesh->mesh()).sway(0.3));
            for (Variant const& v : variants)
                for (auto const& map : maps)
                    for (bool moved : {false, true}) {
                        if (!map && &map != maps) continue;
                        FrameSettings s = settings_for(m);
                        s.displacement = map;
                        if (moved) s.pose = pose;
                        v.set(s);
                        SCOPED_TRACE(scheme->info().name + " on " + model + ", " + v.name +
                                     (map ? ", displaced" : "") + (moved ? ", in a pose" : ""));
                        std::vector<Machine> const machines = test::machines();
                        Bytes const first = draw_bytes(*m.patches, s, 1, machines[0]);
                        EXPECT_GT(first.statistics.pipeline.PSInvocations, 0u);
                        for (StageStatistics const& stage : first.statistics.stages)
                            stages.insert(stage.stage);
                        for (std::size_t i = 1; i < machines.size(); ++i) {
                            expect_equal(first, draw_bytes(*m.patches, s, 2, machines[i]));
                            if (HasFatalFailure()) return;
                        }
                    }
        }
    for (char const* stage : kStages) EXPECT_EQ(stages.count(stage), 1u) << stage;
}

} // namespace
} // namespace tessemu
