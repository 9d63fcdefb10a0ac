// tessellate: the fixed-function tessellator alone.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/job.h"
#include "cli/verbs.h"
#include "io/input_file.h"
#include "io/tessellator_text.h"

#include <fmt/format.h>

namespace tessemu {

namespace {

struct TessellateRequest {
    TessellatorState state;
    std::optional<OutputPrimitive> output_primitive; ///< by default what the domain has
    std::vector<double> factors;
    std::string batch; ///< a file of cases instead; "-": standard input
    std::string output;
};

int run_batch(TessellateRequest const& o)
{
    RunOutput result(o.output.empty() ? "-" : o.output);
    result.keep(o.batch);
    std::string const name = input_name(o.batch);
    std::string out;
    std::size_t line = 0, illegal = 0, first = 0;
    for (TessellatorCase const& c : parse_tessellator_cases(read_file(o.batch), name)) {
        ++line;
        if (!is_legal_output(c.state) && illegal++ == 0) first = line;
        out += tessellator_answer(run_tessellator_case(c)) + "\n";
    }
    if (illegal)
        print_warning(fmt::format(
            "{}:{}: Direct3D 11 has no such output in this domain (rule R75){}: answered as the "
            "reference tessellator does",
            name, first, illegal > 1 ? fmt::format(", and in {} cases more", illegal - 1) : ""));
    result.finish([&] { return out; }, "");
    return 0;
}

int run(TessellateRequest const& o)
{
    if (!o.batch.empty()) return run_batch(o);
    RunOutput result(o.output.empty() ? "-" : o.output);
    TessellatorCase c{o.state, {}};
    bool const isoline = c.state.domain == TessellatorDomain::Isoline;
    c.state.output =
        o.output_primitive.value_or(isoline ? OutputPrimitive::Line : OutputPrimitive::TriangleCw);
    if (!is_legal_output(c.state))
        throw Error(fmt::format("--output is {}, in the domain {} it must be point or {}: lines "
                                "come from isolines and triangles from quad and tri domains (rule "
                                "R75)",
                                name_of(c.state.output), name_of(c.state.domain),
                                isoline ? "line" : "triangle_cw or triangle_ccw"));
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
    verb.option("--output", o->output_primitive, one_of_named(kPrimitives),
                "point; line, of isolines; triangle_cw, triangle_ccw, of the other domains "
                "[triangle_cw, isoline: line]");
    verb.list("--factors", o->factors, any_number,
              "quad: edges u=0 v=0 u=1 v=1, inside u v; tri: u=0 v=0 w=0, inside; isoline: "
              "density, detail; numbers, -inf, inf or nan");
    verb.option("--batch", o->batch, plain, "file of cases, one a line; '-' is standard input");
    for (char const* name : {"--factors", "--domain", "--partitioning", "--output"})
        verb.exclude(name, "--batch"); // whose lines say it
    verb.option("-o,--json", o->output, output_path,
                "file for the result instead of standard output");
    verb.runs([o](Session const&) { return run(*o); });
}

} // namespace tessemu
