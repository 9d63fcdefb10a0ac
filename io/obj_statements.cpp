// SPDX-License-Identifier: Apache-2.0
#include "io/obj_statements.h"

#include "emu/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <climits>

namespace tessemu {

namespace {

bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
bool is_line_end(char c)
{
    return c == '\r' || c == '\n';
}

} // namespace

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

bool Statements::next()
{
    words.clear();
    while (words.empty() && !rest_.empty()) {
        line = int(next_line_);
        continues_ = take_line();
    }
    return !words.empty();
}

bool Statements::take_line()
{
    if (next_line_ > INT_MAX)
        throw FormatError(name_, 0, fmt::format("has more lines than {}, the limit", INT_MAX));
    std::size_t end = 0;
    while (end < rest_.size() && !is_line_end(rest_[end])) ++end;
    std::string_view s = rest_.substr(0, end);
    bool const two = rest_.substr(end).starts_with("\r\n");
    rest_.remove_prefix(std::min(end + (two ? 2 : 1), rest_.size()));
    ++next_line_;
    while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
    bool const backslash = s.ends_with('\\');
    if (backslash) s.remove_suffix(1);
    for (std::size_t at = 0;;) {
        while (at < s.size() && is_blank(s[at])) ++at;
        if (at == s.size()) return backslash;
        if (s[at] == '#') return false;
        std::size_t after = at;
        while (after < s.size() && !is_blank(s[after])) ++after;
        words.push_back(s.substr(at, after - at));
        at = after;
    }
}

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
    std::size_t at = 0;
    while (at < s.size() && s[at] != 'e' && s[at] != 'E') ++at;
    return at;
}

bool is_tiny(std::string_view s)
{
    return point_of(s, exponent_in(s)) < std::int64_t(s.find_first_of("123456789"));
}

bool is_between_floats(double x)
{
    return (std::bit_cast<std::uint64_t>(x) & 0x1fffffff) == 0x10000000;
}

std::string shown(std::string_view s)
{
    std::string out;
    for (char c : s.substr(0, 40)) out += c >= 32 && c < 127 ? c : '?';
    return s.size() > 40 ? out + "..." : out;
}

} // namespace tessemu
