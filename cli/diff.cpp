// diff: two results side by side.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/job.h"
#include "cli/verbs.h"
#include "io/input_file.h"
#include "io/result_diff.h"
#include "io/sha256.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessemu {

namespace {

struct DiffRequest {
    std::string a, b; ///< paths
    double tolerance = 0;
    bool all = false;
    std::string json;
};

double parse_tolerance(std::string const& text, std::string const& option)
{
    double const x = any_number(text, option);
    if (!(x >= 0)) throw Error(fmt::format("{} is {}, it must be 0 or above", option, x));
    return x;
}

int run(DiffRequest const& o)
{
    RunOutput out(o.json);
    for (std::string const& input : {o.a, o.b}) out.keep(input);
    std::string const a = read_file(o.a), b = read_file(o.b);
    std::vector<ResultValue> const values = diff_results(a, b, {o.a, o.b}, o.tolerance);
    auto const input = [](std::string const& path, std::string const& text) {
        return std::pair(path.substr(path.rfind('/') + 1), sha256_of(text));
    };
    ReportHeader const header{
        "diff", {{"tolerance", o.tolerance}}, {input(o.a, a), input(o.b, b)}, {}, {}};
    out.finish([&] { return diff_report(header, values); }, diff_table(values, o.all));
    return std::any_of(values.begin(), values.end(), [](auto const& v) { return v.differs; });
}

} // namespace

void add_diff(CommandLine& program)
{
    auto const o = std::make_shared<DiffRequest>();
    Verb& verb =
        program.add_verb("diff", "two results side by side; exit status 1 where they differ",
                         "  tessemu draw jug --json now.json && tessemu diff golden.json now.json\n"
                         "  tessemu diff before.json after.json --all\n"
                         "  tessemu diff golden.json now.json --tolerance 0.01");
    verb.required("A", o->a, plain, "a result, as --json writes it");
    verb.required("B", o->b, plain, "another");
    verb.option("--tolerance", o->tolerance, parse_tolerance,
                "numbers may differ by this share of the larger one; above 0, hashes are not "
                "compared",
                "0");
    verb.flag("--all", o->all, "show equal values too");
    add_json(verb, o->json);
    verb.runs([o](Session const&) { return run(*o); });
}

} // namespace tessemu
