// Peer: OpenSubdiv's uniform refinement of the same cage, positions, one thread: stencils of a level
// evaluated from the cage; points level by level; and these with the refinement of the topology
// that they need. Prints "stencils LEVEL MILLISECONDS", "points ...", "refinement ...".
//
// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/opensubdiv_cage.h"
#include "bench/scene.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <chrono>
#include <cstdio>

using namespace tessemu;
namespace osd = OpenSubdiv;

namespace {

struct Point {
    float x[3];
    void Clear() { x[0] = x[1] = x[2] = 0; }
    void AddWithWeight(Point const& p, float w)
    {
        for (int k = 0; k < 3; ++k) x[k] += w * p.x[k];
    }
};

template <class Work> double median_ms(Work const& work)
{
    std::vector<double> times;
    for (int round = 0; round < 15; ++round) {
        auto const start = std::chrono::steady_clock::now();
        work();
        std::chrono::duration<double, std::milli> const t =
            std::chrono::steady_clock::now() - start;
        times.push_back(t.count());
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

} // namespace

int main()
{
    BenchScene const scene;
    ControlMesh const& mesh = scene.mesh();
    for (int level = 1; level <= 3; ++level) {
        auto const refiner = opensubdiv_refiner(mesh);
        refiner->RefineUniform(osd::Far::TopologyRefiner::UniformOptions(level));
        osd::Far::StencilTableFactory::Options options;
        options.generateIntermediateLevels = false;
        options.generateOffsets = true;
        std::unique_ptr<osd::Far::StencilTable const> const stencils(
            osd::Far::StencilTableFactory::Create(*refiner, options));
        int const coarse = int(mesh.positions.size()), refined = stencils->GetNumStencils();
        std::unique_ptr<osd::Osd::CpuVertexBuffer> const vertices(
            osd::Osd::CpuVertexBuffer::Create(3, coarse + refined));
        vertices->UpdateData(&mesh.positions.data()->x, 0, coarse);
        osd::Osd::BufferDescriptor const source(0, 3, 3), target(3 * coarse, 3, 3);
        std::printf("stencils %d %.4f\n", level, median_ms([&] {
                        osd::Osd::CpuEvaluator::EvalStencils(vertices.get(), source, vertices.get(),
                                                             target, stencils.get());
                    }));

        std::vector<Point> points(std::size_t(refiner->GetNumVerticesTotal()));
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            points[v] = {{mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z}};
        osd::Far::PrimvarRefiner const primvars(*refiner);
        auto const interpolate = [&] {
            Point* from = points.data();
            for (int l = 1; l <= level; ++l) {
                Point* const to = from + refiner->GetLevel(l - 1).GetNumVertices();
                primvars.Interpolate(l, from, to);
                from = to;
            }
        };
        std::printf("points %d %.4f\n", level, median_ms(interpolate));
        std::printf("refinement %d %.4f\n", level, median_ms([&] {
                        refiner->Unrefine();
                        refiner->RefineUniform(osd::Far::TopologyRefiner::UniformOptions(level));
                        interpolate();
                    }));
    }
}
