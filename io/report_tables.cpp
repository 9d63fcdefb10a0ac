// SPDX-License-Identifier: Apache-2.0
#include "io/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessemu {

namespace {

std::string counted(std::uint64_t n)
{
    std::string digits = std::to_string(n), out;
    for (std::size_t i = 0; i < digits.size(); ++i) {
        if (i && (digits.size() - i) % 3 == 0) out += ',';
        out += digits[i];
    }
    return out;
}

std::string histogram(std::vector<std::pair<std::size_t, std::size_t>> const& entries)
{
    std::string out;
    for (auto const& [key, n] : entries)
        out += fmt::format("{}{}:{}", out.empty() ? "" : "  ", key, n);
    return out.empty() ? "-" : out;
}

// Lines of at most 100 characters, broken at blanks; the first after `head`, which is as wide as
// the indent of the others.
std::string wrapped(std::string const& head, std::string_view text)
{
    constexpr std::size_t kWidth = 100;
    std::string out = head;
    std::size_t column = head.size();
    bool first = true;
    while (!text.empty()) {
        std::string_view const word = text.substr(0, text.find(' '));
        text.remove_prefix(std::min(word.size() + 1, text.size()));
        if (!first && column + 1 + word.size() > kWidth) {
            out += "\n" + std::string(head.size(), ' ');
            column = head.size();
        } else if (!first) {
            out += ' ';
            ++column;
        }
        out += word;
        column += word.size();
        first = false;
    }
    return out + "\n";
}

// LOOP10's types that the patches are of, those of most patches first.
std::string valence_table(std::vector<PatchCount> const& patches)
{
    constexpr std::size_t kShown = 12, kALine = 4;
    std::vector<std::pair<ValenceType, std::size_t>> used;
    for (PatchCount const& c : patches)
        used.insert(used.end(), c.valence_types.begin(), c.valence_types.end());
    if (used.empty()) return "";
    std::stable_sort(used.begin(), used.end(),
                     [](auto const& a, auto const& b) { return a.second > b.second; });
    auto const count = [&](auto const& is) {
        return std::count_if(used.begin(), used.end(), [&](auto const& t) { return is(t.first); });
    };
    auto const known = count([](ValenceType const&t) { return t.is_of_loop10(); }),
               isolated =
                   count([](ValenceType const&t) { return t.is_of_loop10() && t.is_isolated(); });
    std::string out = fmt::format("\ncorner valences of quads: {} types, {} of LOOP10's {}, {} of "
                                  "the {} that isolation leaves\n",
                                  used.size(), known, valence_types().size(), isolated,
                                  isolated_valence_types().size());
    for (std::size_t i = 0; i < std::min(kShown, used.size()); ++i) {
        auto const& [type, n] = used[i];
        bool const last = i % kALine == kALine - 1 || i + 1 == std::min(kShown, used.size());
        std::string const valences = fmt::format("{}", fmt::join(type.valence, " "));
        out += last ? fmt::format("  {:<11} {}\n", valences, n)
                    : fmt::format("  {:<11} {:<7}", valences, n);
    }
    if (used.size() > kShown) out += fmt::format("  and {} more\n", used.size() - kShown);
    return out;
}

std::string short_number(double x)
{
    return std::isnan(x) ? "-"
           : x < 1000    ? fmt::format("{:.3g}", x)
                         : counted(std::uint64_t(x + 0.5));
}

std::string number_table(NumberTable const& table)
{
    if (table.rows.empty()) return "";
    std::size_t name = table.name.size();
    std::vector<std::size_t> width;
    for (std::string const& head : table.columns) width.push_back(head.size());
    for (NumberTable::Row const& r : table.rows) {
        name = std::max(name, r.name.size());
        for (std::size_t i = 0; i < width.size(); ++i)
            width[i] = std::max(width[i], short_number(r.numbers[i]).size());
    }
    auto const line = [&](std::string const& first, auto const& cell, std::string const& last) {
        std::string out = fmt::format("{:<{}}", first, name);
        for (std::size_t i = 0; i < width.size(); ++i)
            out += fmt::format("  {:>{}}", cell(i), width[i]);
        return out + "  " + last + "\n";
    };
    std::string out =
        "\n" + line(
                   table.name, [&](std::size_t i) { return table.columns[i]; }, table.note);
    for (NumberTable::Row const& r : table.rows)
        out += line(
            r.name, [&](std::size_t i) { return short_number(r.numbers[i]); }, r.note);
    return out;
}

// Every curve has points where the first one has.
bool share_x(Plot const& panel)
{
    auto const& first = panel.series[0].points;
    for (PlotSeries const& s : panel.series)
        for (PlotPoint const& p : s.points)
            if (std::none_of(first.begin(), first.end(), [&](auto const& q) { return q.x == p.x; }))
                return false;
    return true;
}

// Both coordinates of each curve's points.
std::string pairs(Plot const& panel, PlotSheet const& sheet)
{
    std::string out = fmt::format("\n{}\n", panel.title);
    for (PlotSeries const& s : panel.series) {
        auto const line = [&](std::string const& head, std::string const& axis, auto const& of) {
            out += fmt::format("  {:<30} {:<23}", head, axis);
            for (PlotPoint const& p : s.points) out += fmt::format(" {:>8}", short_number(of(p)));
            out += "\n";
        };
        line(s.name, sheet.x.name, [](PlotPoint const& p) { return p.x; });
        line("", sheet.y.name, [](PlotPoint const& p) { return p.y; });
    }
    return out;
}

} // namespace

