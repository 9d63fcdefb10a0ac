// Control mesh: positions, faces, and OpenSubdiv's tags.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tessemu {

/// How the surface meets the mesh's boundary (OpenSubdiv's interpolateboundary).
enum class BoundaryRule {
    /// Faces with a vertex on the boundary are not drawn, unless all boundary edges at their
    /// vertices are infinitely sharp; the boundary curve of what is left is as EdgeOnly has it.
    None = 0,
    /// The boundary is a curve, a vertex with one face is interpolated (LOOP09 4.6).
    EdgeAndCorner = 1,
    /// The boundary curve is smooth through such vertices too.
    EdgeOnly = 2,
};

/// How sharpness falls along a crease (OpenSubdiv's creasemethod).
enum class CreaseMethod {
    Normal,  ///< by one a step
    Chaikin, ///< by one a step, after a mean with the other creases at the edge's end
};

/// How a smooth edge beside a sharp vertex is split (docs/math/subdivision.md, 5.2).
enum class SectorRules {
    OpenSubdiv, ///< as any other: the plain edge point
    Biermann,   ///< leans to the sharp end, by the angle of the sector that the edge is in
};

/// How a mesh is subdivided, where its tags and faces leave a choice.
struct SubdivisionRules {
    BoundaryRule boundary = BoundaryRule::EdgeAndCorner;
    CreaseMethod crease_method = CreaseMethod::Normal;
    bool smooth_triangles = false; ///< other weights for the edges of triangles
    SectorRules sectors = SectorRules::OpenSubdiv;
    /// How far a step moves the rings of tagged and extraordinary vertices into a plane, 0 to 1,
    /// with SectorRules::Biermann; without a value only those of concave sectors, as far as they
    /// need it.
    std::optional<double> flatness = {};
    /// Texture coordinates that steps make: sums by the masks of positions, a seam being a boundary
    /// (HOLL10 2B); otherwise linear in faces.
    bool smooth_coordinates = false;

    bool operator==(SubdivisionRules const&) const = default;
};

/// From this sharpness on an edge or vertex stays as sharp at every step, as in OpenSubdiv.
inline constexpr float kInfinitelySharp = 10;

/// An edge by its vertices, the lower number first.
inline std::pair<std::uint32_t, std::uint32_t> ordered_edge(std::uint32_t a, std::uint32_t b)
{
    return {std::min(a, b), std::max(a, b)};
}

struct ControlMesh {
    struct Crease {
        std::uint32_t a, b;
        float sharpness; ///< kInfinitelySharp and above: infinitely
    };
    struct Corner {
        std::uint32_t vertex;
        float sharpness;
    };

    std::string name; ///< file name without its folder, or the built-in's name
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> face_start{0};    ///< faces + 1 offsets into face_vertices
    std::vector<std::uint32_t> face_vertices;    ///< counter-clockwise, from 0
    std::vector<glm::dvec2> coordinates;         ///< texture coordinates, v upwards
    std::vector<std::uint32_t> face_coordinates; ///< of each face corner; empty: there are none
    std::vector<Crease> creases;
    std::vector<Corner> corners;
    std::vector<std::uint32_t> holes; ///< faces that shape the surface but are not drawn
    /// With SectorRules::Biermann: of each concave sector of a sharp corner the corner of its first
    /// face, which follows its first sharp edge counter-clockwise; positions in face_vertices,
    /// ascending (mark_concave_sectors()).
    std::vector<std::uint32_t> concave;
    SubdivisionRules rules;

    // What joins, cuts and sorts have changed: nothing in a mesh as its file has it.
    std::vector<std::uint32_t> file_vertices, file_faces; ///< numbers in the file, from 0
    std::uint32_t cut_edges = 0;                          ///< of the file, no longer shared
    /// Vertices a < b of an edge that two faces run along and do not share, ascending.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> slits;

    /// Whether the boundary curve is smooth through a vertex with one face.
    bool smooth_corners() const { return rules.boundary != BoundaryRule::EdgeAndCorner; }
    std::uint32_t file_vertex(std::uint32_t v) const
    {
        return file_vertices.empty() ? v : file_vertices[v];
    }
    std::uint32_t file_face(std::uint32_t f) const
    {
        return file_faces.empty() ? f : file_faces[f];
    }
    bool is_slit(std::uint32_t a, std::uint32_t b) const
    {
        return std::binary_search(slits.begin(), slits.end(), ordered_edge(a, b));
    }

    std::size_t faces() const { return face_start.size() - 1; }
    std::span<std::uint32_t const> face(std::size_t f) const
    {
        return std::span(face_vertices).subspan(face_start[f], face_start[f + 1] - face_start[f]);
    }
    void add_face(std::span<std::uint32_t const> vertices)
    {
        face_vertices.insert(face_vertices.end(), vertices.begin(), vertices.end());
        face_start.push_back(std::uint32_t(face_vertices.size()));
    }
};

} // namespace tessemu
