// SPDX-License-Identifier: Apache-2.0
#include "io/obj_reader.h"

#include "emu/error.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <bit>
#include <charconv>
#include <climits>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace tessemu {

namespace {

constexpr std::string_view kBlanks = " \t\v\f";

// What a line is to a surface.
enum class Meaning {
    Vertex,
    Coordinates,
    Normal,
    Face,
    Tag,
    Lines,
    Points,
    FreeForm,
    Command, ///< reads or runs something else
    None,    ///< names, materials, how something is shown
    Unknown
};

Meaning meaning_of(std::string_view keyword)
{
    if (keyword == "v") return Meaning::Vertex;
    if (keyword == "vt") return Meaning::Coordinates;
    if (keyword == "vn") return Meaning::Normal;
    if (keyword == "f" || keyword == "fo") return Meaning::Face;
    if (keyword == "t") return Meaning::Tag;
    if (keyword == "l") return Meaning::Lines;
    if (keyword == "p") return Meaning::Points;
    if (keyword == "call" || keyword == "csh") return Meaning::Command;
    for (char const* word :
         {"vp",   "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim",
          "hole", "scrv",   "sp",  "end",  "con",  "bsp",  "bzp",   "cdc",  "cdp",  "res"})
        if (keyword == word) return Meaning::FreeForm;
    for (char const* word :
         {"g", "o", "s", "mg", "usemtl", "mtllib", "usemap", "maplib", "lod", "bevel", "c_interp",
          "d_interp", "shadow_obj", "trace_obj", "ctech", "stech"})
        if (keyword == word) return Meaning::None;
    return Meaning::Unknown;
}

// The text, statement by statement.
class Statements {
public:
    Statements(std::string_view text, std::string const& name) : rest_(text), name_(name) {}

    /// To the next line that says something; false at the end. One that continues is whole only
    /// after join().
    bool next()
    {
        words.clear();
        while (words.empty() && !rest_.empty()) {
            line = int(next_line_);
            continues_ = take_line();
        }
        return !words.empty();
    }
    /// Takes the lines that continue this one.
    void join()
    {
        while (continues_ && !rest_.empty()) continues_ = take_line();
    }

    std::vector<std::string_view> words; ///< the keyword first, without comments
    int line = 0;                        ///< where the statement begins

private:
    // Adds a line's words; says whether a backslash ends it.
    bool take_line()
    {
        if (next_line_ > INT_MAX)
            throw FormatError(name_, 0, fmt::format("has more lines than {}, the limit", INT_MAX));
        std::size_t const end = std::min(rest_.find_first_of("\r\n"), rest_.size());
        std::string_view s = rest_.substr(0, end);
        bool const two = rest_.substr(end).starts_with("\r\n");
        rest_.remove_prefix(std::min(end + (two ? 2 : 1), rest_.size()));
        ++next_line_;
        std::size_t const last = s.find_last_not_of(kBlanks);
        bool const backslash = last != std::string_view::npos && s[last] == '\\';
        s = s.substr(0, last == std::string_view::npos ? 0 : last + (backslash ? 0 : 1));
        for (std::size_t at = 0; (at = s.find_first_not_of(kBlanks, at)) != s.npos;) {
            if (s[at] == '#') return false;
            std::size_t const after = std::min(s.find_first_of(kBlanks, at), s.size());
            words.push_back(s.substr(at, after - at));
            at = after;
        }
        return backslash;
    }

