// check: is the surface closed?
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/mistakes.h"
#include "analysis/watertight.h"
#include "cli/job.h"
#include "cli/verbs.h"
#include "io/image_writer.h"

#include <fmt/format.h>

namespace tessemu {

namespace {

struct CheckRequest {
    SurfaceRequest surface;
    PictureRequest picture;
    RunRequest run;
    std::string output;
    Mistake mistake = Mistake::None;
    std::int64_t mistaken_face = 0; ///< counted from 1; 0: the first that shares all edges
    double parity = 0;
    std::int64_t rays = 0;
};

Mistake parse_mistake(std::string const& text, std::string const& option)
{
    std::vector<std::string> names;
    for (Mistake m : kMistakes) names.emplace_back(name_of(m));
    auto const mistake = mistake_from_name(text);
    if (!mistake) refuse(text, option, in_words(names));
    return *mistake;
}

PlantedMistake mistake_of(CheckRequest const& o, RefinedMesh const& mesh)
{
    PlantedMistake out = plant_mistake(mesh, o.mistake);
    if (o.mistaken_face == 0) return out;
    std::size_t const faces = mesh.base().faces();
    if (std::size_t(o.mistaken_face) > faces)
        throw Error(
            fmt::format("--break-face is {}, the mesh has {} faces", o.mistaken_face, faces));
    out.face = std::uint32_t(o.mistaken_face - 1);
    return out;
}

VerdictRow row_of(CheckedVerdict const& v)
{
    VerdictRow row{v.name,
                   std::string(name_of(v.verdict)),
                   v.reason,
                   v.checked,
                   v.failures,
                   {},
                   v.name == "raycast"};
    for (CrackSite const& site : v.sites)
        row.sites.push_back({{site.face[0], site.face[1]},
                             {site.vertex[0], site.vertex[1]},
                             site.t,
                             site.component,
                             {site.bits[0], site.bits[1]},
                             site.ulp,
                             {site.pixel[0], site.pixel[1]},
                             site.text});
    return row;
}

int run(CheckRequest const& o)
{
    if (!o.output.empty()) check_image_path(o.output);
    Job job = prepare(o.surface, "check");
    set_picture(job, o.picture, o.surface);
    WatertightSettings s;
    s.frame = job.frame;
    s.parity = float(job.placement.length_from_file(o.parity));
    s.rays = std::uint64_t(o.rays);
    s.list = 100000;
    PlantedMistake const mistake = mistake_of(o, *job.surface.mesh);
    std::unique_ptr<PatchMesh> mistaken;
    if (o.mistake != Mistake::None) mistaken = with_mistake(job.patches(), mistake, s.frame);
    PatchMesh const& patches = mistaken ? *mistaken : job.patches();

    Config& c = job.header.config;
    c.emplace_back("tess_edge", name_of(o.picture.tess_edge));
    c.emplace_back("width", std::int64_t(s.frame.width));
    c.emplace_back("height", std::int64_t(s.frame.height));
    c.emplace_back("rays", o.rays);
    c.emplace_back("parity", job.placement.length_to_file(s.parity));
    c.emplace_back("break", std::string(name_of(o.mistake)));
    if (mistaken) c.emplace_back("break_face", std::int64_t(mistake.face) + 1);
    ThreadPool const threads(o.run.threads);
    ProgressBar bar;
    s.progress = [&](std::size_t n, std::size_t all) { bar(n, all); };
    Stopwatch const clock;
    std::vector<CheckedVerdict> const verdicts = check_watertight(patches, s, threads);
    bar.clear();
    add_run(job.header, job, threads, clock.seconds());
    std::vector<VerdictRow> rows;
    for (CheckedVerdict const& v : verdicts) rows.push_back(row_of(v));
    if (!o.output.empty()) write_image(draw_cracks(patches, s, verdicts, threads), o.output);
    write_result(
        o.run.json, [&] { return check_report(job.header, rows); }, check_table(rows, 3));
    return all_hold(verdicts) ? 0 : 1;
}

} // namespace

void add_check(CommandLine& program)
{
    auto const o = std::make_shared<CheckRequest>();
    Verb& verb = program.add_verb(
        "check",
        "is the surface closed? Verdicts on edges, coverage and rays; exit status 1 if one fails",
        "  tessemu check golem\n"
        "  tessemu check cage.obj --tess 7.3 --contraction mixed:5 --displace studs\n"
        "  tessemu check golem --break order --parity 0.02 -o cracks.png --json cracks.json");
    verb.option("-o", o->output, plain, "the lit picture with cracks in red, .png or .exr");
    verb.option("--break", o->mistake, parse_mistake,
                "plant a known mistake: order, contraction, factors, normals, fold, weights, "
                "topleft",
                "none");
    verb.option("--break-face", o->mistaken_face, whole<std::int64_t>(0, std::int64_t(1) << 32),
                "whose patch has it, where it is one patch's [the first that shares all edges]");
    verb.option("--parity", o->parity, finite_number,
                "move every point by so much along its normal, out or in by the parity of its "
                "bits: cracks of one ulp open",
                "0");
    verb.option("--rays", o->rays, whole<std::int64_t>(0, 1000000000), "of each kind; 0: none",
                "200000");
    add_options(verb, o->picture);
    add_options(verb, o->surface);
    add_options(verb, o->run);
    verb.runs([o] { return run(*o); });
}

} // namespace tessemu
