// Tessellated meshes as .obj or .ply, patch by patch as the domain shader emitted them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/output_file.h"
#include "pipeline/frame.h"
#include "pipeline/mesh/placement.h"

namespace tessemu {

class Sha256;

enum class MeshFormat { Obj, Ply };

/// By the extension, .obj or .ply in any case; a stream without one gets OBJ. Throws WriteError
/// otherwise.
MeshFormat mesh_format(OutputFile const& out);

/// Streams a mesh to disk: vertices and triangles go to two files without a name that become one at
/// the end, so memory holds one patch (with welding: one entry per vertex).
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
    /// \param out   is written by finish(); the caller commits
    /// \param placement  of the mesh in its file
    /// \param file_faces by the mesh's face its number in the file; empty: the same
    /// Throws WriteError for another extension, and as any part of the mesh cannot be stored.
    MeshWriter(OutputFile& out, bool weld, Placement const& placement = {},
               std::vector<std::uint32_t> file_faces = {});
    ~MeshWriter();

    void add(SurfacePatch const& patch);
    /// Writes the file.
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
