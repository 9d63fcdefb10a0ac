// Every scheme on bigguy: points a second with their normals, all commands of a frame without the
// raster, one thread; 9 segments along an edge, 10 x 10 points a quad.
//
// SPDX-License-Identifier: Apache-2.0
#include "bench/scene.h"

#include <benchmark/benchmark.h>

namespace tessemu {
namespace {

void scheme_points(benchmark::State& state, std::string const& name)
{
    BenchScene const scene;
    SchemeOnMesh const on = build_scheme(find_scheme(name), scene.scheme.mesh->mesh());
    FrameSettings settings;
    settings.tess_factor = 9;
    ThreadPool const one(1);
    std::size_t points = 0;
    visit_surface(*on.patches, settings, one, [&](SurfacePatch const& p) { points += p.points(); });
    auto const nothing = [](SurfacePatch const& p) { benchmark::DoNotOptimize(p.number()); };
    for (auto _ : state) visit_surface(*on.patches, settings, one, nothing);
    state.counters["points"] = double(points);
    state.counters["Mpoint/s"] =
        benchmark::Counter(double(points) * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}

int const registered = [] {
    for (auto const& scheme : schemes()) {
        std::string const name = scheme->info().name;
        benchmark::RegisterBenchmark(name.c_str(), [name](benchmark::State& s) {
            scheme_points(s, name);
        })->Unit(benchmark::kMillisecond);
    }
    return 0;
}();

} // namespace
} // namespace tessemu