    std::string_view rest_;
    std::string const& name_;
    std::int64_t next_line_ = 1;
    bool continues_ = false;
};

// Where a decimal number, `e` its exponent's letter or its end, has the decimal point if that is
// moved by the exponent: characters from its first one.
std::int64_t point_of(std::string_view s, std::size_t e)
{
    constexpr std::int64_t kFar = std::int64_t(1) << 40; // beyond what text can make up for
    std::int64_t exponent = 0;
    if (e < s.size()) {
        std::string_view digits = s.substr(e + 1);
        if (digits.starts_with('+')) digits.remove_prefix(1);
        auto const error =
            std::from_chars(digits.data(), digits.data() + digits.size(), exponent).ec;
        if (error == std::errc::result_out_of_range) exponent = digits[0] == '-' ? -kFar : kFar;
    }
    return std::int64_t(std::min(s.find('.'), e)) + std::clamp(exponent, -kFar, kFar);
}

std::size_t exponent_in(std::string_view s)
{
    return std::min(s.find_first_of("eE"), s.size());
}

// Of a number that is not representable: whether it is so small that it is 0.
bool is_tiny(std::string_view s)
{
    return point_of(s, exponent_in(s)) < std::int64_t(s.find_first_of("123456789"));
}

enum class Reading { Number, TooLarge, NoNumber };

// A decimal number, rounded once. "nan", "inf", hexadecimal and half-read words are none.
template <class Number> Reading read_number(std::string_view s, Number& out)
{
    if (s.starts_with('+')) s.remove_prefix(s.substr(1).starts_with('-') ? 0 : 1);
    auto const [end, error] = std::from_chars(s.data(), s.data() + s.size(), out);
    if (error == std::errc::invalid_argument || end != s.data() + s.size())
        return Reading::NoNumber;
    if (error == std::errc::result_out_of_range) {
        if constexpr (std::is_integral_v<Number>) return Reading::TooLarge;
        if (!is_tiny(s)) return Reading::TooLarge;
        out = 0;
    }
    if constexpr (!std::is_integral_v<Number>)
        if (!std::isfinite(out)) return Reading::NoNumber;
    return Reading::Number;
}

template <class Number> bool is_number(std::string_view s, Number& out)
{
    return read_number(s, out) == Reading::Number;
}

// Whether a double lies in the middle between two floats, where rounding twice may go wrong.
bool is_between_floats(double x)
{
    return (std::bit_cast<std::uint64_t>(x) & 0x1fffffff) == 0x10000000;
}

// A word of the file in a message.
std::string shown(std::string_view s)
{
    std::string out;
    for (char c : s.substr(0, 40)) out += c >= 32 && c < 127 ? c : '?';
    return s.size() > 40 ? out + "..." : out;
}

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

struct Tag {
    int line;
    std::string name;
    std::vector<std::int64_t> ints;
    std::vector<float> floats;
    std::vector<std::string_view> strings;
};

// Warnings by line; like ones are counted and told once.
class Notes {
public:
    Notes(std::string const& name, WarningSink const& sink) : name_(name), sink_(sink) {}

    void add(int line, std::string const& text) { notes_.push_back({line, text, 1}); }
    /// \param kind  what is counted together
    template <class Text> void count(std::string const& kind, int line, Text const& text)
    {
        auto const [at, fresh] = kinds_.try_emplace(kind, notes_.size());
        if (fresh)
            add(line, text());
        else
            ++notes_[at->second].number;
    }

    std::vector<std::string> tell()
    {
        std::stable_sort(notes_.begin(), notes_.end(),
                         [](Note const& a, Note const& b) { return a.line < b.line; });
        std::vector<std::string> out;
        for (Note const& n : notes_) {
            out.push_back(fmt::format("{}:{}: {}", name_, n.line, n.text));
            if (n.number > 1) out.back() += fmt::format(" (and {} more)", n.number - 1);
            if (sink_) sink_(out.back());
        }
        return out;
    }

private:
    struct Note {
        int line;
        std::string text;
        std::size_t number;
    };
    std::string const& name_;
    WarningSink const& sink_;
    std::vector<Note> notes_;
    std::map<std::string, std::size_t> kinds_;
};

// How a file writes the coordinates of its vertices: whether in a format of so many significant
// digits, such as %g, which has lost those behind. Whole numbers and a fixed number of decimals may
// be all there is to say.
class WrittenDigits {
public:
    /// \param number  a word that is one; the text outlives this
    void see(std::string_view number)
    {
        std::size_t const e = exponent_in(number);
        std::size_t digits = 0, last = 0;
        for (std::size_t i = 0; i < e; ++i)
            if (number[i] >= '0' && number[i] <= '9' && (digits || number[i] != '0'))
                ++digits, last = i;
        if (digits < std::max(most_, kLeast)) return;
        if (digits > most_) full_.clear();
        most_ = digits;
        std::size_t const point = number.find('.');
        auto const place = point_of(number, e) - std::int64_t(last) - (last < point);
        std::set<std::string_view>& some = full_[place];
        if (some.size() < kSeveral) some.insert(number);
    }
    /// How many there are at most, if that is the format's doing: several numbers have so many at
    /// different powers of ten, or one has none at 1.
    std::optional<int> limit() const
    {
        if (full_.empty() || most_ >= kAllOfADouble) return {};
        auto const several = [](auto const& place) { return place.second.size() == kSeveral; };
        auto const fine = std::find_if(full_.begin(), full_.end(), several);
        auto const coarse = std::find_if(full_.rbegin(), full_.rend(), several);
        bool const differ = fine != full_.end() && coarse->first - fine->first >= 2;
        if (!differ && full_.rbegin()->first <= 0) return {};
        return int(most_);
    }

private:
    static constexpr std::size_t kLeast = 6, kAllOfADouble = 15, kSeveral = 3;
    std::size_t most_ = 0; ///< digits of a number, without leading zeros
    /// By the power of ten of the last digit, some different numbers with so many digits.
    std::map<std::int64_t, std::set<std::string_view>> full_;
};

class ObjReader {
public:
    ObjReader(std::string const& name, Notes& notes) : name_(name), notes_(notes) {}

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
        for (Tag const& t : tags_) apply(t);
        finish_tags();
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
            return tag(words, s.line);
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
        float x[3] = {};
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

