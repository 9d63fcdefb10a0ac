// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_writer.h"

#include "io/sha256.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <unordered_map>

#include <unistd.h>

namespace tessemu {

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

// Records that wait in a file without a name, gone with the process.
template <class Record> class WaitingRecords {
public:
    explicit WaitingRecords(OutputFile const& out) : for_(out.path().string())
    {
        std::string name = out.scratch_folder() / ".tessemu-XXXXXX";
        int const fd = mkstemp(name.data());
        if (fd < 0) fail();
        unlink(name.c_str());
        file_.reset(fdopen(fd, "w+b"));
        if (!file_) fail();
    }
    void put(Record const& r)
    {
        if (std::fwrite(&r, sizeof r, 1, file_.get()) != 1) fail();
        ++count_;
    }
    std::uint64_t count() const { return count_; }
    template <class Visit> void visit(Visit const& visit) const
    {
        if (std::fflush(file_.get()) != 0 || std::fseek(file_.get(), 0, SEEK_SET) != 0) fail();
        Record r;
        for (std::uint64_t i = 0; i < count_; ++i) {
            if (std::fread(&r, sizeof r, 1, file_.get()) != 1) fail();
            visit(r);
        }
    }

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    [[noreturn]] void fail() const
    {
        throw WriteError(for_ + ": its temporary: " + std::generic_category().message(errno));
    }

    std::string for_;
    std::unique_ptr<std::FILE, Close> file_;
    std::uint64_t count_ = 0;
};

} // namespace

MeshFormat mesh_format(OutputFile const& out)
{
    std::string const extension = extension_of(out.path());
    if (extension == "obj" || (extension.empty() && out.is_stream())) return MeshFormat::Obj;
    if (extension == "ply") return MeshFormat::Ply;
    throw WriteError(out.path().string() + ": extension is '" + out.path().extension().string() +
                     "', meshes are .obj or .ply");
}

// Vertices and triangles wait until their numbers are known, which the formats begin with.
struct MeshWriter::Impl {
    OutputFile& out;
    MeshFormat format;
    bool weld;
    WaitingRecords<Vertex> vertices;
    WaitingRecords<Triangle> triangles;
    Placement placement;
    std::vector<std::uint32_t> file_faces;
    std::unordered_map<Bits, std::uint32_t, BitsHash> welded;
    std::vector<std::uint32_t> number; // of the patch's points

    Impl(OutputFile& out_, bool weld_, Placement const& placement_,
         std::vector<std::uint32_t> file_faces_)
        : out(out_),
          format(mesh_format(out_)),
          weld(weld_),
          vertices(out_),
          triangles(out_),
          placement(placement_),
          file_faces(std::move(file_faces_))
    {
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

    template <class T> void write_bytes(T const& value) const
    {
        out.write({reinterpret_cast<char const*>(&value), sizeof value});
    }

    void write_ply() const
    {
        out.write(fmt::format(
            "ply\nformat binary_little_endian 1.0\ncomment tessemu\n"
            "element vertex {1}\n"
            "property {0} x\nproperty {0} y\nproperty {0} z\n"
            "property float nx\nproperty float ny\nproperty float nz\n"
            "property float u\nproperty float v\nproperty int patch\n"
            "element face {2}\nproperty list uchar int vertex_indices\nend_header\n",
            placement.is_identity() ? "float" : "double", vertices.count(), triangles.count()));
        vertices.visit([&](Vertex const& v) {
            bytes_of(v, [&](void const* bytes, std::size_t n) {
                out.write({static_cast<char const*>(bytes), n});
            });
        });
        triangles.visit([&](Triangle const& t) {
            write_bytes(std::uint8_t(3));
            write_bytes(t.v);
        });
    }

    void write_obj() const
    {
        vertices.visit([&](Vertex const& v) {
            if (placement.is_identity()) {
                out.write(fmt::format("v {} {} {}\n", v.position[0], v.position[1], v.position[2]));
            } else {
                glm::dvec3 const p = in_file(v);
                out.write(fmt::format("v {} {} {}\n", p.x, p.y, p.z));
            }
            out.write(fmt::format("vn {} {} {}\nvt {} {}\n", v.normal[0], v.normal[1], v.normal[2],
                                  v.uv[0], v.uv[1]));
        });
        std::uint32_t patch = 0xffffffffu;
        triangles.visit([&](Triangle const& t) {
            if (t.patch != patch) out.write(fmt::format("g patch_{}\n", patch = t.patch));
            out.write(fmt::format("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", t.v[0] + 1, t.v[1] + 1,
                                  t.v[2] + 1));
        });
    }
};

MeshWriter::MeshWriter(OutputFile& out, bool weld, Placement const& placement,
                       std::vector<std::uint32_t> file_faces)
    : impl_(std::make_unique<Impl>(out, weld, placement, std::move(file_faces)))
{
}

MeshWriter::~MeshWriter() = default;

void MeshWriter::add(SurfacePatch const& patch)
{
    Impl& m = *impl_;
    DomainPoints const& points = patch.domain();
    PatchPlace const& place = patch.place();
    std::uint32_t const face = m.file_faces.empty() ? place.face : m.file_faces[place.face];
    std::size_t const n = patch.points();
    if (m.vertices.count() + n > 0xffffffffu)
        throw WriteError(m.out.path().string() + ": the mesh has more than 4294967295 vertices");
    m.number.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        SurfaceVertex const v = patch.vertex(i);
        Vertex out{{v.position.x, v.position.y, v.position.z},
                   {v.normal.x, v.normal.y, v.normal.z},
                   {},
                   face};
        if (m.weld) {
            Bits bits;
            std::memcpy(bits.words.data(), out.position, sizeof out.position);
            std::memcpy(bits.words.data() + 3, out.normal, sizeof out.normal);
            auto const [it, fresh] = m.welded.try_emplace(bits, std::uint32_t(m.vertices.count()));
            m.number[i] = it->second;
            if (!fresh) continue;
        } else {
            m.number[i] = std::uint32_t(m.vertices.count());
        }
        UnitPoint const at = domain_to_unit(place, points.u[i], points.v[i]);
        out.uv[0] = at.u;
        out.uv[1] = at.v;
        m.vertices.put(out);
    }
    auto const& index = patch.triangles();
    for (std::size_t i = 0; i + 2 < index.size(); i += 3) {
        Triangle const t{{m.number[index[i]], m.number[index[i + 1]], m.number[index[i + 2]]},
                         face};
        bool const collapsed = t.v[0] == t.v[1] || t.v[1] == t.v[2] || t.v[2] == t.v[0];
        if (!m.weld || !collapsed) m.triangles.put(t);
    }
}

void MeshWriter::finish()
{
    if (impl_->format == MeshFormat::Ply)
        impl_->write_ply();
    else
        impl_->write_obj();
}

std::uint64_t MeshWriter::vertices() const
{
    return impl_->vertices.count();
}
std::uint64_t MeshWriter::triangles() const
{
    return impl_->triangles.count();
}

void MeshWriter::add_to_hash(Sha256& hash) const
{
    impl_->vertices.visit([&](Vertex const& v) {
        impl_->bytes_of(v, [&](void const* bytes, std::size_t n) { hash.add(bytes, n); });
    });
    impl_->triangles.visit([&](Triangle const& t) { hash.add(t.v, sizeof t.v); });
}

} // namespace tessemu
