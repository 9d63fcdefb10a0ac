// Time of each step from an OBJ file to a picture at factor 1, from 10^4 to 10^6 faces: a closed
// torus of quads. The time per face should not grow; the peak of resident memory is the process's.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/obj_reader.h"
#include "pipeline/frame.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/schemes/scheme.h"

#include <benchmark/benchmark.h>

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <optional>

#include <sys/resource.h>

namespace tessemu {
namespace {

std::string torus(int n)
{
    std::string text;
    double const turn = 2 * std::acos(-1.0) / n;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            double const r = 1 + 0.4 * std::cos(j * turn);
            text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", r * std::cos(i * turn),
                                r * std::sin(i * turn), 0.4 * std::sin(j * turn));
        }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            int const k = (i + 1) % n, l = (j + 1) % n;
            text += fmt::format("f {} {} {} {}\n", i * n + j + 1, k * n + j + 1, k * n + l + 1,
                                i * n + l + 1);
        }
    return text;
}

void load_classify_draw(benchmark::State& state)
{
    double const faces = double(state.range(0)) * double(state.range(0));
    Scheme const& scheme = find_scheme("gregory-stencil");
    Parameters const parameters = resolve_parameters(scheme.info(), {});
    ThreadPool const threads;
    using Clock = std::chrono::steady_clock;
    double load = 0, topology = 0, build = 0, drawing = 0;
    auto const since = [](Clock::time_point t) {
        return std::chrono::duration<double>(Clock::now() - t).count();
    };
    for (auto _ : state) {
        state.PauseTiming();
        std::optional<std::string> text(torus(int(state.range(0))));
        state.ResumeTiming();
        auto t = Clock::now();
        ObjFile file = read_obj(*text, "torus");
        text.reset(); // as a program lets go of a file
        load += since(t), t = Clock::now();
        auto const mesh =
            std::make_shared<RefinedMesh const>(std::move(file.mesh), 0, catmull_clark_step);
        topology += since(t), t = Clock::now();
        auto const patches = scheme.build(mesh, parameters, {.threads = &threads});
        build += since(t), t = Clock::now();
        FrameSettings s;
        s.camera = frame_points(mesh->mesh().positions, {0.3f, 0.4f, 1}, 1);
        Frame const frame = draw_frame(*patches, s, threads);
        drawing += since(t);
        if (double(frame.statistics.pipeline.HSInvocations) != faces)
            state.SkipWithError("patches are missing");
    }
    double const per_face = 1e9 / faces / double(state.iterations());
    state.counters["load ns/face"] = load * per_face;
    state.counters["topology ns/face"] = topology * per_face;
    state.counters["tables ns/face"] = build * per_face;
    state.counters["draw ns/face"] = drawing * per_face;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    state.counters["peak MiB"] = double(usage.ru_maxrss) / 1024;
}
BENCHMARK(load_classify_draw)->Arg(100)->Arg(316)->Arg(1000)->Unit(benchmark::kMillisecond);

} // namespace
} // namespace tessemu