    // \param kind  of tags; like ones are counted
    void note_tag(int line, std::string const& kind, std::string const& text)
    {
        notes_.count("tag: " + kind, line, [&] { return text; });
    }

    void tag(std::vector<std::string_view> const& words, int line)
    {
        auto const skip = [&](char const* kind, std::string const& why) {
            note_tag(line, kind, why + ": the tag is skipped");
        };
        std::size_t counts[3] = {};
        std::string_view form = words.size() > 2 ? words[2] : "";
        for (int i = 0; i < 3; ++i) {
            std::size_t const slash = form.find('/');
            if (!is_number(form.substr(0, slash), counts[i]) || (i < 2) != (slash != form.npos))
                return skip("form", "tag is not 'name ints/floats/strings'");
            form = slash == form.npos ? "" : form.substr(slash + 1);
        }
        std::string const what = fmt::format("tag '{}'", shown(words[1]));
        std::size_t const has = words.size() - 3;
        for (std::size_t expected = 0; std::size_t c : counts)
            if (c > has || (expected += c) > has)
                return skip("lacks",
                            fmt::format("{} announces {} values and has {}", what, words[2], has));
        Tag t{line, std::string(words[1]), {}, {}, {}};
        auto word = words.begin() + 3;
        for (std::size_t i = 0; i < counts[0] + counts[1]; ++i, ++word) {
            std::int64_t k = 0;
            float x = 0;
            bool const integer = i < counts[0], endless = *word == "inf" || *word == "infinite";
            if (endless) x = kInfinitelySharp;
            if (integer ? !is_number(*word, k) : !endless && !is_number(*word, x))
                return skip("value", fmt::format("{} has the value '{}'", what, shown(*word)));
            if (integer)
                t.ints.push_back(k);
            else
                t.floats.push_back(x);
        }
        t.strings.assign(word, word + std::ptrdiff_t(counts[2]));
        if (word + std::ptrdiff_t(counts[2]) != words.end())
            note_tag(line, "rest",
                     fmt::format("{} announces {} values and has {}: the rest is left out", what,
                                 words[2], has));
        tags_.push_back(std::move(t));
    }

    bool in_range(Tag const& t, std::int64_t value, std::size_t limit, char const* what)
    {
        if (value >= 0 && value < std::int64_t(limit)) return true;
        note_tag(t.line, t.name + " names " + what,
                 fmt::format("tag '{}' names {} {}, the file has 0 to {}: skipped", t.name, what,
                             value, std::int64_t(limit) - 1));
        return false;
    }

    // Of item i of a tag with so many items of so many integers each: a value for all, for each
    // item, or, as OpenSubdiv asks, one for each integer.
    float sharpness(Tag const& t, std::size_t item, std::size_t ints) const
    {
        std::size_t const n = t.floats.size(), items = t.ints.size() / ints;
        if (n == 0) return kInfinitelySharp;
        return std::max(0.0f, t.floats[n == 1 ? 0 : n == items ? item : item * ints]);
    }
    bool has_sharpness(Tag const& t, std::size_t ints)
    {
        std::size_t const n = t.floats.size(), items = t.ints.size() / ints;
        if (n == 0)
            note_tag(t.line, t.name + " has none",
                     fmt::format("tag '{}' has no sharpness: it is infinitely sharp", t.name));
        for (float s : t.floats)
            if (s < 0) {
                note_tag(t.line, t.name + " below 0",
                         fmt::format("tag '{}' has the sharpness {}: taken as 0", t.name, s));
                break;
            }
        if (n <= 1 || n == items || n > (items - 1) * ints) return true;
        note_tag(t.line, t.name + " number",
                 fmt::format("tag '{}' has {} sharpnesses for {} {}: the tag is skipped", t.name, n,
                             items, ints == 2 ? "edges" : "vertices"));
        return false;
    }

