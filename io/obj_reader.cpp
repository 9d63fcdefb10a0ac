// SPDX-License-Identifier: Apache-2.0
#include "io/obj_reader.h"

#include "emu/error.h"
#include "io/input_file.h"

#include <fmt/format.h>

#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace tessemu {

namespace {

std::vector<std::string_view> words_of(std::string_view line)
{
    std::vector<std::string_view> words;
    std::size_t i = 0;
    while (i < line.size()) {
        while (i < line.size() && (line[i] == ' ' || line[i] == '\t' || line[i] == '\r')) ++i;
        std::size_t const begin = i;
        while (i < line.size() && line[i] != ' ' && line[i] != '\t' && line[i] != '\r') ++i;
        if (i > begin) words.push_back(line.substr(begin, i - begin));
    }
    return words;
}

// Decimal notation as OBJ has it; "nan", "inf", hexadecimal and half-read tokens are not numbers.
bool is_decimal(std::string_view s)
{
    std::size_t i = 0;
    auto const digits = [&] {
        std::size_t const begin = i;
        while (i < s.size() && s[i] >= '0' && s[i] <= '9') ++i;
        return i - begin;
    };
    auto const sign = [&] {
        if (i < s.size() && (s[i] == '+' || s[i] == '-')) ++i;
    };
    sign();
    std::size_t n = digits();
    if (i < s.size() && s[i] == '.') ++i, n += digits();
    if (n == 0) return false;
    if (i < s.size() && (s[i] == 'e' || s[i] == 'E')) {
        ++i;
        sign();
        if (digits() == 0) return false;
    }
    return i == s.size();
}

template <class Number> bool parse(std::string_view s, Number& out)
{
    if (!s.empty() && s[0] == '+') s.remove_prefix(1);
    auto const [end, ec] = std::from_chars(s.data(), s.data() + s.size(), out);
    return ec == std::errc() && end == s.data() + s.size();
}

// A face's corner: v, v/t, v//n or v/t/n with whole numbers.
bool is_index_group(std::string_view s)
{
    int fields = 0;
    while (true) {
        std::size_t const slash = s.find('/');
        std::string_view const field = s.substr(0, slash);
        int value = 0;
        if (field.empty() ? fields == 0 : !parse(field, value)) return false;
        ++fields;
        if (slash == std::string_view::npos) return fields <= 3;
        s.remove_prefix(slash + 1);
    }
}

struct Tag {
    int line;
    std::string name;
    std::vector<int> ints;
    std::vector<double> floats;
};

struct Scan {
    std::string text; ///< for the parser: no byte order mark, continuations joined
    std::vector<int> vertex_line, face_line;
    std::vector<std::uint32_t> vertices_before_face;
    std::vector<std::uint32_t> face_corners;
    std::vector<std::uint32_t> coordinates_before_face;
    std::size_t coordinates = 0, corners_with_coordinates = 0;
    bool coordinates_fail = false; ///< said so
    std::vector<Tag> tags;
};

class Scanner {
public:
    Scanner(std::string_view text, std::string const& name, std::vector<std::string>& warnings)
        : name_(name),
          warnings_(warnings)
    {
        if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
        int line = 1;
        std::string joined;
        while (!text.empty()) {
            std::size_t const end = std::min(text.find('\n'), text.size());
            std::string_view current = text.substr(0, end);
            text.remove_prefix(std::min(end + 1, text.size()));
            int const first = line++;
            if (current.ends_with('\r')) current.remove_suffix(1);
            if (current.ends_with('\\')) { // the statement goes on
                joined.assign(current.substr(0, current.size() - 1));
                while (true) {
                    std::size_t const next_end = std::min(text.find('\n'), text.size());
                    std::string_view next = text.substr(0, next_end);
                    text.remove_prefix(std::min(next_end + 1, text.size()));
                    ++line;
                    if (next.ends_with('\r')) next.remove_suffix(1);
                    bool const more = next.ends_with('\\') && !text.empty();
                    if (next.ends_with('\\')) next.remove_suffix(1);
                    joined += ' ';
                    joined += next;
                    if (!more) break;
                }
                current = joined;
            }
            statement(current, first);
        }
    }

