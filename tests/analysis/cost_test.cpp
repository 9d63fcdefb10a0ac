// From counts to seconds, on machines small enough for pencil and paper.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/cost.h"

#include "analysis/papers/loop09/timing.h"
#include "io/gpu_file.h"
#include "io/model.h"
#include "tests/support/files.h"
#include "tests/support/fitted_table.h"
#include "tests/support/printed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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
    GpuModel m;
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

    // The tessellator takes as long as its points or its triangles, whichever is longer.
    m.tessellated_triangles = 250;
    EXPECT_DOUBLE_EQ(estimate_cost(m, s).stages[1].fixed, 8);
    m.tessellated_triangles = 500;
    EXPECT_DOUBLE_EQ(estimate_cost(m, s).stages[1].fixed, 7);

    // What nobody knows bounds nothing.
    GpuModel const unknown;
    EXPECT_EQ(estimate_cost(unknown, s).seconds, 0);
    EXPECT_EQ(estimate_cost(unknown, s).bound, "-");
}

TEST(Cost, TheCacheKeepsWhatFits)
{
    GpuModel m;
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
    GpuModel m;
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

// Patches of 16 control points leave half of 32 lanes idle, patches of 32 none; the mean of 24
// would say a quarter for both.
TEST(Cost, EachDrawOfAFrameHasItsOwnIdleLanes)
{
    GpuModel m;
    m.arithmetic = 1;
    m.group_width = 32;
    m.overhead = 1000;
    std::vector<CommandStatistics> frame(2, {"draw", "patches", 1, {}});
    for (auto& c : frame) {
        c.statistics.pipeline.HSInvocations = 1;
        c.statistics.stages = {stage("hull_shader", 100, 0, {}), stage("domain_shader", 8, 0, {})};
    }
    frame[0].statistics.pipeline.HSControlPointInvocations = 16;
    frame[1].statistics.pipeline.HSControlPointInvocations = 32;
    DrawCost const c = estimate_cost(m, frame);
    ASSERT_EQ(c.stages.size(), 2u);
    EXPECT_EQ(c.stages[0].arithmetic, 200 + 100);
    EXPECT_EQ(c.stages[0].operations, 200);
    EXPECT_EQ(c.stages[1].arithmetic, 16);
    EXPECT_EQ(c.shaders, 316);
    EXPECT_EQ(c.seconds, 1316) << "one overhead";
    EXPECT_EQ(c.bound, "hull_shader");
}

// Claims ask which frame is shorter: the same triangles take the same time to the last bit.
TEST(Cost, HowAFramesPatchesAreSpreadOverDrawsDoesNotShow)
{
    GpuModel m;
    m.tessellated_triangles = 0.3;
    m.bandwidth = 0.7;
    auto const frame = [](std::vector<std::uint64_t> const& draws) {
        std::vector<CommandStatistics> out;
        for (std::uint64_t n : draws) {
            out.push_back({"draw", "patches", 1, {}});
            out.back().statistics.pipeline.CInvocations = n;
            out.back().statistics.stages = {
                stage("tessellator", 0, 0, {}),
                stage("domain_shader", 0, 0, {{"b", ResourceKind::Buffer, n, n, n}})};
        }
        return out;
    };
    DrawCost const one = estimate_cost(m, frame({27})), three = estimate_cost(m, frame({1, 1, 25}));
    EXPECT_EQ(one.seconds, three.seconds);
    EXPECT_EQ(one.stages[1].memory, three.stages[1].memory);
}

// ---- GPUs whose shaders are assembly

// Draws of so many fragments each, of 80 additions, 48 products and 16 texels.
CommandStatistics draws_of(char const* name, std::vector<std::uint64_t> const& fragments,
                           bool own_targets)
{
    CommandStatistics c{"draw", name, fragments.size(), {}};
    for (std::uint64_t n : fragments) {
        ++c.draws[n];
        c.statistics.pipeline.PSInvocations += n;
    }
    std::uint64_t const n = c.statistics.pipeline.PSInvocations;
    StageStatistics pixel = stage("pixel_shader", 48 * n, 0,
                                  {{"t", ResourceKind::Texture, 16 * n, 64 * n, 4096}}),
                    merger = stage("output_merger", 0, 0, {});
    pixel.flops.add = 80 * n;
    merger.output_bytes = 16 * n;
    c.statistics.stages = {pixel, merger};
    if (own_targets) c.own_targets = fragments.size();
    return c;
}

GpuModel assembly()
{
    GpuModel m;
    m.name = "toy";
    m.issues["pixel_shader"] = 100;
    m.components = 4;
    m.fragment_batch = 512;
    return m;
}

// A patch of 1089 fragments fills two batches of 512 and 65 places of a third.
TEST(CostOfAssembly, FragmentsRunInBatchesThatDrawsDoNotShare)
{
    GpuModel const m = assembly();
    EXPECT_DOUBLE_EQ(utilisation(m, {{1089, 300}}), 1089.0 / 1536);
    EXPECT_DOUBLE_EQ(utilisation(m, {{512, 7}}), 1);
    EXPECT_DOUBLE_EQ(utilisation(m, {{1, 1}, {1023, 1}}), 1024.0 / 1536);
    EXPECT_EQ(utilisation(m, {{0, 3}}), 1);
    EXPECT_EQ(utilisation({}, {{1089, 3}}), 1);

    // 48 products in as many of the 80 sums: 20 instructions of four, and 16 of texels.
    std::vector<CommandStatistics> const frame{draws_of("positions", {1089, 1089}, false),
                                               draws_of("normals", {512}, false)};
    DrawCost const c = estimate_cost(m, frame);
    ASSERT_EQ(c.stages.size(), 2u);
    EXPECT_DOUBLE_EQ(c.stages[0].arithmetic, (2 * 1536 + 512) * 20 / 100.0);
    EXPECT_DOUBLE_EQ(c.stages[0].fetch, (2 * 1536 + 512) * 16 / 100.0);
    EXPECT_EQ(c.stages[0].bound(), "arithmetic");
    EXPECT_EQ(c.bound, "pixel_shader");
    EXPECT_DOUBLE_EQ(estimate_cost(m, frame[1].statistics).seconds, 512 * 36 / 100.0);
}

TEST(CostOfAssembly, TargetsOfDrawsAreSwitchedToAndTravel)
{
    GpuModel m = assembly();
    std::vector<CommandStatistics> const frame{draws_of("positions", {1089, 1089}, true),
                                               draws_of("surface", {512}, false)};
    double const shaders = estimate_cost(m, frame).seconds;
    EXPECT_EQ(estimate_cost(m, frame).stages.size(), 2u) << "a rate that nobody knows has no row";
    m.target_switches = 1e-3;
    m.bus = 8;
    DrawCost const c = estimate_cost(m, frame);
    ASSERT_EQ(c.stages.size(), 4u);
    EXPECT_EQ(c.stages[2].stage, "target_switch");
    EXPECT_DOUBLE_EQ(c.stages[2].seconds(), 2000);
    EXPECT_EQ(c.stages[2].bound(), "rate");
    EXPECT_EQ(c.stages[3].stage, "bus");
    EXPECT_DOUBLE_EQ(c.stages[3].seconds(), 2 * 16 * 2 * 1089 / 8.0) << "there and back";
    EXPECT_EQ(c.bound, "bus");
    EXPECT_DOUBLE_EQ(c.seconds, c.stages[3].seconds());
    EXPECT_DOUBLE_EQ(c.shaders, shaders) << "they work beside the shaders";
}

TEST(CostOfAssembly, AStageThatTheGpuLacksIsTheCpusOrRefused)
{
    GpuModel m = assembly();
    m.bus = 10;
    m.stages = {"pixel_shader", "output_merger"};
    m.cpu_stages = {"compute_shader"};
    std::vector<CommandStatistics> frame{draws_of("positions", {512}, false)};
    double const without = estimate_cost(m, frame).seconds;
    CommandStatistics constants{"dispatch", "patch constants", 1, {}};
    constants.statistics.stages = {stage("compute_shader", 1u << 30, 0, {})};
    constants.statistics.stages[0].output_bytes = 100;
    frame.push_back(constants);
    DrawCost const c = estimate_cost(m, frame);
    EXPECT_EQ(c.seconds, without);
    ASSERT_EQ(c.stages.size(), 3u);
    EXPECT_EQ(c.stages[2].stage, "bus");
    EXPECT_DOUBLE_EQ(c.stages[2].seconds(), 10) << "once";

    frame[1].statistics.stages[0].stage = "hull_shader";
    try {
        estimate_cost(m, frame);
        ADD_FAILURE() << "no error";
    } catch (Error const& e) {
        EXPECT_STREQ(e.what(), "toy has no hull_shader, which the scheme uses; it has "
                               "pixel_shader, output_merger");
    }
}

TEST(Gpu, TheCardOfBolz03HasThePapersNumbers)
{
    GpuModel const m = load_gpu_model("geforce-fx");
    EXPECT_EQ(m.issues.at("pixel_shader"), 1000e6);
    EXPECT_EQ(m.issues.size(), 1u);
    EXPECT_EQ(m.fragment_batch, 512);
    EXPECT_EQ(m.target_switches, 200);
    EXPECT_EQ(m.arithmetic, GpuModel::kUnknown);
    EXPECT_EQ(m.bandwidth, GpuModel::kUnknown);
    EXPECT_TRUE(m.has("pixel_shader"));
    for (char const* stage : {"hull_shader", "domain_shader", "geometry_shader", "stream_output"})
        EXPECT_FALSE(m.has(stage));
    for (auto const& [place, source] : m.sources) EXPECT_GT(source.size(), 20u) << place;
}

// What least squares of relative errors r = (predicted - t) / t give, whatever the cells count:
// the sum of r / t, its derivative by the overhead, is 0 but for rounding; and a cell's error
// without the cell is r / (1 - h), 0 < h < 1, so it grows.
//
// seconds_of  a cell's time from what its column prints
void expect_least_squares(PaperTable const& table, std::string const& column,
                          double (*seconds_of)(double))
{
    auto const all = test::by_row(table, column),
               out = test::by_row(table, column + ", cell left out of the fit");
    ASSERT_EQ(all.size(), out.size());
    double sum = 0, size = 0;
    for (auto const& [row, c] : all) {
        double const t = seconds_of(c.paper), r = (seconds_of(c.ours) - t) / t,
                     without = (seconds_of(out.at(row).ours) - t) / t;
        EXPECT_GT(std::abs(without), std::abs(r)) << row;
        EXPECT_GT(without * r, 0) << row;
        sum += r / t;
        size += std::abs(r / t);
    }
    EXPECT_LE(std::abs(sum), 1e-9 * size) << column;
}

// Gregory patches win within each form, by the paper's ratios as docs/cost.md has them.
TEST(Loop09Table1, RatiosWithinAFormAreThePapers)
{
    TimingTable const t = reproduce_loop09_table1(
        load_model("golem").mesh, load_gpu_model("loop09-emulator"), {}, ThreadPool(), {});
    test::expect_stored("loop09-emulator", t.gpu);
    expect_least_squares(t.table, "ms", [](double ms) { return 1e-3 * ms; });

    constexpr char const* kPage = "docs/cost.md";
    auto const said = test::said_in(kPage, R"(ACC/Gregory ([\d.]+) \(paper ([\d.]+)\), )"
                                           R"(Pm/Gregory ([\d.]+) \(paper ([\d.]+)\))");
    auto const ratios = test::by_row(t.table, "ratio of times");
    ASSERT_EQ(ratios.size(), 2u);
    ASSERT_EQ(said.size(), 4u);
    PaperCell const acc = ratios.at("N = 10, stencil: ACC / Gregory"),
                    pm = ratios.at("N = 10, two-stage: Pm / Gregory");
    EXPECT_TRUE(said[0].rounds_from(acc.ours)) << acc.ours;
    EXPECT_TRUE(said[1].rounds_from(acc.paper));
    EXPECT_TRUE(said[2].rounds_from(pm.ours)) << pm.ours;
    EXPECT_TRUE(said[3].rounds_from(pm.paper));
    EXPECT_GT(acc.ours, 1);
    EXPECT_GT(pm.ours, 1);

    auto const ms = test::by_row(t.table, "ms");
    EXPECT_EQ(ms.size(), 6u);
    double worst = 0;
    for (auto const& [row, c] : ms) worst = std::max(worst, 100 * std::abs(c.ours / c.paper - 1));
    auto const miss = test::said_in(kPage, R"(single cells miss by up to (\d+) %)");
    ASSERT_EQ(miss.size(), 1u);
    EXPECT_TRUE(miss[0].rounds_from(worst)) << worst;
    // Counters cannot order the two forms as the paper's emulator did.
    EXPECT_LT(ms.at("N = 10, gregory-two-stage").ours, ms.at("N = 10, gregory-stencil").ours);
    EXPECT_GT(ms.at("N = 10, gregory-two-stage").paper, ms.at("N = 10, gregory-stencil").paper);
}

// The bounds are those that README.md and docs/cost.md promise, the figures the page's table.
TEST(Loop09Table2, EveryCellIsAsCloseToThePaperAsThePagesPromise)
{
    std::vector<ControlMesh> meshes;
    for (std::string_view name : kLoop09Table2Models) {
        std::string const file = "models/" + std::string(name) + ".obj";
        TESSEMU_NEEDS_SHARED(file);
        meshes.push_back(load_model(test::shared(file).string()).mesh);
    }
    TimingTable const t =
        reproduce_loop09_table2(meshes, load_gpu_model("gtx260"), {}, ThreadPool(), {});
    test::expect_stored("gtx260", t.gpu);

    constexpr char const* kPage = "docs/cost.md";
    auto const readme = test::said_in("README.md", R"(comes out within (\d+) % from counters)");
    auto const said =
        test::said_in(kPage, R"(frames a second within (\d+) % of the paper, within )"
                             R"((\d+) % where the cell is left out; the eight ratios )"
                             R"(to Gregory's time within (\d+\.?\d*) %)");
    auto const fit =
        test::said_in(kPage, R"(The fit says ([\d.]+) ms a frame and ([\d.e]+) fetches a second)");
    ASSERT_EQ(readme.size() + said.size() + fit.size(), 6u);
    auto const fps = test::by_row(t.table, "frames a second"),
               left_out = test::by_row(t.table, "frames a second, cell left out of the fit"),
               ratios = test::by_row(t.table, "time / Gregory's");
    ASSERT_EQ(fps.size(), 12u);
    ASSERT_EQ(left_out.size(), 12u);
    ASSERT_EQ(ratios.size(), 8u);
    auto const expect_within = [](std::map<std::string, PaperCell> const& cells, double percent) {
        for (auto const& [row, c] : cells)
            EXPECT_LE(100 * std::abs(c.ours / c.paper - 1), percent) << row << " " << c.column;
    };
    expect_within(fps, readme[0].value);
    expect_within(fps, said[0].value);
    expect_within(left_out, said[1].value);
    expect_within(ratios, said[2].value);
    for (auto const& [row, c] : ratios) EXPECT_GT(c.ours, 1) << row;
    EXPECT_TRUE(fit[0].rounds_from(1e3 * t.gpu.overhead)) << t.gpu.overhead;
    EXPECT_TRUE(fit[1].rounds_from(t.gpu.any_fetch)) << t.gpu.any_fetch;

    std::map<std::string, std::string> const schemes{
        {"ACC, frames a second", "acc"}, {"Pm", "pm"}, {"Gregory", "gregory-stencil"}};
    std::size_t rows = 0;
    for (auto const& cells : test::table_of(kPage, "| N = 17 / 25 | monsterfrog, paper | ours")) {
        ASSERT_EQ(cells.size(), 5u);
        for (std::size_t model = 0; model < 2; ++model) {
            auto const paper = test::printed_numbers(cells[1 + 2 * model]),
                       ours = test::printed_numbers(cells[2 + 2 * model]);
            ASSERT_EQ(paper.size() + ours.size(), 4u);
            for (std::size_t i = 0; i < 2; ++i) {
                std::string const row = std::string(kLoop09Table2Models[model]) +
                                        (i ? ", N = 25, " : ", N = 17, ") + schemes.at(cells[0]);
                EXPECT_EQ(paper[i].value, std::round(fps.at(row).paper)) << row;
                EXPECT_TRUE(ours[i].rounds_from(fps.at(row).ours)) << row << fps.at(row).ours;
            }
        }
        ++rows;
    }
    EXPECT_EQ(rows, 3u);
}

// What the program carries is the folder gpus/, to the byte, and every number tells its source.
TEST(GpuFile, TheBuiltInGpusAreTheFilesOfTheFolder)
{
    std::map<std::string, std::string> builtin, files;
    for (BuiltinGpu const& g : builtin_gpus()) builtin[std::string(g.name)] = g.json;
    for (auto const& entry : std::filesystem::directory_iterator(test::source("gpus")))
        files[entry.path().stem().string()] = test::read_text(entry.path());
    EXPECT_EQ(builtin, files);
    for (auto const& [name, json] : files) {
        GpuModel const by_name = load_gpu_model(name),
                       by_path = load_gpu_model(test::source("gpus/" + name + ".json").string());
        EXPECT_EQ(by_name.sources, by_path.sources);
        EXPECT_FALSE(by_name.sources.empty()) << name;
        for (auto const& [place, source] : by_name.sources) EXPECT_NE(source, "") << place;
    }
    EXPECT_THROW(load_gpu_model("no such gpu"), FormatError);
}

TEST(GpuFile, RatesArePerClockOrPerSecondAndUnknownWhereTheyAreLeftOut)
{
    GpuModel const m = parse_gpu_model(R"({"name": "a", "about": "b",
        "clocks": {"fast": {"value": 2e9, "source": "s1"}},
        "arithmetic": {"value": 3, "per": "fast", "source": "s2"},
        "fetch": {"any": {"value": 5, "per": "second", "source": "s3"},
                  "texture": {"value": 0.5, "per": "fast", "source": "s4"}},
        "cache_bytes": {"value": 7, "source": "s5"},
        "group_width": {"value": 32, "source": "s6"},
        "vertex_cache": {"value": "lru:9", "source": "s7"},
        "issues": {"pixel_shader": {"value": 2, "per": "fast", "source": "s8"}},
        "components": {"value": 3, "source": "s9"},
        "fragment_batch": {"value": 512, "source": "s10"},
        "target_switches": {"value": 200, "per": "second", "source": "s11"},
        "bus": {"value": 8, "per": "second", "source": "s12"},
        "stages": {"value": ["pixel_shader"], "source": "s13"},
        "cpu_stages": {"value": ["compute_shader"], "source": "s14"}})",
                                       "m.json");
    EXPECT_EQ(m.name, "a");
    EXPECT_EQ(m.arithmetic, 6e9);
    EXPECT_EQ(m.fetch_rate(ResourceKind::Buffer), 5);
    EXPECT_EQ(m.fetch_rate(ResourceKind::Texture), 1e9);
    EXPECT_EQ(m.cache_bytes, 7);
    EXPECT_EQ(m.group_width, 32);
    EXPECT_EQ(m.vertex_cache.kind, VertexCacheModel::Kind::Lru);
    EXPECT_EQ(m.vertex_cache.entries, 9u);
    for (double unknown :
         {m.special, m.bandwidth, m.tessellator, m.tessellated_triangles, m.setup, m.raster})
        EXPECT_EQ(unknown, GpuModel::kUnknown);
    EXPECT_EQ(m.overhead, 0);
    EXPECT_EQ(m.issues, (std::map<std::string, double>{{"pixel_shader", 4e9}}));
    EXPECT_EQ(m.components, 3);
    EXPECT_EQ(m.fragment_batch, 512);
    EXPECT_EQ(m.target_switches, 200);
    EXPECT_EQ(m.bus, 8);
    EXPECT_TRUE(m.has("pixel_shader") && !m.has("compute_shader"));
    EXPECT_EQ(m.cpu_stages, std::vector<std::string>{"compute_shader"});
    std::map<std::string, std::string> const sources{
        {"clocks.fast", "s1"},     {"arithmetic", "s2"},          {"fetch.any", "s3"},
        {"fetch.texture", "s4"},   {"cache_bytes", "s5"},         {"group_width", "s6"},
        {"vertex_cache", "s7"},    {"issues.pixel_shader", "s8"}, {"components", "s9"},
        {"fragment_batch", "s10"}, {"target_switches", "s11"},    {"bus", "s12"},
        {"stages", "s13"},         {"cpu_stages", "s14"}};
    EXPECT_EQ(m.sources, sources);
}