    void apply(Tag const& t)
    {
        std::size_t const vertices = positions_.size(), faces = mesh().faces();
        auto const left_out = [&](std::string const& what, char const* kind = nullptr) {
            note_tag(t.line, kind ? kind : what, what);
        };
        if (t.name == "crease") {
            std::size_t const edges = t.ints.size() / 2;
            if (t.ints.size() % 2)
                left_out("tag 'crease' is pairs of vertices: the last one has no partner and is "
                         "left out");
            if (edges == 0 || !has_sharpness(t, 2)) return;
            for (std::size_t i = 0; i < edges; ++i) {
                std::int64_t const a = t.ints[2 * i], b = t.ints[2 * i + 1];
                if (!in_range(t, a, vertices, "vertex") || !in_range(t, b, vertices, "vertex"))
                    continue;
                if (!is_edge(std::uint32_t(a), std::uint32_t(b)))
                    left_out(
                        fmt::format("crease {}-{} runs along no edge of the mesh: skipped", a, b),
                        "crease along no edge");
                else
                    creases_[ordered_edge(std::uint32_t(a), std::uint32_t(b))] = {
                        std::uint32_t(a), std::uint32_t(b), sharpness(t, i, 2)};
            }
        } else if (t.name == "corner") {
            if (t.ints.empty()) return left_out("tag 'corner' names no vertex");
            if (!has_sharpness(t, 1)) return;
            for (std::size_t i = 0; i < t.ints.size(); ++i)
                if (in_range(t, t.ints[i], vertices, "vertex"))
                    corners_[std::uint32_t(t.ints[i])] = sharpness(t, i, 1);
        } else if (t.name == "hole") {
            if (t.ints.empty()) return left_out("tag 'hole' names no face");
            for (std::int64_t f : t.ints)
                if (in_range(t, f, faces, "face")) mesh().holes.push_back(std::uint32_t(f));
        } else if (t.name == "interpolateboundary") {
            if (t.ints.size() != 1)
                return left_out("tag 'interpolateboundary' has not one integer: skipped");
            if (in_range(t, t.ints[0], 3, "rule")) mesh().boundary = BoundaryRule(t.ints[0]);
        } else if (t.name == "creasemethod" || t.name == "smoothtriangles") {
            std::string_view const honoured = t.name == "creasemethod" ? "normal" : "catmark";
            if (t.strings != std::vector{honoured})
                left_out(fmt::format("tag '{}' is not honoured but for '{}'", t.name, honoured));
        } else if (t.name == "facevaryinginterpolateboundary") {
            if (t.ints != std::vector<std::int64_t>{kLinear})
                left_out(fmt::format("tag '{}' is not honoured: texture coordinates are linear in "
                                     "faces, as by rule {}",
                                     t.name, kLinear));
        } else {
            left_out(fmt::format("tag '{}' is not known and is skipped", shown(t.name)), "unknown");
        }
    }

    using Edge = std::pair<std::uint32_t, std::uint32_t>;
    bool is_edge(std::uint32_t a, std::uint32_t b)
    {
        if (edges_.empty()) {
            for (std::size_t f = 0; f < mesh().faces(); ++f) {
                auto const v = mesh().face(f);
                for (std::size_t i = 0; i < v.size(); ++i)
                    edges_.push_back(ordered_edge(v[i], v[(i + 1) % v.size()]));
            }
            std::sort(edges_.begin(), edges_.end());
        }
        return std::binary_search(edges_.begin(), edges_.end(), ordered_edge(a, b));
    }

    // What is not sharp has no tag.
    void finish_tags()
    {
        for (auto const& [edge, crease] : creases_)
            if (crease.sharpness > 0) mesh().creases.push_back(crease);
        for (auto const& [vertex, sharpness] : corners_)
            if (sharpness > 0) mesh().corners.push_back({vertex, sharpness});
        auto& holes = mesh().holes;
        std::sort(holes.begin(), holes.end());
        holes.erase(std::unique(holes.begin(), holes.end()), holes.end());
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
    static constexpr std::int64_t kLinear = 5;

    std::string const& name_;
    Notes& notes_;
    ObjFile out_;
    std::vector<glm::dvec3> positions_;
    std::vector<InBetween> in_between_;
    WrittenDigits digits_;
    std::vector<glm::vec2> coordinates_;
    std::size_t normals_ = 0;
    ForwardIndices vertex_indices_, coordinate_indices_, normal_indices_;
    bool corner_has_coordinates_ = false;
    bool coordinates_lost_ = false; ///< said so
    int bare_face_line_ = 0;        ///< the first face with a corner without coordinates
    int first_coordinates_line_ = 0;
    std::vector<Tag> tags_;
    std::vector<Edge> edges_; ///< of the faces, ascending; made for the first crease
    std::map<Edge, ControlMesh::Crease> creases_;
    std::map<std::uint32_t, float> corners_;
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
