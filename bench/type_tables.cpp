// LOOP10's changes of basis made before any mesh is there: the 10 types that isolation leaves, and
// all 449.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/valence_type.h"
#include "pipeline/schemes/gregory/stencils.h"

#include <benchmark/benchmark.h>

namespace tessemu {
namespace {

void gregory_tables(benchmark::State& state, std::vector<ValenceType> const& types)
{
    std::size_t weights = 0;
    for (auto _ : state) {
        weights = 0;
        Neighbourhood n;
        for (ValenceType const& t : types) {
            ControlMesh const cage = one_ring_cage(t);
            find_neighbourhood(Topology(cage), 0, n);
            PatchStencils const s = make_gregory_stencils(n, t.inputs() == 16, {});
            weights += s.rows.size() * std::size_t(s.inputs);
            benchmark::DoNotOptimize(s);
        }
    }
    state.counters["types"] = double(types.size());
    state.counters["table_bytes"] = double(4 * weights);
}
BENCHMARK_CAPTURE(gregory_tables, isolated, isolated_valence_types())
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(gregory_tables, all, valence_types())->Unit(benchmark::kMillisecond);

} // namespace
} // namespace tessemu
