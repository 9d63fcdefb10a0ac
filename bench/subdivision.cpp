// Subdivision's kernels, counting on, positions, to a level of bigguy.
//
// What to compare with: OpenSubdiv's stencils of the same level and its refinement
// (peers/opensubdiv_subdivision.cpp); scripts/bench.sh runs both in turn.
//
// SPDX-License-Identifier: Apache-2.0
#include "bench/scene.h"

#include <benchmark/benchmark.h>

namespace tessemu {
namespace {

void subdivision(benchmark::State& state)
{
    BenchScene const scene;
    RefinedMesh const refined(scene.mesh(), int(state.range(0)), catmull_clark_step);
    ThreadPool const threads(int(state.range(1)));
    CommandList list;
    VertexSource const points = add_vertices(list, refined, {});
    ListStatistics statistics;
    for (auto _ : state) statistics = run_commands(list, threads);
    benchmark::DoNotOptimize(points.floats.data());
    std::uint64_t made = 0;
    for (SubdivisionTables const& t : refined.tables()) made += t.new_points();
    if (statistics.total.pipeline.CSInvocations < made) state.SkipWithError("points are missing");
    state.counters["points"] = double(made);
    state.counters["ns/point"] =
        benchmark::Counter(double(made) * 1e-9, benchmark::Counter::kIsIterationInvariantRate |
                                                    benchmark::Counter::kInvert);
}
BENCHMARK(subdivision)
    ->ArgsProduct({{1, 2, 3}, {1, 2}})
    ->ArgNames({"level", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
} // namespace tessemu
