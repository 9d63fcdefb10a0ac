// export: the tessellated mesh.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/job.h"
#include "cli/verbs.h"
#include "io/mesh_writer.h"
#include "pipeline/displaced_normals.h"

#include <fmt/format.h>

namespace tessemu {

namespace {

struct ExportRequest {
    SurfaceRequest surface;
    RunRequest run;
    std::string output;
    bool weld = false;
};

int run(ExportRequest const& o, Session const& session)
{
    RunOutput out(o.run.json, session);
    OutputFile& file = out.add(o.output);
    mesh_format(file); // or refuses
    keep_inputs(out, o.surface);
    std::optional<ThreadPool> own;
    ThreadPool const& threads = session.pool(o.run.threads, own);
    Job job = prepare(o.surface, "export", threads, session);
    job.header.config.emplace_back("weld", o.weld);
    MeshWriter writer(file, o.weld, job.placement, job.surface().mesh->base().file_faces);
    ProgressBar bar(session);
    Stopwatch const clock;
    std::size_t all = 0, done = 0;
    for (PatchCount const& c : job.patches().patch_counts()) all += c.patches;
    SurfaceVisitor const add = [&](SurfacePatch const& patch) {
        writer.add(patch);
        if (++done % 64 == 0) bar(done, all);
    };
    bool const displaced = o.surface.shading.normals == ShadingRequest::Normals::Displaced;
    ListStatistics const statistics =
        displaced ? visit_displaced_surface(job.patches(), job.frame, threads, add)
                  : visit_surface(job.patches(), job.frame, threads, add);
    bar.clear();
    writer.finish();
    add_run(job.header, job, threads, clock.seconds());
    out.finish([&] { return export_report(job.header, statistics, writer); },
               fmt::format("{}: {} vertices, {} triangles\n", o.output, writer.vertices(),
                           writer.triangles()));
    return 0;
}

} // namespace

void add_export(CommandLine& program)
{
    auto const o = std::make_shared<ExportRequest>();
    Verb& verb = program.add_verb("export", "write the tessellated mesh, patch by patch",
                                  "  tessemu export jug --tess 8 -o jug.ply\n"
                                  "  tessemu export cage.obj --tess 4 --weld -o cage4.obj");
    verb.required("-o", o->output, output_path, "mesh, .obj or .ply; '-': OBJ on standard output");
    verb.flag("--weld", o->weld, "join vertices with equal bits");
    add_options(verb, o->surface, NormalWords::AndDisplaced);
    add_vertex_cache(verb, o->surface);
    add_options(verb, o->run);
    verb.runs([o](Session const& session) { return run(*o, session); });
}

} // namespace tessemu
