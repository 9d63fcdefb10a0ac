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

struct MeshWriter::Impl {
    fs::path path, vertex_path, triangle_path;
    bool ply, weld, finished = false;
    std::ofstream vertex_file, triangle_file;
    std::uint64_t vertices = 0, triangles = 0;
    std::unordered_map<Bits, std::uint32_t, BitsHash> welded;
    std::vector<std::uint32_t> number; // of the patch's points
    Sha256 vertex_hash, triangle_hash;
    std::string vertex_digest, triangle_digest;

    void put(Vertex const& v)
    {
        vertex_hash.add(&v, sizeof v);
        if (ply) {
            vertex_file.write(reinterpret_cast<char const*>(&v), sizeof v);
        } else {
            vertex_file << fmt::format("v {} {} {}\nvn {} {} {}\nvt {} {}\n", v.position[0],
                                       v.position[1], v.position[2], v.normal[0], v.normal[1],
                                       v.normal[2], v.uv[0], v.uv[1]);
        }
        ++vertices;
    }

    void put_triangle(std::uint32_t const (&t)[3])
    {
        triangle_hash.add(t, sizeof t);
        if (ply) {
            char const three = 3;
            triangle_file.write(&three, 1);
            triangle_file.write(reinterpret_cast<char const*>(t), sizeof t);
        } else {
            triangle_file << fmt::format("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", t[0] + 1,
                                         t[1] + 1, t[2] + 1);
        }
        ++triangles;
    }
};

MeshWriter::MeshWriter(fs::path path, bool weld) : impl_(std::make_unique<Impl>())
{
    Impl& m = *impl_;
    if (path.extension() != ".obj" && path.extension() != ".ply")
        throw WriteError(path.string() + ": extension is '" + path.extension().string() +
                         "', meshes are .obj or .ply");
    m.path = path;
    m.ply = path.extension() == ".ply";
    m.weld = weld;
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

void MeshWriter::add(DrawPass const& pass, ShadedPatch const& patch)
{
    Impl& m = *impl_;
    DomainPoints const& points = *patch.points;
    PatchOrigin const& origin = pass.patches[patch.primitive_id];
    std::size_t const n = points.patch.points();
    if (m.vertices + n > 0xffffffffu)
        throw WriteError(m.path.string() + ": the mesh has more than 4294967295 vertices");
    m.number.resize(n);
    // ShadedVertex: position x y z w, normal x y z.
    constexpr int component[6] = {0, 1, 2, 4, 5, 6};
    for (std::size_t i = 0; i < n; ++i) {
        float c[6];
        for (int k = 0; k < 6; ++k)
            c[k] = patch.outputs[std::size_t(component[k]) * patch.stride + i];
        if (m.weld) {
            Bits bits;
            std::memcpy(bits.words.data(), c, sizeof c);
            auto const [it, fresh] = m.welded.try_emplace(bits, std::uint32_t(m.vertices));
            m.number[i] = it->second;
            if (!fresh) continue;
        } else {
            m.number[i] = std::uint32_t(m.vertices);
        }
        FacePoint const uv = domain_to_face(origin, points.u[i], points.v[i]);
        m.put({{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {uv.u, uv.v}, origin.face});
    }
    if (!m.ply) m.triangle_file << fmt::format("g patch_{}\n", origin.face);
    auto const& index = points.patch.indices;
    for (std::size_t i = 0; i + 2 < index.size(); i += 3) {
        std::uint32_t const t[3] = {m.number[index[i]], m.number[index[i + 1]],
                                    m.number[index[i + 2]]};
        if (m.weld && (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])) continue;
        m.put_triangle(t);
    }
}

void MeshWriter::finish()
{
    Impl& m = *impl_;
    m.vertex_file.close();
    m.triangle_file.close();
    m.vertex_digest = m.vertex_hash.hex();
    m.triangle_digest = m.triangle_hash.hex();
    write_atomically(m.path, [&](fs::path const& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        if (m.ply)
            out << fmt::format(
                "ply\nformat binary_little_endian 1.0\ncomment tessemu\nelement vertex {}\n"
                "property float x\nproperty float y\nproperty float z\n"
                "property float nx\nproperty float ny\nproperty float nz\n"
                "property float u\nproperty float v\nproperty int patch\n"
                "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                m.vertices, m.triangles);
        for (fs::path const& part : {m.vertex_path, m.triangle_path}) {
            std::ifstream in(part, std::ios::binary);
            if (in.peek() != std::ifstream::traits_type::eof()) out << in.rdbuf();
        }
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
    hash.add(impl_->vertex_digest.data(), impl_->vertex_digest.size());
    hash.add(impl_->triangle_digest.data(), impl_->triangle_digest.size());
}

} // namespace tessemu
