// A sweep of a thousand draws of geometry, as the program runs it on one thread, beside those draws
// alone, on a surface that is there already: what plans, claims, results and starting cost.
//
// SPDX-License-Identifier: Apache-2.0
#include "bench/scene.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>

#include <unistd.h>

namespace tessemu {
namespace {

constexpr int kCases = 1000;

float factor(int i)
{
    return float(1 + 63 * double(i) / (kCases - 1));
}

void draws_alone(benchmark::State& state)
{
    BenchScene scene;
    scene.settings.vertex_cache = {VertexCacheModel::Kind::Infinite, 0}; // the GPU's
    ThreadPool const threads(1);
    for (auto _ : state)
        for (int i = 0; i < kCases; ++i) {
            scene.settings.tess_factor = factor(i);
            benchmark::DoNotOptimize(visit_surface(scene.patches(), scene.settings, threads, {}));
        }
}
BENCHMARK(draws_alone)->Unit(benchmark::kMillisecond)->UseRealTime();

void sweep_run(benchmark::State& state)
{
    namespace fs = std::filesystem;
    fs::path const folder = fs::temp_directory_path() / fmt::format("bench_sweep_{}", getpid());
    std::string const bigguy = std::string(TESSEMU_SHARED_DIR) + "/models/bigguy.obj";
    std::string factors;
    for (int i = 0; i < kCases; ++i) factors += fmt::format("{}{}", i ? "," : "", factor(i));
    fs::create_directories(folder);
    std::ofstream(folder / "sweep.json") << fmt::format(
        R"({{"verb": "cost", "models": ["{}"], "geometry-only": true, "tess": [{}]}})",
        fs::exists(bigguy) ? fs::absolute(bigguy).string() : "jug", factors);
    auto const run = [&](std::string const& arguments) {
        std::string const command = fmt::format("cd {} && {} sweep {} >/dev/null", folder.string(),
                                                TESSEMU_PROGRAM, arguments);
        if (std::system(command.c_str()) != 0) state.SkipWithError(arguments.c_str());
    };
    for (auto _ : state) {
        state.PauseTiming();
        fs::remove_all(folder / "cases");
        run("plan sweep.json -o cases");
        state.ResumeTiming();
        run("run cases -j 1");
    }
    fs::remove_all(folder);
}
BENCHMARK(sweep_run)->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
} // namespace tessemu
