// tessellate: the fixed-function tessellator alone.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/job.h"
#include "cli/verbs.h"
#include "io/input_file.h"
#include "io/tessellator_text.h"

#include <fmt/format.h>

#include <sstream>

namespace tessemu {

namespace {

struct TessellateRequest {
    TessellatorState state;
    std::vector<double> factors;
    std::string batch; ///< a file of cases instead; "-": standard input
    std::string output;
};

int run_batch(TessellateRequest const& o)
{
    RunOutput result(o.output.empty() ? "-" : o.output);
    std::string const text = o.batch == "-" ? read_file("/dev/stdin") : read_file(o.batch);
    std::string out;
    int line = 0;
    std::istringstream in(text);
    for (std::string row; std::getline(in, row);) {
        TessellatorCase const c = parse_tessellator_case(row, o.batch, ++line);
        out += tessellator_answer(run_tessellator_case(c)) + "\n";
    }
    result.finish([&] { return out; }, "");
    return 0;
}

int run(TessellateRequest const& o)
{
    if (!o.batch.empty()) return run_batch(o);
    RunOutput result(o.output.empty() ? "-" : o.output);
    TessellatorCase c{o.state, {}};
    auto const wanted = std::size_t(tess_factor_count(c.state.domain));
    if (o.factors.size() != wanted)
        throw Error(fmt::format("{} has {} factors, {} are needed", name_of(c.state.domain),
                                o.factors.size(), wanted));
    for (std::size_t i = 0; i < wanted; ++i) c.factors[i] = float(o.factors[i]);
    ReportHeader const header{"tessellate",
                              {{"domain", std::string(name_of(c.state.domain))},
                               {"partitioning", std::string(name_of(c.state.partitioning))},
                               {"output", std::string(name_of(c.state.output))},
                               {"factors", o.factors}},
                              {},
                              {},
                              {}};
    result.finish([&] { return tessellate_report(header, c, run_tessellator_case(c)); }, "");
    return 0;
}

template <class T, std::size_t N> auto one_of_named(T const (&values)[N])
{
    std::vector<std::pair<std::string, T>> words;
    for (T v : values) words.emplace_back(name_of(v), v);
    return one_of(std::move(words));
}

constexpr TessellatorDomain kDomains[] = {TessellatorDomain::Quad, TessellatorDomain::Tri,
                                          TessellatorDomain::Isoline};
constexpr OutputPrimitive kPrimitives[] = {OutputPrimitive::Point, OutputPrimitive::Line,
                                           OutputPrimitive::TriangleCw,
                                           OutputPrimitive::TriangleCcw};

} // namespace

void add_tessellate(CommandLine& program)
{
    auto const o = std::make_shared<TessellateRequest>();
    Verb& verb = program.add_verb(
        "tessellate", "run the fixed-function tessellator alone",
        "  tessemu tessellate --factors 3 3 3 3 3 3\n"
        "  tessemu tessellate --domain tri --partitioning integer --factors 2 2 2 4\n"
        "  tessemu tessellate --batch cases.txt > answers.txt");
    verb.option("--domain", o->state.domain, one_of_named(kDomains), "quad, tri, isoline", "quad");
    add_partitioning(verb, o->state.partitioning);
    verb.option("--output", o->state.output, one_of_named(kPrimitives),
                "point, line, triangle_cw, triangle_ccw", "triangle_cw");
    verb.list("--factors", o->factors, any_number,
              "quad: edges u=0 v=0 u=1 v=1, inside u v; tri: u=0 v=0 w=0, inside; isoline: "
              "density, detail");
    verb.option("--batch", o->batch, plain, "file of cases, one a line; '-' is standard input");
    for (char const* name : {"--factors", "--domain", "--partitioning", "--output"})
        verb.exclude(name, "--batch"); // whose lines say it
    verb.option("-o,--json", o->output, output_path,
                "file for the result instead of standard output");
    verb.runs([o] { return run(*o); });
}

} // namespace tessemu
