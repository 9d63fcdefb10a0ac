// SPDX-License-Identifier: Apache-2.0
#include "cli/job.h"

#include "io/atomic_file.h"
#include "io/sha256.h"

#include <fmt/format.h>

#include <cstdio>

#include <unistd.h>

namespace tessemu {

void ProgressBar::clear()
{
    if (shown_) std::fputs("\r\033[K", stderr);
    shown_ = false;
}

void ProgressBar::operator()(std::size_t done, std::size_t all)
{
    if (!isatty(STDERR_FILENO) || clock_.seconds() < 1 || all == 0) return;
    int const width = 40, filled = int(std::uint64_t(width) * done / all);
    fmt::print(stderr, "\r[{}{}] {:3d} %", std::string(std::size_t(filled), '#'),
               std::string(std::size_t(width - filled), '.'), int(100 * std::uint64_t(done) / all));
    std::fflush(stderr);
    shown_ = true;
}

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

ErrorRow error_row(char const* quantity, char const* measure, char const* unit,
                   ErrorStatistics const& e)
{
    return {quantity, measure, unit, e.max, e.mean, e.rms, e.samples};
}

} // namespace tessemu
