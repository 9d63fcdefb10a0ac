// A modelling program's first objects, as the OBJ files that it writes: object and material lines,
// texture coordinates and normals with every corner.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/mesh.h"

#include <string>
#include <vector>

namespace tessemu::test {

struct Shape {
    std::string name;
    ControlMesh mesh;
    bool closed = true;
};

Shape plane();
Shape grid(int across, int along);
Shape cube();
/// The cube with a crease that ends, a semi-sharp one and a corner.
ControlMesh tagged_cube();
/// Triangles around the poles, quads between them.
Shape uv_sphere(int segments, int rings);
/// Triangles; each of an icosahedron's split `levels` times.
Shape ico_sphere(int levels);
/// The caps are faces of `sides` sides.
Shape cylinder(int sides);
/// Triangles that meet at the apex, and a base of `sides` sides.
Shape cone(int sides);
Shape torus(int major, int minor);
/// Of 2 n quads, n around each pole: the poles' valence is n, the equator's 3.
Shape trapezohedron(int n);
/// n faces around a vertex of the boundary, quads or triangles.
Shape open_fan(int n, bool quads);

/// The first eight, as modelling programs size them.
std::vector<Shape> first_objects();
std::string obj_of(Shape const& shape);

} // namespace tessemu::test
