// Papers' tables and figures beside our own: what one looks like, and the list of those that
// `reproduce` knows. A paper is a folder here and one line of registry.cpp.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"
#include "io/gpu_model.h"
#include "io/number_table.h"
#include "io/plot.h"
#include "pipeline/frame.h"

#include <functional>
#include <string>
#include <variant>
#include <vector>

namespace tessemu {

/// A cell: what the paper prints, and ours.
struct PaperCell {
    std::string row, column;
    double paper, ours;
};

struct PaperTable {
    std::string title;
    std::vector<PaperCell> cells;
    std::vector<std::string> remarks; ///< what the paper leaves open, and how we read it
};

struct PaperFigure {
    struct Panel {
        ColorTarget picture;
        std::string caption;
    };
    struct Scale { ///< from blue, 0, to red
        std::string label;
        double max;
    };
    int columns = 1;
    std::vector<Panel> panels; ///< row after row
    std::vector<Scale> scales; ///< of the columns, or none
    std::vector<std::string> remarks;
};

/// What a paper says in words, and whether our figures say it too.
struct PaperClaim {
    enum class Verdict { Holds, DoesNot, CannotFollow };
    std::string letter; ///< "a"
    std::string claim;  ///< the paper's, in short
    Verdict verdict;
    std::string criterion; ///< what decided
    std::string ours;      ///< figures
    std::string bound;     ///< what the times wait for; empty: it is not about times
    std::vector<std::string> other_readings = {}; ///< what it says under others
};
/// "holds", "does not hold", "cannot follow from counters"
std::string_view name_of(PaperClaim::Verdict verdict);

/// Curves of which the paper prints no numbers: its claims stand for them.
struct PaperPlots {
    std::string title;
    PlotSheet sheet; ///< points' labels say what bounds them
    std::vector<PaperClaim> claims;
    std::vector<std::string> remarks;
    NumberTable table = {}; ///< beside the curves
};

/// (done, all) steps
using PaperProgress = std::function<void(std::size_t, std::size_t)>;

/// A control mesh that a table or figure is made from.
struct PaperModel {
    std::string name;
    bool builtin = true;  ///< otherwise NAME.obj of a folder that the user names
    bool required = true; ///< otherwise used where it is there
};

struct PaperInput {
    std::vector<ControlMesh> meshes; ///< those of PaperItem::models that are there, in that order
    std::vector<GpuModel> gpus;      ///< PaperItem::gpus
    int level = 0;                   ///< of a comparison; PaperItem::level by default
    Machine machine;
    FrameSettings picture; ///< of a figure's panel: size, samples, background, tess factor
};

/// What comes of an item.
enum class PaperKind { Table, Figure, Plots };

/// A table or a figure that can be reproduced.
struct PaperItem {
    std::string name;  ///< "loop09-table1"
    std::string about; ///< a line for the help
    PaperKind kind = PaperKind::Table;
    std::vector<PaperModel> models;
    std::vector<std::string> gpus; ///< built-in descriptions
    int level = 0;                 ///< of its comparison; 0: it has none
    std::function<std::variant<PaperTable, PaperFigure, PaperPlots>(
        PaperInput const&, ThreadPool const&, PaperProgress const&)>
        run;

    bool makes_picture() const { return kind != PaperKind::Table; }
    bool makes_numbers() const { return kind != PaperKind::Figure; }
};

/// In the order of the papers.
std::vector<PaperItem> const& paper_items();
/// Throws Error that lists the known names.
PaperItem const& find_paper_item(std::string_view name);

} // namespace tessemu