std::string sequence_table(std::vector<SequenceFrame> const& frames)
{
    std::string out =
        fmt::format("{:>5} {:>7} {:>13} {:>12} {:>12} {:>11} {:>13} {:>16}\n", "frame", "phase",
                    "upload bytes", "VS runs", "CS threads", "points", "pixels", "fetched bytes");
    for (std::size_t i = 0; i < frames.size(); ++i) {
        SequenceFrame const& f = frames[i];
        PipelineStatistics const& p = f.statistics.total.pipeline;
        out += fmt::format("{:>5} {:>7.4f} {:>13} {:>12} {:>12} {:>11} {:>13} {:>16}\n", i, f.phase,
                           counted(f.upload_bytes), counted(p.VSInvocations),
                           counted(p.CSInvocations), counted(p.DSInvocations),
                           counted(p.PSInvocations), counted(f.fetched_bytes()));
    }
    return out;
}

std::string subdivide_table(std::vector<SubdivisionRow> const& steps)
{
    if (steps.empty()) return "";
    std::string out;
    auto const line = [&](auto const&... column) {
        out += fmt::format("{:>4} {:<14} {:>10} {:>12} {:>12} {:>12} {:>12} {:>14} {:>7} {:>7}\n",
                           column...);
    };
    line("", "", "", "", "", "index", "vertex", "bytes", "lost at", "lost at");
    line("step", "kernel", "threads", "add", "mul, div", "fetches", "fetches", "fetched", "32",
         "64");
    for (std::size_t i = 0; i < steps.size(); ++i)
        for (KernelRow const& k : steps[i].kernels) {
            auto const lost = [&](std::size_t l) {
                return l < k.loops.size() ? fmt::format("{:.2f} %", 100 * k.loops[l].lost) : "-";
            };
            line(i + 1, k.kernel, counted(k.threads), counted(k.flops.add),
                 counted(flops_loop10(k.flops)), counted(k.index_fetches),
                 counted(k.vertex_fetches), counted(k.fetched_bytes), lost(0), lost(1));
        }
    return out + "\n";
}

std::string tables_table(std::vector<TableSetRow> const& sets)
{
    std::string out;
    for (TableSetRow const& row : sets) {
        auto const line = [&](auto const&... column) {
            out += fmt::format("{:<20} {:>8} {:>8} {:>8} {:>14} {:>14}\n", column...);
        };
        out += "rules=" + row.rules + "\n";
        line("family", "types", "made", "tables", "bytes", "but 2 faces");
        std::size_t types = 0, made = 0, tables = 0, others = 0;
        for (TableSet::Family const& f : row.set.families) {
            line(in_words(f.family), counted(f.types), counted(f.made), counted(f.tables),
                 counted(f.bytes()), counted(f.tables_but_2));
            types += f.types, made += f.made, tables += f.tables, others += f.tables_but_2;
        }
        line("all", counted(types), counted(made), counted(tables),
             counted(TableSet::Family::bytes_of(tables)), counted(others));
        SymmetryReport const& r = row.set.symmetry;
        out += fmt::format("\n{:<28} {:>12} {:>10} {:>12} {:>8}\n", "classes of equal edges",
                           "table edges", "directed", "undirected", "BOLZ03");
        auto const classes = [&](char const* name, SymmetryReport::Classes const& c,
                                 char const* paper) {
            out += fmt::format("{:<28} {:>12} {:>10} {:>12} {:>8}\n", name, counted(c.table_edges),
                               counted(c.directed), counted(c.undirected), paper);
        };
        classes("off-corner", r.off_corner, "4");
        classes("off-corner, at a tag", r.off_corner_at_a_tag, "4");
        classes("on-corner, second ring", r.two_ring, "2");
        classes("on-corner, others", r.on_corner, "-");
        out += fmt::format("entries: {} compared, {} changed, of these {} roundings of 0; the "
                           "others by {} bits in all,\nat most {}; passes: {}\n\n",
                           counted(r.entries), counted(r.changed), counted(r.zeroed),
                           counted(r.changed_ulps), counted(r.most_ulps), r.passes);
    }
    return out;
}

