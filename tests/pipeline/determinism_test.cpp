// Same input, same bytes: threads and the form of the machine change neither picture nor counters.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/frame.h"
#include "tests/support/machines.h"

#include <gtest/gtest.h>

#include <cstring>

namespace tessemu {
namespace {

struct Bytes {
    std::string pixels;
    DrawStatistics statistics;
};

Bytes draw_bytes(PatchMesh const& patches, ControlMesh const& mesh, int threads,
                 Machine const& machine)
{
    FrameSettings s;
    s.width = 150;
    s.height = 110;
    s.tess_factor = 5.7f;
    s.machine = machine;
    s.camera = frame_points(mesh.positions, {0.5f, 0.4f, 1}, 150.0f / 110);
    Frame const f = draw_frame(patches, s, ThreadPool(threads));
    Bytes out{{}, f.statistics};
    for (int y = 0; y < s.height; ++y) {
        out.pixels.append(reinterpret_cast<char const*>(f.color.texel(0, y)), f.color.row_bytes());
        out.pixels.append(reinterpret_cast<char const*>(f.depth.codes() + f.depth.index(0, y)),
                          150 * 4);
    }
    return out;
}

TEST(Determinism, PictureAndCountersDoNotDependOnThreadsLanesOrForm)
{
    for (char const* name : {"jug", "spindle", "saddle_star"})
        for (Contraction contraction : {Contraction::None, Contraction::All, Contraction::Mixed}) {
            Technique const& technique = find_technique("gregory-stencil");
            PreparedMesh const m = prepare_mesh(load_model(name).mesh, technique);
            auto const patches = technique.build(*m.topology, {});
            std::vector<Machine> const machines = test::machines(contraction, 3);
            Bytes const first = draw_bytes(*patches, *m.mesh, 1, machines[0]);
            for (int threads : {1, 2, 3, 8})
                for (Machine const& machine : machines) {
                    Bytes const other = draw_bytes(*patches, *m.mesh, threads, machine);
                    ASSERT_TRUE(first.pixels == other.pixels)
                        << name << " -j " << threads << " " << testing::PrintToString(machine);
                    ASSERT_EQ(first.statistics, other.statistics)
                        << name << " -j " << threads << " " << testing::PrintToString(machine);
                }
        }
}

} // namespace
} // namespace tessemu
