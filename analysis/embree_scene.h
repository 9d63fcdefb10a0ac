// Triangles as an Embree scene.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree3/rtcore.h>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

namespace tessemu {

class EmbreeScene {
public:
    /// \tparam Vec  glm::vec3 or glm::dvec3, which is rounded
    template <class Vec>
    EmbreeScene(std::span<Vec const> positions, std::span<std::uint32_t const> triangles,
                RTCSceneFlags flags = RTC_SCENE_FLAG_NONE)
        : device_(rtcNewDevice(nullptr)),
          scene_(rtcNewScene(device_.get()))
    {
        rtcSetSceneFlags(scene_.get(), flags);
        RTCGeometry const g = new_geometry(RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* const v = static_cast<float*>(rtcSetNewGeometryBuffer(
            g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), positions.size()));
        for (std::size_t i = 0; i < positions.size(); ++i)
            for (int k = 0; k < 3; ++k) v[3 * i + std::size_t(k)] = float(positions[i][k]);
        auto* const n = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), triangles.size() / 3));
        std::copy(triangles.begin(), triangles.end(), n);
        commit(g);
    }
    /// Boxes that decide for themselves what meets them.
    /// \param bounds, meets  RTC's functions of `of`, which outlives the scene
    EmbreeScene(std::size_t boxes, void* of, RTCBoundsFunction bounds, RTCIntersectFunctionN meets)
        : device_(rtcNewDevice(nullptr)),
          scene_(rtcNewScene(device_.get()))
    {
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        RTCGeometry const g = new_geometry(RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(g, unsigned(boxes));
        rtcSetGeometryUserData(g, of);
        rtcSetGeometryBoundsFunction(g, bounds, nullptr);
        rtcSetGeometryIntersectFunction(g, meets);
        commit(g);
    }
    RTCScene get() const { return scene_.get(); }

private:
    RTCGeometry new_geometry(RTCGeometryType type) const
    {
        return rtcNewGeometry(device_.get(), type);
    }
    void commit(RTCGeometry g) const
    {
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene_.get(), g);
        rtcReleaseGeometry(g);
        rtcCommitScene(scene_.get());
    }
    struct Release {
        void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
        void operator()(RTCScene s) const { rtcReleaseScene(s); }
    };
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene_;
};

} // namespace tessemu
