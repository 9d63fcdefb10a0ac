// The scene that this project and its peers measure: bigguy, or the built-in jug where it is not
// there, seen whole.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <filesystem>

namespace tessemu {

struct BenchScene {
    SchemeOnMesh scheme;
    FrameSettings settings;

    ControlMesh const& mesh() const { return scheme.mesh->mesh(); }
    PatchMesh const& patches() const { return *scheme.patches; }

    explicit BenchScene(float tess_factor = 1)
    {
        std::string const bigguy = std::string(TESSEMU_SHARED_DIR) + "/models/bigguy.obj";
        scheme = build_scheme(find_scheme("gregory-stencil"),
                              load_model(std::filesystem::exists(bigguy) ? bigguy : "jug").mesh);
        settings.tess_factor = tess_factor;

        // The bounding sphere fills the picture at a field of view of 0.6.
        auto const& points = mesh().positions;
        glm::vec3 low(1e30f), high(-1e30f);
        for (glm::vec3 const& p : points) low = glm::min(low, p), high = glm::max(high, p);
        glm::vec3 const centre = 0.5f * (low + high);
        float radius = 0;
        for (glm::vec3 const& p : points) radius = std::max(radius, glm::length(p - centre));
        float const distance = radius / std::sin(0.3f) * 1.02f;
        Camera& c = settings.camera;
        c.target = centre;
        c.eye = centre + distance * glm::normalize(glm::vec3(0.35f, 0.25f, 0.9f));
        c.focal = 1 / std::tan(0.3f);
        c.near_plane = distance - 1.2f * radius;
        c.far_plane = distance + 1.2f * radius;
    }
};

} // namespace tessemu
