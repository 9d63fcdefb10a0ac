// tables: basis-function tables ahead of any mesh, as BOLZ03 has them.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/job.h"
#include "cli/verbs.h"
#include "emu/parallel.h"
#include "io/report.h"
#include "io/table_cache.h"

#include <fmt/format.h>

#include <charconv>

namespace tessemu {

namespace {

struct Valences {
    int first = 2, last = 12;
};

struct TablesRequest {
    Valences valences;
    std::string rules;
    std::string folder;
    RunRequest run;
};

constexpr int kMostValence = 64;

Valences parse_valences(std::string const& text, std::string const& option)
{
    auto const refuse = [&]() -> Error {
        return Error(
            fmt::format("{} is '{}', it must be a whole number, or two as in 2-12, of 1 to "
                        "{}, the lower one first",
                        option, text, kMostValence));
    };
    Valences out;
    char const *const begin = text.data(), *const end = begin + text.size();
    auto const [first_end, first_error] = std::from_chars(begin, end, out.first);
    if (first_error != std::errc()) throw refuse();
    out.last = out.first;
    if (first_end != end) {
        if (*first_end != '-') throw refuse();
        auto const [last_end, last_error] = std::from_chars(first_end + 1, end, out.last);
        if (last_error != std::errc() || last_end != end) throw refuse();
    }
    if (out.first < 1 || out.last > kMostValence || out.last < out.first) throw refuse();
    return out;
}

std::string folder_path(std::string const& text, std::string const& option)
{
    if (text.empty() || text == "-") refuse(text, option, "a folder: tables are files");
    return text;
}

int run(TablesRequest const& o)
{
    RunOutput out(o.run.json);
    ThreadPool const threads(o.run.threads);
    ProgressBar bar;
    std::vector<std::string> warnings;
    auto const warn = [&](std::string const& w) {
        bar.clear();
        print_warning(w);
        warnings.push_back(w);
    };
    if (o.valences.first == 1)
        warn("a ring of one face is no manifold: of valence 1 there are sectors alone, of creases, "
             "boundaries and convex corners");
    Stopwatch const clock;
    std::vector<TableSetRow> sets;
    bool is_written = true;
    BasisTableCache cache(o.folder, [&](std::string const& w) {
        is_written = false;
        warn(w);
    });
    for (auto const& [name, sectors] : {std::pair("opensubdiv", SectorRules::OpenSubdiv),
                                        std::pair("biermann", SectorRules::Biermann)}) {
        if (o.rules != "both" && o.rules != name) continue;
        SubdivisionRules rules;
        rules.sectors = sectors;
        auto const families = table_families(o.valences.first, o.valences.last, rules);
        sets.push_back(
            {name, make_table_set(families, cache, threads,
                                  [&](std::size_t done, std::size_t all) { bar(done, all); })});
    }
    bar.clear();
    if (!is_written) throw Error(o.folder + ": tables could not be written");
    ReportHeader header{
        "tables",
        {{"valences", fmt::format("{}-{}", o.valences.first, o.valences.last)}, {"rules", o.rules}},
        {},
        warnings,
        {{"threads", std::int64_t(threads.threads())},
         {"seconds", clock.seconds()},
         {"bytes_written", std::int64_t(cache.bytes_written())}}};
    out.finish([&] { return tables_report(header, sets); },
               tables_table(sets) +
                   fmt::format("{} bytes written to {}\n", cache.bytes_written(), o.folder));
    return 0;
}

} // namespace

void add_tables(CommandLine& program)
{
    auto const o = std::make_shared<TablesRequest>();
    Verb& verb = program.add_verb(
        "tables", "make basis-function tables ahead of any mesh (BOLZ03)",
        "  tessemu tables -o cache\n"
        "  tessemu tables --valences 3-8 --rules opensubdiv -o cache --json tables.json\n"
        "  tessemu draw cage.obj --table-cache cache -o cage.png");
    verb.required("-o", o->folder, folder_path,
                  "folder for them, a file for each type of patch; --table-cache takes it");
    verb.option("--valences", o->valences, parse_valences,
                "faces around a vertex: N or FIRST-LAST, 1 to 64", "2-12");
    verb.option("--rules", o->rules,
                one_of<std::string>(
                    {{"both", "both"}, {"opensubdiv", "opensubdiv"}, {"biermann", "biermann"}}),
                "opensubdiv: its plain rules; biermann: Biermann's, with concave corners; both",
                "both");
    add_options(verb, o->run);
    verb.runs([o](Session const&) { return run(*o); });
}

} // namespace tessemu
