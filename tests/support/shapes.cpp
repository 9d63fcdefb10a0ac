// SPDX-License-Identifier: Apache-2.0
#include "tests/support/shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace tessemu::test {

namespace {

constexpr double kPi = 3.14159265358979323846;

void add_point(ControlMesh& m, double x, double y, double z)
{
    m.positions.emplace_back(float(x), float(y), float(z));
}
void add_circle(ControlMesh& m, int n, double radius, double z)
{
    for (int j = 0; j < n; ++j)
        add_point(m, radius * std::cos(2 * kPi * j / n), radius * std::sin(2 * kPi * j / n), z);
}
void add(ControlMesh& m, std::vector<int> const& face)
{
    m.add_face(std::vector<std::uint32_t>(face.begin(), face.end()));
}
// Quads between the circles of n points that begin at a and, below it, at b.
void add_band(ControlMesh& m, int n, int a, int b)
{
    for (int j = 0; j < n; ++j) add(m, {a + j, b + j, b + (j + 1) % n, a + (j + 1) % n});
}
void add_cap(ControlMesh& m, int n, int first, bool up)
{
    std::vector<int> cap;
    for (int j = 0; j < n; ++j) cap.push_back(first + (up ? j : n - 1 - j));
    add(m, cap);
}

} // namespace

Shape plane()
{
    return {"plane", grid(1, 1).mesh, false};
}

Shape grid(int across, int along)
{
    Shape s{"grid", {}, false};
    for (int y = 0; y <= along; ++y)
        for (int x = 0; x <= across; ++x)
            add_point(s.mesh, 2.0 * x / across - 1, 2.0 * y / along - 1, 0);
    int const w = across + 1;
    for (int y = 0; y < along; ++y)
        for (int x = 0; x < across; ++x)
            add(s.mesh, {y * w + x, y * w + x + 1, (y + 1) * w + x + 1, (y + 1) * w + x});
    return s;
}

Shape cube()
{
    Shape s{"cube", {}};
    for (int i = 0; i < 8; ++i) add_point(s.mesh, i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    for (std::vector<int> const& f : {std::vector{0, 2, 3, 1},
                                      {4, 5, 7, 6},
                                      {0, 1, 5, 4},
                                      {2, 6, 7, 3},
                                      {0, 4, 6, 2},
                                      {1, 3, 7, 5}})
        add(s.mesh, f);
    return s;
}

ControlMesh tagged_cube()
{
    ControlMesh out = cube().mesh;
    auto const crease = [&](std::size_t corner, float sharpness) {
        out.creases.push_back(
            {out.face_vertices[corner], out.face_vertices[corner + 1], sharpness});
    };
    crease(0, kInfinitelySharp);
    crease(1, kInfinitelySharp);
    crease(2, 2.5f);
    out.corners.push_back({out.face_vertices[3], kInfinitelySharp});
    return out;
}

Shape uv_sphere(int segments, int rings)
{
    Shape s{"UV sphere", {}};
    ControlMesh& m = s.mesh;
    add_point(m, 0, 0, 1);
    for (int i = 1; i < rings; ++i)
        add_circle(m, segments, std::sin(kPi * i / rings), std::cos(kPi * i / rings));
    add_point(m, 0, 0, -1);
    int const last = int(m.positions.size()) - 1;
    for (int j = 0; j < segments; ++j) add(m, {0, 1 + j, 1 + (j + 1) % segments});
    for (int i = 0; i + 2 < rings; ++i)
        add_band(m, segments, 1 + i * segments, 1 + (i + 1) * segments);
    for (int j = 0; j < segments; ++j)
        add(m, {last, last - segments + (j + 1) % segments, last - segments + j});
    return s;
}

Shape ico_sphere(int levels)
{
    Shape s{"ico sphere", {}};
    ControlMesh& m = s.mesh;
    add_point(m, 0, 0, 1);
    double const z = 1 / std::sqrt(5.0), r = 2 * z;
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 5; ++j) {
            double const a = 2 * kPi * (j + 0.5 * k) / 5;
            add_point(m, r * std::cos(a), r * std::sin(a), k ? -z : z);
        }
    add_point(m, 0, 0, -1);
    std::vector<std::vector<int>> faces;
    for (int j = 0; j < 5; ++j) {
        int const a = 1 + j, b = 1 + (j + 1) % 5, c = 6 + j, d = 6 + (j + 1) % 5;
        faces.insert(faces.end(), {{0, a, b}, {a, c, b}, {b, c, d}, {11, d, c}});
    }
    for (; levels > 0; --levels) {
        std::map<std::pair<int, int>, int> middles;
        auto const middle = [&](int a, int b) {
            auto const [it, fresh] = middles.try_emplace(std::minmax(a, b), m.positions.size());
            if (fresh) {
                auto const p = m.positions[std::size_t(a)] + m.positions[std::size_t(b)];
                float const length = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
                m.positions.push_back(p / length);
            }
            return it->second;
        };
        std::vector<std::vector<int>> finer;
        for (auto const& f : faces) {
            int const a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
            finer.insert(finer.end(), {{f[0], a, c}, {f[1], b, a}, {f[2], c, b}, {a, b, c}});
        }
        faces = finer;
    }
    for (auto const& f : faces) add(m, f);
    return s;
}

