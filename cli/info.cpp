// info: a control mesh and its patches in figures.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/job.h"
#include "cli/verbs.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessemu {

namespace {

struct InfoRequest {
    ModelRequest model;
    std::string json;
};

// Of a file's mesh: those of no face that is drawn.
std::size_t unused_vertices(ControlMesh const& file, ControlMesh const& drawn)
{
    std::vector<char> used(file.positions.size());
    for (std::uint32_t f = 0; f < drawn.faces(); ++f)
        for (std::uint32_t v : file.face(drawn.file_face(f))) used[v] = 1;
    return std::size_t(std::count(used.begin(), used.end(), 0));
}

int run(InfoRequest const& o)
{
    RunOutput out(o.json);
    out.keep(o.model.model);
    Model const model = open_model(o.model.model);
    SchemeInfo const info = o.model.scheme->info();
    Parameters parameters = resolve_parameters(info, o.model.build.set);
    std::vector<std::string> more;
    auto const tell = [&](std::string const& warning) {
        more.push_back(warning);
        print_warning(warning);
    };
    ThreadPool const threads;
    SchemeOnMesh surface;
    std::vector<PatchCount> patches;
    try {
        surface = build(model, o.model, threads, build_scheme, tell);
        patches = surface.patches->patch_counts();
        parameters = surface.parameters;
    } catch (FormatError const& e) {
        // A mesh that the scheme refuses still has figures: the refusal becomes a warning.
        ModelRequest as_it_is = o.model;
        as_it_is.build.subdivide = 0;
        as_it_is.build.set.clear();
        surface = build(model, as_it_is, threads, refine_for_scheme, {});
        tell(info.name + " cannot draw this mesh: " + e.what());
    }
    MeshSummary summary = summarize(surface.mesh->base_topology());
    std::size_t const unused = unused_vertices(model.mesh, surface.mesh->base());
    summary.vertices += unused - summary.unused_vertices;
    summary.unused_vertices = unused;
    ReportHeader header{
        "info", config_of(o.model, parameters), {{model.name, model.sha256}}, model.warnings, {}};
    header.warnings.insert(header.warnings.end(), more.begin(), more.end());
    header.warnings = without_folder(std::move(header.warnings), model.lines.file);
    out.finish([&] { return info_report(header, summary, patches); }, info_table(summary, patches));
    return 0;
}

} // namespace

void add_info(CommandLine& program)
{
    auto const o = std::make_shared<InfoRequest>();
    Verb& verb =
        program.add_verb("info", "figures of a control mesh, and of its patches under a scheme",
                         "  tessemu info jug\n  tessemu info cage.obj --json info.json");
    add_options(verb, o->model);
    add_json(verb, o->json);
    verb.runs([o](Session const&) { return run(*o); });
}

} // namespace tessemu
