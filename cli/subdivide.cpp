// subdivide: steps of Catmull-Clark subdivision alone, by LOOP10's kernels over tables.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/subdivision_cost.h"
#include "cli/job.h"
#include "cli/verbs.h"
#include "io/control_mesh_writer.h"

#include <fmt/format.h>

namespace tessemu {

namespace {

struct SubdivideRequest {
    ModelRequest mesh;
    ShadingRequest shading;
    RunRequest run;
    std::string output;
};

SchemeOnMesh take_steps(Scheme const& scheme, ControlMesh mesh, BuildOptions const& options)
{
    return refine_for_no_scheme(scheme.info().takes.step, std::move(mesh), options);
}

Config config_of(SubdivideRequest const& o, Parameters const& parameters)
{
    Config out{{"levels", std::int64_t(o.mesh.build.subdivide)}};
    if (o.mesh.build.join) out.emplace_back("join", *o.mesh.build.join);
    for (std::string const& name : {sort_parameter().name, coordinates_parameter().name})
        if (parameters.values().count(name)) out.emplace_back(name, parameters.word(name));
    out.emplace_back("contraction", name_of(o.shading.products));
    return out;
}

SubdivisionRow row_of(StepCost const& step)
{
    SubdivisionRow out{step.faces, step.edges, step.vertices, {}};
    for (KernelCost const& k : step.kernels) {
        KernelRow row{k.kernel,         k.threads,       k.flops, k.index_fetches,
                      k.vertex_fetches, k.fetched_bytes, {}};
        auto const add = [&](int width, LoopTurns const& turns) {
            if (turns.run) row.loops.push_back({width, turns.needed, turns.run, turns.lost()});
        };
        add(kWarpOfGtx480, k.gtx480);
        add(kWavefrontOfRadeon5870, k.radeon5870);
        out.kernels.push_back(std::move(row));
    }
    return out;
}

int run(SubdivideRequest const& o, Session const& session)
{
    RunOutput out(o.run.json, session);
    OutputFile* const file = o.output.empty() ? nullptr : &out.add(o.output);
    bool const is_ply = file && mesh_format(*file) == MeshFormat::Ply; // or refuses
    out.keep(o.mesh.model);
    ProgressBar bar(session);
    auto const progress = [&](std::size_t done, std::size_t all) { bar(done, all); };
    ModelRequest request = o.mesh;
    request.scheme = &find_scheme("gregory-stencil"); // whose masks these are
    request.build.progress = progress;
    std::optional<ThreadPool> own;
    ThreadPool const& threads = session.pool(o.run.threads, own);
    Job job = open_job(request, o.shading, "subdivide", threads, session, take_steps);
    job.header.config = config_of(o, job.surface().parameters);
    RefinedMesh const& refined = *job.surface().mesh;
    Stopwatch const clock;
    DrawnMesh const drawn = drawn_mesh(refined, job.frame, threads);
    add_run(job.header, job, threads, clock.seconds());
    std::vector<SubdivisionRow> steps;
    for (StepCost const& s : subdivision_cost(refined.tables(), drawn.statistics))
        steps.push_back(row_of(s));
    if (file) write_control_mesh(drawn.mesh, *file, job.placement, progress);
    bar.clear();
    std::string const lost = is_ply ? left_out_of_ply(drawn.mesh) : "";
    if (!lost.empty())
        print_warning(o.output + ": positions and faces alone, " + lost + " are left out");
    out.finish(
        [&] {
            return subdivide_report(job.header, drawn.statistics, steps, drawn.mesh, job.placement);
        },
        subdivide_table(steps) + fmt::format("{} vertices, {} faces\n", drawn.mesh.positions.size(),
                                             drawn.mesh.faces()));
    return 0;
}

} // namespace

void add_subdivide(CommandLine& program)
{
    auto const o = std::make_shared<SubdivideRequest>();
    Verb& verb = program.add_verb(
        "subdivide", "subdivide a control mesh by kernels over tables, and count them",
        "  tessemu subdivide jug\n"
        "  tessemu subdivide cage.obj --levels 2 -o refined.obj --json kernels.json\n"
        "  tessemu subdivide cage.obj --set sort=valence");
    verb.option("--levels", o->mesh.build.subdivide, whole(0, 6),
                "steps of Catmull-Clark subdivision, 0 to 6", "1");
    verb.option("-o", o->output, output_path,
                "the refined mesh, .obj with tags or .ply; '-': OBJ on standard output");
    add_mesh_options(verb, o->mesh,
                     "sort=none or sort=valence: the order of the mesh's vertices and faces for "
                     "the tables; valence: those of one valence side by side [none]; "
                     "coordinates=linear or coordinates=smooth: texture coordinates linear in "
                     "faces, or by the masks of positions, seams being boundaries [linear]");
    add_machine(verb, o->shading);
    add_options(verb, o->run);
    verb.runs([o, &verb](Session const& session) {
        if (o->mesh.build.subdivide == 0) verb.needs({"--set"}, "--levels 1 or more");
        return run(*o, session);
    });
}

} // namespace tessemu