std::string compare_table(std::vector<ErrorRow> const& rows)
{
    std::string out = fmt::format("{:<10} {:<31} {:<9} {:>11} {:>11} {:>11} {:>9}\n", "error",
                                  "measure", "unit", "max", "mean", "rms", "samples");
    for (ErrorRow const& r : rows) {
        auto const value = [&](double x) {
            return r.samples ? fmt::format("{:.4g}", x) : std::string("-");
        };
        out += fmt::format("{:<10} {:<31} {:<9} {:>11} {:>11} {:>11} {:>9}\n", r.quantity,
                           r.measure, r.unit, value(r.max), value(r.mean), value(r.rms), r.samples);
    }
    return out;
}

std::string paper_table(std::string const& title, std::vector<PaperRow> const& rows,
                        std::vector<std::string> const& remarks)
{
    std::string out = fmt::format("{}\n\n{:<38} {:<46} {:>9} {:>9} {:>6}\n", title, "", "", "paper",
                                  "ours", "ratio");
    std::string row;
    auto const number = [](double x) {
        return x < 1e4 ? fmt::format("{:>9.4g}", x) : fmt::format("{:>9.0f}", x); // triangles
    };
    for (PaperRow const& r : rows) {
        out += fmt::format("{:<38} {:<46} {} {} {:>6.2f}\n", r.row == row ? "" : r.row, r.column,
                           number(r.paper), number(r.ours), r.ratio());
        row = r.row;
    }
    for (std::string const& remark : remarks) out += "\n" + remark + "\n";
    return out;
}

std::string plots_table(std::string const& title, PlotSheet const& sheet,
                        std::vector<ClaimRow> const& claims,
                        std::vector<std::string> const& remarks, NumberTable const& table)
{
    std::string out = title + "\n" + number_table(table);
    for (Plot const& panel : sheet.panels) {
        if (panel.series.empty()) continue;
        if (!share_x(panel)) {
            out += pairs(panel, sheet);
            continue;
        }
        out += fmt::format("\n{:<32} {:>16}", panel.title, sheet.x.name);
        for (PlotPoint const& p : panel.series[0].points) out += fmt::format(" {:>8.6g}", p.x);
        out += "\n";
        for (PlotSeries const& s : panel.series) {
            out += fmt::format("  {:<47}", s.name);
            auto next = s.points.begin();
            for (PlotPoint const& p : panel.series[0].points) {
                if (next == s.points.end() || next->x != p.x) {
                    out += fmt::format(" {:>8}", "");
                    continue;
                }
                double const y = next++->y;
                out += y < 1000 ? fmt::format(" {:>8.4g}", y) : fmt::format(" {:>8.0f}", y);
            }
            out.erase(out.find_last_not_of(' ') + 1);
            out += "\n";
        }
    }
    for (ClaimRow const& c : claims) {
        out += "\n" + wrapped(fmt::format("({}) ", c.letter), c.claim);
        out += wrapped("    verdict    ", c.verdict);
        out += wrapped("    criterion  ", c.criterion);
        out += wrapped("    ours       ", c.ours);
        if (!c.bound.empty()) out += wrapped("    bound by   ", c.bound);
        for (std::string const& reading : c.other_readings)
            out += wrapped("    otherwise  ", reading);
    }
    out += "\n";
    for (std::string const& remark : remarks) out += wrapped("* ", remark);
    return out;
}

std::string check_table(std::vector<VerdictRow> const& verdicts, std::size_t most)
{
    std::string out =
        fmt::format("{:<10} {:<8} {:>12} {:>10}\n", "", "verdict", "checked", "failures");
    for (VerdictRow const& v : verdicts) {
        bool const is_short = v.reason.size() <= 60;
        out += fmt::format("{:<10} {:<8} {:>12} {:>10}  {}\n", v.name, v.verdict,
                           counted(v.checked), counted(v.failures), is_short ? v.reason : "");
        std::string_view rest = is_short ? std::string_view() : v.reason;
        while (!rest.empty()) { // a part a line
            std::size_t const end = std::min(rest.find("; "), rest.size());
            out += fmt::format("    {}\n", rest.substr(0, end));
            rest.remove_prefix(std::min(end + 2, rest.size()));
        }
        for (std::size_t i = 0; i < std::min(most, v.sites.size()); ++i)
            out += "    " + v.sites[i].text + "\n";
        if (v.failures > most) out += fmt::format("    and {} more\n", counted(v.failures - most));
    }
    return out;
}

