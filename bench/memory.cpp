// Peak memory of one large draw: a model at a tess factor, 1024x1024. Prints domain points, seconds
// and the peak resident size. Usage: bench_memory [MODEL [FACTOR]], beast at 64 by default.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"

#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <fstream>

using namespace tessemu;

namespace {
// VmHWM of the process, in MB.
double peak_megabytes()
{
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == "VmHWM:") {
            double kilobytes = 0;
            status >> kilobytes;
            return kilobytes / 1024;
        }
    return 0;
}
} // namespace

int main(int argc, char** argv)
{
    std::string model = std::string(TESSEMU_SHARED_DIR) + "/models/beast.obj";
    if (argc > 1) model = argv[1];
    float const factor = argc > 2 ? std::stof(argv[2]) : 64;
    if (argc < 2 && !std::filesystem::exists(model)) {
        fmt::print("{} is not there\n", model);
        return 0;
    }
    SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), load_model(model).mesh);
    FrameSettings settings;
    settings.tess_factor = factor;
    settings.camera = frame_points(m.mesh->mesh().positions, {0.5f, 0.5f, 1}, 1);
    auto const start = std::chrono::steady_clock::now();
    Frame const frame = draw_frame(*m.patches, settings, ThreadPool());
    double const seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("{} patches, {} domain points, {:.2f} s, peak {:.0f} MB\n",
               frame.statistics.pipeline.HSInvocations, frame.statistics.pipeline.DSInvocations,
               seconds, peak_megabytes());
}
