// Displacement of any scheme's surface: height map, texture coordinates and who owns them, and the
// epilog that a draw's domain shader gets.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "pipeline/commands/surface_settings.h"
#include "pipeline/mesh/refinement.h"
#include "shaders_cpp/displacement.h"

#include <variant>

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
    /// An image on the texture coordinates of the file's mesh, linear in its faces; with
    /// SubdivisionRules::smooth_coordinates on those that its steps have made, linear in the faces of
    /// the drawn mesh. Throws Error if it has none.
    Displacement(std::shared_ptr<RefinedMesh const> mesh, HeightImage image, float scale,
                 HeightWrap wrap = HeightWrap::Repeat);
    Displacement(Displacement&&) = default;

    HeightMap height_map() const;
    float scale() const { return scale_; }
    /// The largest distance between a point and where it is displaced to; the scale's magnitude at
    /// least.
    float reach() const { return reach_; }
    /// See OwnedCoordinates; empty for the pattern.
    std::span<float const> corners() const { return corners_; }
    /// OwnedCoordinates::patches of a patch.
    std::array<std::uint32_t, 2> words(PatchPlace const& place) const;

    /// A point of a patch, and a direction to leave it in.
    struct Ray {
        glm::dvec2 domain, step;   ///< (u, v), and what a unit of the way adds to it
        glm::dvec3 point, tangent; ///< of the smooth surface, and what it adds to that
    };
    /// How fast the displacement grows along a unit of the way, as the ray begins: in an image in
    /// the patch's own coordinates, towards the side that it leaves to where the height has a bend.
    double slope(PatchPlace const& place, Ray const& ray) const;

private:
    Displacement() = default;
    bool is_smooth() const { return faces_.has_value(); }
    /// Whose faces' corners have the coordinates.
    Topology const& coordinate_topology() const
    {
        return is_smooth() ? mesh_->topology() : mesh_->base_topology();
    }
    /// A patch's place on that mesh.
    PatchPlace on_coordinates(PatchPlace const& place) const;
    /// Of a place there the first of its unit's four corners.
    std::uint32_t first_corner(PatchPlace const& place) const;
    double image_slope(PatchPlace const& place, Ray const& ray) const;
    double studs_slope(Ray const& ray) const;

    float scale_ = 0, reach_ = 0, frequency_ = 1;
    HeightImage image_;
    HeightWrap wrap_ = HeightWrap::Repeat;
    std::shared_ptr<RefinedMesh const> mesh_; // none: the pattern
    std::optional<FacesByPlace> faces_;       // with smooth coordinates
    std::vector<float> corners_;
    std::vector<std::uint32_t> split_start_; // of a face that is no quad: its quads' corners
};

struct SurfaceEpilog {
    std::variant<ProjectionEpilog, DisplacementEpilog> shader;
    std::shared_ptr<void const> memory; ///< what the shader's buffers view
};

/// Projection, or displacement and projection. `patches` of one shape, by primitive id.
SurfaceEpilog make_surface_epilog(std::span<PatchPlace const> patches,
                                  SurfaceSettings const& settings);

} // namespace tessemu
