// compare: a scheme's surface against the limit surface.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/compare.h"

#include "cli/job.h"
#include "cli/verbs.h"

#include <fmt/format.h>

namespace tessemu {

namespace {

struct CompareRequest {
    ModelRequest model;
    ShadingRequest shading;
    RunRequest run;
    int level = 0;
};

int run(CompareRequest const& o, Session const& session)
{
    RunOutput out(o.run.json, session);
    out.keep(o.model.model);
    std::optional<ThreadPool> own;
    ThreadPool const& threads = session.pool(o.run.threads, own);
    Job job = prepare(o.model, o.shading, "compare", threads, session);
    job.header.config.emplace_back("level", std::int64_t(o.level));
    Stopwatch const clock;
    SurfaceComparison const c = compare_with_limit(job.patches(), job.frame, o.level, threads);
    if (c.to_limit.samples == 0 && c.from_limit.samples == 0)
        throw Error(job.path + ": nothing was compared: no face is drawn, or the surface has no "
                               "area");
    add_run(job.header, job, threads, clock.seconds());
    std::vector<ErrorRow> const rows{
        error_row("position", "closest point, scheme to limit", "diagonal", c.to_limit),
        error_row("position", "closest point, limit to scheme", "diagonal", c.from_limit),
        error_row("position", "equal parameter", "diagonal", c.equal_position),
        error_row("normal", "closest point, scheme to limit", "radians", c.normal_to_limit),
        error_row("normal", "closest point, limit to scheme", "radians", c.normal_from_limit),
        error_row("normal", "equal parameter", "radians", c.equal_normal)};
    double const diagonal = job.placement.length_to_file(c.diagonal);
    out.finish([&] { return compare_report(job.header, diagonal, rows); }, compare_table(rows));
    return 0;
}

} // namespace

void add_compare(CommandLine& program)
{
    auto const o = std::make_shared<CompareRequest>();
    Verb& verb = program.add_verb(
        "compare", "distance and normal error against the limit surface of a scheme's rules",
        "  tessemu compare cage.obj\n"
        "  tessemu compare cage.obj --level 5 --json error.json");
    add_level(verb, o->level, "both surfaces at 2^level segments an edge, 1 to 6");
    add_options(verb, o->model);
    add_options(verb, o->shading);
    add_options(verb, o->run);
    verb.runs([o](Session const& session) { return run(*o, session); });
}

} // namespace tessemu
