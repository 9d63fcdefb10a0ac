// draw: pictures of a surface and what every stage did.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/curvature.h"
#include "analysis/error_view.h"
#include "cli/job.h"
#include "cli/verbs.h"
#include "io/figure.h"
#include "io/image_writer.h"
#include "pipeline/colored_mesh.h"
#include "pipeline/patch_valences.h"

#include <fmt/format.h>

#include <filesystem>

namespace tessemu {

namespace {

struct ViewRequest {
    enum class Shows { Surface, Cage, Error };
    Shows shows = Shows::Surface;
    View view = View::Lit; ///< of the surface
};

/// What is red in the error view.
struct ErrorMax {
    double position, angle;
};

struct DrawRequest {
    SurfaceRequest surface;
    PictureRequest picture;
    RunRequest run;
    std::string output;
    ViewRequest view;
    std::optional<ErrorMax> error_max;   ///< none: from the errors
    std::optional<double> curvature_max; ///< 1/length of the file; none: from the surface

    bool shows(View v) const { return view.shows == ViewRequest::Shows::Surface && view.view == v; }
    int level = 0;
    int samples = 1;
    CullMode cull = CullMode::None;
};

std::string name_of(ViewRequest const& v)
{
    if (v.shows == ViewRequest::Shows::Surface) return std::string(name_of(v.view));
    return v.shows == ViewRequest::Shows::Cage ? "cage" : "error";
}

std::string_view name_of(CullMode cull)
{
    return cull == CullMode::None ? "none" : cull == CullMode::Back ? "back" : "front";
}

auto view_parser()
{
    std::vector<std::pair<std::string, ViewRequest>> words;
    for (View v : kViews) words.push_back({std::string(name_of(v)), {{}, v}});
    words.push_back({"cage", {ViewRequest::Shows::Cage}});
    words.push_back({"error", {ViewRequest::Shows::Error}});
    return one_of(std::move(words));
}

std::optional<ErrorMax> parse_error_max(std::string const& text, std::string const& option)
{
    if (text == "auto") return {};
    auto const parts = split(text, ',');
    if (parts.size() != 2) refuse(text, option, "auto or POSITION,ANGLE");
    ErrorMax const out{finite_number(parts[0], option), finite_number(parts[1], option)};
    if (!(out.position > 0 && out.angle > 0))
        throw Error(option + " is '" + text + "', both must be above 0");
    return out;
}

std::optional<double> parse_curvature_max(std::string const& text, std::string const& option)
{
    if (text == "auto") return {};
    double const out = finite_number(text, option);
    if (!(out > 0)) throw Error(option + " is '" + text + "', it must be auto or above 0");
    return out;
}

// NAME_0007.png of NAME.png
std::string numbered(std::string const& path, std::size_t i)
{
    std::filesystem::path p = path;
    p.replace_filename(fmt::format("{}_{:04}{}", p.stem().string(), i, p.extension().string()));
    return p.string();
}

// One, or a picture for each frame. A stream takes one.
std::vector<OutputFile*> pictures_of(DrawRequest const& o, RunOutput& out)
{
    std::vector<OutputFile*> files;
    std::size_t const frames = std::size_t(o.surface.animate.frames);
    if (o.output.empty()) return files;
    if (frames > 1 && OutputFile::names_stream(o.output))
        throw Error(
            fmt::format("-o is {}, which takes one picture; --frames makes {}", o.output, frames));
    for (std::size_t i = 0; i < frames; ++i) {
        files.push_back(&out.add(frames > 1 ? numbered(o.output, i) : o.output));
        picture_format(*files.back()); // or refuses
    }
    return files;
}

std::vector<double> as_doubles(glm::dvec3 v)
{
    return {v.x, v.y, v.z};
}

// The mesh that the scheme draws, in the frame's pose.
void draw_cage(RefinedMesh const& refined, FrameSettings const& f, ThreadPool const& threads,
               Frame& frame)
{
    ControlMesh const mesh = drawn_mesh(refined, f, threads).mesh;
    draw_colored_mesh(control_mesh_picture(Topology(mesh)), f, 0.45f, threads, frame);
}

int run_error_view(DrawRequest const& o, Job& job, ThreadPool const& threads, OutputFile* picture,
                   RunOutput& out)
{
    FrameSettings& f = job.frame;
    if (f.displacement || f.pose || f.direct3d10)
        throw Error("--view error compares the smooth surface at rest: it takes no --displace, "
                    "--animate or --direct3d 10");
    f.adaptive = {};
    Stopwatch const clock;
    EqualParameterErrors const e = equal_parameter_errors(job.patches(), f, o.level, threads);
    if (e.triangles.empty())
        throw Error(job.path + ": --view error needs quads, or triangles of a regular pattern, and "
                               "none is drawn");
    double const position =
        o.error_max ? o.error_max->position : quantile(e.distance, e.weight, 0.99);
    double const normal = o.error_max ? o.error_max->angle : quantile(e.angle, e.weight, 0.99);
    ErrorView const view = draw_error(e, f, position, normal, threads);
    add_run(job.header, job, threads, clock.seconds());
    Config& c = job.header.config;
    c.emplace_back("width", std::int64_t(f.width));
    c.emplace_back("height", std::int64_t(f.height));
    c.emplace_back("view", name_of(o.view));
    c.emplace_back("level", std::int64_t(o.level));
    std::vector<ErrorRow> const rows{
        error_row("position", "equal parameter", "diagonal", e.position_statistics()),
        error_row("normal", "equal parameter", "radians", e.normal_statistics())};
    std::string const scheme = o.surface.model.scheme->info().name;
    if (picture)
        write_figure(
            {2,
             {{&view.position, scheme + ": position"}, {&view.normal, scheme + ": normal"}},
             {{"distance / diagonal", position}, {"angle, radians", normal}}},
            *picture);
    double const diagonal = job.placement.length_to_file(e.diagonal);
    out.finish([&] { return compare_report(job.header, diagonal, rows); }, compare_table(rows));
    return 0;
}

// What is red, of all frames: 1/length of the file.
double set_curvature_range(DrawRequest const& o, Job& job, ThreadPool const& threads)
{
    double range = 0; // in the mesh
    if (o.curvature_max) {
        range = *o.curvature_max * job.placement.length_to_file(1);
        if (!(range > 1e-30 && range < 1e30))
            throw Error(fmt::format("--curvature-max is {}, for this model it must be {:g} to {:g}",
                                    *o.curvature_max, job.placement.length_from_file(1e-30),
                                    job.placement.length_from_file(1e30)));
    } else {
        FrameSettings settings = job.frame;
        for (FramePose const& p : job.poses) {
            settings.pose = p.pose;
            range = std::max(range, curvature_range(job.patches(), settings, threads));
        }
    }
    job.frame.curvature_max = float(range);
    return range * job.placement.length_from_file(1);
}

std::string curvature_legend(double range, PatchMesh const& patches)
{
    std::string out = fmt::format(
        "mean curvature, 1/unit of length: blue {:.4g} and below, white 0, red {:.4g} and above\n",
        -range, range);
    if (std::size_t const n = patches_without_curvature(patches))
        out += fmt::format("{} patch{} without second derivatives: grey\n", n, n == 1 ? "" : "es");
    return out;
}

// A camera that its user placed and that sees nothing is a mistake; else the picture may be so.
void expect_something(bool covered, DrawRequest const& o, Job& job, Session const& session)
{
    if (covered) return;
    std::string const what = "no pixel is covered: there is nothing to see";
    if (o.picture.camera.is_placed() && o.cull == CullMode::None)
        throw Error("--camera: " + what + "; 'auto' shows the whole model");
    job.header.warnings.push_back(what);
    session.warn(what);
}

int run(DrawRequest const& o, Session const& session)
{
    RunOutput out(o.run.json, session);
    std::vector<OutputFile*> const pictures = pictures_of(o, out);
    OutputFile* const picture = pictures.empty() ? nullptr : pictures[0];
    bool const cage = o.view.shows == ViewRequest::Shows::Cage;
    if (o.shows(View::Curvature)) {
        check_curvature(o.surface.model.scheme->info());
        if (o.surface.displace.heights.kind != DisplaceRequest::Heights::Kind::None)
            throw Error("--view curvature is of the smooth surface: it takes no --displace");
    }
    keep_inputs(out, o.surface);
    std::optional<ThreadPool> own;
    ThreadPool const& threads = session.pool(o.run.threads, own);
    Job job = prepare(o.surface, "draw", threads, session, cage ? refine_for_scheme : build_scheme);
    set_picture(job, o.picture, o.surface);
    if (o.view.shows == ViewRequest::Shows::Error)
        return run_error_view(o, job, threads, picture, out);
    FrameSettings& f = job.frame;
    f.view = o.view.view;
    f.cull = o.cull;
    f.samples = o.samples;
    if (picture && picture_format(*picture) == PictureFormat::Exr)
        f.color_format = Format::R32G32B32A32_FLOAT;

    Config& c = job.header.config;
    c.emplace_back("width", std::int64_t(f.width));
    c.emplace_back("height", std::int64_t(f.height));
    c.emplace_back("tess_edge", name_of(o.picture.tess_edge));
    c.emplace_back("view", name_of(o.view));
    c.emplace_back("cull", std::string(name_of(f.cull)));
    c.emplace_back("samples", std::int64_t(f.samples));
    c.emplace_back("color_format", std::string(info(f.color_format).name));
    c.emplace_back("camera_eye", as_doubles(job.placement.to_file(f.camera.eye)));
    c.emplace_back("camera_target", as_doubles(job.placement.to_file(f.camera.target)));
    c.emplace_back("camera_up", as_doubles(f.camera.up));
    c.emplace_back("camera_focal", double(f.camera.focal));
    if (job.poses.size() > 1) c.emplace_back("frames", std::int64_t(job.poses.size()));

    ProgressBar bar(session);
    Stopwatch const clock;
    std::string legend = in_words_of_levels(job.header.levels);
    if (!legend.empty()) legend += "\n";
    if (o.shows(View::Valence)) legend += valence_legend(job.patches()) + "\n";
    if (o.shows(View::Curvature)) {
        double const range = set_curvature_range(o, job, threads);
        c.emplace_back("curvature_max", range);
        legend += curvature_legend(range, job.patches()) + "\n";
    }
    Frame frame(f);
    std::vector<SequenceFrame> sequence;
    bool covered = false;
    for (std::size_t i = 0; i < job.poses.size(); ++i) {
        f.pose = job.poses[i].pose;
        if (cage)
            draw_cage(*job.surface().mesh, f, threads, frame);
        else
            draw_frame(job.patches(), f, threads, frame, [&](std::size_t n, std::size_t all) {
                bar(i * all + n, job.poses.size() * all);
            });
        covered = covered || frame.statistics.pipeline.PSInvocations > 0;
        if (job.poses.size() == 1) break;
        sequence.push_back({job.poses[i].phase, f.pose->bytes(),
                            ListStatistics{frame.statistics, frame.commands},
                            sha256_of_targets(frame.color, frame.depth)});
        if (!pictures.empty()) {
            write_image(frame.color, *pictures[i]);
            pictures[i]->close();
        }
    }
    bar.clear();
    expect_something(covered, o, job, session);
    add_run(job.header, job, threads, clock.seconds());
    if (!sequence.empty()) {
        out.finish([&] { return sequence_report(job.header, sequence); },
                   legend + sequence_table(sequence));
        return 0;
    }
    if (picture) write_image(frame.color, *picture);
    out.finish([&] { return draw_report(job.header, frame); },
               legend + counters_table(frame.statistics));
    return 0;
}

void warn_of_unused(Verb const& verb, Session const& session, std::string const& view,
                    std::initializer_list<char const*> options)
{
    for (char const* option : options)
        if (verb.given(option)) session.warn(view + " does not use " + option);
}

} // namespace

void add_draw(CommandLine& program)
{
    auto const o = std::make_shared<DrawRequest>();
    Verb& verb = program.add_verb(
        "draw", "draw a control mesh and count what every stage does",
        "  tessemu draw jug -o jug.png\n"
        "  tessemu draw cage.obj --tess 16 --view patches -o patches.png --json counters.json\n"
        "  tessemu draw cage.obj --camera from=1,0.5,0 --size 1920x1080 -o side.exr\n"
        "  tessemu draw jug --tess 32 --displace studs -o studs.png\n"
        "  tessemu draw jug --animate sway --frames 12 -o sway.png --json sway.json\n"
        "  tessemu draw cage.obj --view error -o error.png\n"
        "  tessemu draw cage.obj --scheme stam --tess 16 --view curvature -o curvature.png");
    verb.option("-o", o->output, output_path, "picture, .png or .exr; '-': PNG on standard output");
    add_options(verb, o->picture);
    verb.option(
        "--view", o->view, view_parser(),
        "lit, normals, patches, depth, wire; valence: patches by that of their extraordinary "
        "vertex; zebra: reflection lines; curvature: mean curvature, of schemes that have second "
        "derivatives; coverage: how often a pixel is covered, before depth; cage: the control "
        "mesh; error: against the limit surface of its rules",
        "lit");
    verb.option("--error-max", o->error_max, parse_error_max,
                "of the error view: POSITION,ANGLE that are red, in diagonals and radians; auto: "
                "what 99 % of the area stays below",
                "auto");
    verb.option(
        "--curvature-max", o->curvature_max, parse_curvature_max,
        "of the curvature view: what is red, 1/unit of length, and blue its negative; auto: "
        "what 99 % of the area stays below in size",
        "auto");
    add_level(verb, o->level, "of the error view: 2^level segments an edge, 1 to 6");
    verb.option("--frames", o->surface.animate.frames, whole(1, 10000),
                "pictures of one period of the motion, numbered: NAME_0000.png and so on", "1");
    verb.option("--samples", o->samples, one_of<int>({{"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}}),
                "1, 2, 4 or 8 samples a pixel, resolved", "1");
    verb.option(
        "--cull", o->cull,
        one_of<CullMode>(
            {{"none", CullMode::None}, {"back", CullMode::Back}, {"front", CullMode::Front}}),
        "none, back, front", "none");
    add_options(verb, o->surface);
    add_vertex_cache(verb, o->surface);
    add_options(verb, o->run);
    verb.runs([o, &verb](Session const& session) {
        using Shows = ViewRequest::Shows;
        if (o->view.shows != Shows::Error) verb.needs({"--error-max", "--level"}, "--view error");
        if (!o->shows(View::Curvature)) verb.needs({"--curvature-max"}, "--view curvature");
        // No error: one list of options may serve several views.
        if (o->view.shows == Shows::Error)
            warn_of_unused(verb, session, "--view error",
                           {"--tess", "--tess-edge", "--partitioning", "--samples", "--cull",
                            "--vertex-cache"});
        if (o->view.shows == Shows::Cage)
            warn_of_unused(verb, session, "--view cage",
                           {"--tess", "--tess-edge", "--partitioning", "--normals", "--direct3d",
                            "--pattern"});
        return run(*o, session);
    });
}

} // namespace tessemu
