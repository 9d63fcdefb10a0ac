// SPDX-License-Identifier: Apache-2.0
#include "io/control_mesh_writer.h"

#include "io/sha256.h"

#include <fmt/format.h>

namespace tessemu {

namespace {

// Many small pieces of text or bytes on their way to a file.
class Pieces {
public:
    Pieces(OutputFile& out, std::size_t all, DrawProgress const& progress)
        : out_(out),
          all_(all),
          progress_(progress)
    {
    }
    template <class... Values>
    void text(fmt::format_string<Values...> form, Values const&... values)
    {
        fmt::vformat_to(fmt::appender(buffer_), form, fmt::make_format_args(values...));
    }
    template <class Value> void bytes(Value const& value)
    {
        char const* const first = reinterpret_cast<char const*>(&value);
        buffer_.append(first, first + sizeof value);
    }
    // A line or record is whole.
    void end()
    {
        ++done_;
        if (buffer_.size() < kFull) return;
        flush();
        if (progress_) progress_(done_, all_);
    }
    void flush()
    {
        out_.write({buffer_.data(), buffer_.size()});
        buffer_.clear();
    }

private:
    static constexpr std::size_t kFull = std::size_t(1) << 16;
    OutputFile& out_;
    std::size_t all_, done_ = 0;
    DrawProgress const& progress_;
    fmt::memory_buffer buffer_;
};

// A position as the file of a mesh has it: visit(vector of float, or of double).
template <class Visit> void in_file(glm::vec3 p, Placement const& placement, Visit const& visit)
{
    if (placement.is_identity())
        visit(p);
    else
        visit(placement.to_file(p));
}

std::size_t most_sides(ControlMesh const& mesh)
{
    std::size_t most = 0;
    for (std::size_t f = 0; f < mesh.faces(); ++f) most = std::max(most, mesh.face(f).size());
    return most;
}

void write_tags(ControlMesh const& mesh, Pieces& out)
{
    for (ControlMesh::Crease const& c : mesh.creases) {
        out.text("t crease 2/1/0 {} {} {}\n", c.a, c.b, c.sharpness);
        out.end();
    }
    for (ControlMesh::Corner const& c : mesh.corners) {
        out.text("t corner 1/1/0 {} {}\n", c.vertex, c.sharpness);
        out.end();
    }
    for (std::uint32_t f : mesh.holes) {
        out.text("t hole 1/0/0 {}\n", f);
        out.end();
    }
    ControlMesh const plain;
    if (mesh.rules.boundary != plain.rules.boundary)
        out.text("t interpolateboundary 1/0/0 {}\n", int(mesh.rules.boundary));
    if (mesh.rules.crease_method == CreaseMethod::Chaikin)
        out.text("t creasemethod 0/0/1 chaikin\n");
    if (mesh.rules.smooth_triangles) out.text("t smoothtriangles 0/0/1 smooth\n");
}

void write_obj(ControlMesh const& mesh, Placement const& placement, Pieces& out)
{
    for (glm::vec3 const& p : mesh.positions) {
        in_file(p, placement, [&](auto const& x) { out.text("v {} {} {}\n", x.x, x.y, x.z); });
        out.end();
    }
    bool const has_coordinates = !mesh.face_coordinates.empty();
    for (glm::dvec2 const& c : mesh.coordinates) {
        out.text("vt {} {}\n", c.x, c.y);
        out.end();
    }
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        out.text("f");
        for (std::uint32_t h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h) {
            out.text(" {}", mesh.face_vertices[h] + 1);
            if (has_coordinates) out.text("/{}", mesh.face_coordinates[h] + 1);
        }
        out.text("\n");
        out.end();
    }
    write_tags(mesh, out);
}

void write_ply(ControlMesh const& mesh, Placement const& placement, Pieces& out)
{
    bool const large = most_sides(mesh) > 255;
    out.text("ply\nformat binary_little_endian 1.0\ncomment tessemu\nelement vertex {1}\n"
             "property {0} x\nproperty {0} y\nproperty {0} z\nelement face {2}\n"
             "property list {3} int vertex_indices\nend_header\n",
             placement.is_identity() ? "float" : "double", mesh.positions.size(), mesh.faces(),
             large ? "uint" : "uchar");
    for (glm::vec3 const& p : mesh.positions) {
        in_file(p, placement, [&](auto const& x) {
            for (int k = 0; k < 3; ++k) out.bytes(x[k]);
        });
        out.end();
    }
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        if (large)
            out.bytes(std::uint32_t(face.size()));
        else
            out.bytes(std::uint8_t(face.size()));
        for (std::uint32_t v : face) out.bytes(v);
        out.end();
    }
}

} // namespace

void write_control_mesh(ControlMesh const& mesh, OutputFile& out, Placement const& placement,
                        DrawProgress const& progress)
{
    MeshFormat const format = mesh_format(out);
    Pieces pieces(out, mesh.positions.size() + mesh.coordinates.size() + mesh.faces(), progress);
    if (format == MeshFormat::Ply)
        write_ply(mesh, placement, pieces);
    else
        write_obj(mesh, placement, pieces);
    pieces.flush();
}

std::string left_out_of_ply(ControlMesh const& mesh)
{
    ControlMesh const plain;
    std::vector<std::string> lost;
    auto const count = [&](std::size_t n, char const* one, char const* several) {
        if (n) lost.push_back(fmt::format("{} {}", n, n == 1 ? one : several));
    };
    count(mesh.creases.size(), "crease", "creases");
    count(mesh.corners.size(), "corner", "corners");
    count(mesh.holes.size(), "hole", "holes");
    count(mesh.coordinates.size(), "pair of texture coordinates", "texture coordinates");
    if (mesh.rules.boundary != plain.rules.boundary) lost.emplace_back("interpolateboundary");
    if (mesh.rules.crease_method != plain.rules.crease_method) lost.emplace_back("creasemethod");
    if (mesh.rules.smooth_triangles) lost.emplace_back("smoothtriangles");
    std::string out;
    for (std::size_t i = 0; i < lost.size(); ++i)
        out += (i == 0 ? "" : i + 1 == lost.size() ? " and " : ", ") + lost[i];
    return out;
}

void add_to_hash(ControlMesh const& mesh, Placement const& placement, Sha256& hash)
{
    for (glm::vec3 const& p : mesh.positions)
        in_file(p, placement, [&](auto const& x) { hash.add(&x[0], sizeof x); });
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        auto const n = std::uint32_t(face.size());
        hash.add(&n, sizeof n);
        hash.add(face.data(), face.size_bytes());
    }
}

} // namespace tessemu
