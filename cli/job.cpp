// SPDX-License-Identifier: Apache-2.0
#include "cli/job.h"

#include "analysis/compare.h"
#include "io/image_reader.h"
#include "io/input_file.h"
#include "io/sha256.h"
#include "io/table_cache.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include <unistd.h>

namespace tessemu {

void ProgressBar::clear()
{
    if (shown_) print_message("\r\033[K");
    shown_ = false;
}

void ProgressBar::operator()(std::size_t done, std::size_t all, std::string const& note)
{
    if (silent_ || !isatty(STDERR_FILENO) || clock_.seconds() < 1 || all == 0) return;
    int const width = 40, filled = int(std::uint64_t(width) * done / all);
    print_message(fmt::format("\r[{}{}] {:3d} %{}\033[K", std::string(std::size_t(filled), '#'),
                              std::string(std::size_t(width - filled), '.'),
                              int(100 * std::uint64_t(done) / all), note));
    shown_ = true;
}

void print_warning(std::string const& warning)
{
    print_message("warning: " + warning + "\n");
}

void Session::warn(std::string const& warning) const
{
    if (!result) print_warning(warning); // else the result says it
}

Model open_model(std::string const& model, WarningSink const& warn)
{
    return load_model(model, warn);
}

std::shared_ptr<OpenSurface const> SurfaceStore::find(std::string const& key,
                                                      std::function<OpenSurface()> const& make)
{
    std::promise<std::shared_ptr<OpenSurface const>> promise;
    Future future;
    bool is_first = false;
    {
        std::scoped_lock const lock(mutex_);
        auto const at = std::find_if(entries_.begin(), entries_.end(),
                                     [&](auto const& e) { return e.first == key; });
        is_first = at == entries_.end();
        if (is_first) {
            entries_.emplace_front(key, promise.get_future().share());
            if (entries_.size() > capacity_) entries_.pop_back(); // whoever uses it keeps it
        } else {
            entries_.splice(entries_.begin(), entries_, at);
        }
        future = entries_.front().second;
    }
    if (is_first) {
        try {
            promise.set_value(std::make_shared<OpenSurface const>(make()));
        } catch (...) {
            promise.set_exception(std::current_exception());
        }
    }
    return future.get();
}

std::vector<std::string> without_folder(std::vector<std::string> warnings, std::string const& path)
{
    std::string const folder = path.substr(0, path.find_last_of('/') + 1);
    for (std::string& w : warnings)
        if (!folder.empty() && w.starts_with(folder)) w.erase(0, folder.size());
    return warnings;
}

SchemeOnMesh build(Model model, ModelRequest const& o, ThreadPool const& threads, MakeSurface& make,
                   WarningSink const& warn)
{
    BuildOptions options = o.build;
    options.placement = model.placement;
    options.lines = std::move(model.lines);
    options.warn = warn;
    options.threads = &threads;
    bool const is_named = o.table_cache.has_value();
    std::filesystem::path const folder =
        is_named ? std::filesystem::path(*o.table_cache) : default_table_cache();
    std::optional<BasisTableCache> cache;
    if (!folder.empty() && folder != "none")
        options.tables = &cache.emplace(folder, is_named ? warn : WarningSink());
    try {
        return make(*o.scheme, std::move(model.mesh), options);
    } catch (MeshError const& e) {
        throw FormatError(options.lines.file, options.lines.line_of_face(e.face), e.what());
    } catch (LimitError const& e) {
        throw FormatError(options.lines.file, 0, e.what());
    }
}

Config config_of(ModelRequest const& o, Parameters const& parameters)
{
    SchemeInfo const info = o.scheme->info();
    Config out{{"scheme", info.name}, {"subdivide", std::int64_t(o.build.subdivide)}};
    if (o.build.join) out.emplace_back("join", *o.build.join);
    auto const add = [&](SchemeParameter const& p) {
        auto const found = parameters.values().find(p.name);
        if (found == parameters.values().end()) return; // was not given, and has no default
        std::visit([&](auto const& value) { out.emplace_back(p.name, value); }, found->second);
    };
    for (SchemeParameter const& p : info.parameters) add(p);
    add(sort_parameter());
    add(coordinates_parameter());
    return out;
}

namespace {

// All that a surface hangs on.
std::string key_of(ModelRequest const& o, MakeSurface& make)
{
    std::string key = fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}", o.model, o.scheme->info().name,
                                  o.build.subdivide, o.build.join.value_or(-1), o.build.strict,
                                  o.table_cache.value_or(""), make == build_scheme);
    for (auto const& [name, value] : o.build.set) key += "\n" + name + "=" + value;
    return key;
}

OpenSurface open_surface(ModelRequest const& o, ThreadPool const& threads, Session const& session,
                         MakeSurface& make)
{
    auto const warn = [&](std::string const& warning) { session.warn(warning); };
    OpenSurface out;
    Stopwatch const load_clock;
    Model model = open_model(o.model, warn);
    out.load_seconds = load_clock.seconds();
    out.path = model.lines.file;
    out.placement = model.placement;
    out.input = {model.name, model.sha256};
    out.warnings = std::move(model.warnings);
    Stopwatch const build_clock;
    out.surface = build(std::move(model), o, threads, make, warn);
    out.build_seconds = build_clock.seconds();
    auto const& more = out.surface.warnings;
    out.warnings.insert(out.warnings.end(), more.begin(), more.end());
    out.warnings = without_folder(std::move(out.warnings), out.path);
    return out;
}

} // namespace

