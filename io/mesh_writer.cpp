// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_writer.h"

#include "io/atomic_file.h"
#include "io/sha256.h"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <unordered_map>

#include <unistd.h>

namespace tessemu {

namespace fs = std::filesystem;

namespace {

struct Vertex {
    float position[3], normal[3], uv[2];
    std::uint32_t patch;
};
static_assert(sizeof(Vertex) == 36);

struct Triangle {
    std::uint32_t v[3], patch;
};

struct Bits {
    std::array<std::uint32_t, 6> words;
    friend bool operator==(Bits const&, Bits const&) = default;
};
struct BitsHash {
    std::size_t operator()(Bits const& b) const
    {
        std::uint64_t h = 0xcbf29ce484222325u;
        for (std::uint32_t w : b.words) h = (h ^ w) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
        return std::size_t(h);
    }
};

} // namespace

// Vertices and triangles wait in two binary files; the format is made of them at the end.
struct MeshWriter::Impl {
    fs::path path, vertex_path, triangle_path;
    bool ply, weld;
    Placement placement;
    std::ofstream vertex_file, triangle_file;
    std::uint64_t vertices = 0, triangles = 0;
    std::unordered_map<Bits, std::uint32_t, BitsHash> welded;
    std::vector<std::uint32_t> number; // of the patch's points

    void put(Vertex const& v)
    {
        vertex_file.write(reinterpret_cast<char const*>(&v), sizeof v);
        ++vertices;
    }
    void put(Triangle const& t)
    {
        triangle_file.write(reinterpret_cast<char const*>(&t), sizeof t);
        ++triangles;
    }

    glm::dvec3 in_file(Vertex const& v) const
    {
        return placement.to_file({v.position[0], v.position[1], v.position[2]});
    }
    /// A vertex's bytes in turn: its position as the file of a mesh has it, and the rest.
    template <class Visit> void bytes_of(Vertex const& v, Visit const& visit) const
    {
        if (placement.is_identity()) return visit(&v, sizeof v);
        glm::dvec3 const p = in_file(v);
        for (int k = 0; k < 3; ++k) visit(&p[k], sizeof p[k]);
        visit(&v.normal, sizeof v - sizeof v.position);
    }

    template <class Record, class Visit> static void read(fs::path const& file, Visit const& visit)
    {
        std::ifstream in(file, std::ios::binary);
        Record r;
        while (in.read(reinterpret_cast<char*>(&r), sizeof r)) visit(r);
    }

    void write_ply(std::ostream& out) const
    {
        out << fmt::format("ply\nformat binary_little_endian 1.0\ncomment tessemu\n"
                           "element vertex {1}\n"
                           "property {0} x\nproperty {0} y\nproperty {0} z\n"
                           "property float nx\nproperty float ny\nproperty float nz\n"
                           "property float u\nproperty float v\nproperty int patch\n"
                           "element face {2}\nproperty list uchar int vertex_indices\nend_header\n",
                           placement.is_identity() ? "float" : "double", vertices, triangles);
        read<Vertex>(vertex_path, [&](Vertex const& v) {
            bytes_of(v, [&](void const* bytes, std::size_t n) {
                out.write(static_cast<char const*>(bytes), std::streamsize(n));
            });
        });
        read<Triangle>(triangle_path, [&](Triangle const& t) {
            out.put(3);
            out.write(reinterpret_cast<char const*>(t.v), sizeof t.v);
        });
    }

