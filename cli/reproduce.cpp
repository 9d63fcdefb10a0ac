// reproduce: papers' tables and figures beside ours.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/paper.h"
#include "cli/job.h"
#include "cli/verbs.h"
#include "io/figure.h"
#include "io/gpu_file.h"
#include "io/image_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace tessemu {

namespace {

struct ReproduceRequest {
    PaperItem const* item = nullptr;
    std::string models; ///< folder of the papers' cages
    std::string output;
    std::optional<int> level;
    RunRequest run;
};

PaperItem const* parse_item(std::string const& text, std::string const&)
{
    return &find_paper_item(text);
}

PaperInput load_input(ReproduceRequest const& o, ReportHeader& header)
{
    PaperInput in;
    for (PaperModel const& m : o.item->models) {
        std::string const path = m.builtin ? m.name : o.models + "/" + m.name + ".obj";
        bool const is_there = m.builtin || std::filesystem::exists(path);
        if (!m.required && !is_there) continue;
        if (!is_there)
            throw Error(path + ": no such file; " + o.item->name + " needs " + m.name +
                        ".obj, in the folder of --models");
        Model model = open_model(path);
        header.inputs.emplace_back(model.name, model.sha256);
        for (std::string& w : without_folder(std::move(model.warnings), path))
            header.warnings.push_back(std::move(w));
        in.meshes.push_back(std::move(model.mesh));
    }
    for (std::string const& gpu : o.item->gpus) in.gpus.push_back(load_gpu_model(gpu));
    in.level = o.level.value_or(o.item->level);
    FrameSettings& panel = in.picture;
    panel.width = panel.height = 360;
    panel.samples = 4;
    panel.tess_factor = 16;
    panel.background = {1, 1, 1, 1};
    return in;
}

void show(PaperFigure const& figure, OutputFile& picture, RunOutput& out)
{
    Figure drawn{figure.columns, {}, {}};
    for (PaperFigure::Panel const& p : figure.panels)
        drawn.panels.push_back({&p.picture, p.caption});
    for (PaperFigure::Scale const& scale : figure.scales)
        drawn.scales.push_back({scale.label, scale.max});
    write_figure(drawn, picture);
    std::string said = picture.path().string() + "\n";
    for (std::string const& remark : figure.remarks) said += remark + "\n";
    out.finish([] { return ""; }, said);
}

void show(PaperTable const& table, ReportHeader const& header, RunOutput& out)
{
    std::vector<PaperRow> rows;
    for (PaperCell const& c : table.cells) rows.push_back({c.row, c.column, c.paper, c.ours});
    out.finish([&] { return paper_report(header, table.title, rows, table.remarks); },
               paper_table(table.title, rows, table.remarks));
}

void show(PaperPlots const& plots, OutputFile& picture, ReportHeader const& header, RunOutput& out)
{
    write_plots(plots.sheet, picture);
    std::vector<ClaimRow> rows;
    for (PaperClaim const& c : plots.claims)
        rows.push_back({c.letter, c.claim, std::string(name_of(c.verdict)), c.criterion, c.ours,
                        c.bound, c.other_readings});
    out.finish(
        [&] {
            return plots_report(header, plots.title, plots.sheet, rows, plots.remarks, plots.table);
        },
        picture.path().string() + "\n" +
            plots_table(plots.title, plots.sheet, rows, plots.remarks, plots.table));
}

int run(ReproduceRequest const& o)
{
    PaperItem const& item = *o.item;
    std::string const output = o.output.empty() ? item.name + ".png" : o.output;
    if (!item.makes_numbers() && !o.run.json.empty())
        throw Error("--json is of tables and curves; " + item.name + " is a picture");
    if (!item.makes_picture() && !o.output.empty())
        throw Error("-o is of pictures; " + item.name + " is a table, which --json writes");
    if (o.level && item.level == 0) throw Error("--level: " + item.name + " has no level");
    RunOutput out(o.run.json);
    OutputFile* const picture = item.makes_picture() ? &out.add(output) : nullptr;
    if (picture) picture_format(*picture); // or refuses
    ReportHeader header{"reproduce", {{"name", item.name}}, {}, {}, {}};
    PaperInput const in = load_input(o, header);
    if (item.level != 0) header.config.emplace_back("level", std::int64_t(in.level));

    ThreadPool const threads(o.run.threads);
    ProgressBar bar;
    Stopwatch const clock;
    auto const result = item.run(in, threads, [&](std::size_t n, std::size_t all) { bar(n, all); });
    bar.clear();
    header.run = {{"threads", std::int64_t(threads.threads())}, {"seconds", clock.seconds()}};
    if (auto const* const figure = std::get_if<PaperFigure>(&result))
        show(*figure, *picture, out);
    else if (auto const* const plots = std::get_if<PaperPlots>(&result))
        show(*plots, *picture, header, out);
    else
        show(std::get<PaperTable>(result), header, out);
    return 0;
}

// A text for each table and figure; those left empty are left out.
template <class TextOf> std::string listed(TextOf const& text_of)
{
    std::string out;
    for (PaperItem const& i : paper_items())
        if (std::string const text = text_of(i); !text.empty())
            out += (out.empty() ? "" : ", ") + text;
    return out;
}

bool has_model(PaperItem const& item, bool required)
{
    return std::any_of(item.models.begin(), item.models.end(),
                       [&](PaperModel const& m) { return !m.builtin && m.required == required; });
}

std::string cages()
{
    std::vector<std::string> names;
    for (PaperItem const& i : paper_items())
        for (PaperModel const& m : i.models)
            if (!m.builtin && std::find(names.begin(), names.end(), m.name + ".obj") == names.end())
                names.push_back(m.name + ".obj");
    std::string out;
    for (std::string const& n : names) out += (out.empty() ? "" : ", ") + n;
    return out;
}

// A name alone, one with cages, and a picture; then all names.
std::string examples()
{
    std::string out;
    auto const example = [&](std::string const& rest, auto const& wanted) {
        auto const i = std::find_if(paper_items().begin(), paper_items().end(), wanted);
        if (i != paper_items().end()) out += "  tessemu reproduce " + i->name + rest + "\n";
    };
    example("", [](PaperItem const& i) { return !i.makes_picture() && !has_model(i, true); });
    example(" --models cages", [](PaperItem const& i) { return has_model(i, true); });
    example(" -o figure.png", [](PaperItem const& i) { return i.makes_picture(); });
    out += "\nNames:";
    for (PaperItem const& i : paper_items()) out += fmt::format("\n  {:<18} {}", i.name, i.about);
    return out;
}

} // namespace

void add_reproduce(CommandLine& program)
{
    auto const o = std::make_shared<ReproduceRequest>();
    Verb& verb = program.add_verb(
        "reproduce",
        "a paper's table or figure: its numbers, ours and the ratio; pictures; curves and claims",
        examples());
    verb.required("NAME", o->item, parse_item, "a table or figure, see below");
    verb.option("--models", o->models, plain,
                "folder with papers' cages (" + cages() + "): needed by " + listed([](auto& i) {
                    return has_model(i, true) ? i.name : "";
                }) + "; shown where they are there by " +
                    listed([](auto& i) { return has_model(i, false) ? i.name : ""; }),
                ".");
    verb.option("-o", o->output, output_path, "of a figure: picture, .png or .exr [NAME.png]");
    verb.option("--level", o->level, whole(1, 6),
                "both surfaces at 2^level segments an edge, 1 to 6: of " + listed([](auto& i) {
                    return i.level ? fmt::format("{} [{}]", i.name, i.level) : "";
                }));
    add_options(verb, o->run);
    verb.runs([o](Session const&) { return run(*o); });
}

} // namespace tessemu
