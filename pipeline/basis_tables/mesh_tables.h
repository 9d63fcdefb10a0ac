// Tables of a mesh's patches by any scheme (HOLL10 2A): types, the patches' records, and the
// vertices that they sum over.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/local_tables.h"

#include <cstdint>
#include <functional>
#include <span>

namespace tessemu {

/// Tables of a type in single precision, without control points that weigh nothing.
struct TypeOfTables {
    LocalMesh type;
    TableGrid grid;
    int points = 0;
    std::vector<float> position, tangents[2]; ///< as LocalTables
};

/// A vertex as patches sum over it: with one normal. Where infinitely sharp edges meet it is one for
/// each sector, and patches on both sides of a crease have each their own, in the same order.
struct TableVertex {
    std::uint32_t vertex; ///< of the mesh
    /// Its faces' other vertices in order, e_0, e_1, ...; of an open fan one more than faces.
    std::uint32_t first_ring, ring;
    bool is_open;
};

/// Of a vertex and `faces` of its faces from ring(v)[first] on; appends its ring to `rings`.
TableVertex make_table_vertex(Topology const& topology, std::uint32_t v, std::size_t first,
                              std::size_t faces, bool is_open, std::vector<std::uint32_t>& rings);

class MeshTables {
public:
    static constexpr int kSteps = 5; ///< tables of level 5: 32 segments (HOLL10 2A)

    struct Options {
        bool enforced = true; ///< entries that patches share have equal bits (BOLZ03 2.1.1)
        int rings = 1;        ///< LocalMeshFinder's
    };
    using Make = std::function<LocalTables(LocalMesh const&)>;
    using Progress = std::function<void(std::size_t, std::size_t)>;

    /// \param topology  of triangles, or of quads
    /// \param make      tables of kSteps steps
    /// \cost  linear in the patches; some milliseconds for a type
    MeshTables(Topology const& topology, Make const& make, Options options,
               Progress const& progress = {});

    struct Patch {
        std::uint32_t face;
        int rotation;              ///< the domain's corner 0 is the face's corner `rotation`
        std::uint32_t type;        ///< of types()
        std::uint32_t first_point; ///< its points: types()[type].points from here in points()
    };
    /// By ascending vertex: the order of the sums, one for the whole mesh.
    struct Point {
        std::uint32_t vertex; ///< of vertices()
        std::uint32_t column; ///< of the type's tables
    };
    std::span<TypeOfTables const> types() const { return types_; }
    std::span<Patch const> patches() const { return patches_; } ///< of all faces, in their order
    std::span<Point const> points() const { return points_; }
    std::span<TableVertex const> vertices() const { return vertices_; }
    std::span<std::uint32_t const> rings() const { return rings_; } ///< vertices of the mesh
    /// The same rings around all of a vertex, whatever is sharp: [vertex of vertices()].
    std::span<TableVertex const> whole_vertices() const { return whole_; }
    bool has_creases() const { return has_creases_; } ///< a vertex is in vertices() twice
    /// Inside the mesh; where they end none of their vertices need be twice.
    bool has_sharp_edges() const { return has_sharp_edges_; }
    /// Corners of faces that meet at a vertex between two infinitely sharp edges have one number.
    std::uint32_t sector(HalfEdge h) const { return sectors_[h]; }
    std::uint32_t sectors() const { return sector_count_; }
    std::size_t changed() const { return changed_; } ///< entries that enforcement changed

private:
    void add_vertices(Topology const& topology, LocalMeshFinder const& finder,
                      std::vector<std::vector<HalfEdge>> const& corners_of_points);
    void enforce(Topology const& topology);

    std::vector<TypeOfTables> types_;
    std::vector<Patch> patches_;
    std::vector<Point> points_;
    std::vector<TableVertex> vertices_, whole_;
    std::vector<std::uint32_t> rings_;
    std::vector<std::uint32_t> sectors_; // by half-edge
    std::uint32_t sector_count_ = 0;
    bool has_creases_ = false, has_sharp_edges_ = false;
    std::size_t changed_ = 0;
};

} // namespace tessemu
