// SPDX-License-Identifier: Apache-2.0
#include "io/obj_reader.h"

#include "emu/error.h"
#include "io/obj_digits.h"
#include "io/obj_statements.h"
#include "io/obj_tags.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <climits>
#include <cmath>
#include <optional>

namespace tessemu {

namespace {

// Indices beyond what the file has had when they are read: its end says whether they are right.
class ForwardIndices {
public:
    struct Index {
        std::int64_t index = 0;
        int line = 0;
    };
    void see(std::int64_t index, std::size_t had, int line)
    {
        std::int64_t const most = highest_.empty() ? std::int64_t(had) : highest_.back().index;
        if (index > std::max(most, std::int64_t(had))) highest_.push_back({index, line});
    }
    /// The first that is beyond all.
    std::optional<Index> beyond(std::size_t all) const
    {
        for (Index const& i : highest_)
            if (i.index > std::int64_t(all)) return i;
        return {};
    }

private:
    std::vector<Index> highest_; ///< each above all before it
};

class ObjReader {
public:
    ObjReader(std::string const& name, Notes& notes)
        : name_(name),
          notes_(notes),
          tags_(out_.mesh, notes)
    {
    }

    ObjFile read(std::string_view text)
    {
        check_encoding(text);
        if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
        for (Statements s(text, name_); s.next();) statement(s);
        if (out_.lines.faces.empty())
            throw FormatError(name_, 0,
                              text.empty()
                                  ? std::string("is empty")
                                  : fmt::format("holds no face ({} vertices)", positions_.size()));
        check_vertices();
        check_coordinates();
        if (auto const n = normal_indices_.beyond(normals_))
            notes_.add(n->line, fmt::format("normal index is {}, the file has {}: normals are not "
                                            "used",
                                            n->index, normals_));
        tags_.apply(positions_.size());
        mesh().name = out_.lines.file = name_;
        place();
        if (out_.placement.is_moved()) warn_of_digits();
        return std::move(out_);
    }

private:
    ControlMesh& mesh() { return out_.mesh; }

    [[noreturn]] void fail(int line, std::string const& what) const
    {
        throw FormatError(name_, line, what);
    }

