// The fixed-function tessellator with its cache off, one thread: points and indices.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/tessellator.h"

#include <benchmark/benchmark.h>

namespace tessemu {
namespace {

template <TessellatorDomain kDomain> void uniform_factor(benchmark::State& state)
{
    TessellatorState const s{kDomain, Partitioning::FractionalOdd, OutputPrimitive::TriangleCw};
    float const f = float(state.range(0)) / 10;
    TessellatedPatch patch;
    std::uint64_t points = 0, triangles = 0;
    for (auto _ : state) {
        tessellate(s, process_tess_factors(s, {f, f, f, f, f, f}), patch);
        benchmark::DoNotOptimize(patch.indices.data());
        points += patch.points();
        triangles += patch.indices.size() / 3;
    }
    if (points == 0) state.SkipWithError("no points");
    state.counters["Mpoint/s"] =
        benchmark::Counter(double(points) * 1e-6, benchmark::Counter::kIsRate);
    state.counters["Mtri/s"] =
        benchmark::Counter(double(triangles) * 1e-6, benchmark::Counter::kIsRate);
}

BENCHMARK(uniform_factor<TessellatorDomain::Quad>)->Arg(30)->Arg(103)->Arg(167)->Arg(630);
BENCHMARK(uniform_factor<TessellatorDomain::Tri>)->Arg(30)->Arg(103)->Arg(167)->Arg(630);

} // namespace
} // namespace tessemu
