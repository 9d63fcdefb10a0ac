// Results as JSON (schema tessemu.VERB/1) and as a table.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"
#include "emu/statistics.h"
#include "io/mesh_writer.h"
#include "io/number_table.h"
#include "io/plot.h"
#include "io/tessellator_text.h"
#include "pipeline/basis_tables/table_set.h"
#include "pipeline/schemes/scheme.h"

#include <string>
#include <utility>
#include <variant>

namespace tessemu {

/// Version of the library, as CMake has it.
std::string_view tessemu_version();

/// Bytes as UTF-8: each that is none becomes \xNN, and a backslash \x5C, so that they can be had
/// back. Names of files, and texts that quote what files say, are such bytes.
std::string as_utf8(std::string_view bytes);

/// An option with its resolved value.
using ConfigValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;
using Config = std::vector<std::pair<std::string, ConfigValue>>;

/// What all results say; texts are bytes, see as_utf8.
struct ReportHeader {
    std::string verb;
    Config config;
    std::vector<std::pair<std::string, std::string>> inputs; ///< (name, SHA-256)
    std::vector<std::string> warnings;
    Config run; ///< times, threads, lanes: not hashed
    /// Where patches have levels of their own: how many have 2^i segments inside.
    std::vector<std::uint64_t> levels = {};
};

/// draw: counters and stages of all commands together, then of like commands in a row; "hash"
/// covers the report without tool, run and hash, then the colour and the depth target, rows from
/// the top, all samples of each.
std::string draw_report(ReportHeader const& header, Frame const& frame);

/// A frame of a sequence.
struct SequenceFrame {
    double phase = 0;
    std::uint64_t upload_bytes = 0; ///< what an application sends for it: the pose
    ListStatistics statistics;
    std::string target_sha256; ///< of colour and depth, as draw_report hashes them

    /// By all stages.
    std::uint64_t fetched_bytes() const;
};
std::string sha256_of_targets(ColorTarget const& color, DepthTarget const& depth);
/// draw of several frames: "frames" with the counters and commands of each.
std::string sequence_report(ReportHeader const& header, std::vector<SequenceFrame> const& frames);
std::string sequence_table(std::vector<SequenceFrame> const& frames);

/// export: the same with the mesh instead of the target.
std::string export_report(ReportHeader const& header, ListStatistics const& statistics,
                          MeshWriter const& mesh);

/// A kernel's loop where so many threads run in step: the turns of all its threads.
struct LoopRow {
    int threads_in_step;
    std::uint64_t needed, run;
    double lost; ///< the share of lanes that wait
};
struct KernelRow {
    std::string kernel;
    std::uint64_t threads; ///< with a point to make
    FlopCount flops;
    std::uint64_t index_fetches, vertex_fetches, fetched_bytes;
    std::vector<LoopRow> loops; ///< none: it has no loop
};
/// A step of subdivision.
struct SubdivisionRow {
    std::uint64_t faces, edges, vertices; ///< of the mesh before it
    std::vector<KernelRow> kernels;
};
/// subdivide: "hash" covers the mesh as add_to_hash() has it.
std::string subdivide_report(ReportHeader const& header, ListStatistics const& statistics,
                             std::vector<SubdivisionRow> const& steps, ControlMesh const& mesh,
                             Placement const& placement);
std::string subdivide_table(std::vector<SubdivisionRow> const& steps);

/// A set of basis-function tables by one choice of rules.
struct TableSetRow {
    std::string rules;
    TableSet set;
};
/// tables
std::string tables_report(ReportHeader const& header, std::vector<TableSetRow> const& sets);
std::string tables_table(std::vector<TableSetRow> const& sets);

/// info: the mesh's figures and its patches under a scheme.
std::string info_report(ReportHeader const& header, MeshSummary const& summary,
                        std::vector<PatchCount> const& patches);

/// tessellate: one patch.
std::string tessellate_report(ReportHeader const& header, TessellatorCase const& c,
                              TessellatedPatch const& patch);

/// A quantity's error over a surface.
struct ErrorRow {
    std::string quantity, measure, unit;
    double max, mean, rms;
    std::size_t samples;
};
/// compare
std::string compare_report(ReportHeader const& header, double diagonal,
                           std::vector<ErrorRow> const& rows);
std::string compare_table(std::vector<ErrorRow> const& rows);

/// A cell of a paper's table.
struct PaperRow {
    std::string row, column;
    double paper, ours;

    /// Equal numbers have the ratio 1, zeros too.
    double ratio() const { return ours == paper ? 1 : ours / paper; }
};
/// reproduce: each cell with ours / paper.
std::string paper_report(ReportHeader const& header, std::string const& title,
                         std::vector<PaperRow> const& rows,
                         std::vector<std::string> const& remarks);
std::string paper_table(std::string const& title, std::vector<PaperRow> const& rows,
                        std::vector<std::string> const& remarks);

/// A claim of a paper, and whether our figures say it too.
struct ClaimRow {
    std::string letter, claim, verdict, criterion, ours, bound;
    std::vector<std::string> other_readings; ///< what it says under others
};
/// reproduce of curves: "plots" with each point and what bounds it, "claims"; "table" where there is
/// one, an object a row.
std::string plots_report(ReportHeader const& header, std::string const& title,
                         PlotSheet const& sheet, std::vector<ClaimRow> const& claims,
                         std::vector<std::string> const& remarks, NumberTable const& table = {});
std::string plots_table(std::string const& title, PlotSheet const& sheet,
                        std::vector<ClaimRow> const& claims,
                        std::vector<std::string> const& remarks, NumberTable const& table = {});

/// A verdict of check, and what it fails on.
struct VerdictSite {
    std::uint32_t face[2], vertex[2], t; ///< faces and vertices from 0
    int component;                       ///< -1: no value differs
    std::uint32_t bits[2];
    std::uint64_t ulp;
    int pixel[2];     ///< -1: no pixel
    std::string edge; ///< in the scheme's words; empty: none
    std::string text;
};
struct VerdictRow {
    std::string name, verdict, reason;
    std::uint64_t checked, failures;
    std::vector<VerdictSite> sites;
    bool witness = false; ///< its numbers are another program's: under "witness", not hashed
};
/// check: each verdict with what it checked and where it fails
std::string check_report(ReportHeader const& header, std::vector<VerdictRow> const& verdicts);
/// \param most  sites of a verdict that are shown
std::string check_table(std::vector<VerdictRow> const& verdicts, std::size_t most);

/// A stage's predicted time.
struct CostRow {
    std::string stage, bound;
    double arithmetic, fetch, memory, fixed, seconds; ///< seconds
    double operations, fetches, fetched_bytes, memory_bytes;
};
/// A draw on a GPU.
struct CostSummary {
    std::string gpu, bound;
    double overhead, shaders, seconds;
    std::vector<CostRow> rows;
    std::vector<std::pair<std::string, std::string>> sources; ///< of the GPU's numbers
};
/// cost
std::string cost_report(ReportHeader const& header, CostSummary const& cost);
std::string cost_table(CostSummary const& cost);

/// Counters by stage as text for a terminal.
std::string counters_table(DrawStatistics const& statistics);
std::string info_table(MeshSummary const& summary, std::vector<PatchCount> const& patches);

} // namespace tessemu
