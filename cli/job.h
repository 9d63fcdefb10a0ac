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
#include <functional>
#include <future>
#include <list>
#include <mutex>

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
    explicit ProgressBar(Session const& session = {}) : silent_(session.result != nullptr) {}
    ~ProgressBar() { clear(); }
    void clear();
    /// \param note  behind the bar
    void operator()(std::size_t done, std::size_t all, std::string const& note = "");

private:
    bool silent_;
    Stopwatch clock_;
    bool shown_ = false;
};

/// At once, so that a warning stands before the error that follows from it.
void print_warning(std::string const& warning);
/// A model as its warnings are printed.
Model open_model(std::string const& model, WarningSink const& warn = print_warning);
/// Warnings of a file carry its path; a result must not.
std::vector<std::string> without_folder(std::vector<std::string> warnings, std::string const& path);

struct FramePose {
    double phase = 0;
    std::shared_ptr<Pose const> pose; ///< none: the mesh at rest
};

/// A model under a scheme, and what is said of both.
struct OpenSurface {
    SchemeOnMesh surface;
    std::string path; ///< of the model, for messages
    Placement placement;
    std::pair<std::string, std::string> input; ///< name and SHA-256
    std::vector<std::string> warnings;
    double load_seconds = 0, build_seconds = 0;
};

/// Surfaces that several runs of a process share, each made once. Holds the last ones. Thread-safe.
class SurfaceStore {
public:
    explicit SurfaceStore(std::size_t capacity) : capacity_(capacity) {}
    /// What `make` gives, or throws, now or before.
    std::shared_ptr<OpenSurface const> find(std::string const& key,
                                            std::function<OpenSurface()> const& make);

private:
    using Future = std::shared_future<std::shared_ptr<OpenSurface const>>;
    std::mutex mutex_;
    std::size_t capacity_;
    std::list<std::pair<std::string, Future>> entries_; // from the last used on
};

/// What a verb draws a surface with.
struct Job {
    std::shared_ptr<OpenSurface const> opened;
    FrameSettings frame;
    std::vector<FramePose> poses; ///< one at least
    ReportHeader header;
    std::string path;    ///< of the model, for messages
    Placement placement; ///< of the mesh in the model's file

    SchemeOnMesh const& surface() const { return opened->surface; }
    PatchMesh const& patches() const { return *surface().patches; }
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
             ThreadPool const& threads, Session const& session, MakeSurface& make);
/// The model and its settings for shading.
Job prepare(ModelRequest const& o, ShadingRequest const& shading, std::string const& verb,
            ThreadPool const& threads, Session const& session);
/// "patches by their segments: 12 of 1 segment, 3 of 2 segments" and a line's end; empty where
/// patches have no levels of their own.
std::string in_words_of_levels(std::vector<std::uint64_t> const& levels);
/// No result may replace the model or the height map.
void keep_inputs(RunOutput const& out, SurfaceRequest const& o);
/// With everything that verbs that tessellate share.
Job prepare(SurfaceRequest const& o, std::string const& verb, ThreadPool const& threads,
            Session const& session, MakeSurface& make = build_scheme);
/// Size, factors and camera, which shows the model, displaced, as it moves through all frames.
void set_picture(Job& job, PictureRequest const& o, SurfaceRequest const& surface);
void add_run(ReportHeader& h, Job const& job, ThreadPool const& threads, double seconds);
ErrorRow error_row(char const* quantity, char const* measure, char const* unit,
                   ErrorStatistics const& e);

} // namespace tessemu