Shape cylinder(int sides)
{
    Shape s{"cylinder", {}};
    add_circle(s.mesh, sides, 1, 1);
    add_circle(s.mesh, sides, 1, -1);
    add_band(s.mesh, sides, 0, sides);
    add_cap(s.mesh, sides, 0, true);
    add_cap(s.mesh, sides, sides, false);
    return s;
}

Shape cone(int sides)
{
    Shape s{"cone", {}};
    add_circle(s.mesh, sides, 1, -1);
    add_point(s.mesh, 0, 0, 1);
    for (int j = 0; j < sides; ++j) add(s.mesh, {j, (j + 1) % sides, sides});
    add_cap(s.mesh, sides, 0, false);
    return s;
}

Shape torus(int major, int minor)
{
    Shape s{"torus", {}};
    for (int i = 0; i < major; ++i)
        for (int j = 0; j < minor; ++j) {
            double const a = 2 * kPi * i / major, b = 2 * kPi * j / minor;
            double const r = 1 + 0.25 * std::cos(b);
            add_point(s.mesh, r * std::cos(a), r * std::sin(a), 0.25 * std::sin(b));
        }
    for (int i = 0; i < major; ++i) {
        int const here = i * minor, next = (i + 1) % major * minor;
        for (int j = 0; j < minor; ++j) {
            int const k = (j + 1) % minor;
            add(s.mesh, {here + j, next + j, next + k, here + k});
        }
    }
    return s;
}

Shape trapezohedron(int n)
{
    Shape s{"trapezohedron", {}};
    add_point(s.mesh, 0, 0, 1);
    add_point(s.mesh, 0, 0, -1);
    for (int j = 0; j < 2 * n; ++j)
        add_point(s.mesh, std::cos(kPi * j / n), std::sin(kPi * j / n), j % 2 ? 0.2 : -0.2);
    auto const equator = [&](int j) { return 2 + j % (2 * n); };
    for (int j = 0; j < 2 * n; j += 2) {
        add(s.mesh, {0, equator(j + 1), equator(j + 2), equator(j + 3)});
        add(s.mesh, {1, equator(j + 2), equator(j + 1), equator(j)});
    }
    return s;
}

Shape open_fan(int n, bool quads)
{
    Shape s{quads ? "fan of quads" : "fan of triangles", {}, false};
    add_point(s.mesh, 0, 0, 0.3);
    for (int j = 0; j <= 2 * n; ++j) {
        double const a = 1.5 * kPi * j / (2 * n), r = j % 2 ? 1.3 : 1;
        add_point(s.mesh, r * std::cos(a), r * std::sin(a), 0.1 * std::sin(5 * a));
    }
    for (int j = 0; j < n; ++j)
        if (quads)
            add(s.mesh, {0, 1 + 2 * j, 2 + 2 * j, 3 + 2 * j});
        else
            add(s.mesh, {0, 1 + 2 * j, 3 + 2 * j});
    return s;
}

std::vector<Shape> first_objects()
{
    return {plane(),       grid(10, 10), cube(),   uv_sphere(32, 16),
            ico_sphere(2), cylinder(32), cone(32), torus(48, 12)};
}

std::string obj_of(Shape const& shape)
{
    std::string out = fmt::format("# a modelling program\nmtllib {0}.mtl\no {0}\n", shape.name);
    ControlMesh const& m = shape.mesh;
    for (auto const& p : m.positions) out += fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x, p.y, p.z);
    for (std::size_t f = 0; f < m.faces(); ++f)
        for (std::size_t k = 0; k < m.face(f).size(); ++k)
            out += fmt::format("vt {:.6f} {:.6f}\n", double(k) / double(m.face(f).size()),
                               double(k % 2));
    for (std::size_t f = 0; f < m.faces(); ++f) {
        auto const p = [&](std::size_t k) { return m.positions[m.face(f)[k]]; };
        auto const a = p(1) - p(0), b = p(2) - p(0);
        float const x = a.y * b.z - a.z * b.y, y = a.z * b.x - a.x * b.z, z = a.x * b.y - a.y * b.x;
        float const length = std::sqrt(x * x + y * y + z * z);
        out += fmt::format("vn {:.4f} {:.4f} {:.4f}\n", x / length, y / length, z / length);
    }
    out += "usemtl None\ns off\n";
    std::size_t corner = 0;
    for (std::size_t f = 0; f < m.faces(); ++f) {
        out += "f";
        for (std::uint32_t v : m.face(f)) out += fmt::format(" {}/{}/{}", v + 1, ++corner, f + 1);
        out += "\n";
    }
    return out;
}

} // namespace tessemu::test
