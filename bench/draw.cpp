// Whole draws: bigguy at 1024x1024, culling off, counting on; the jug where bigguy is not there.
//
// SPDX-License-Identifier: Apache-2.0
#include "bench/scene.h"

#include <benchmark/benchmark.h>

namespace tessemu {
namespace {

void whole_frame(benchmark::State& state)
{
    BenchScene const scene(float(state.range(0)));
    ThreadPool const threads(int(state.range(1)));
    Frame frame(scene.settings);
    for (int i = 0; i < 3; ++i)
        draw_frame(scene.patches(), scene.settings, threads, frame); // as peers
    for (auto _ : state) draw_frame(scene.patches(), scene.settings, threads, frame);
    DrawStatistics const& statistics = frame.statistics;
    PipelineStatistics const& p = statistics.pipeline;
    if (p.PSInvocations == 0) state.SkipWithError("nothing was drawn");
    state.counters["points"] = double(p.DSInvocations);
    state.counters["triangles"] = double(p.CInvocations);
    state.counters["vertices/triangle"] = double(p.DSInvocations) / double(p.CInvocations);
    state.counters["PS"] = double(p.PSInvocations);
    for (StageStatistics const& stage : statistics.stages)
        if (stage.stage == "domain_shader")
            for (FetchStatistics const& f : stage.fetches)
                if (f.resource == "control_points")
                    state.counters["fetched_bytes/patch"] =
                        double(f.bytes) / double(p.HSInvocations);
}
BENCHMARK(whole_frame)
    ->ArgsProduct({{3, 10, 17, 25, 64}, {1, 2}})
    ->ArgNames({"tess", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void geometry_only(benchmark::State& state)
{
    BenchScene const scene(float(state.range(0)));
    ThreadPool const threads(1);
    DrawStatistics statistics;
    for (auto _ : state)
        statistics = visit_surface(scene.patches(), scene.settings, threads, {}).total;
    if (statistics.pipeline.DSInvocations == 0) state.SkipWithError("nothing was evaluated");
    state.counters["Mpoint/s"] =
        benchmark::Counter(double(statistics.pipeline.DSInvocations) * 1e-6,
                           benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(geometry_only)
    ->Arg(3)
    ->Arg(10)
    ->Arg(17)
    ->Arg(25)
    ->Arg(64)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
} // namespace tessemu
