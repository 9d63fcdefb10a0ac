// The verbs that ask about surfaces and papers: compare, check, cost, reproduce.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/cost.h"
#include "analysis/loop09_figures.h"
#include "analysis/loop09_table3.h"
#include "analysis/loop09_timing.h"
#include "analysis/watertight.h"
#include "cli/job.h"
#include "cli/verbs.h"
#include "io/figure.h"
#include "io/image_writer.h"
#include "io/machine_file.h"
#include "pipeline/builtin_models.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessemu {

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

} // namespace tessemu