    void write_obj(std::ostream& out) const
    {
        read<Vertex>(vertex_path, [&](Vertex const& v) {
            if (placement.is_identity()) {
                out << fmt::format("v {} {} {}\n", v.position[0], v.position[1], v.position[2]);
            } else {
                glm::dvec3 const p = in_file(v);
                out << fmt::format("v {} {} {}\n", p.x, p.y, p.z);
            }
            out << fmt::format("vn {} {} {}\nvt {} {}\n", v.normal[0], v.normal[1], v.normal[2],
                               v.uv[0], v.uv[1]);
        });
        std::uint32_t patch = 0xffffffffu;
        read<Triangle>(triangle_path, [&](Triangle const& t) {
            if (t.patch != patch) out << fmt::format("g patch_{}\n", patch = t.patch);
            out << fmt::format("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", t.v[0] + 1, t.v[1] + 1,
                               t.v[2] + 1);
        });
    }
};

MeshWriter::MeshWriter(fs::path path, bool weld, Placement const& placement)
    : impl_(std::make_unique<Impl>())
{
    Impl& m = *impl_;
    if (path.extension() != ".obj" && path.extension() != ".ply")
        throw WriteError(path.string() + ": extension is '" + path.extension().string() +
                         "', meshes are .obj or .ply");
    m.path = path;
    m.ply = path.extension() == ".ply";
    m.weld = weld;
    m.placement = placement;
    std::string const base = path.string() + ".tmp" + std::to_string(getpid());
    m.vertex_path = base + "v";
    m.triangle_path = base + "f";
    m.vertex_file.open(m.vertex_path, std::ios::binary);
    m.triangle_file.open(m.triangle_path, std::ios::binary);
    if (!m.vertex_file || !m.triangle_file)
        throw WriteError(path.string() + ": " + std::strerror(errno));
}

MeshWriter::~MeshWriter()
{
    std::error_code ignored;
    fs::remove(impl_->vertex_path, ignored);
    fs::remove(impl_->triangle_path, ignored);
}

void MeshWriter::add(SurfacePatch const& patch)
{
    Impl& m = *impl_;
    DomainPoints const& points = patch.domain();
    PatchPlace const& place = patch.place();
    std::size_t const n = patch.points();
    if (m.vertices + n > 0xffffffffu)
        throw WriteError(m.path.string() + ": the mesh has more than 4294967295 vertices");
    m.number.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        SurfaceVertex const v = patch.vertex(i);
        Vertex out{{v.position.x, v.position.y, v.position.z},
                   {v.normal.x, v.normal.y, v.normal.z},
                   {},
                   place.face};
        if (m.weld) {
            Bits bits;
            std::memcpy(bits.words.data(), out.position, sizeof out.position);
            std::memcpy(bits.words.data() + 3, out.normal, sizeof out.normal);
            auto const [it, fresh] = m.welded.try_emplace(bits, std::uint32_t(m.vertices));
            m.number[i] = it->second;
            if (!fresh) continue;
        } else {
            m.number[i] = std::uint32_t(m.vertices);
        }
        UnitPoint const at = domain_to_unit(place, points.u[i], points.v[i]);
        out.uv[0] = at.u;
        out.uv[1] = at.v;
        m.put(out);
    }
    auto const& index = patch.triangles();
    for (std::size_t i = 0; i + 2 < index.size(); i += 3) {
        Triangle const t{{m.number[index[i]], m.number[index[i + 1]], m.number[index[i + 2]]},
                         place.face};
        bool const collapsed = t.v[0] == t.v[1] || t.v[1] == t.v[2] || t.v[2] == t.v[0];
        if (!m.weld || !collapsed) m.put(t);
    }
}

void MeshWriter::finish()
{
    Impl& m = *impl_;
    m.vertex_file.close();
    m.triangle_file.close();
    write_atomically(m.path, [&](fs::path const& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        if (m.ply)
            m.write_ply(out);
        else
            m.write_obj(out);
        out.close();
        if (!out || !m.vertex_file || !m.triangle_file)
            throw WriteError(m.path.string() + ": writing failed (is the disk full?)");
    });
}

std::uint64_t MeshWriter::vertices() const
{
    return impl_->vertices;
}
std::uint64_t MeshWriter::triangles() const
{
    return impl_->triangles;
}

void MeshWriter::add_to_hash(Sha256& hash) const
{
    Impl::read<Vertex>(impl_->vertex_path, [&](Vertex const& v) {
        impl_->bytes_of(v, [&](void const* bytes, std::size_t n) { hash.add(bytes, n); });
    });
    Impl::read<Triangle>(impl_->triangle_path,
                         [&](Triangle const& t) { hash.add(t.v, sizeof t.v); });
}

} // namespace tessemu
