// Displacement of any scheme's surface: height map, texture coordinates and who owns them, and the
// epilog that a draw's domain shader gets.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "pipeline/patch_origin.h"
#include "pipeline/topology.h"
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
    /// An image on the mesh's texture coordinates. Throws Error if the mesh has none.
    Displacement(Topology const& topology, HeightImage const& image, float scale);
    Displacement(Displacement&&) = default;

    HeightMap height_map() const;
    float scale() const { return scale_; }
    /// See OwnedCoordinates; empty for the pattern.
    std::span<float const> corners() const { return corners_; }

private:
    Displacement() = default;
    float scale_ = 0, frequency_ = 1;
    int width_ = 0, height_ = 0;
    std::vector<float> texels_, corners_;
};

struct PatchEpilog {
    std::shared_ptr<DomainEpilog const> program;
    std::shared_ptr<void const> memory; ///< what the program's buffers view
};

/// Projection, or displacement and projection. `patches` of one shape, by primitive id.
PatchEpilog make_patch_epilog(ControlMesh const& mesh, std::span<PatchOrigin const> patches,
                              VertexFinish const& finish,
                              std::shared_ptr<Displacement const> const& displacement,
                              Machine const& machine);

} // namespace tessemu
