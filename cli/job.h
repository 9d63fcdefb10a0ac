// What the verbs share: a model under a scheme with its settings, progress, results.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/compare.h"
#include "cli/options.h"
#include "io/model.h"
#include "io/report.h"

#include <chrono>

namespace tessemu {

inline constexpr int kCompareLevel = 4; ///< 16 segments an edge

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

void print_warnings(std::vector<std::string> const& warnings);
/// Writes a result to a file, or prints it for "-"; nothing for an empty path.
void write_result(std::string const& path, std::string const& json);

/// A model under a scheme, and the settings that draw and export share.
struct Job {
    PreparedMesh prepared;
    std::unique_ptr<PatchMesh> patches;
    FrameSettings frame;
    ReportHeader header;
    std::vector<FramePose> poses;
    double load_seconds = 0, build_seconds = 0;
};

/// Errors about the mesh name the file, and the line where it is known.
void build(Model& model, Technique const& technique,
           std::map<std::string, double> const& parameters, PreparedMesh& prepared,
           std::unique_ptr<PatchMesh>& patches);
/// From the options that all surface verbs share. Prints warnings.
Job prepare(Options const& o, std::string const& verb);
void add_run(ReportHeader& h, Job const& job, ThreadPool const& threads, double seconds);
/// All that the frames will show, about.
std::vector<glm::vec3> points_to_show(Job const& job);
ErrorRow error_row(char const* quantity, char const* measure, char const* unit,
                   ErrorStatistics const& e);

} // namespace tessemu
