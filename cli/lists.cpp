// schemes, models: what is built in.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/options.h"
#include "cli/run_output.h"
#include "cli/verbs.h"
#include "pipeline/mesh/builtin_models.h"

#include <fmt/format.h>

#include <cmath>

namespace tessemu {

namespace {

std::string allowed(SchemeParameter const& p)
{
    if (!p.words.empty()) return in_words(p.words);
    bool const low = std::isfinite(p.min), high = std::isfinite(p.max);
    if (low && high) return fmt::format("{} to {}", p.min, p.max);
    if (low) return fmt::format("{} or above", p.min);
    return high ? fmt::format("{} or below", p.max) : "any number";
}

std::string line_of(SchemeParameter const& p)
{
    std::string const value = !p.words.empty()  ? p.words[0]
                              : p.default_value ? fmt::format("{}", *p.default_value)
                                                : "NUMBER";
    return fmt::format("    --set {}={}  {}{}: {}\n", p.name, value, allowed(p),
                       p.words.empty() && !p.default_value ? ", by default not set" : "",
                       p.meaning);
}

int list_schemes(Session const&)
{
    std::string out;
    for (auto const& scheme : schemes()) {
        SchemeInfo const i = scheme->info();
        out += fmt::format("{}\n    {} section {}: {}\n    takes {}\n", i.name, i.paper, i.section,
                           i.summary, in_words(i.takes));
        for (SchemeParameter const& p : i.parameters) out += line_of(p);
        for (auto const& [name, value] : i.watertight_with)
            out += fmt::format("    shared edges have equal bits with --set {}={}\n", name, value);
    }
    out += "every scheme of quads, where steps of subdivision are taken: its own, or by "
           "--subdivide\n" +
           line_of(sort_parameter()) + "every scheme, where steps are taken\n" +
           line_of(coordinates_parameter());
    print(out);
    return 0;
}

int list_models(Session const&)
{
    std::string out;
    for (BuiltinModel const& m : builtin_models()) {
        std::string_view about = m.obj.substr(0, m.obj.find('\n'));
        about.remove_prefix(std::min<std::size_t>(2, about.size()));
        out += fmt::format("{:<14} {}\n", m.name, about);
    }
    print(out);
    return 0;
}

} // namespace

void add_schemes(CommandLine& program)
{
    program
        .add_verb("schemes", "list the patch schemes: what they draw, and what can be set",
                  "  tessemu schemes")
        .runs(list_schemes);
}

void add_models(CommandLine& program)
{
    program.add_verb("models", "list the built-in control meshes", "  tessemu models")
        .runs(list_models);
}

} // namespace tessemu
