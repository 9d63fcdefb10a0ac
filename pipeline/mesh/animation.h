// Animation of a control mesh: a rig of bones along its longest axis, and a motion.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/mesh.h"

#include <memory>

namespace tessemu {

/// [vertex][2] as SkinBuffers has it.
struct Skin {
    std::vector<std::uint32_t> vertices;
    int bones = 0;
};

/// A skin and where its bones are: what an application sends for a frame.
struct Pose {
    std::shared_ptr<Skin const> skin;
    std::vector<float> bones; ///< [bone][3][4]

    std::size_t bytes() const { return bones.size() * sizeof(float); }
    /// A vertex's position, as the shaders compute it but for rounding.
    glm::vec3 posed(std::size_t vertex, glm::vec3 rest) const;
};

/// A chain of bones along the longest side of a mesh's bounding box. Each vertex follows the two
/// nearest bones.
class SpineRig {
public:
    /// \param bones  2 to 255. Throws Error for another number or a mesh without vertices.
    explicit SpineRig(ControlMesh const& mesh, int bones = 6);

    /// A wave runs along the chain, which bends in the plane of the two longest sides.
    /// \param phase  in periods
    /// Rotations come from tan(angle / 2), without sine and cosine.
    Pose sway(double phase) const;

private:
    std::shared_ptr<Skin const> skin_;
    int along_ = 1, across_ = 0; ///< coordinates
    glm::vec3 foot_{0};          ///< the chain's first joint
    float length_ = 1;           ///< of the chain
};

} // namespace tessemu