    Scan scan;

private:
    [[noreturn]] void fail(int line, std::string const& what) const
    {
        throw FormatError(name_, line, what);
    }
    void warn(int line, std::string const& what)
    {
        warnings_.push_back(fmt::format("{}:{}: {}", name_, line, what));
    }
    static std::string shown(std::string_view s)
    {
        std::string out;
        for (char c : s.substr(0, 40)) out += c >= 32 && c < 127 ? c : '?';
        return s.size() > 40 ? out + "..." : out;
    }

    void statement(std::string_view line, int number)
    {
        std::size_t const start = line.find_first_not_of(" \t\r");
        if (start == std::string_view::npos) return;
        line.remove_prefix(start);
        bool const spaced = line.size() > 1 && (line[1] == ' ' || line[1] == '\t');
        bool const alone = line.size() == 1;
        if (line.starts_with("vt ") || line.starts_with("vt\t"))
            coordinates(line, number);
        else if (line[0] == 'v' && (spaced || alone))
            vertex(line, number);
        else if (line[0] == 'f' && (spaced || alone))
            face(line, number);
        else if (line[0] == 't' && (spaced || alone))
            tag(line, number);
        // Normals, groups, materials and comments do not shape the surface.
    }

    void vertex(std::string_view line, int number)
    {
        auto words = words_of(line);
        if (words.size() < 4)
            fail(number, fmt::format("vertex has {} coordinates, 3 are needed", words.size() - 1));
        scan.text += 'v';
        for (std::size_t i = 1; i < 4; ++i) {
            if (!is_decimal(words[i]))
                fail(number,
                     fmt::format("coordinate '{}' is not a finite number", shown(words[i])));
            scan.text += ' ';
            scan.text += words[i];
        }
        scan.text += '\n';
        scan.vertex_line.push_back(number);
    }

    // A fault here leaves the mesh without texture coordinates; its surface is what it is.
    void coordinates(std::string_view line, int number)
    {
        auto const words = words_of(line);
        bool const good = words.size() >= 3 && is_decimal(words[1]) && is_decimal(words[2]);
        if (!good && !scan.coordinates_fail)
            warn(number, "texture coordinates are not two finite numbers: the mesh gets none");
        scan.coordinates_fail = scan.coordinates_fail || !good;
        scan.text += good ? fmt::format("vt {} {}\n", words[1], words[2]) : "vt 0 0\n";
        ++scan.coordinates;
    }

    void face(std::string_view line, int number)
    {
        auto const words = words_of(line);
        if (words.size() < 2) fail(number, "face has no vertices");
        scan.text += 'f';
        for (std::size_t i = 1; i < words.size(); ++i) {
            if (!is_index_group(words[i]))
                fail(number, fmt::format("'{}' is not a vertex index", shown(words[i])));
            scan.text += ' ';
            std::string_view const group = words[i];
            std::size_t const slash = group.find('/');
            scan.text += group.substr(0, slash);
            if (slash == std::string_view::npos) continue;
            std::string_view const rest = group.substr(slash + 1);
            std::string_view const t = rest.substr(0, rest.find('/'));
            if (t.empty()) continue;
            scan.text += '/';
            scan.text += t;
            ++scan.corners_with_coordinates;
        }
        scan.text += '\n';
        scan.face_line.push_back(number);
        scan.face_corners.push_back(std::uint32_t(words.size() - 1));
        scan.vertices_before_face.push_back(std::uint32_t(scan.vertex_line.size()));
        scan.coordinates_before_face.push_back(std::uint32_t(scan.coordinates));
    }

    void tag(std::string_view line, int number)
    {
        auto const words = words_of(line);
        int counts[3] = {};
        std::string_view form = words.size() > 2 ? words[2] : "";
        for (int i = 0; i < 3; ++i) {
            std::size_t const slash = form.find('/');
            if (!parse(form.substr(0, slash), counts[i]) || counts[i] < 0 ||
                (i < 2) != (slash != std::string_view::npos))
                return warn(number, "tag without 'name ints/floats/strings' is skipped");
            form = slash == std::string_view::npos ? "" : form.substr(slash + 1);
        }
        Tag t{number, std::string(words[1]), {}, {}};
        auto const expected = std::int64_t(counts[0]) + counts[1] + counts[2];
        if (std::int64_t(words.size()) - 3 < expected)
            return warn(number, fmt::format("tag '{}' announces {} values and has {}: skipped",
                                            shown(t.name), expected, words.size() - 3));
        for (std::size_t i = 3; i < 3 + std::size_t(counts[0]) + std::size_t(counts[1]); ++i) {
            bool const integer = i < 3 + std::size_t(counts[0]);
            int k = 0;
            double x = 0;
            if (integer ? !parse(words[i], k) : !is_decimal(words[i]) || !parse(words[i], x))
                return warn(number, fmt::format("tag '{}' has the value '{}': skipped",
                                                shown(t.name), shown(words[i])));
            if (integer)
                t.ints.push_back(k);
            else
                t.floats.push_back(x);
        }
        scan.tags.push_back(std::move(t));
    }

