// From what a user asks for to what the library works on: a model under a scheme with its settings;
// progress and results.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/options.h"
#include "cli/run_output.h"
#include "io/model.h"
#include "io/report.h"

#include <chrono>

namespace tessemu {

struct ErrorStatistics;

class Stopwatch {
public:
    double seconds() const
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// On a terminal, and only once the work has lasted a second.
class ProgressBar {
public:
    ~ProgressBar() { clear(); }
    void clear();
    void operator()(std::size_t done, std::size_t all);

private:
    Stopwatch clock_;
    bool shown_ = false;
};

/// At once, so that a warning stands before the error that follows from it.
void print_warning(std::string const& warning);
/// A model as its warnings are printed.
Model open_model(std::string const& model);
/// Warnings of a file carry its path; a result must not.
std::vector<std::string> without_folder(std::vector<std::string> warnings, std::string const& path);

struct FramePose {
    double phase = 0;
    std::shared_ptr<Pose const> pose; ///< none: the mesh at rest
};

/// A model under a scheme, and what a verb draws it with.
struct Job {
    SchemeOnMesh surface;
    FrameSettings frame;
    std::vector<FramePose> poses; ///< one at least
    ReportHeader header;
    std::string path;    ///< of the model, for messages
    Placement placement; ///< of the mesh in the model's file
    double load_seconds = 0, build_seconds = 0;

    PatchMesh const& patches() const { return *surface.patches; }
};

/// build_scheme, or refine_for_scheme for who needs no patches.
using MakeSurface = SchemeOnMesh(Scheme const&, ControlMesh, BuildOptions const&);
/// Prints warnings, or tells them to another. Errors about the mesh name the file, and the line
/// where it is known.
SchemeOnMesh build(Model model, ModelRequest const& o, ThreadPool const& threads,
                   MakeSurface& make = build_scheme, WarningSink const& warn = print_warning);
/// "scheme", "subdivide", "join" where it is asked for, and each parameter by its name, "sort"
/// where there is something to sort.
Config config_of(ModelRequest const& o, Parameters const& parameters);
/// The model, the machine, and a header without a configuration.
Job open_job(ModelRequest const& o, ShadingRequest const& shading, std::string const& verb,
             ThreadPool const& threads, MakeSurface& make);
/// The model and its settings for shading.
Job prepare(ModelRequest const& o, ShadingRequest const& shading, std::string const& verb,
            ThreadPool const& threads);
/// "patches by their segments: 12 of 1 segment, 3 of 2 segments" and a line's end; empty where
/// patches have no levels of their own.
std::string in_words_of_levels(std::vector<std::uint64_t> const& levels);
/// No result may replace the model or the height map.
void keep_inputs(RunOutput const& out, SurfaceRequest const& o);
/// With everything that verbs that tessellate share.
Job prepare(SurfaceRequest const& o, std::string const& verb, ThreadPool const& threads,
            MakeSurface& make = build_scheme);
/// Size, factors and camera, which shows the model, displaced, as it moves through all frames.
void set_picture(Job& job, PictureRequest const& o, SurfaceRequest const& surface);
void add_run(ReportHeader& h, Job const& job, ThreadPool const& threads, double seconds);
ErrorRow error_row(char const* quantity, char const* measure, char const* unit,
                   ErrorStatistics const& e);

} // namespace tessemu