Job open_job(ModelRequest const& o, ShadingRequest const& shading, std::string const& verb,
             ThreadPool const& threads, Session const& session, MakeSurface& make)
{
    Job job;
    job.frame.machine = shading.machine();
    job.frame.true_normals = shading.normals != ShadingRequest::Normals::Frozen;
    job.poses.emplace_back();
    auto const open = [&] { return open_surface(o, threads, session, make); };
    job.opened = session.surfaces ? session.surfaces->find(key_of(o, make), open)
                                  : std::make_shared<OpenSurface const>(open());
    job.path = job.opened->path;
    job.placement = job.opened->placement;
    job.header.verb = verb;
    job.header.inputs = {job.opened->input};
    job.header.warnings = job.opened->warnings;
    return job;
}

namespace {

void add_config(Config& c, ShadingRequest const& o)
{
    c.emplace_back("normals", name_of(o.normals));
    c.emplace_back("contraction", name_of(o.products));
}

float diagonal_of(ControlMesh const& mesh)
{
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (glm::vec3 const& p : mesh.positions) low = min(low, p), high = max(high, p);
    return glm::length(high - low);
}

std::shared_ptr<Displacement const> make_displacement(SurfaceRequest const& o, Job const& job)
{
    RefinedMesh const& mesh = *job.surface().mesh;
    using Kind = DisplaceRequest::Heights::Kind;
    auto const& [kind, path] = o.displace.heights;
    if (kind == Kind::None) return {};
    float const diagonal = diagonal_of(mesh.base());
    float const scale = o.displace.scale ? float(job.placement.length_from_file(*o.displace.scale))
                                         : 0.01f * diagonal;
    if (!std::isfinite(scale))
        throw Error(fmt::format("--displace-scale is {}: too large for a model of diagonal {}",
                                *o.displace.scale, job.placement.length_to_file(diagonal)));
    std::shared_ptr<Displacement const> out;
    if (kind == Kind::Studs) {
        out = std::make_shared<Displacement>(Displacement::studs(diagonal / 16, scale));
    } else {
        HeightImage image = read_height_image(path);
        try {
            out = std::make_shared<Displacement>(job.surface().mesh, std::move(image), scale,
                                                 o.displace.wrap.value_or(HeightWrap::Repeat));
        } catch (Error const& e) {
            throw Error(job.path + ": " + e.what());
        }
    }
    // Beyond, nothing of the model is left in single precision.
    float const most = 0x1p20f * diagonal;
    if (!(out->reach() <= most))
        throw Error(fmt::format("--displace-scale: it and the heights move points by up to {:g}, "
                                "the limit is 2^20 diagonals of the model, {:g}",
                                job.placement.length_to_file(out->reach()),
                                job.placement.length_to_file(most)));
    return out;
}

std::vector<FramePose> make_poses(AnimateRequest const& o, ControlMesh const& mesh)
{
    if (o.motion == AnimateRequest::Motion::None) return {{}};
    SpineRig const rig(mesh);
    std::vector<FramePose> out;
    for (int i = 0; i < o.frames; ++i) {
        double const phase = o.phase + double(i) / o.frames;
        out.push_back({phase, std::make_shared<Pose>(rig.sway(phase))});
    }
    return out;
}

// All that the frames will show, about.
std::vector<glm::vec3> points_to_show(Job const& job, AnimateRequest const& animate)
{
    ControlMesh const& mesh = job.surface().mesh->base();
    std::vector<glm::vec3> points;
    for (FramePose const& f : make_poses(animate, mesh))
        for (std::size_t v = 0; v < mesh.positions.size(); ++v)
            points.push_back(f.pose ? f.pose->posed(v, mesh.positions[v]) : mesh.positions[v]);
    return points;
}

Camera make_camera(CameraRequest const& o, Job const& job, AnimateRequest const& animate,
                   float aspect)
{
    std::vector<glm::vec3> const points = points_to_show(job, animate);
    float const reach = job.frame.displacement ? job.frame.displacement->reach() : 0;
    Camera camera = frame_points(points, o.from, aspect, reach);
    if (o.target) camera.target = job.placement.from_file(*o.target);
    if (o.eye) camera.eye = job.placement.from_file(*o.eye);
    if (o.up) camera.up = *o.up;
    if (o.focal) camera.focal = *o.focal;
    try {
        check_camera(camera);
    } catch (Error const& e) {
        throw Error(std::string("--camera: ") + e.what());
    }
    if (o.eye || o.target) fit_depth_range(camera, points, reach);
    return camera;
}

AdaptiveFactors factors_in_mesh(AdaptiveFactors factors, Placement const& placement)
{
    if (factors.kind != AdaptiveFactors::Kind::Distance) return factors;
    double const given = factors.value;
    factors.value = placement.length_from_file(given);
    if (!(factors.value > 1e-30 && factors.value < 1e30))
        throw Error(
            fmt::format("--tess-edge: distance is {}, for this model it must be {:g} to {:g}",
                        given, placement.length_to_file(1e-30), placement.length_to_file(1e30)));
    return factors;
}

} // namespace

