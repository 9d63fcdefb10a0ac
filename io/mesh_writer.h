// Tessellated meshes as .obj or .ply, patch by patch as the domain shader emitted them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/frame.h"
#include "pipeline/mesh/placement.h"

#include <filesystem>
#include <iosfwd>

namespace tessemu {

class Sha256;

/// Streams a mesh to disk: vertices and triangles go to two temporary files that become one at the
/// end, so memory holds one patch (with welding: one entry per vertex).
///
/// A vertex is position, normal, patch (the face's number in the file's mesh, from 0), and u, v in
/// its unit (patch_place.h).
/// Faces run counter-clockwise seen from outside. OBJ: v, vt (u, v), vn, a group per patch. PLY:
/// binary little endian, properties x y z nx ny nz u v (float) and patch (int). Of a mesh that was
/// moved or scaled positions are the file's, in double, and x y z of a PLY are double.
class MeshWriter {
public:
    /// \param weld  join vertices whose position and normal have equal bits; triangles that lose a
    ///              corner that way are left out; patch and (u,v) are those of the first
    /// \param placement  of the mesh in its file
    /// Throws WriteError for another extension or a path that cannot be written.
    MeshWriter(std::filesystem::path path, bool weld, Placement const& placement = {});
    ~MeshWriter();

    void add(SurfacePatch const& patch);
    /// Completes the file. Without it nothing is left behind.
    void finish();

    std::uint64_t vertices() const;
    std::uint64_t triangles() const;
    /// Adds the mesh's bytes to a hash, little endian: the vertices (x y z as a PLY has them; nx ny
    /// nz u v as floats; patch as a 32-bit integer), then the triangles (three 32-bit vertex
    /// numbers). The same for both formats. Call after finish().
    void add_to_hash(Sha256& hash) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessemu
