// Displacement of any scheme's surface: height map, texture coordinates and who owns them, and the
// epilog that a draw's domain shader gets.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "pipeline/commands/surface_settings.h"
#include "pipeline/mesh/patch_place.h"
#include "pipeline/mesh/topology.h"
#include "shaders_cpp/displacement.h"

namespace tessemu {

/// Heights from an image, rows from the top.
struct HeightImage {
    std::vector<float> heights;
    int width = 0, height = 0;
};

/// A height map on a mesh.
class Displacement {
public:
    /// The built-in solid pattern: studs on a lattice of `period`.
    /// \param scale  displacement at full height, object space; negative is inwards
    static Displacement studs(float period, float scale);
    /// An image on the texture coordinates of the file's mesh. Throws Error if it has none.
    Displacement(Topology const& topology, HeightImage const& image, float scale);
    Displacement(Displacement&&) = default;

    HeightMap height_map() const;
    float scale() const { return scale_; }
    /// The largest distance between a point and where it is displaced to; the scale's magnitude at
    /// least.
    float reach() const { return reach_; }
    /// See OwnedCoordinates; empty for the pattern.
    std::span<float const> corners() const { return corners_; }
    /// The first of a unit's four corners among them.
    std::uint32_t first_corner(ControlMesh const& mesh, PatchPlace const& place) const;

private:
    Displacement() = default;
    float scale_ = 0, reach_ = 0, frequency_ = 1;
    int width_ = 0, height_ = 0;
    std::vector<float> texels_, corners_;
    std::vector<std::uint32_t> split_start_; // of a face that is no quad: its quads' corners
};

struct PatchEpilog {
    DomainEpilog shader;
    std::shared_ptr<void const> memory; ///< what the shader's buffers view
};

/// Projection, or displacement and projection. `patches` of one shape, by primitive id, on `mesh`.
PatchEpilog make_patch_epilog(ControlMesh const& mesh, std::span<PatchPlace const> patches,
                              SurfaceSettings const& settings);

} // namespace tessemu