    void check_encoding(std::string_view text) const
    {
        if (text.starts_with("ply\n") || text.starts_with("ply\r"))
            throw FormatError(name_, 0, "is a PLY file, which is written only; models are OBJ");
        if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
            throw FormatError(name_, 0, "is UTF-16 text; save it as UTF-8");
        if (std::size_t const at = text.find('\0'); at != text.npos)
            fail(int(std::min<std::ptrdiff_t>(
                     INT_MAX,
                     1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n'))),
                 fmt::format("byte {} is zero: this is no text, or UTF-16; an OBJ file is ASCII or "
                             "UTF-8",
                             at));
    }

    void statement(Statements& s)
    {
        auto const& words = s.words;
        std::string_view const keyword = words[0];
        Meaning const meaning = meaning_of(keyword);
        if (meaning != Meaning::None && meaning != Meaning::Unknown) s.join();
        auto const left_out = [&](char const* what) {
            notes_.count(what, s.line, [&] {
                return fmt::format("'{}': {} are left out, only faces make a surface", keyword,
                                   what);
            });
        };
        switch (meaning) {
        case Meaning::Vertex:
            return vertex(words, s.line);
        case Meaning::Coordinates:
            return coordinates(words, s.line);
        case Meaning::Normal:
            return normal(words, s.line);
        case Meaning::Face:
            return face(words, s.line);
        case Meaning::Tag:
            return tags_.read(words, s.line);
        case Meaning::Lines:
            return left_out("lines");
        case Meaning::Points:
            return left_out("points");
        case Meaning::FreeForm:
            return left_out("free-form curves and surfaces");
        case Meaning::Command:
            return left_out("other files and commands");
        case Meaning::Unknown:
            if (std::string_view("+-.0123456789").find(keyword[0]) != std::string_view::npos)
                fail(s.line, "'" + shown(keyword) +
                                 "' begins the line, which is no statement: the rest of another "
                                 "that was cut? One that ends in a '\\' goes on in the next line, "
                                 "even if that is empty");
            notes_.count("unknown", s.line, [&] {
                return fmt::format("'{}' begins no statement of an OBJ file: left out",
                                   shown(keyword));
            });
            return;
        case Meaning::None:
            return;
        }
    }

    [[noreturn]] void refuse_coordinate(std::string_view word, int line) const
    {
        bool const comma = word.find(',') != word.npos;
        fail(line, fmt::format("coordinate '{}' is not a finite number{}", shown(word),
                               comma ? "; decimals follow a point" : ""));
    }
    [[noreturn]] void refuse_size(std::string_view word, int line) const
    {
        fail(line, fmt::format("coordinate is {}, the limit is {}", shown(word), kMaxCoordinate));
    }

    void vertex(std::vector<std::string_view> const& words, int line)
    {
        std::size_t const numbers = words.size() - 1;
        if (numbers < 3)
            fail(line, fmt::format("vertex has {} coordinates, 3 are needed", numbers));
        double x[8] = {};
        for (std::size_t i = 0; i < numbers; ++i) {
            double& out = x[std::min(i, std::size_t(7))];
            Reading const reading = read_number(words[i + 1], out);
            if (reading == Reading::NoNumber) refuse_coordinate(words[i + 1], line);
            if (i >= 3) continue;
            if (reading == Reading::TooLarge || std::abs(out) > kMaxCoordinate)
                refuse_size(words[i + 1], line);
            digits_.see(words[i + 1]);
            float nearest = 0;
            if (is_between_floats(out) && is_number(words[i + 1], nearest) &&
                std::isnormal(nearest))
                in_between_.push_back({positions_.size(), int(i), nearest});
        }
        positions_.emplace_back(x[0], x[1], x[2]);
        out_.lines.vertices.push_back(line);
        if (numbers == 4 && x[3] == 1) return;
        if (numbers > 3)
            notes_.count(numbers == 4 ? "weights" : "colours", line, [&] {
                return numbers == 4 ? fmt::format("vertex has the weight {}: left out, only "
                                                  "free-form surfaces have weights",
                                                  words[4])
                                    : fmt::format("vertex has {} numbers: those after the first 3, "
                                                  "as of a colour, are left out",
                                                  numbers);
            });
    }

    // A fault here leaves the mesh without texture coordinates; its surface is what it is.
    void coordinates(std::vector<std::string_view> const& words, int line)
    {
        double x[3] = {};
        bool good = words.size() > 1 && words.size() <= 4;
        for (std::size_t i = 1; good && i < words.size(); ++i)
            good = is_number(words[i], x[i - 1]) && std::abs(x[i - 1]) <= kMaxTextureCoordinate;
        if (!good) {
            notes_.count("coordinates", line, [&] {
                return fmt::format("texture coordinates are not one to three finite numbers of at "
                                   "most {}: the mesh gets none",
                                   kMaxTextureCoordinate);
            });
            coordinates_lost_ = true;
        }
        if (coordinates_.empty()) first_coordinates_line_ = line;
        coordinates_.emplace_back(x[0], x[1]);
    }

    // Counted for indices; a subdivision surface has normals of its own.
    void normal(std::vector<std::string_view> const& words, int line)
    {
        ++normals_;
        double x = 0;
        bool good = words.size() == 4;
        for (std::size_t i = 1; good && i < words.size(); ++i) good = is_number(words[i], x);
        if (!good)
            notes_.count("normal", line, [] {
                return std::string("normal is not three finite numbers; normals are not used");
            });
    }

    // An index of a face's corner from 0, or none: 0, or before the file's first.
    static std::optional<std::uint32_t> resolved(std::int64_t index, std::size_t had)
    {
        std::int64_t const i = index < 0 ? std::int64_t(had) + index : index - 1;
        if (index == 0 || i < 0 || i >= kNone) return {};
        return std::uint32_t(i);
    }

    void face(std::vector<std::string_view> const& words, int line)
    {
        if (words.size() < 2) fail(line, "face has no vertices");
        for (std::size_t i = 1; i < words.size(); ++i) corner(words[i], line);
        mesh().face_start.push_back(std::uint32_t(mesh().face_vertices.size()));
        out_.lines.faces.push_back(line);
    }

    // v, v/t, v//n or v/t/n with whole numbers.
    void corner(std::string_view word, int line)
    {
        std::optional<std::int64_t> field[3];
        std::string_view rest = word;
        for (int i = 0;; ++i) {
            std::size_t const slash = rest.find('/');
            std::string_view const digits = rest.substr(0, slash);
            std::int64_t index = 0;
            if (i > 2 || (digits.empty() ? i == 0 : !is_number(digits, index)))
                fail(line, fmt::format("'{}' is not a vertex index", shown(word)));
            if (!digits.empty()) field[i] = index;
            if (slash == rest.npos) break;
            rest.remove_prefix(slash + 1);
        }
        std::int64_t const v = *field[0];
        auto const vertex = resolved(v, positions_.size());
        if (v == 0) fail(line, "vertex index is 0, indices start at 1");
        if (!vertex)
            fail(line, fmt::format("vertex index is {}, {}", v,
                                   v < 0 ? fmt::format("the file has {} vertices before this line",
                                                       positions_.size())
                                         : "no file has so many vertices"));
        vertex_indices_.see(v, positions_.size(), line);
        mesh().face_vertices.push_back(*vertex);

        std::uint32_t coordinate = kNone;
        if (field[1]) {
            if (auto const c = resolved(*field[1], coordinates_.size()))
                coordinate = *c;
            else
                lose_coordinates(line, *field[1],
                                 fmt::format("{} before this line", coordinates_.size()));
            coordinate_indices_.see(*field[1], coordinates_.size(), line);
            corner_has_coordinates_ = true;
        } else if (bare_face_line_ == 0) {
            bare_face_line_ = line;
        }
        mesh().face_coordinates.push_back(coordinate);

        if (!field[2]) return;
        normal_indices_.see(*field[2], normals_, line);
        if (!resolved(*field[2], normals_))
            notes_.count("normal index", line, [&] {
                return fmt::format("normal index is {}, the file has {} before this line: normals "
                                   "are not used",
                                   *field[2], normals_);
            });
    }

    void lose_coordinates(int line, std::int64_t index, std::string const& has)
    {
        coordinates_lost_ = true;
        notes_.count("coordinate index", line, [&] {
            return fmt::format(
                "texture index is {}, the file has {}: the mesh gets no texture coordinates", index,
                has);
        });
    }

    void check_vertices() const
    {
        if (auto const v = vertex_indices_.beyond(positions_.size()))
            fail(v->line, fmt::format("vertex index is {}, the file has {} vertices", v->index,
                                      positions_.size()));
    }

    // All corners get texture coordinates, or none does.
    void check_coordinates()
    {
        if (auto const c = coordinate_indices_.beyond(coordinates_.size()))
            lose_coordinates(c->line, c->index, std::to_string(coordinates_.size()));
        if (!coordinates_.empty() && !corner_has_coordinates_)
            notes_.add(first_coordinates_line_,
                       fmt::format("no face uses the file's {} texture coordinates: the mesh gets "
                                   "none",
                                   coordinates_.size()));
        if (corner_has_coordinates_ && bare_face_line_)
            notes_.add(bare_face_line_, "a corner has no texture coordinates, others have: the "
                                        "mesh gets none");
        if (coordinates_lost_ || bare_face_line_ || !corner_has_coordinates_)
            mesh().face_coordinates = {};
        else
            mesh().coordinates = std::move(coordinates_);
    }

    void place()
    {
        std::vector<char> used(positions_.size());
        for (std::uint32_t v : mesh().face_vertices) used[v] = 1;
        std::vector<glm::dvec3> points;
        for (std::size_t v = 0; v < used.size(); ++v)
            if (used[v]) points.push_back(positions_[v]);
        Placement& placement = out_.placement;
        try {
            placement = Placement(points);
        } catch (Error const& e) {
            throw FormatError(name_, 0, e.what());
        }
        for (glm::dvec3 const& p : positions_) mesh().positions.push_back(placement.from_file(p));
        if (!placement.is_moved())
            for (InBetween const& i : in_between_)
                mesh().positions[i.vertex][i.axis] =
                    float(placement.length_from_file(double(i.nearest)));
        for (glm::vec3& p : mesh().positions) // vertices of no face may lie anywhere
            p = clamp(p, -kFarthest, kFarthest);
    }

    void warn_of_digits()
    {
        constexpr double kBad = 1e-3;
        double rounding = 0;
        glm::dvec3 const shift = out_.placement.to_file(glm::dvec3(0));
        for (int k = 0; k < 3; ++k) {
            if (shift[k] == 0) continue; // near the origin numbers are as they should be
            double most = 0;
            for (std::uint32_t v : mesh().face_vertices)
                most = std::max(most, std::abs(positions_[v][k]));
            int exponent = 0;
            std::frexp(most, &exponent);
            double half = std::ldexp(1.0, exponent - 54);
            if (auto const digits = digits_.limit()) {
                // d.dde+06: half of the last of so many digits
                std::string const most_in_words = fmt::format("{:.{}e}", most, *digits - 1);
                int power = 0;
                double written = 0;
                if (is_number(most_in_words.substr(most_in_words.find('e') + 1), power) &&
                    is_number(fmt::format("5e{}", power - *digits), written))
                    half = std::max(half, written);
            }
            rounding = std::max(rounding, half);
        }
        double shortest = INFINITY;
        std::uint32_t a = 0, b = 0;
        for (std::size_t f = 0; f < mesh().faces(); ++f) {
            auto const v = mesh().face(f);
            for (std::size_t i = 0; i < v.size(); ++i) {
                std::uint32_t const next = v[(i + 1) % v.size()];
                double const along = length(positions_[next] - positions_[v[i]]);
                if (along > 0 && along < shortest) shortest = along, a = v[i], b = next;
            }
        }
        if (!(rounding > kBad * shortest)) return;
        notes_.add(out_.lines.vertices[a],
                   fmt::format("so far from the origin the file's coordinates are good to {:g}, "
                               "{:.3g} % of the edge between vertices {} and {}: more digits, or "
                               "a mesh nearer to the origin, would keep its shape",
                               rounding, 100 * rounding / shortest, a + 1, b + 1));
    }

    struct InBetween {
        std::size_t vertex;
        int axis;
        float nearest; ///< to the number as it is written
    };

    static constexpr float kFarthest = 1e9f;
    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::string const& name_;
    Notes& notes_;
    ObjFile out_;
    std::vector<glm::dvec3> positions_;
    std::vector<InBetween> in_between_;
    WrittenDigits digits_;
    std::vector<glm::dvec2> coordinates_;
    std::size_t normals_ = 0;
    ForwardIndices vertex_indices_, coordinate_indices_, normal_indices_;
    bool corner_has_coordinates_ = false;
    bool coordinates_lost_ = false; ///< said so
    int bare_face_line_ = 0;        ///< the first face with a corner without coordinates
    int first_coordinates_line_ = 0;
    ObjTags tags_;
};

} // namespace

ObjFile read_obj(std::string_view text, std::string const& name, WarningSink const& sink)
{
    Notes notes(name, sink);
    try {
        ObjFile out = ObjReader(name, notes).read(text);
        out.warnings = notes.tell();
        return out;
    } catch (FormatError const&) {
        notes.tell();
        throw;
    }
}

} // namespace tessemu
