// check: is the surface closed?
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/mistakes.h"
#include "analysis/watertight.h"
#include "cli/job.h"
#include "cli/verbs.h"
#include "io/image_writer.h"
#include "pipeline/mesh/join.h"

#include <fmt/format.h>

namespace tessemu {

namespace {

struct CheckRequest {
    SurfaceRequest surface;
    PictureRequest picture;
    RunRequest run;
    std::string output;
    Mistake mistake = Mistake::None;
    std::optional<std::int64_t> mistaken_face; ///< of the file, counted from 1; none: the first
                                               ///< that shares all edges
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
    if (!o.mistaken_face) return out;
    ControlMesh const& base = mesh.base();
    for (std::uint32_t f = 0; f < base.faces(); ++f)
        if (std::int64_t(base.file_face(f)) + 1 == *o.mistaken_face) {
            out.face = f;
            return out;
        }
    std::uint32_t last = 0; // of all that there are, which may be in any order
    for (std::uint32_t f = 0; f < base.faces(); ++f) last = std::max(last, base.file_face(f) + 1);
    throw Error(fmt::format(
        "--break-face is {}, it must be 1 to {}{}: the mesh has {} faces", *o.mistaken_face, last,
        last == base.faces() ? "" : " and a face that was not left out", base.faces()));
}

// How to close a surface that looks closed and is not.
std::string join_hint(Seams const& seams, Placement const& placement)
{
    if (seams.edges == 0) return "";
    // Two digits that are no less.
    double const distance = placement.length_to_file(seams.apart);
    std::string const apart = distance > 0 ? fmt::format("{:.1e}", 1.06 * distance) : "0";
    return fmt::format("{} open edges lie on others with other vertices: --join DISTANCE joins "
                       "them, here --join {} or more",
                       seams.edges, apart);
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
                             site.edge,
                             site.text});
    return row;
}

// Where a scheme can promise what fails.
std::string closing_hint(SchemeInfo const& info, Parameters const& parameters)
{
    for (auto const& [name, value] : info.watertight_with)
        if (parameters.word(name) != value)
            return fmt::format("{} with {}={} is not watertight: --set {}={} gives shared edges "
                               "equal bits",
                               info.name, name, parameters.word(name), name, value);
    return "";
}

int run(CheckRequest const& o, Session const& session)
{
    RunOutput out(o.run.json, session);
    OutputFile* const picture = o.output.empty() ? nullptr : &out.add(o.output);
    if (picture) picture_format(*picture); // or refuses
    keep_inputs(out, o.surface);
    std::optional<ThreadPool> own;
    ThreadPool const& threads = session.pool(o.run.threads, own);
    Job job = prepare(o.surface, "check", threads, session);
    set_picture(job, o.picture, o.surface);
    std::string const hint =
        join_hint(find_seams(job.surface().mesh->base_topology()), job.placement);
    if (!hint.empty()) job.header.warnings.push_back(hint);
    WatertightSettings s;
    s.frame = job.frame;
    s.parity = float(job.placement.length_from_file(o.parity));
    s.rays = std::uint64_t(o.rays);
    s.list = 100000;
    PlantedMistake const mistake = mistake_of(o, *job.surface().mesh);
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
    if (mistaken)
        c.emplace_back("break_face",
                       std::int64_t(job.surface().mesh->base().file_face(mistake.face)) + 1);
    ProgressBar bar(session);
    s.progress = [&](std::size_t n, std::size_t all) { bar(n, all); };
    Stopwatch const clock;
    std::vector<CheckedVerdict> const verdicts = check_watertight(patches, s, threads);
    bar.clear();
    add_run(job.header, job, threads, clock.seconds());
    std::vector<VerdictRow> rows;
    for (CheckedVerdict const& v : verdicts) rows.push_back(row_of(v));
    if (picture) write_image(draw_cracks(patches, s, verdicts, threads), *picture);
    out.finish([&] { return check_report(job.header, rows); }, check_table(rows, 3));
    if (!hint.empty() && any_checked(verdicts)) session.warn(hint); // else an error says so
    if (!all_hold(verdicts)) {
        std::string const closing =
            closing_hint(o.surface.model.scheme->info(), job.surface().parameters);
        if (!closing.empty()) session.warn(closing);
        return 1;
    }
    std::string const& model = o.surface.model.model;
    if (std::string const why = why_not_found(o.mistake, verdicts); !why.empty())
        throw Error(model + ": " + why);
    if (!any_checked(verdicts))
        throw Error(fmt::format("{}: nothing was checked: {}", model,
                                hint.empty() ? verdicts.front().reason : hint));
    return 0;
}

} // namespace

void add_check(CommandLine& program)
{
    auto const o = std::make_shared<CheckRequest>();
    Verb& verb = program.add_verb(
        "check",
        "is the surface closed? Verdicts on edges, coverage and rays; exit status 1 if one fails, "
        "2 if all are skipped or a planted mistake is not found",
        "  tessemu check golem\n"
        "  tessemu check cage.obj --tess 7.3 --contraction mixed:5 --displace studs\n"
        "  tessemu check golem --break order --parity 0.02 -o cracks.png --json cracks.json");
    verb.option("-o", o->output, output_path, "the lit picture with cracks in red, .png or .exr");
    verb.option("--break", o->mistake, parse_mistake,
                "plant a known mistake: order, contraction, factors, normals, fold, weights, "
                "topleft",
                "none");
    verb.option("--break-face", o->mistaken_face, whole<std::int64_t>(INT64_MIN, INT64_MAX),
                "the file's face whose patch has it, where it is one patch's [the first that "
                "shares all edges]");
    verb.option("--parity", o->parity, finite_number,
                "move every point by so much along its normal, out or in by the parity of its "
                "bits: cracks of one ulp open",
                "0");
    verb.option("--rays", o->rays, whole<std::int64_t>(0, 1000000000), "of each kind; 0: none",
                "200000");
    add_options(verb, o->picture);
    add_options(verb, o->surface);
    add_options(verb, o->run);
    verb.runs([o, &verb](Session const& session) {
        if (o->mistake == Mistake::None) verb.needs({"--break-face"}, "--break");
        return run(*o, session);
    });
}

} // namespace tessemu
