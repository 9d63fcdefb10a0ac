// A control mesh as a scheme draws it: the file's mesh after some steps of subdivision, each face
// with its place on the file's mesh.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/patch_place.h"
#include "pipeline/mesh/subdivision_tables.h"

#include <functional>
#include <memory>

namespace tessemu {

/// A step's mesh and how kernels make its positions. Quads' children are four quads, of any other
/// face a quad for each corner, in the order of the corners, or of a triangle four triangles, as
/// split_triangle() has them; tags are carried along, each a step less sharp.
struct RefinedStep {
    ControlMesh mesh;
    SubdivisionTables tables;
};
struct LimitRules; // limit_points.h
/// A scheme's step.
struct RefinementStep {
    /// \param first  of the mesh's vertices in the vertex buffer
    RefinedStep (*take)(Topology const&, std::uint32_t first);
    bool keeps_triangles = false;      ///< their children are triangles
    char const* name = "";             ///< of the scheme, for messages: "Loop"
    LimitRules const* limit = nullptr; ///< of the surface that steps come to

    RefinedStep operator()(Topology const& topology, std::uint32_t first = 0) const
    {
        return take(topology, first);
    }
    int children(std::size_t sides) const { return keeps_triangles && sides == 3 ? 4 : int(sides); }
};

/// Told while steps are taken: work done, of all.
using RefinementProgress = std::function<void(std::size_t, std::size_t)>;

class RefinedMesh {
public:
    static constexpr int kMaxSteps = 8;
    /// Some 400 bytes each, with the tables that make them.
    static constexpr std::uint64_t kMostFaces = std::uint64_t(1) << 25;

    /// \param steps  0 to kMaxSteps
    /// \cost         memory for the last two meshes and all tables, four times larger with each step
    /// Throws LimitError for more steps or more faces than kMostFaces, and MeshError for a mesh that
    /// is no manifold.
    RefinedMesh(ControlMesh mesh, int steps, RefinementStep step,
                RefinementProgress const& progress = {});
    RefinedMesh(RefinedMesh&&) = default;

    /// The file's mesh. Cameras and sizes are taken from it, whatever steps a scheme takes: the same
    /// for all of them, so that their pictures and errors compare.
    ControlMesh const& base() const { return *base_; }
    Topology const& base_topology() const { return *base_topology_; }
    /// What is drawn.
    ControlMesh const& mesh() const { return steps_ ? *mesh_ : *base_; }
    Topology const& topology() const { return steps_ ? *topology_ : *base_topology_; }
    int steps() const { return steps_; }
    /// Whose rules the surface has, whether steps are taken or not.
    RefinementStep const& step() const { return step_; }
    /// By step: what kernels make mesh()'s positions from base()'s with, in one buffer of all.
    std::span<SubdivisionTables const> tables() const { return tables_; }

    /// A vertex of mesh() as the file's user knows it: "vertex 12", "the middle of face 3"; of new
    /// ones those that may have more than four edges.
    std::string vertex_in_words(std::uint32_t vertex) const;

    /// Of a patch on a face of mesh() whose corner 0 is the face's corner `rotation`.
    PatchPlace place(std::uint32_t face, int rotation = 0) const
    {
        return turned(places_[face], rotation);
    }

private:
    std::unique_ptr<ControlMesh const> base_, mesh_;
    std::unique_ptr<Topology const> base_topology_, topology_;
    int steps_;
    RefinementStep step_;
    std::vector<SubdivisionTables> tables_;
    std::vector<PatchPlace> places_; // by face of mesh()
};

/// The drawn mesh's faces, by the places of patches on them.
class FacesByPlace {
public:
    explicit FacesByPlace(RefinedMesh const& mesh);

    struct Found {
        std::uint32_t face; ///< of the drawn mesh
        int turns;          ///< the patch's corner 0 is the face's corner `turns`
    };
    /// Of a patch on a whole face, however it is turned. \cost  a search
    Found operator()(PatchPlace const& place) const;

private:
    std::vector<std::pair<PatchPlace, std::uint32_t>> faces_; // ascending by place
};

} // namespace tessemu
