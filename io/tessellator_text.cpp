// SPDX-License-Identifier: Apache-2.0
#include "io/tessellator_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <sstream>

namespace tessemu {

namespace {
class Fnv {
public:
    void add(std::uint32_t word)
    {
        for (int k = 0; k < 4; ++k) hash_ = (hash_ ^ ((word >> (8 * k)) & 255)) * 0x100000001b3u;
    }
    std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325u;
};
} // namespace

TessellatorCase parse_tessellator_case(std::string_view text, std::string const& file, int line)
{
    std::istringstream in{std::string(text)};
    std::string domain, partitioning, output, word;
    in >> domain >> partitioning >> output;
    auto const d = tessellator_domain_from_name(domain);
    auto const p = partitioning_from_name(partitioning);
    auto const o = output_primitive_from_name(output);
    if (!d)
        throw FormatError(file, line,
                          "domain is '" + domain + "', it must be quad, tri or isoline");
    if (!p)
        throw FormatError(file, line,
                          "partitioning is '" + partitioning +
                              "', it must be integer, pow2, fractional_odd or fractional_even");
    if (!o)
        throw FormatError(file, line,
                          "output is '" + output +
                              "', it must be point, line, triangle_cw or triangle_ccw");
    TessellatorCase c{{*d, *p, *o}, {}};
    int const wanted = tess_factor_count(*d);
    int got = 0;
    while (in >> word) {
        std::uint32_t bits = 0;
        auto const [end, ec] = std::from_chars(word.data(), word.data() + word.size(), bits, 16);
        if (word.size() != 8 || ec != std::errc() || end != word.data() + word.size())
            throw FormatError(file, line,
                              "factor is '" + word + "', it must be 8 hexadecimal digits");
        if (got < wanted) c.factors[std::size_t(got)] = std::bit_cast<float>(bits);
        ++got;
    }
    if (got != wanted)
        throw FormatError(file, line,
                          fmt::format("{} has {} factors, {} are needed", domain, got, wanted));
    return c;
}

std::vector<TessellatorCase> parse_tessellator_cases(std::string_view text, std::string const& file)
{
    constexpr std::string_view kBlank = " \t\r\n";
    text = text.substr(0, text.find_last_not_of(kBlank) + 1);
    std::vector<TessellatorCase> out;
    for (int line = 1; !text.empty(); ++line) {
        std::size_t const end = std::min(text.find('\n'), text.size());
        std::string_view const row = text.substr(0, end);
        if (row.find_first_not_of(kBlank) == row.npos)
            throw FormatError(file, line, "the line is empty, and cases follow");
        out.push_back(parse_tessellator_case(row, file, line));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return out;
}

std::string format_tessellator_case(TessellatorCase const& c)
{
    std::string s = fmt::format("{} {} {}", name_of(c.state.domain), name_of(c.state.partitioning),
                                name_of(c.state.output));
    for (int i = 0; i < tess_factor_count(c.state.domain); ++i)
        s += fmt::format(" {:08x}", std::bit_cast<std::uint32_t>(c.factors[std::size_t(i)]));
    return s;
}

bool is_legal_output(TessellatorState const& s)
{
    bool const isoline = s.domain == TessellatorDomain::Isoline;
    return s.output == OutputPrimitive::Point || isoline == (s.output == OutputPrimitive::Line);
}

TessellatedPatch run_tessellator_case(TessellatorCase const& c)
{
    TessellatedPatch out;
    tessellate(c.state, process_tess_factors(c.state, c.factors), out);
    return out;
}

std::string tessellator_answer(TessellatedPatch const& patch)
{
    Fnv points, indices;
    for (std::size_t i = 0; i < patch.points(); ++i) points.add(patch.u[i]), points.add(patch.v[i]);
    for (std::uint32_t i : patch.indices) indices.add(i);
    return fmt::format("{} {} {:016x} {:016x}", patch.points(), patch.indices.size(),
                       points.value(), indices.value());
}

} // namespace tessemu
