// SPDX-License-Identifier: Apache-2.0
#include "cli/verbs.h"

#include "analysis/cost.h"
#include "analysis/loop09_figures.h"
#include "analysis/loop09_table3.h"
#include "analysis/loop09_timing.h"
#include "analysis/watertight.h"
#include "io/atomic_file.h"
#include "io/figure.h"
#include "io/image_writer.h"
#include "io/machine_file.h"
#include "io/mesh_writer.h"
#include "io/model.h"
#include "io/report.h"
#include "io/result_diff.h"
#include "io/sha256.h"
#include "pipeline/builtin_models.h"
#include "pipeline/colored_mesh.h"
#include "pipeline/frame.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include <unistd.h>

namespace tessemu {

namespace {

constexpr int kCompareLevel = 4; // 16 segments an edge

class Stopwatch {
public:
    double seconds() const
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// On a terminal, and only once the work has lasted a second.
class ProgressBar {
public:
    ~ProgressBar() { clear(); }
    void clear()
    {
        if (shown_) std::fputs("\r\033[K", stderr);
        shown_ = false;
    }
    void operator()(std::size_t done, std::size_t all)
    {
        if (!isatty(STDERR_FILENO) || clock_.seconds() < 1 || all == 0) return;
        int const width = 40, filled = int(std::uint64_t(width) * done / all);
        fmt::print(stderr, "\r[{}{}] {:3d} %", std::string(std::size_t(filled), '#'),
                   std::string(std::size_t(width - filled), '.'),
                   int(100 * std::uint64_t(done) / all));
        std::fflush(stderr);
        shown_ = true;
    }

private:
    Stopwatch clock_;
    bool shown_ = false;
};

void print_warnings(std::vector<std::string> const& warnings)
{
    for (std::string const& w : warnings) fmt::print(stderr, "warning: {}\n", w);
}

void write_result(std::string const& path, std::string const& json)
{
    if (path == "-")
        fmt::print("{}", json);
    else if (!path.empty())
        write_file(path, json);
}

// A model under a scheme, and the settings that draw and export share.
struct Job {
    PreparedMesh prepared;
    std::unique_ptr<PatchMesh> patches;
    FrameSettings frame;
    ReportHeader header;
    std::vector<FramePose> poses;
    double load_seconds = 0, build_seconds = 0;
};

// Errors about the mesh name the file, and the line where it is known.
void build(Model& model, Technique const& technique,
           std::map<std::string, double> const& parameters, PreparedMesh& prepared,
           std::unique_ptr<PatchMesh>& patches)
{
    try {
        prepared = prepare_mesh(std::move(model.mesh), technique);
        patches = technique.build(*prepared.topology, parameters);
    } catch (MeshError const& e) {
        throw FormatError(model.path, model.line_of_face(e.face), e.what());
    } catch (LimitError const& e) {
        throw FormatError(model.path, 0, e.what());
    }
}

Job prepare(Options const& o, std::string const& verb)
{
    Job job;
    FrameSettings& f = job.frame;
    auto const partitioning = partitioning_from_name(o.partitioning);
    if (!partitioning)
        throw Error("--partitioning is '" + o.partitioning +
                    "', it must be integer, pow2, fractional_odd or fractional_even");
    if (!(o.tess > 0 && o.tess <= kMaxTessFactor))
        throw Error(
            fmt::format("--tess is {}, it must be above 0 and at most {}", o.tess, kMaxTessFactor));
    if (o.normals != "frozen" && o.normals != "true")
        throw Error("--normals is '" + o.normals + "', it must be frozen or true");
    f.partitioning = *partitioning;
    f.tess_factor = float(o.tess);
    f.true_normals = o.normals == "true";
    f.machine = parse_machine(o);
    f.vertex_cache = vertex_cache_from_name(o.vertex_cache);
    Technique const& technique = find_technique(o.scheme);
    auto const parameters = parse_parameters(o);

    Stopwatch const load_clock;
    Model model = load_model(o.model);
    job.load_seconds = load_clock.seconds();
    Stopwatch const build_clock;
    build(model, technique, parameters, job.prepared, job.patches);
    job.build_seconds = build_clock.seconds();
    f.displacement = parse_displacement(o, *job.prepared.topology);
    f.direct3d10 = o.direct3d == 10;
    job.poses = parse_frames(o, *job.prepared.mesh);
    f.pose = job.poses[0].pose;

    ReportHeader& h = job.header;
    h.verb = verb;
    h.inputs = {{model.name, model.sha256}};
    if (std::filesystem::is_regular_file(o.displace))
        h.inputs.emplace_back(std::filesystem::path(o.displace).filename().string(),
                              sha256_of(read_file(o.displace)));
    h.warnings = std::move(model.warnings);
    for (std::vector<std::string> const* more :
         {&std::as_const(job.prepared.warnings), &job.patches->warnings()})
        h.warnings.insert(h.warnings.end(), more->begin(), more->end());
    print_warnings(h.warnings);
    // Warnings of the file carry its path; a result must not.
    std::string const prefix = o.model.substr(0, o.model.size() - model.name.size());
    for (std::string& w : h.warnings)
        if (!prefix.empty() && w.starts_with(prefix)) w.erase(0, prefix.size());
    h.config = {{"scheme", o.scheme}};
    for (SchemeParameter const& p : technique.info().parameters) {
        auto const it = parameters.find(p.name);
        h.config.emplace_back(p.name, it == parameters.end() ? p.default_value : it->second);
    }
    h.config.emplace_back("tess", o.tess);
    h.config.emplace_back("partitioning", o.partitioning);
    h.config.emplace_back("normals", o.normals);
    h.config.emplace_back("contraction", o.contraction);
    h.config.emplace_back("vertex_cache", name_of(f.vertex_cache));
    std::filesystem::path const image = o.displace;
    if (o.direct3d != 11) h.config.emplace_back("direct3d", std::int64_t(o.direct3d));
    h.config.emplace_back("displace", image.filename().string());
    if (f.displacement) h.config.emplace_back("displace_scale", double(f.displacement->scale()));
    h.config.emplace_back("animate", o.animate);
    if (o.animate != "none") h.config.emplace_back("phase", o.phase);
    return job;
}

void add_run(ReportHeader& h, Job const& job, ThreadPool const& threads, double seconds)
{
    h.run = {{"threads", std::int64_t(threads.threads())},
             {"lanes", std::int64_t(job.frame.machine.lanes)},
             {"load_seconds", job.load_seconds},
             {"build_seconds", job.build_seconds},
             {"draw_seconds", seconds}};
}

// All that the frames will show, about.
std::vector<glm::vec3> points_to_show(Job const& job)
{
    std::vector<glm::vec3> points;
    std::vector<glm::vec3> const& rest = job.prepared.mesh->positions;
    for (FramePose const& f : job.poses)
        for (std::size_t v = 0; v < rest.size(); ++v)
            points.push_back(f.pose ? f.pose->posed(v, rest[v]) : rest[v]);
    if (float const d = job.frame.displacement ? job.frame.displacement->scale() : 0; d > 0)
        for (std::size_t i = 0, n = points.size(); i < n; ++i)
            for (float s : {-d, d}) points.push_back(points[i] + glm::vec3(s));
    return points;
}

// NAME_0007.png of NAME.png
std::string numbered(std::string const& path, std::size_t i)
{
    std::filesystem::path p = path;
    p.replace_filename(fmt::format("{}_{:04}{}", p.stem().string(), i, p.extension().string()));
    return p.string();
}

ErrorRow error_row(char const* quantity, char const* measure, char const* unit,
                   ErrorStatistics const& e)
{
    return {quantity, measure, unit, e.max, e.mean, e.rms, e.samples};
}

std::vector<double> as_doubles(glm::vec3 v)
{
    return {v.x, v.y, v.z};
}

} // namespace

namespace {

// The control mesh in the frame's pose.
void draw_cage(ControlMesh mesh, FrameSettings const& f, ThreadPool const& threads, Frame& frame)
{
    if (f.pose)
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            mesh.positions[v] = f.pose->posed(v, mesh.positions[v]);
    draw_colored_mesh(control_mesh_picture(Topology(mesh)), f, 0.45f, threads, frame);
}

int run_error_view(Options const& o, Job& job, int width, int height)
{
    auto const max = parse_error_max(o.error_max);
    int const level = o.level.value_or(kCompareLevel);
    if (job.frame.displacement || job.frame.pose || job.frame.direct3d10)
        throw Error("--view error compares the smooth surface at rest: it takes no --displace, "
                    "--animate or --direct3d 10");
    ThreadPool const threads(o.threads);
    Stopwatch const clock;
    EqualParameterErrors const e =
        equal_parameter_errors(*job.prepared.topology, *job.patches, job.frame, level, threads);
    if (e.triangles.empty()) throw Error(o.model + ": --view error needs quads, the mesh has none");
    double const position = max ? max->first : quantile(e.distance, e.weight, 0.99);
    double const normal = max ? max->second : quantile(e.angle, e.weight, 0.99);
    ErrorView const view = draw_error(e, job.frame, position, normal, threads);
    add_run(job.header, job, threads, clock.seconds());
    job.header.config.emplace_back("width", std::int64_t(width));
    job.header.config.emplace_back("height", std::int64_t(height));
    job.header.config.emplace_back("view", o.view);
    job.header.config.emplace_back("level", std::int64_t(level));
    std::vector<ErrorRow> const rows{
        error_row("position", "equal parameter", "diagonal", e.position_statistics()),
        error_row("normal", "equal parameter", "radians", e.normal_statistics())};
    if (!o.output.empty())
        write_figure(
            {2,
             {{&view.position, o.scheme + ": position"}, {&view.normal, o.scheme + ": normal"}},
             {{"distance / diagonal", position}, {"angle, radians", normal}}},
            o.output);
    if (!o.json.empty()) write_result(o.json, compare_report(job.header, e.diagonal, rows));
    if (o.json != "-") fmt::print("{}", compare_table(rows));
    return 0;
}

} // namespace

int run_draw(Options const& o)
{
    if (!o.output.empty()) check_image_path(o.output);
    auto const view = o.view == "error" || o.view == "cage" ? View::Lit : view_from_name(o.view);
    if (!view)
        throw Error("--view is '" + o.view +
                    "', it must be lit, normals, patches, depth, wire, coverage, cage or error");
    auto const [width, height] = parse_size(o.size);
    Job job = prepare(o, "draw");
    FrameSettings& f = job.frame;
    f.width = width;
    f.height = height;
    f.view = *view;
    f.camera = parse_camera(o.camera, points_to_show(job), float(width) / float(height));
    if (o.view == "error") return run_error_view(o, job, width, height);
    f.cull = parse_cull(o.cull);
    f.samples = o.samples;
    f.adaptive = parse_tess_edge(o.tess_edge);
    if (o.output.ends_with(".exr")) f.color_format = Format::R32G32B32A32_FLOAT;

    Config& c = job.header.config;
    c.emplace_back("width", std::int64_t(width));
    c.emplace_back("height", std::int64_t(height));
    c.emplace_back("tess_edge", o.tess_edge);
    c.emplace_back("view", o.view);
    c.emplace_back("cull", o.cull);
    c.emplace_back("samples", std::int64_t(o.samples));
    c.emplace_back("color_format", std::string(info(f.color_format).name));
    c.emplace_back("camera_eye", as_doubles(f.camera.eye));
    c.emplace_back("camera_target", as_doubles(f.camera.target));
    c.emplace_back("camera_up", as_doubles(f.camera.up));
    c.emplace_back("camera_focal", double(f.camera.focal));

    if (o.frames > 1) c.emplace_back("frames", std::int64_t(o.frames));
    ThreadPool const threads(o.threads);
    ProgressBar bar;
    Stopwatch const clock;
    Frame frame(f);
    std::vector<SequenceFrame> sequence;
    for (std::size_t i = 0; i < job.poses.size(); ++i) {
        f.pose = job.poses[i].pose;
        if (o.view == "cage")
            draw_cage(*job.prepared.mesh, f, threads, frame);
        else
            draw_frame(*job.patches, f, threads, frame, [&](std::size_t n, std::size_t all) {
                bar(i * all + n, job.poses.size() * all);
            });
        if (job.poses.size() == 1) break;
        sequence.push_back({job.poses[i].phase, f.pose->bytes(), frame.statistics,
                            sha256_of_targets(frame.color, frame.depth)});
        if (!o.output.empty()) write_image(frame.color, numbered(o.output, i));
    }
    bar.clear();
    add_run(job.header, job, threads, clock.seconds());
    if (!sequence.empty()) {
        if (!o.json.empty()) write_result(o.json, sequence_report(job.header, sequence));
        if (o.json != "-") fmt::print("{}", sequence_table(sequence));
        return 0;
    }
    if (!o.output.empty()) write_image(frame.color, o.output);
    if (!o.json.empty())
        write_result(o.json, draw_report(job.header, frame.statistics, frame.color, frame.depth));
    if (o.json != "-") fmt::print("{}", counters_table(frame.statistics));
    return 0;
}

int run_export(Options const& o)
{
    Job job = prepare(o, "export");
    job.header.config.emplace_back("weld", o.weld);
    MeshWriter writer(o.output, o.weld);
    ThreadPool const threads(o.threads);
    ProgressBar bar;
    Stopwatch const clock;
    std::size_t all = 0, done = 0;
    for (PatchCount const& c : job.patches->patch_counts()) all += c.patches;
    DrawStatistics const statistics = visit_surface(
        *job.patches, job.frame, threads, [&](DrawPass const& pass, ShadedPatch const& patch) {
            writer.add(pass, patch);
            if (++done % 64 == 0) bar(done, all);
        });
    bar.clear();
    writer.finish();
    add_run(job.header, job, threads, clock.seconds());
    if (!o.json.empty()) write_result(o.json, export_report(job.header, statistics, writer));
    if (o.json != "-")
        fmt::print("{}: {} vertices, {} triangles\n", o.output, writer.vertices(),
                   writer.triangles());
    return 0;
}

int run_compare(Options const& o)
{
    Job job = prepare(o, "compare");
    std::erase_if(job.header.config, [](auto const& c) {
        return c.first == "tess" || c.first == "partitioning" || c.first == "vertex_cache" ||
               c.first == "displace" || c.first == "animate";
    });
    int const level = o.level.value_or(kCompareLevel);
    job.header.config.emplace_back("level", std::int64_t(level));
    ThreadPool const threads(o.threads);
    Stopwatch const clock;
    SurfaceComparison const c =
        compare_with_limit(*job.prepared.topology, *job.patches, job.frame, level, threads);
    add_run(job.header, job, threads, clock.seconds());
    std::vector<ErrorRow> const rows{
        error_row("position", "closest point, scheme to limit", "diagonal", c.to_limit),
        error_row("position", "closest point, limit to scheme", "diagonal", c.from_limit),
        error_row("position", "equal parameter", "diagonal", c.equal_position),
        error_row("normal", "closest point, scheme to limit", "radians", c.normal_to_limit),
        error_row("normal", "closest point, limit to scheme", "radians", c.normal_from_limit),
        error_row("normal", "equal parameter", "radians", c.equal_normal)};
    if (!o.json.empty()) write_result(o.json, compare_report(job.header, c.diagonal, rows));
    if (o.json != "-") fmt::print("{}", compare_table(rows));
    return 0;
}

int run_check(Options const& o)
{
    if (!o.output.empty()) check_image_path(o.output);
    auto const mistake = mistake_from_name(o.mistake);
    if (!mistake)
        throw Error("--break is '" + o.mistake +
                    "', it must be order, contraction, factors, normals, fold, weights or topleft");
    auto const [width, height] = parse_size(o.size);
    Job job = prepare(o, "check");
    WatertightSettings s;
    s.frame = job.frame;
    s.frame.width = width;
    s.frame.height = height;
    s.frame.adaptive = parse_tess_edge(o.tess_edge);
    s.frame.camera = parse_camera(o.camera, points_to_show(job), float(width) / float(height));
    s.frame.parity = float(o.parity.value_or(0));
    s.rays = std::uint64_t(o.rays);
    s.list = 100000;
    s.frame.mistake = plant_mistake(*job.prepared.topology, *mistake);
    if (o.mistaken_face > 0) {
        if (std::size_t(o.mistaken_face) > job.prepared.mesh->faces())
            throw Error(fmt::format("--break-face is {}, the mesh has {} faces", o.mistaken_face,
                                    job.prepared.mesh->faces()));
        s.frame.mistake.face = std::uint32_t(o.mistaken_face - 1);
    }
    Config& c = job.header.config;
    std::erase_if(c, [](auto const& entry) { return entry.first == "vertex_cache"; });
    c.emplace_back("tess_edge", o.tess_edge);
    c.emplace_back("width", std::int64_t(width));
    c.emplace_back("height", std::int64_t(height));
    c.emplace_back("rays", o.rays);
    c.emplace_back("parity", double(s.frame.parity));
    c.emplace_back("break", o.mistake);
    if (*mistake != Mistake::None)
        c.emplace_back("break_face", std::int64_t(s.frame.mistake.face) + 1);
    ThreadPool const threads(o.threads);
    ProgressBar bar;
    s.progress = [&](std::size_t n, std::size_t all) { bar(n, all); };
    Stopwatch const clock;
    std::vector<CheckedVerdict> const verdicts =
        check_watertight(*job.prepared.topology, *job.patches, s, threads);
    bar.clear();
    add_run(job.header, job, threads, clock.seconds());
    std::vector<VerdictRow> rows;
    for (CheckedVerdict const& v : verdicts) {
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
        rows.push_back(std::move(row));
    }
    if (!o.output.empty()) write_image(draw_cracks(*job.patches, s, verdicts, threads), o.output);
    if (!o.json.empty()) write_result(o.json, check_report(job.header, rows));
    if (o.json != "-") fmt::print("{}", check_table(rows, 3));
    return all_hold(verdicts) ? 0 : 1;
}

int run_cost(Options const& o)
{
    if (!o.output.empty()) check_image_path(o.output);
    MachineModel const machine = load_machine_model(o.machine);
    auto const [width, height] = parse_size(o.size);
    Job job = prepare(o, "cost");
    FrameSettings& f = job.frame;
    f.width = width;
    f.height = height;
    f.camera = parse_camera(o.camera, points_to_show(job), float(width) / float(height));
    f.adaptive = parse_tess_edge(o.tess_edge);
    f.vertex_cache = machine.vertex_cache;
    Config& c = job.header.config;
    for (auto& [key, value] : c)
        if (key == "vertex_cache") value = name_of(f.vertex_cache);
    c.emplace_back("machine", std::filesystem::path(o.machine).filename().string());
    c.emplace_back("tess_edge", o.tess_edge);
    c.emplace_back("geometry_only", o.geometry_only);
    if (!o.geometry_only) {
        c.emplace_back("width", std::int64_t(width));
        c.emplace_back("height", std::int64_t(height));
    }
    ThreadPool const threads(o.threads);
    Stopwatch const clock;
    DrawStatistics const statistics = o.geometry_only
                                          ? visit_surface(*job.patches, f, threads, {})
                                          : draw_frame(*job.patches, f, threads).statistics;
    add_run(job.header, job, threads, clock.seconds());
    DrawCost const cost = estimate_cost(machine, statistics);
    CostSummary summary{machine.name, cost.bound, machine.overhead, cost.shaders, cost.seconds,
                        {},           {}};
    Roofline roofline{fmt::format("{} on {}", job.header.inputs[0].first, machine.name),
                      machine.arithmetic,
                      16 * machine.any_fetch,
                      {}};
    for (StageCost const& s : cost.stages) {
        summary.rows.push_back({s.stage, s.bound(), s.arithmetic, s.fetch, s.memory, s.fixed,
                                s.seconds(), s.operations, s.fetches, s.fetched_bytes,
                                s.memory_bytes});
        if (s.operations > 0 && s.fetches > 0 && s.seconds() > 0)
            roofline.points.push_back(
                {s.stage, s.operations / (16 * s.fetches), s.operations / s.seconds()});
    }
    summary.sources.assign(machine.sources.begin(), machine.sources.end());
    if (!o.output.empty()) write_roofline(roofline, o.output);
    if (!o.json.empty()) write_result(o.json, cost_report(job.header, summary));
    if (o.json != "-") fmt::print("{}", cost_table(summary));
    return 0;
}

namespace {

constexpr std::string_view kReproducible[] = {
    "loop09-table1",  "loop09-table2",   "loop09-table3",   "loop09-figure1", "loop09-figure3",
    "loop09-figure9", "loop09-figure10", "loop09-figure11", "loop09-figure12"};

ControlMesh model_of_paper(std::string const& path, ReportHeader& header)
{
    Model model = load_model(path);
    header.inputs.emplace_back(model.name, model.sha256);
    return std::move(model.mesh);
}

template <class Names>
std::vector<ControlMesh> models_of_paper(Options const& o, Names const& names, ReportHeader& header)
{
    std::vector<ControlMesh> meshes;
    for (std::string_view name : names)
        meshes.push_back(model_of_paper(o.models + "/" + std::string(name) + ".obj", header));
    return meshes;
}

// Built-in cages, and the paper's where they are there.
std::vector<ControlMesh> models_of_figure(Options const& o, int number, ReportHeader& header)
{
    std::vector<ControlMesh> meshes;
    auto const add_papers = [&] {
        for (std::string_view name : kLoop09Table2Models) {
            std::string const path = o.models + "/" + std::string(name) + ".obj";
            if (std::filesystem::exists(path)) meshes.push_back(model_of_paper(path, header));
        }
    };
    if (number == 11) add_papers();
    if (number == 1 || number == 10) meshes.push_back(model_of_paper("jug", header));
    if (number == 9 || number == 11) meshes.push_back(model_of_paper("golem", header));
    if (number == 12)
        for (BuiltinModel const& m : builtin_models())
            meshes.push_back(model_of_paper(std::string(m.name), header));
    if (number == 9 || number == 12) add_papers();
    return meshes;
}

int run_figure(Options const& o, ReportHeader header, int number, ThreadPool const& threads)
{
    std::string const output = o.output.empty() ? o.reproduce + ".png" : o.output;
    check_image_path(output);
    if (!o.json.empty()) throw Error("--json is of tables; a figure is a picture");
    FrameSettings s;
    s.width = s.height = 360;
    s.samples = 4;
    s.tess_factor = 16;
    s.machine = parse_machine(o);
    s.background = {1, 1, 1, 1};
    ProgressBar bar;
    PaperFigure const figure =
        reproduce_loop09_figure(number, models_of_figure(o, number, header), s, threads,
                                [&](std::size_t n, std::size_t all) { bar(n, all); });
    bar.clear();
    Figure out{figure.columns, {}, {}};
    for (PaperFigure::Panel const& p : figure.panels) out.panels.push_back({&p.picture, p.caption});
    for (PaperFigure::Scale const& scale : figure.scales)
        out.scales.push_back({scale.label, scale.max});
    write_figure(out, output);
    fmt::print("{}\n", output);
    for (std::string const& remark : figure.remarks) fmt::print("{}\n", remark);
    return 0;
}

} // namespace

int run_reproduce(Options const& o)
{
    std::string known;
    for (std::string_view name : kReproducible)
        known += (known.empty() ? "" : ", ") + std::string(name);
    if (std::find(std::begin(kReproducible), std::end(kReproducible), o.reproduce) ==
        std::end(kReproducible))
        throw Error("'" + o.reproduce + "' is not known; there is " + known);
    ReportHeader header{"reproduce", {{"name", o.reproduce}}, {}, {}, {}};
    ThreadPool const threads(o.threads);
    std::string_view const figure = "loop09-figure";
    if (o.reproduce.starts_with(figure))
        return run_figure(o, header, std::stoi(o.reproduce.substr(figure.size())), threads);
    if (!o.output.empty()) throw Error("-o is of figures; --json writes a table");

    ProgressBar bar;
    auto const progress = [&](std::size_t n, std::size_t all) { bar(n, all); };
    Stopwatch const clock;
    PaperTable table;
    if (o.reproduce == "loop09-table1") {
        ControlMesh const mesh = model_of_paper("golem", header);
        table = reproduce_loop09_table1(mesh, load_machine_model("loop09-emulator"),
                                        parse_machine(o), threads, progress)
                    .table;
    } else if (o.reproduce == "loop09-table2") {
        auto const meshes = models_of_paper(o, kLoop09Table2Models, header);
        table = reproduce_loop09_table2(meshes, load_machine_model("gtx260"), parse_machine(o),
                                        threads, progress)
                    .table;
    } else {
        int const level = o.level.value_or(3); // nearest to the paper, see the table's remarks
        header.config.emplace_back("level", std::int64_t(level));
        auto const meshes = models_of_paper(o, kLoop09Table3Models, header);
        table = reproduce_loop09_table3(meshes, level, parse_machine(o), threads, progress);
    }
    bar.clear();
    header.run = {{"threads", std::int64_t(threads.threads())}, {"seconds", clock.seconds()}};
    std::vector<PaperRow> rows;
    for (PaperCell const& c : table.cells) rows.push_back({c.row, c.column, c.paper, c.ours});
    if (!o.json.empty())
        write_result(o.json, paper_report(header, table.title, rows, table.remarks));
    if (o.json != "-") fmt::print("{}", paper_table(table.title, rows, table.remarks));
    return 0;
}

int run_diff(Options const& o)
{
    if (!(o.tolerance >= 0))
        throw Error(fmt::format("--tolerance is {}, it must be 0 or above", o.tolerance));
    std::string const a = read_file(o.model), b = read_file(o.other);
    std::vector<ResultValue> const values = diff_results(a, b, {o.model, o.other}, o.tolerance);
    auto const input = [](std::string const& path, std::string const& text) {
        return std::pair(path.substr(path.rfind('/') + 1), sha256_of(text));
    };
    ReportHeader const header{
        "diff", {{"tolerance", o.tolerance}}, {input(o.model, a), input(o.other, b)}, {}, {}};
    if (!o.json.empty()) write_result(o.json, diff_report(header, values));
    if (o.json != "-") fmt::print("{}", diff_table(values, o.all));
    return std::any_of(values.begin(), values.end(), [](auto const& v) { return v.differs; });
}

int run_info(Options const& o)
{
    Model model = load_model(o.model);
    print_warnings(model.warnings);
    Technique const& technique = find_technique(o.scheme);
    ReportHeader header{
        "info", {{"scheme", o.scheme}}, {{model.name, model.sha256}}, model.warnings, {}};
    MeshSummary summary;
    try {
        summary = summarize(Topology(model.mesh));
    } catch (MeshError const& e) {
        throw FormatError(model.path, model.line_of_face(e.face), e.what());
    }
    // A mesh that the scheme refuses still has figures: the refusal becomes a warning.
    std::vector<PatchCount> patches;
    PreparedMesh prepared;
    std::unique_ptr<PatchMesh> mesh;
    std::vector<std::string> more;
    try {
        build(model, technique, {}, prepared, mesh);
        patches = mesh->patch_counts();
        more = prepared.warnings;
        more.insert(more.end(), mesh->warnings().begin(), mesh->warnings().end());
    } catch (FormatError const& e) {
        more.push_back(o.scheme + " cannot draw this mesh: " + e.what());
    }
    print_warnings(more);
    header.warnings.insert(header.warnings.end(), more.begin(), more.end());
    if (!o.json.empty()) write_result(o.json, info_report(header, summary, patches));
    if (o.json != "-") fmt::print("{}", info_table(summary, patches));
    return 0;
}

int run_tessellate(Options const& o)
{
    if (!o.batch.empty()) {
        std::string const text = o.batch == "-" ? read_file("/dev/stdin") : read_file(o.batch);
        std::string out;
        int line = 0;
        std::istringstream in(text);
        for (std::string row; std::getline(in, row);) {
            ++line;
            out += tessellator_answer(
                       run_tessellator_case(parse_tessellator_case(row, o.batch, line))) +
                   "\n";
        }
        if (o.output.empty())
            fmt::print("{}", out);
        else
            write_file(o.output, out);
        return 0;
    }
    TessellatorCase c;
    std::string row = o.domain + " " + o.partitioning + " " + o.primitive;
    for (double f : o.factors)
        row += fmt::format(" {:08x}", std::bit_cast<std::uint32_t>(float(f)));
    c = parse_tessellator_case(row, "tessellate", 0);
    ReportHeader header{"tessellate",
                        {{"domain", o.domain},
                         {"partitioning", o.partitioning},
                         {"output", o.primitive},
                         {"factors", o.factors}},
                        {},
                        {},
                        {}};
    std::string const json = tessellate_report(header, c, run_tessellator_case(c));
    write_result(o.output.empty() ? "-" : o.output, json);
    return 0;
}

int run_schemes(Options const&)
{
    for (auto const& t : techniques()) {
        SchemeInfo const i = t->info();
        fmt::print("{:<18} {} section {}: {}\n", i.name, i.paper, i.section, i.summary);
        for (SchemeParameter const& p : i.parameters)
            fmt::print("    --set {}={:<8} {}\n", p.name, p.default_value, p.meaning);
    }
    return 0;
}

int run_models(Options const&)
{
    for (BuiltinModel const& m : builtin_models()) {
        std::string_view about = m.obj.substr(0, m.obj.find('\n'));
        about.remove_prefix(std::min<std::size_t>(2, about.size()));
        fmt::print("{:<14} {}\n", m.name, about);
    }
    return 0;
}

} // namespace tessemu
