// info: a control mesh and its patches in figures.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/job.h"
#include "cli/verbs.h"
#include "pipeline/mesh/join.h"
#include "pipeline/mesh/manifold.h"

#include <fmt/format.h>

namespace tessemu {

namespace {

struct InfoRequest {
    ModelRequest model;
    std::string json;
};

int run(InfoRequest const& o)
{
    RunOutput out(o.json);
    Model model = open_model(o.model.model);
    SchemeInfo const info = o.model.scheme->info();
    ReportHeader header{"info",
                        config_of(o.model, resolve_parameters(info, o.model.build.set)),
                        {{model.name, model.sha256}},
                        model.warnings,
                        {}};
    std::vector<std::string> more;
    MeshSummary summary;
    try {
        MeshRepairs repairs;
        if (auto const& distance = o.model.build.join) {
            JoinedMesh joined = join_vertices(std::move(model.mesh), *distance, model.placement);
            model.mesh = std::move(joined.mesh);
            more = in_words(joined.join, *distance);
        }
        if (!o.model.build.strict) {
            ManifoldMesh manifold = make_manifold(std::move(model.mesh));
            model.mesh = std::move(manifold.mesh);
            repairs = manifold.repairs;
            std::vector<std::string> const repaired = in_words(repairs, model.lines);
            more.insert(more.end(), repaired.begin(), repaired.end());
            for (std::string const& w : more) print_warning(w);
        }
        summary = summarize(Topology(model.mesh));
        summary.vertices += repairs.unused.number;
        summary.unused_vertices += repairs.unused.number;
    } catch (MeshError const& e) {
        throw FormatError(model.lines.file, model.lines.line_of_face(e.face), e.what());
    }
    // A mesh that the scheme refuses still has figures: the refusal becomes a warning.
    std::vector<PatchCount> patches;
    std::string const path = model.lines.file;
    try {
        SchemeOnMesh const surface = build(std::move(model), o.model);
        patches = surface.patches->patch_counts();
        more.insert(more.end(), surface.warnings.begin(), surface.warnings.end());
    } catch (FormatError const& e) {
        more.push_back(info.name + " cannot draw this mesh: " + e.what());
        print_warning(more.back());
    }
    header.warnings.insert(header.warnings.end(), more.begin(), more.end());
    header.warnings = without_folder(std::move(header.warnings), path);
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
    verb.runs([o] { return run(*o); });
}

} // namespace tessemu
