// SPDX-License-Identifier: Apache-2.0
#include "sweep/slurm.h"

#include "emu/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessemu {

namespace {

// A word of the shell.
std::string quoted(std::string const& text)
{
    std::string out = "'";
    for (char const c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

std::string head(SlurmJob const& job, std::string const& name, std::string const& log)
{
    std::string out = "#!/bin/sh\n";
    auto const option = [&](std::string const& text) {
        // Such a line has no quotes that a blank could hide in.
        if (text.find('\n') != std::string::npos)
            throw Error("--option has a line break: '" + text + "'");
        out += "#SBATCH " + text + "\n";
    };
    option("--job-name=" + name);
    std::string const logs = (job.folder / "slurm").string();
    if (logs.find_first_of("\"%\n") != std::string::npos)
        throw Error("the sweep's folder is " + job.folder.string() +
                    ": Slurm takes no \", % or line break in the path of a log");
    option("--output=\"" + logs + "/" + log + "\"");
    for (std::string const& o : job.options) option(o);
    return out;
}

} // namespace

std::string slurm_array_script(SlurmJob const& job)
{
    std::string out = head(job, "tessemu-sweep", "%A_%a.log");
    out += fmt::format("#SBATCH --array=1-{}\n", job.tasks);
    return out + fmt::format("exec {} sweep run {} -j \"${{SLURM_CPUS_PER_TASK:-1}}\"\n",
                             quoted(job.program.string()), quoted(job.folder.string()));
}

std::string slurm_merge_script(SlurmJob const& job)
{
    return head(job, "tessemu-merge", "merge_%j.log") +
           fmt::format("exec {} sweep merge {} -o {}\n", quoted(job.program.string()),
                       quoted(job.folder.string()), quoted(job.table.string()));
}

} // namespace tessemu
