// Results as JSON (schema tessemu.VERB/1) and as a table.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"
#include "emu/statistics.h"
#include "io/mesh_writer.h"
#include "io/tessellator_text.h"
#include "pipeline/technique.h"

#include <string>
#include <utility>
#include <variant>

namespace tessemu {

/// Version of the library, as CMake has it.
std::string_view tessemu_version();

/// An option with its resolved value.
using ConfigValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;
using Config = std::vector<std::pair<std::string, ConfigValue>>;

/// What all results say.
struct ReportHeader {
    std::string verb;
    Config config;
    std::vector<std::pair<std::string, std::string>> inputs; ///< (name, SHA-256)
    std::vector<std::string> warnings;
    Config run; ///< times, threads, lanes: not hashed
};

/// draw: counters and stages; "hash" covers the report without tool, run and hash, then the colour
/// and the depth target, rows from the top, all samples of each.
std::string draw_report(ReportHeader const& header, DrawStatistics const& statistics,
                        ColorTarget const& color, DepthTarget const& depth);

/// export: the same with the mesh instead of the target.
std::string export_report(ReportHeader const& header, DrawStatistics const& statistics,
                          MeshWriter const& mesh);

/// info: the mesh's figures and its patches under a scheme.
std::string info_report(ReportHeader const& header, MeshSummary const& summary,
                        std::vector<PatchCount> const& patches);

/// tessellate: one patch.
std::string tessellate_report(ReportHeader const& header, TessellatorCase const& c,
                              TessellatedPatch const& patch);

/// Counters by stage as text for a terminal.
std::string counters_table(DrawStatistics const& statistics);
std::string info_table(MeshSummary const& summary, std::vector<PatchCount> const& patches);

} // namespace tessemu
