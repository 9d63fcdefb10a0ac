// SPDX-License-Identifier: Apache-2.0
#include "cli/verbs.h"

#include "analysis/error_view.h"
#include "cli/job.h"
#include "io/atomic_file.h"
#include "io/figure.h"
#include "io/image_writer.h"
#include "io/mesh_writer.h"
#include "io/result_diff.h"
#include "io/sha256.h"
#include "pipeline/builtin_models.h"
#include "pipeline/colored_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace tessemu {

namespace {

// NAME_0007.png of NAME.png
std::string numbered(std::string const& path, std::size_t i)
{
    std::filesystem::path p = path;
    p.replace_filename(fmt::format("{}_{:04}{}", p.stem().string(), i, p.extension().string()));
    return p.string();
}

std::vector<double> as_doubles(glm::vec3 v)
{
    return {v.x, v.y, v.z};
}

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