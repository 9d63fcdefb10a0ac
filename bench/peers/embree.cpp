// Peer: Embree's rtcInterpolateN on the same cage as a subdivision surface, position and both first
// derivatives at 10 x 10 points a face, one thread. Prints "evaluation 10 MILLIONS_A_SECOND".
//
// SPDX-License-Identifier: Apache-2.0
#include "bench/scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

using namespace tessemu;

int main()
{
    BenchScene const scene;
    ControlMesh const& mesh = scene.mesh();
    RTCDevice const device = rtcNewDevice("threads=1");
    RTCGeometry const geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SUBDIVISION);
    auto* const positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size() + 1));
    // One more: Embree reads four floats of each, and asserts that the last one's are numbers too.
    std::fill_n(positions + 3 * mesh.positions.size(), 3, 0.0f);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (int k = 0; k < 3; ++k) positions[3 * i + std::size_t(k)] = mesh.positions[i][k];
    std::vector<unsigned> sides, indices;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        sides.push_back(unsigned(mesh.face(f).size()));
        for (std::uint32_t v : mesh.face(f)) indices.push_back(v);
    }
    std::copy(sides.begin(), sides.end(),
              static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_FACE, 0,
                                                             RTC_FORMAT_UINT, 4, sides.size())));
    std::copy(indices.begin(), indices.end(),
              static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                             RTC_FORMAT_UINT, 4, indices.size())));
    rtcCommitGeometry(geometry);
    RTCScene const rtc_scene = rtcNewScene(device);
    rtcAttachGeometry(rtc_scene, geometry);
    rtcCommitScene(rtc_scene);

    constexpr unsigned kSide = 10, kCount = 112; // a multiple of 16, as Embree 3.13 needs
    alignas(64) static float u[kCount], v[kCount], out[9][3 * kCount];
    alignas(64) static unsigned face[kCount];
    for (unsigned i = 0; i < kCount; ++i) {
        unsigned const k = std::min(i, kSide * kSide - 1);
        u[i] = float(k % kSide) / (kSide - 1), v[i] = float(k / kSide) / (kSide - 1);
    }
    std::vector<double> rates;
    for (int round = 0; round < 9; ++round) {
        auto const start = std::chrono::steady_clock::now();
        for (unsigned f = 0; f < sides.size(); ++f) {
            std::fill(face, face + kCount, f);
            RTCInterpolateNArguments a{};
            a.geometry = geometry;
            a.primIDs = face;
            a.u = u, a.v = v, a.N = kCount;
            a.bufferType = RTC_BUFFER_TYPE_VERTEX;
            a.P = out[0], a.dPdu = out[3], a.dPdv = out[6];
            a.valueCount = 3;
            rtcInterpolateN(&a);
        }
        double const s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        rates.push_back(double(sides.size()) * kSide * kSide / s * 1e-6);
    }
    std::sort(rates.begin(), rates.end());
    std::printf("evaluation 10 %.4f\n", rates[rates.size() / 2]);
    rtcReleaseScene(rtc_scene);
    rtcReleaseGeometry(geometry);
    rtcReleaseDevice(device);
}