std::string cost_table(CostSummary const& c)
{
    auto const ms = [](double s) {
        return s == 0 ? std::string("-") : fmt::format("{:.4f}", 1e3 * s);
    };
    std::string out =
        fmt::format("{}\n\n{:<16} {:>11} {:>11} {:>11} {:>11} {:>11}  {}\n", c.gpu, "stage, ms",
                    "arithmetic", "fetch", "memory", "rate", "all", "bound by");
    for (CostRow const& r : c.rows)
        out += fmt::format("{:<16} {:>11} {:>11} {:>11} {:>11} {:>11}  {}\n", r.stage,
                           ms(r.arithmetic), ms(r.fetch), ms(r.memory), ms(r.fixed), ms(r.seconds),
                           r.bound);
    out +=
        fmt::format("\nshaders {} ms, overhead {} ms, draw {} ms ({:.1f} a second), bound by {}\n",
                    ms(c.shaders), ms(c.overhead), ms(c.seconds), 1 / c.seconds, c.bound);
    return out;
}

std::string counters_table(DrawStatistics const& s)
{
    std::string out = fmt::format("{:<16} {:>13} {:>14} {:>14} {:>11} {:>9} {:>9}\n", "stage",
                                  "invocations", "add", "mul", "mad", "div", "sqrt");
    for (StageStatistics const& stage : s.stages)
        out += fmt::format("{:<16} {:>13} {:>14} {:>14} {:>11} {:>9} {:>9}\n", stage.stage,
                           counted(stage.invocations), counted(stage.flops.add),
                           counted(stage.flops.mul), counted(stage.flops.mad),
                           counted(stage.flops.div), counted(stage.flops.sqrt));
    out += fmt::format("\n{:<16} {:<22} {:<15} {:>15} {:>16} {:>16}\n", "fetches of", "resource",
                       "kind", "count", "bytes", "unique bytes");
    for (StageStatistics const& stage : s.stages)
        for (FetchStatistics const& f : stage.fetches)
            out += fmt::format("{:<16} {:<22} {:<15} {:>15} {:>16} {:>16}\n", stage.stage,
                               f.resource, name_of(f.kind), counted(f.count), counted(f.bytes),
                               counted(f.unique_bytes));
    PipelineStatistics const& p = s.pipeline;
    out += '\n';
    if (p.HSInvocations) // else no tessellator made the triangles
        out += fmt::format("{} patches, {} domain points, ", counted(p.HSInvocations),
                           counted(p.DSInvocations));
    out += fmt::format("{} triangles, {} after clipping, {} pixels shaded\n",
                       counted(p.CInvocations), counted(p.CPrimitives), counted(p.PSInvocations));
    return out;
}

std::string info_table(MeshSummary const& s, std::vector<PatchCount> const& patches)
{
    std::string out = fmt::format(
        "vertices           {}{}\nfaces              {}   by sides  {}\nedges              {}\n"
        "boundary edges     {}   {}\ncomponents         {}\ninterior valences  {}\n"
        "boundary valences  {}\nregular faces      {}\n",
        s.vertices, s.unused_vertices ? fmt::format("   ({} unused)", s.unused_vertices) : "",
        s.faces, histogram(s.faces_by_size), s.edges, s.boundary_edges,
        s.boundary_edges ? "open" : "closed", s.components, histogram(s.interior_valences),
        histogram(s.boundary_valences), s.regular_faces);
    if (patches.empty()) return out;
    out += fmt::format("\n{:<18} {:>9} {:>20} {:>10}\n", "patch kind", "patches",
                       "connectivity types", "inputs");
    for (PatchCount const& c : patches)
        out += fmt::format("{:<18} {:>9} {:>20} {:>10}\n", c.kind.name, c.patches, c.types,
                           c.min_inputs == c.max_inputs
                               ? std::to_string(c.min_inputs)
                               : fmt::format("{}-{}", c.min_inputs, c.max_inputs));
    return out + valence_table(patches);
}

} // namespace tessemu