    std::string const& name_;
    std::vector<std::string>& warnings_;
};

// What the library's callbacks collect.
struct Parsed {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> coordinates;
    std::vector<int> indices, coordinate_indices;
    std::vector<std::uint32_t> corners;
};

Parsed parse_with_tinyobj(std::string const& text, std::string const& name)
{
    Parsed parsed;
    tinyobj::callback_t callback;
    callback.vertex_cb = [](void* user, tinyobj::real_t x, tinyobj::real_t y, tinyobj::real_t z,
                            tinyobj::real_t) {
        static_cast<Parsed*>(user)->positions.emplace_back(x, y, z);
    };
    callback.texcoord_cb = [](void* user, tinyobj::real_t x, tinyobj::real_t y, tinyobj::real_t) {
        static_cast<Parsed*>(user)->coordinates.emplace_back(x, y);
    };
    callback.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
        auto* p = static_cast<Parsed*>(user);
        for (int i = 0; i < count; ++i) {
            p->indices.push_back(indices[i].vertex_index);
            p->coordinate_indices.push_back(indices[i].texcoord_index);
        }
        p->corners.push_back(std::uint32_t(count));
    };
    std::istringstream in(text);
    std::string warning, error;
    if (!tinyobj::LoadObjWithCallback(in, callback, &parsed, nullptr, &warning, &error))
        throw FormatError(name, 0, error.empty() ? "cannot be parsed" : error);
    return parsed;
}

// All corners get texture coordinates, or none does.
template <class Warn>
void assign_coordinates(Scan const& scan, Parsed const& parsed, ControlMesh& mesh, Warn const& warn)
{
    auto const all = std::int64_t(parsed.coordinates.size());
    for (glm::vec2 const& c : parsed.coordinates)
        if (!(std::abs(c.x) <= kMaxCoordinate && std::abs(c.y) <= kMaxCoordinate)) {
            warn(scan.face_line.front(),
                 fmt::format("texture coordinates are {} {}, the limit is {}: the mesh gets none",
                             c.x, c.y, kMaxCoordinate));
            return;
        }
    std::size_t at = 0;
    for (std::size_t f = 0; f < parsed.corners.size(); ++f)
        for (std::uint32_t i = 0; i < parsed.corners[f]; ++i, ++at) {
            std::int64_t const index = parsed.coordinate_indices[at];
            std::int64_t const c = index < 0 ? scan.coordinates_before_face[f] + index : index - 1;
            if (c < 0 || c >= all) {
                warn(scan.face_line[f],
                     index == 0
                         ? std::string("a corner has no texture coordinates: the mesh gets none")
                         : fmt::format("texture index is {}, the file has {}: the mesh gets no "
                                       "texture coordinates",
                                       index, all));
                mesh.face_coordinates.clear();
                return;
            }
            mesh.face_coordinates.push_back(std::uint32_t(c));
        }
    mesh.coordinates = parsed.coordinates;
}

} // namespace