TEST(GpuFile, NamesWhatIsWrong)
{
    auto const message = [](std::string const& json) {
        try {
            parse_gpu_model(json, "m.json");
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
             {head + R"("vertex_cache": {"value": "big", "source": "s"}})", "big"},
             {head + R"("issues": 3})", "'issues'"},
             {head + R"("issues": {"mixer": {"value": 1, "per": "second", "source": "s"}}})",
              "mixer"},
             {head + R"("issues": {"rasterizer": {"value": 1, "per": "second", "source": "s"}}})",
              "no shader"},
             {head + R"("components": {"value": 5, "source": "s"}})", "up to 4"},
             {head + R"("fragment_batch": {"value": 0.5, "source": "s"}})", "0.5"},
             {head + R"("stages": {"value": "pixel_shader", "source": "s"}})", "list"},
             {head + R"("stages": {"value": ["mixer"], "source": "s"}})", "mixer"},
             {head + R"("stages": {"value": ["pixel_shader"]}})", "no source"},
             {head + R"("cpu_stages": {"value": ["pixel_shader"], "source": "s"}})",
              "which the GPU has"}}) {
        EXPECT_NE(message(json).find(words), std::string::npos) << json << ": " << message(json);
        EXPECT_EQ(message(json).find("m.json"), 0u) << message(json);
    }
    EXPECT_EQ(message(head + R"("overhead": {"value": 0, "source": "s"}})"), "");
}

} // namespace
} // namespace tessemu