std::string in_words_of_levels(std::vector<std::uint64_t> const& levels)
{
    std::vector<std::string> parts;
    for (std::size_t level = 0; level < levels.size(); ++level)
        if (levels[level])
            parts.push_back(fmt::format("{} of {} segment{}", levels[level], 1 << level,
                                        level == 0 ? "" : "s"));
    if (parts.empty()) return "";
    return fmt::format("patches by their segments: {}\n", fmt::join(parts, ", "));
}

void keep_inputs(RunOutput const& out, SurfaceRequest const& o)
{
    out.keep(o.model.model);
    out.keep(o.displace.heights.image);
}

Job prepare(ModelRequest const& o, ShadingRequest const& shading, std::string const& verb,
            ThreadPool const& threads, Session const& session)
{
    Job job = open_job(o, shading, verb, threads, session, build_scheme);
    job.header.config = config_of(o, job.surface().parameters);
    add_config(job.header.config, shading);
    return job;
}

Job prepare(SurfaceRequest const& o, std::string const& verb, ThreadPool const& threads,
            Session const& session, MakeSurface& make)
{
    check_request(o);
    Job job = open_job(o.model, o.shading, verb, threads, session, make);
    FrameSettings& f = job.frame;
    f.partitioning = o.partitioning.value_or(f.partitioning);
    f.tess_factor = float(o.tess.value_or(kDefaultTessFactor));
    if (job.surface().patches) job.header.levels = job.surface().patches->level_counts();
    bool const adaptive = !job.header.levels.empty();
    if (adaptive && o.tess) {
        job.header.warnings.push_back("--tess is not used: each patch has its own segments");
        session.warn(job.header.warnings.back());
    }
    if (o.vertex_cache) f.vertex_cache = *o.vertex_cache;
    f.direct3d10 = o.direct3d10;
    f.pattern = o.pattern.value_or(f.pattern);
    bool const is_uniform = f.pattern == RefinementPattern::Uniform;
    f.displacement = make_displacement(o, job);
    job.poses = make_poses(o.animate, job.surface().mesh->base());
    f.pose = job.poses[0].pose;

    ReportHeader& h = job.header;
    DisplaceRequest::Heights const& heights = o.displace.heights;
    if (heights.kind == DisplaceRequest::Heights::Kind::Image)
        h.inputs.emplace_back(name_of(heights), sha256_of(read_file(heights.image)));
    Config& c = h.config = config_of(o.model, job.surface().parameters);
    if (!adaptive) c.emplace_back("tess", double(f.tess_factor));
    if (o.model.scheme->info().tessellator && !is_uniform)
        c.emplace_back("partitioning", std::string(name_of(f.partitioning)));
    add_config(c, o.shading);
    if (o.vertex_cache) c.emplace_back("vertex_cache", name_of(*o.vertex_cache));
    if (o.direct3d10) c.emplace_back("direct3d", std::int64_t(10));
    if (is_uniform) c.emplace_back("pattern", std::string("uniform"));
    c.emplace_back("displace", name_of(heights));
    if (f.displacement)
        c.emplace_back("displace_scale", job.placement.length_to_file(f.displacement->scale()));
    if (heights.kind == DisplaceRequest::Heights::Kind::Image)
        c.emplace_back("displace_wrap", name_of(o.displace.wrap.value_or(HeightWrap::Repeat)));
    c.emplace_back("animate", name_of(o.animate.motion));
    if (f.pose) c.emplace_back("phase", o.animate.phase);
    return job;
}

void set_picture(Job& job, PictureRequest const& o, SurfaceRequest const& surface)
{
    SchemeInfo const info = surface.model.scheme->info();
    if (!info.tessellator && o.tess_edge.kind != AdaptiveFactors::Kind::None)
        throw Error("--tess-edge: " + info.name +
                    " has no tessellator that takes factors by edge; "
                    "'tessemu schemes' lists what it can be set to");
    FrameSettings& f = job.frame;
    f.width = o.size.width;
    f.height = o.size.height;
    f.adaptive = factors_in_mesh(o.tess_edge, job.placement);
    f.camera = make_camera(o.camera, job, surface.animate, o.size.aspect());
}

void add_run(ReportHeader& h, Job const& job, ThreadPool const& threads, double seconds)
{
    h.run = {{"threads", std::int64_t(threads.threads())},
             {"lanes", std::int64_t(job.frame.machine.lanes)},
             {"load_seconds", job.opened->load_seconds},
             {"build_seconds", job.opened->build_seconds},
             {"draw_seconds", seconds}};
}

ErrorRow error_row(char const* quantity, char const* measure, char const* unit,
                   ErrorStatistics const& e)
{
    return {quantity, measure, unit, e.max, e.mean, e.rms, e.samples};
}

} // namespace tessemu