ObjFile read_obj(std::string_view text, std::string const& name)
{
    ObjFile out;
    ControlMesh& mesh = out.mesh;
    mesh.name = name;
    Scanner const scanner(text, name, out.warnings);
    Scan const& scan = scanner.scan;
    if (scan.face_line.empty())
        throw FormatError(name, 0,
                          fmt::format("holds no face ({} vertices)", scan.vertex_line.size()));
    auto const warn = [&](int line, std::string const& what) {
        out.warnings.push_back(fmt::format("{}:{}: {}", name, line, what));
    };

    out.face_lines = scan.face_line;
    Parsed const parsed = parse_with_tinyobj(scan.text, name);
    if (parsed.positions.size() != scan.vertex_line.size() || parsed.corners != scan.face_corners)
        throw FormatError(name, 0, "the parser lost vertices or faces");
    mesh.positions = parsed.positions;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        glm::vec3 const p = mesh.positions[v];
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(p[k]) <= kMaxCoordinate))
                throw FormatError(
                    name, scan.vertex_line[v],
                    fmt::format("coordinate is {}, the limit is {}: normals would overflow", p[k],
                                kMaxCoordinate));
    }

    std::vector<std::uint32_t> face;
    std::size_t at = 0;
    for (std::size_t f = 0; f < parsed.corners.size(); ++f) {
        face.clear();
        std::int64_t const seen = scan.vertices_before_face[f];
        auto const all = std::int64_t(mesh.positions.size());
        for (std::uint32_t i = 0; i < parsed.corners[f]; ++i) {
            std::int64_t const index = parsed.indices[at++];
            std::int64_t const v = index < 0 ? seen + index : index - 1;
            if (index == 0)
                throw FormatError(name, scan.face_line[f], "vertex index is 0, indices start at 1");
            if (v < 0 || v >= all)
                throw FormatError(
                    name, scan.face_line[f],
                    fmt::format("vertex index is {}, the file has {} vertices{}", index, all,
                                index < 0 ? fmt::format(" ({} before this line)", seen) : ""));
            face.push_back(std::uint32_t(v));
        }
        mesh.add_face(face);
    }

    if (scan.coordinates > 0 && scan.corners_with_coordinates > 0 && !scan.coordinates_fail)
        assign_coordinates(scan, parsed, mesh, warn);

    auto const vertices = int(mesh.positions.size()), faces = int(mesh.faces());
    for (Tag const& t : scan.tags) {
        auto const in_range = [&](int value, int limit, char const* what) {
            if (value >= 0 && value < limit) return true;
            warn(t.line, fmt::format("tag '{}' names {} {}, the file has 0 to {}: skipped", t.name,
                                     what, value, limit - 1));
            return false;
        };
        auto const value = [&](std::size_t i) {
            return t.floats.empty() ? 10.0f : float(t.floats[std::min(i, t.floats.size() - 1)]);
        };
        if (t.name == "crease") {
            for (std::size_t i = 0; i + 1 < t.ints.size(); ++i)
                if (in_range(t.ints[i], vertices, "vertex") &&
                    in_range(t.ints[i + 1], vertices, "vertex"))
                    mesh.creases.push_back(
                        {std::uint32_t(t.ints[i]), std::uint32_t(t.ints[i + 1]), value(i)});
        } else if (t.name == "corner") {
            for (std::size_t i = 0; i < t.ints.size(); ++i)
                if (in_range(t.ints[i], vertices, "vertex"))
                    mesh.corners.push_back({std::uint32_t(t.ints[i]), value(i)});
        } else if (t.name == "hole") {
            for (int f : t.ints)
                if (in_range(f, faces, "face")) mesh.holes.push_back(std::uint32_t(f));
        } else if (t.name == "interpolateboundary") {
            if (t.ints.size() == 1 && in_range(t.ints[0], 3, "rule"))
                mesh.boundary = BoundaryRule(t.ints[0]);
        } else {
            warn(t.line, fmt::format("tag '{}' is not known and is skipped", t.name));
        }
    }

    // A crease must run along an edge of the mesh.
    if (!mesh.creases.empty()) {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
        auto const ordered = [](std::uint32_t a, std::uint32_t b) {
            return std::pair(std::min(a, b), std::max(a, b));
        };
        for (std::size_t f = 0; f < mesh.faces(); ++f) {
            auto const v = mesh.face(f);
            for (std::size_t i = 0; i < v.size(); ++i)
                edges.push_back(ordered(v[i], v[(i + 1) % v.size()]));
        }
        std::sort(edges.begin(), edges.end());
        std::erase_if(mesh.creases, [&](ControlMesh::Crease const& c) {
            if (std::binary_search(edges.begin(), edges.end(), ordered(c.a, c.b))) return false;
            out.warnings.push_back(fmt::format(
                "{}: crease {}-{} runs along no edge of the mesh: skipped", name, c.a, c.b));
            return true;
        });
    }
    return out;
}

ObjFile read_obj_file(std::filesystem::path const& path)
{
    ObjFile out = read_obj(read_file(path), path.string());
    out.mesh.name = path.filename().string();
    return out;
}

} // namespace tessemu
