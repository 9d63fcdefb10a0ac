// From counts to seconds, on machines small enough for pencil and paper.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/cost.h"

#include "analysis/loop09_timing.h"
#include "io/machine_file.h"
#include "io/model.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <map>

namespace tessemu {
namespace {

StageStatistics stage(char const* name, std::uint64_t mul, std::uint64_t div,
                      std::vector<FetchStatistics> fetches)
{
    StageStatistics s;
    s.stage = name;
    s.flops.mul = mul;
    s.flops.div = div;
    s.fetches = std::move(fetches);
    return s;
}

TEST(FetchCount, RecordsInWholeSixteenBytesScalarsShareThem)
{
    auto const count = [](ResourceKind kind, std::uint64_t n, std::uint64_t bytes) {
        return fetch_count({"x", kind, n, bytes, bytes});
    };
    EXPECT_EQ(count(ResourceKind::ControlPoint, 10, 120), 10); // float3
    EXPECT_EQ(count(ResourceKind::ControlPoint, 10, 200), 20); // five floats
    EXPECT_EQ(count(ResourceKind::PatchConstant, 3, 48), 3);
    EXPECT_EQ(count(ResourceKind::Texture, 3, 48), 3);
    EXPECT_EQ(count(ResourceKind::Buffer, 16, 64), 4);   // floats
    EXPECT_EQ(count(ResourceKind::Buffer, 16, 16), 1);   // bytes
    EXPECT_EQ(count(ResourceKind::Buffer, 16, 192), 16); // float3
    EXPECT_EQ(count(ResourceKind::Buffer, 0, 0), 0);
}

TEST(Cost, AddsArithmeticAndFetchesAndFindsTheBound)
{
    MachineModel m;
    m.arithmetic = 100;
    m.special = 10;
    m.any_fetch = 50;
    m.fetch[ResourceKind::Texture] = 25;
    m.bandwidth = 1000;
    m.cache_bytes = 400;
    m.tessellator = 10;
    m.setup = 1000;
    m.raster = 4;
    m.overhead = 0.5;
    DrawStatistics s;
    s.pipeline.DSInvocations = 70;
    s.pipeline.CInvocations = 2000;
    s.pipeline.PSInvocations = 12;
    // 1 s of multiplications, 0.5 s of divisions, 2 s of control points, 1 s of texels.
    s.stages.push_back(stage("domain_shader", 100, 5,
                             {{"p", ResourceKind::ControlPoint, 100, 1200, 240},
                              {"t", ResourceKind::Texture, 25, 400, 400}}));
    s.stages.push_back(stage("tessellator", 0, 0, {}));
    s.stages.push_back(stage("rasterizer", 0, 0, {}));
    DrawCost const c = estimate_cost(m, s);
    EXPECT_DOUBLE_EQ(c.stages[0].arithmetic, 1.5);
    EXPECT_DOUBLE_EQ(c.stages[0].fetch, 3);
    EXPECT_DOUBLE_EQ(c.stages[0].memory, 0.4); // the texture; control points stay on the chip
    EXPECT_EQ(c.stages[0].bound(), "fetch");
    EXPECT_DOUBLE_EQ(c.stages[1].fixed, 7);
    EXPECT_DOUBLE_EQ(c.stages[2].fixed, 3); // pixels take longer than 2 s of triangles
    EXPECT_EQ(c.bound, "tessellator");
    EXPECT_DOUBLE_EQ(c.shaders, 4.5);
    EXPECT_DOUBLE_EQ(c.seconds, 7.5);

    // What nobody knows bounds nothing.
    MachineModel const unknown;
    EXPECT_EQ(estimate_cost(unknown, s).seconds, 0);
    EXPECT_EQ(estimate_cost(unknown, s).bound, "-");
}

TEST(Cost, TheCacheKeepsWhatFits)
{
    MachineModel m;
    m.bandwidth = 1;
    DrawStatistics s;
    s.stages.push_back(stage("vertex_shader", 0, 0, {{"b", ResourceKind::Buffer, 100, 1600, 800}}));
    auto const bytes = [&](double cache) {
        m.cache_bytes = cache;
        return estimate_cost(m, s).stages[0].memory_bytes;
    };
    EXPECT_EQ(bytes(0), 1600);
    EXPECT_EQ(bytes(400), 1200); // half of the 800 repeated bytes
    EXPECT_EQ(bytes(800), 800);
    EXPECT_EQ(bytes(5000), 800);
}

TEST(Cost, LanesBeyondAPatchsControlPointsIdle)
{
    MachineModel m;
    m.arithmetic = 1;
    DrawStatistics s;
    s.pipeline.HSInvocations = 2;
    s.pipeline.HSControlPointInvocations = 40;  // 20 a patch: of 32 lanes
    s.pipeline.HSPatchConstantInvocations = 50; // 25 a patch: of 32 lanes
    s.stages.push_back(stage("hull_shader", 90, 0, {}));
    EXPECT_DOUBLE_EQ(estimate_cost(m, s).seconds, 90);
    m.group_width = 32;
    EXPECT_DOUBLE_EQ(estimate_cost(m, s).seconds, 128);
}

// The stored numbers are what the fit gives, to the digits that the file has.
void expect_stored(MachineModel const& stored, MachineModel const& fitted)
{
    EXPECT_NEAR(stored.any_fetch, fitted.any_fetch, 0.01 * fitted.any_fetch);
    EXPECT_NEAR(stored.overhead, fitted.overhead, 0.01 * fitted.overhead);
}

std::map<std::string, PaperCell> by_row(PaperTable const& table, std::string const& column)
{
    std::map<std::string, PaperCell> out;
    for (PaperCell const& c : table.cells)
        if (c.column == column) out[c.row] = c;
    return out;
}

// Gregory patches win within each form, and by the paper's ratios within 10 %.
TEST(Loop09Table1, RatiosWithinAFormAreThePapers)
{
    MachineModel const machine = load_machine_model("loop09-emulator");
    TimingTable const t =
        reproduce_loop09_table1(load_model("golem").mesh, machine, {}, ThreadPool(), {});
    expect_stored(machine, t.machine);
    auto const ratios = by_row(t.table, "ratio of times");
    ASSERT_EQ(ratios.size(), 2u);
    for (auto const& [row, c] : ratios) {
        EXPECT_GT(c.ours, 1) << row;
        EXPECT_NEAR(c.ours, c.paper, 0.1 * c.paper) << row;
    }
    auto const ms = by_row(t.table, "ms");
    EXPECT_EQ(ms.size(), 6u);
    // Counters cannot order the two forms as the paper's emulator did.
    EXPECT_LT(ms.at("N = 10, gregory-two-stage").ours, ms.at("N = 10, gregory-stencil").ours);
    EXPECT_GT(ms.at("N = 10, gregory-two-stage").paper, ms.at("N = 10, gregory-stencil").paper);
}

TEST(Loop09Table2, EveryCellIsWithinTenPercentAlsoWhereItIsLeftOut)
{
    std::vector<ControlMesh> meshes;
    for (std::string_view name : kLoop09Table2Models) {
        std::string const file = "models/" + std::string(name) + ".obj";
        TESSEMU_NEEDS_SHARED(file);
        meshes.push_back(load_model(test::shared(file).string()).mesh);
    }
    MachineModel const machine = load_machine_model("gtx260");
    TimingTable const t = reproduce_loop09_table2(meshes, machine, {}, ThreadPool(), {});
    expect_stored(machine, t.machine);
    for (PaperCell const& c : t.table.cells)
        EXPECT_NEAR(c.ours, c.paper, 0.1 * c.paper) << c.row << " " << c.column;
    auto const ratios = by_row(t.table, "time / Gregory's");
    ASSERT_EQ(ratios.size(), 8u);
    for (auto const& [row, c] : ratios) EXPECT_GT(c.ours, 1) << row;
}

TEST(MachineFile, TheBuiltInMachinesAreWhole)
{
    ASSERT_EQ(builtin_machines().size(), 2u);
    MachineModel const m = load_machine_model("gtx260");
    EXPECT_EQ(m.name, "GeForce GTX 260");
    EXPECT_DOUBLE_EQ(m.arithmetic, 192 * 1.242e9);
    EXPECT_DOUBLE_EQ(m.raster, 28 * 576e6);
    EXPECT_EQ(m.group_width, 32);
    EXPECT_EQ(m.sources.count("bandwidth"), 1u);
    EXPECT_EQ(load_machine_model("loop09-emulator").arithmetic, MachineModel::kUnknown);
}

TEST(MachineFile, NamesWhatIsWrong)
{
    auto const message = [](std::string const& json) {
        try {
            parse_machine_model(json, "m.json");
        } catch (FormatError const& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    std::string const head = R"({"name": "a", "about": "b", )";
    for (auto const& [json, words] : std::vector<std::pair<std::string, std::string>>{
             {"{", "JSON"},
             {"[]", "object"},
             {R"({"about": "b"})", "'name'"},
             {head + R"("speed": 1})", "'speed'"},
             {head + R"("bandwidth": {"value": 1, "per": "second"}})", "no source"},
             {head + R"("bandwidth": {"value": 0, "per": "second", "source": "s"}})", "above 0"},
             {head + R"("bandwidth": {"value": "x", "per": "second", "source": "s"}})",
              "not a number"},
             {head + R"("bandwidth": {"value": 1, "source": "s"}})", "per what"},
             {head + R"("bandwidth": {"value": 1, "per": "tick", "source": "s"}})", "'tick'"},
             {head + R"("fetch": {"milk": {"value": 1, "per": "second", "source": "s"}}})",
              "fetch.milk"},
             {head + R"("group_width": {"value": 1.5, "source": "s"}})", "1.5"},
             {head + R"("vertex_cache": {"value": "big", "source": "s"}})", "big"}}) {
        EXPECT_NE(message(json).find(words), std::string::npos) << json << ": " << message(json);
        EXPECT_EQ(message(json).find("m.json"), 0u) << message(json);
    }
    EXPECT_EQ(message(head + R"("overhead": {"value": 0, "source": "s"}})"), "");
}

} // namespace
} // namespace tessemu
