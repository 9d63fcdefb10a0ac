// Peer: OpenSubdiv's CpuEvaluator on the same cage, Gregory end caps at isolation level 1, position
// and both first derivatives at 10 x 10 points a patch, one thread. Prints
// "evaluation 10 MILLIONS_A_SECOND".
//
// SPDX-License-Identifier: Apache-2.0
#include "bench/peers/opensubdiv_cage.h"
#include "bench/scene.h"

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuPatchTable.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>

#include <chrono>
#include <cstdio>

using namespace tessemu;
namespace osd = OpenSubdiv;

int main()
{
    BenchScene const scene;
    ControlMesh const& mesh = scene.mesh();
    auto const refiner = opensubdiv_refiner(mesh);
    osd::Far::PatchTableFactory::Options options(1);
    options.SetEndCapType(osd::Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
    refiner->RefineAdaptive(options.GetRefineAdaptiveOptions());
    std::unique_ptr<osd::Far::PatchTable const> const patches(
        osd::Far::PatchTableFactory::Create(*refiner, options));
    osd::Far::StencilTableFactory::Options stencil_options;
    stencil_options.generateIntermediateLevels = true;
    stencil_options.generateOffsets = true;
    std::unique_ptr<osd::Far::StencilTable const> stencils(
        osd::Far::StencilTableFactory::Create(*refiner, stencil_options));
    if (auto const* local = patches->GetLocalPointStencilTable())
        stencils.reset(osd::Far::StencilTableFactory::AppendLocalPointStencilTable(
            *refiner, stencils.get(), local));

    int const coarse = int(mesh.positions.size()), refined = stencils->GetNumStencils();
    std::unique_ptr<osd::Osd::CpuVertexBuffer> const vertices(
        osd::Osd::CpuVertexBuffer::Create(3, coarse + refined));
    vertices->UpdateData(&mesh.positions.data()->x, 0, coarse);
    osd::Osd::BufferDescriptor const source(0, 3, 3), target(3 * coarse, 3, 3);
    osd::Osd::CpuEvaluator::EvalStencils(vertices.get(), source, vertices.get(), target,
                                         stencils.get());

    std::vector<osd::Osd::PatchCoord> coords;
    constexpr int kSide = 10;
    int before = 0; // patches of the arrays before
    for (int array = 0; array < patches->GetNumPatchArrays();
         before += patches->GetNumPatches(array), ++array)
        for (int p = 0; p < patches->GetNumPatches(array); ++p) {
            osd::Far::PatchTable::PatchHandle handle;
            handle.arrayIndex = array;
            handle.patchIndex = before + p;
            handle.vertIndex = p * patches->GetPatchArrayDescriptor(array).GetNumControlVertices();
            for (int i = 0; i < kSide * kSide; ++i) {
                osd::Osd::PatchCoord c;
                c.handle = handle;
                // Patch coordinates are given in the face: the patch's own corner and size.
                osd::Far::PatchParam const param = patches->GetPatchParam(array, p);
                float s = float(i % kSide) / (kSide - 1), t = float(i / kSide) / (kSide - 1);
                param.Unnormalize(s, t);
                c.s = s, c.t = t;
                coords.push_back(c);
            }
        }
    std::unique_ptr<osd::Osd::CpuPatchTable> const table(
        osd::Osd::CpuPatchTable::Create(patches.get()));
    osd::Osd::CpuVertexBuffer* out[3];
    for (auto& o : out) o = osd::Osd::CpuVertexBuffer::Create(3, int(coords.size()));
    std::vector<double> rates;
    for (int round = 0; round < 7; ++round) {
        auto const start = std::chrono::steady_clock::now();
        osd::Osd::CpuEvaluator::EvalPatches(
            vertices->BindCpuBuffer(), source, out[0]->BindCpuBuffer(), source,
            out[1]->BindCpuBuffer(), source, out[2]->BindCpuBuffer(), source, int(coords.size()),
            coords.data(), table->GetPatchArrayBuffer(), table->GetPatchIndexBuffer(),
            table->GetPatchParamBuffer());
        double const s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        rates.push_back(double(coords.size()) / s * 1e-6);
    }
    std::sort(rates.begin(), rates.end());
    std::printf("evaluation 10 %.4f\n", rates[rates.size() / 2]);
    for (auto* o : out) delete o;
}
