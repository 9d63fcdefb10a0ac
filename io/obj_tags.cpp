// SPDX-License-Identifier: Apache-2.0
#include "io/obj_tags.h"

#include "io/obj_statements.h"

#include <algorithm>

namespace tessemu {

namespace {

constexpr std::int64_t kLinear = 5;

} // namespace

void ObjTags::note_tag(int line, std::string const& kind, std::string const& text)
{
    notes_.count("tag: " + kind, line, [&] { return text; });
}

void ObjTags::read(std::vector<std::string_view> const& words, int line)
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

bool ObjTags::in_range(Tag const& t, std::int64_t value, std::size_t limit, char const* what)
{
    if (value >= 0 && value < std::int64_t(limit)) return true;
    note_tag(t.line, t.name + " names " + what,
             fmt::format("tag '{}' names {} {}, the file has 0 to {}: skipped", t.name, what, value,
                         std::int64_t(limit) - 1));
    return false;
}

// Of item i of a tag with so many items of so many integers each: a value for all, for each
// item, or, as OpenSubdiv asks, one for each integer.
float ObjTags::sharpness(Tag const& t, std::size_t item, std::size_t ints) const
{
    std::size_t const n = t.floats.size(), items = t.ints.size() / ints;
    if (n == 0) return kInfinitelySharp;
    return std::max(0.0f, t.floats[n == 1 ? 0 : n == items ? item : item * ints]);
}

bool ObjTags::has_sharpness(Tag const& t, std::size_t ints)
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

std::optional<bool> ObjTags::one_of(Tag const& t, std::string_view first, std::string_view second)
{
    if (t.strings.size() == 1 && (t.strings[0] == first || t.strings[0] == second))
        return t.strings[0] == second;
    note_tag(t.line, t.name,
             t.strings.empty()
                 ? fmt::format("tag '{}' has no word, '{}' or '{}': skipped", t.name, first, second)
                 : fmt::format("tag '{}' is '{}', known are '{}' and '{}': skipped", t.name,
                               shown(t.strings[0]), first, second));
    return {};
}

void ObjTags::apply(Tag const& t, std::size_t vertices)
{
    std::size_t const faces = mesh_.faces();
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
                left_out(fmt::format("crease {}-{} runs along no edge of the mesh: skipped", a, b),
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
            if (in_range(t, f, faces, "face")) mesh_.holes.push_back(std::uint32_t(f));
    } else if (t.name == "interpolateboundary") {
        if (t.ints.size() != 1)
            return left_out("tag 'interpolateboundary' has not one integer: skipped");
        if (t.ints[0] < 0 || t.ints[0] > 2)
            return left_out(fmt::format("tag 'interpolateboundary' is {}, known are 0 (none), 1 "
                                        "(edge and corner) and 2 (edge only): skipped",
                                        t.ints[0]),
                            "interpolateboundary");
        mesh_.rules.boundary = BoundaryRule(t.ints[0]);
    } else if (t.name == "creasemethod") {
        if (auto const is_second = one_of(t, "normal", "chaikin"))
            mesh_.rules.crease_method = *is_second ? CreaseMethod::Chaikin : CreaseMethod::Normal;
    } else if (t.name == "smoothtriangles") {
        if (auto const is_second = one_of(t, "catmark", "smooth"))
            mesh_.rules.smooth_triangles = *is_second;
    } else if (t.name == "facevaryinginterpolateboundary") {
        if (t.ints != std::vector<std::int64_t>{kLinear})
            left_out(fmt::format("tag '{}' is not honoured: texture coordinates are linear in "
                                 "faces, as by rule {}",
                                 t.name, kLinear));
    } else {
        left_out(fmt::format("tag '{}' is not known and is skipped", shown(t.name)), "unknown");
    }
}

bool ObjTags::is_edge(std::uint32_t a, std::uint32_t b)
{
    if (edges_.empty()) {
        for (std::size_t f = 0; f < mesh_.faces(); ++f) {
            auto const v = mesh_.face(f);
            for (std::size_t i = 0; i < v.size(); ++i)
                edges_.push_back(ordered_edge(v[i], v[(i + 1) % v.size()]));
        }
        std::sort(edges_.begin(), edges_.end());
    }
    return std::binary_search(edges_.begin(), edges_.end(), ordered_edge(a, b));
}

void ObjTags::apply(std::size_t vertices)
{
    for (Tag const& t : tags_) apply(t, vertices);
    // What is not sharp has no tag.
    for (auto const& [edge, crease] : creases_)
        if (crease.sharpness > 0) mesh_.creases.push_back(crease);
    for (auto const& [vertex, sharpness] : corners_)
        if (sharpness > 0) mesh_.corners.push_back({vertex, sharpness});
    auto& holes = mesh_.holes;
    std::sort(holes.begin(), holes.end());
    holes.erase(std::unique(holes.begin(), holes.end()), holes.end());
}

} // namespace tessemu
