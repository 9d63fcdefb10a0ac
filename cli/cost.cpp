// cost: what a draw counted as time on a described GPU.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/cost.h"

#include "cli/job.h"
#include "cli/verbs.h"
#include "io/gpu_file.h"
#include "io/image_writer.h"
#include "io/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace tessemu {

namespace {

struct CostRequest {
    SurfaceRequest surface;
    PictureRequest picture;
    RunRequest run;
    std::string gpu; ///< a path, or a built-in's name
    std::string output;
    bool geometry_only = false;
};

int run(CostRequest o, Session const& session)
{
    RunOutput out(o.run.json, session);
    OutputFile* const picture = o.output.empty() ? nullptr : &out.add(o.output);
    if (picture) picture_format(*picture); // or refuses
    GpuModel const gpu = load_gpu_model(o.gpu);
    o.surface.vertex_cache = gpu.vertex_cache;
    keep_inputs(out, o.surface);
    std::optional<ThreadPool> own;
    ThreadPool const& threads = session.pool(o.run.threads, own);
    Job job = prepare(o.surface, "cost", threads, session);
    set_picture(job, o.picture, o.surface);
    FrameSettings const& f = job.frame;
    Config& c = job.header.config;
    c.emplace_back("gpu", std::filesystem::path(o.gpu).filename().string());
    c.emplace_back("tess_edge", name_of(o.picture.tess_edge));
    c.emplace_back("geometry_only", o.geometry_only);
    if (!o.geometry_only) {
        c.emplace_back("width", std::int64_t(f.width));
        c.emplace_back("height", std::int64_t(f.height));
    }
    Stopwatch const clock;
    std::vector<CommandStatistics> const commands =
        o.geometry_only ? visit_surface(job.patches(), f, threads, {}).commands
                        : draw_frame(job.patches(), f, threads).commands;
    add_run(job.header, job, threads, clock.seconds());
    DrawCost const cost = estimate_cost(gpu, commands);
    CostSummary summary{gpu.name, cost.bound, gpu.overhead, cost.shaders, cost.seconds, {}, {}};
    double fetches = gpu.any_fetch; // of the fastest kind
    for (auto const& [kind, rate] : gpu.fetch) fetches = std::max(fetches, rate);
    Roofline roofline{fmt::format("{} on {}", as_utf8(job.header.inputs[0].first), gpu.name),
                      gpu.arithmetic,
                      16 * fetches,
                      {}};
    for (StageCost const& s : cost.stages) {
        summary.rows.push_back({s.stage, s.bound(), s.arithmetic, s.fetch, s.memory, s.fixed,
                                s.seconds(), s.operations, s.fetches, s.fetched_bytes,
                                s.memory_bytes});
        if (s.operations > 0 && s.fetches > 0 && s.seconds() > 0)
            roofline.points.push_back(
                {s.stage, s.operations / (16 * s.fetches), s.operations / s.seconds()});
    }
    summary.sources.assign(gpu.sources.begin(), gpu.sources.end());
    if (picture) write_plots(plot_of(roofline), *picture);
    out.finish([&] { return cost_report(job.header, summary); }, cost_table(summary));
    return 0;
}

} // namespace

void add_cost(CommandLine& program)
{
    auto const o = std::make_shared<CostRequest>();
    Verb& verb =
        program.add_verb("cost", "predicted time by stage on a described GPU, and what bounds it",
                         "  tessemu cost jug --tess 16\n"
                         "  tessemu cost cage.obj --direct3d 10 --geometry-only -o roofline.png\n"
                         "  tessemu cost cage.obj --gpu my_gpu.json --json cost.json");
    std::string known;
    for (BuiltinGpu const& g : builtin_gpus())
        known += (known.empty() ? "" : " or ") + std::string(g.name);
    verb.option("--gpu", o->gpu, plain, "a file, or " + known, std::string(builtin_gpus()[0].name));
    verb.option("-o", o->output, output_path, "roofline picture, .png or .exr");
    verb.flag("--geometry-only", o->geometry_only, "without rasterization");
    add_options(verb, o->picture);
    add_options(verb, o->surface);
    add_options(verb, o->run);
    verb.runs([o](Session const& session) { return run(*o, session); });
}

} // namespace tessemu
