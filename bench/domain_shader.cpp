// Evaluation of Gregory and biseptic patches with unit normals, lanes across the points of a patch, one thread.
//
// Counters: evaluations per second, multiplications and all operations per point. The limit to
// compare with is a hand-written kernel, built with contraction off for the same instruction set;
// scripts/bench.sh runs both in turn where the kernel is at hand.
//
// SPDX-License-Identifier: Apache-2.0
#include "shaders_cpp/biseptic/biseptic_domain_shaders.h"
#include "shaders_cpp/gregory/domain_shaders.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <numeric>

namespace tessemu {
namespace {

// Position and unit normal of interior evaluation alone, as the bound computes it.
template <class Inside> struct Evaluation {
    static constexpr TessellatorDomain kDomain = Inside::kDomain;
    static constexpr int kControlPoints = Inside::kControlPoints;
    template <class T> using ControlPoint = typename Inside::template ControlPoint<T>;
    template <class T> using PatchConstant = EdgeRegister<T>;
    template <class T> using Output = SurfacePoint<T>;
    template <class T>
    SurfacePoint<T> operator()(DomainInput<T> const& in,
                               ControlPoints<ControlPoint<T>> const& patch,
                               ControlPoints<EdgeRegister<T>> const&) const
    {
        TangentFrame<T> const s = Inside::template evaluate<T>(patch, in, false);
        return {s.position, unit_or_zero(cross(s.du, s.dv))};
    }
};

struct Workload {
    static constexpr std::size_t kPatches = 1450; // bigguy's
    std::vector<float> control_points, registers, u, v, out;
    std::size_t points, padded;

    Workload(int n, int per_patch) : points(std::size_t(n * n)), padded((points + 15) / 16 * 16)
    {
        std::uint32_t state = 1;
        auto const random = [&] {
            return float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f;
        };
        for (std::size_t p = 0; p < kPatches; ++p)
            for (int i = 0; i < per_patch; ++i)
                for (int k = 0; k < 3; ++k)
                    control_points.push_back(float(k == 0   ? i % 4
                                                   : k == 1 ? i / 4
                                                            : 0) +
                                             0.3f * random());
        registers.assign(24 * 4, 0.5f);
        for (std::size_t i = 0; i < padded; ++i) {
            std::size_t const k = std::min(i, points - 1), w = std::size_t(n);
            u.push_back(float(k / w) / float(n - 1));
            v.push_back(float(k % w) / float(n - 1));
        }
        out.resize(padded * 7);
    }
};

/// \param per_patch  vectors of a patch
/// \param packed     of these in a control point
template <class Shader, class T, class Check = Lanes<4>>
void run(benchmark::State& state, int per_patch, Contraction contraction = Contraction::None,
         int packed = 1)
{
    Workload w(int(state.range(0)), per_patch);
    DomainProgramOn<Shader, T> const program;
    ShaderBinding const binding(Shader{}, SiteState{contraction, 0});
    StageBuffers const buffers({});
    StageCounters counters;
    std::uint64_t evaluations = 0;
    auto const batch = [&](std::size_t p, std::vector<float>& out) {
        return DomainBatch{w.control_points.data() + p * std::size_t(per_patch) * 3,
                           per_patch / packed,
                           w.registers.data(),
                           24,
                           std::int32_t(p),
                           w.u.data(),
                           w.v.data(),
                           w.points,
                           out.data(),
                           w.padded};
    };
    for (auto _ : state) {
        StageScope const scope(counters, buffers, binding.sites());
        for (std::size_t p = 0; p < Workload::kPatches; ++p) {
            program.run(binding, batch(p, w.out), counters);
            benchmark::ClobberMemory();
        }
        evaluations += Workload::kPatches * w.points;
    }
    // The last patch against the scalar machine, bit for bit.
    std::vector<float> check(w.padded * 7);
    DomainProgramOn<Shader, Check> const narrow;
    StageCounters ignored;
    {
        StageScope const scope(ignored, buffers, binding.sites());
        narrow.run(binding, batch(Workload::kPatches - 1, check), ignored);
    }
    for (std::size_t k = 0; k < 6; ++k)
        for (std::size_t i = 0; i < w.points; ++i)
            if (std::bit_cast<std::uint32_t>(check[k * w.padded + i]) !=
                std::bit_cast<std::uint32_t>(w.out[k * w.padded + i]))
                return state.SkipWithError("results differ between lane counts");
    state.counters["Meval/s"] =
        benchmark::Counter(double(evaluations) * 1e-6, benchmark::Counter::kIsRate);
    if (ScalarTraits<T>::kCounted) {
        FlopCount const& c = counters.flops;
        state.counters["mul/point"] = double(c.mul) / double(evaluations);
        state.counters["flops/point"] =
            double(c.add + c.mul + c.mad + c.div + c.sqrt) / double(evaluations);
        state.counters["reads/point"] = double(counters.input_fetches) / double(evaluations);
    }
}

using Quad = Evaluation<GregoryQuadInside>;
using Regular = Evaluation<RegularQuadInside>;
using Triangle = Evaluation<GregoryTriangleInside>;
using Biseptic = Evaluation<BisepticInside>;

void gregory_quad_uncounted(benchmark::State& s)
{
    run<Quad, Lanes<kNativeLanes>>(s, 20);
}
void gregory_quad_counted(benchmark::State& s)
{
    run<Quad, Counted<Lanes<kNativeLanes>>>(s, 20);
}
void gregory_quad_counted_contracted(benchmark::State& s)
{
    run<Quad, CheckScalar, Contracted<Lanes<4>>>(s, 20, Contraction::All);
}
void gregory_quad_counted_8_lanes(benchmark::State& s)
{
    run<Quad, Counted<Lanes<8>>>(s, 20);
}
void gregory_quad_whole_domain_shader(benchmark::State& s)
{
    run<GregoryQuadDomainShader, Counted<Lanes<kNativeLanes>>>(s, 20);
}
void regular_quad_counted(benchmark::State& s)
{
    run<Regular, Counted<Lanes<kNativeLanes>>>(s, 16);
}
void gregory_triangle_counted(benchmark::State& s)
{
    run<Triangle, Counted<Lanes<kNativeLanes>>>(s, 15);
}

void biseptic_quad_counted(benchmark::State& s)
{
    run<Biseptic, Counted<Lanes<kNativeLanes>>>(s, 64, Contraction::None, BisepticInside::kPacked);
}

BENCHMARK(gregory_quad_uncounted)->Arg(17)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(gregory_quad_counted)->Arg(17)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(gregory_quad_counted_contracted)->Arg(17)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(gregory_quad_counted_8_lanes)->Arg(17)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(gregory_quad_whole_domain_shader)->Arg(17)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(regular_quad_counted)->Arg(17)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(gregory_triangle_counted)->Arg(17)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(biseptic_quad_counted)->Arg(17)->Arg(64)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace tessemu
