// SPDX-License-Identifier: Apache-2.0
#include "io/report.h"

#include "io/control_mesh_writer.h"
#include "io/result_diff.h"
#include "io/sha256.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tessemu {

using Json = nlohmann::ordered_json;

std::string_view tessemu_version()
{
    return TESSEMU_VERSION;
}

namespace {

// How many bytes of text begin with a character in UTF-8, as RFC 3629 has it; 0: none does.
std::size_t utf8_length(std::string_view text)
{
    auto const byte = [&](std::size_t i) {
        return i < text.size() ? std::uint8_t(text[i]) : std::uint8_t(0);
    };
    std::uint8_t const first = byte(0);
    if (first < 0x80) return 1;
    if (first < 0xc2 || first > 0xf4) return 0;
    std::size_t const n = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    // Neither overlong, nor half of a pair, nor beyond U+10FFFF.
    std::uint8_t const low = first == 0xe0   ? 0xa0
                             : first == 0xf0 ? 0x90
                                             : 0x80,
                       high = first == 0xed   ? 0x9f
                              : first == 0xf4 ? 0x8f
                                              : 0xbf;
    if (byte(1) < low || byte(1) > high) return 0;
    for (std::size_t i = 2; i < n; ++i)
        if (byte(i) < 0x80 || byte(i) > 0xbf) return 0;
    return n;
}

} // namespace

std::string as_utf8(std::string_view bytes)
{
    std::string out;
    while (!bytes.empty()) {
        std::size_t const n = bytes[0] == '\\' ? 0 : utf8_length(bytes);
        if (n == 0)
            out += fmt::format("\\x{:02X}", std::uint8_t(bytes[0]));
        else
            out += bytes.substr(0, n);
        bytes.remove_prefix(std::max<std::size_t>(n, 1));
    }
    return out;
}

namespace {

// JSON has no infinities and no NaN: they are the strings "inf", "-inf" and "nan".
Json to_json(double x)
{
    if (std::isfinite(x)) return x;
    return std::isnan(x) ? "nan" : x > 0 ? "inf" : "-inf";
}

Json to_json(std::vector<double> const& list)
{
    Json j = Json::array();
    for (double x : list) j.push_back(to_json(x));
    return j;
}

Json to_json(Config const& config)
{
    Json j = Json::object();
    for (auto const& entry : config) // no structured binding: clang 14 cannot capture one
        std::visit(
            [&](auto const& value) {
                using Value = std::decay_t<decltype(value)>;
                if constexpr (std::is_same_v<Value, std::string>)
                    j[entry.first] = as_utf8(value);
                else if constexpr (std::is_same_v<Value, double> ||
                                   std::is_same_v<Value, std::vector<double>>)
                    j[entry.first] = to_json(value);
                else
                    j[entry.first] = value;
            },
            entry.second);
    return j;
}

Json to_json(FlopCount const& c)
{
    return {{"add", c.add},   {"mul", c.mul},     {"mad", c.mad},        {"div", c.div},
            {"sqrt", c.sqrt}, {"rsqrt", c.rsqrt}, {"compare", c.compare}};
}

Json start(ReportHeader const& header)
{
    Json j;
    j["schema"] = "tessemu." + header.verb + "/1";
    j["tool"] = {{"name", "tessemu"}, {"version", tessemu_version()}};
    j["config"] = to_json(header.config);
    j["inputs"] = Json::array();
    for (auto const& [name, sha256] : header.inputs)
        j["inputs"].push_back({{"name", as_utf8(name)}, {"sha256", sha256}});
    j["warnings"] = Json::array();
    for (std::string const& w : header.warnings) j["warnings"].push_back(as_utf8(w));
    return j;
}

Json to_json(std::vector<StageStatistics> const& stages)
{
    Json out = Json::object();
    for (StageStatistics const& stage : stages) {
        Json fetches = Json::array();
        for (FetchStatistics const& f : stage.fetches)
            fetches.push_back({{"resource", f.resource},
                               {"kind", name_of(f.kind)},
                               {"count", f.count},
                               {"bytes", f.bytes},
                               {"unique_bytes", f.unique_bytes}});
        out[stage.stage] = {{"invocations", stage.invocations},
                            {"flops", to_json(stage.flops)},
                            {"flops_loop10", flops_loop10(stage.flops)},
                            {"fetches", fetches},
                            {"output_bytes", stage.output_bytes}};
    }
    return out;
}

void add_statistics(Json& j, DrawStatistics const& s)
{
    PipelineStatistics const& p = s.pipeline;
    j["counters"] = {{"IAVertices", p.IAVertices},
                     {"IAPrimitives", p.IAPrimitives},
                     {"VSInvocations", p.VSInvocations},
                     {"HSInvocations", p.HSInvocations},
                     {"DSInvocations", p.DSInvocations},
                     {"GSInvocations", p.GSInvocations},
                     {"GSPrimitives", p.GSPrimitives},
                     {"CInvocations", p.CInvocations},
                     {"CPrimitives", p.CPrimitives},
                     {"PSInvocations", p.PSInvocations},
                     {"CSInvocations", p.CSInvocations},
                     {"HSControlPointInvocations", p.HSControlPointInvocations},
                     {"HSPatchConstantInvocations", p.HSPatchConstantInvocations}};
    j["stages"] = to_json(s.stages);
}

void add_commands(Json& j, std::vector<CommandStatistics> const& commands)
{
    j["commands"] = Json::array();
    for (CommandStatistics const& c : commands)
        j["commands"].push_back({{"kind", c.kind},
                                 {"name", c.name},
                                 {"number", c.number},
                                 {"stages", to_json(c.statistics.stages)}});
}

// The hash covers everything but itself, the tool, the run and another program's testimony; then
// whatever `add_result` adds.
template <class AddResult>
std::string finish(Json j, ReportHeader const& header, AddResult const& add_result)
{
    Json hashed = j;
    hashed.erase("tool");
    hashed.erase("witness");
    std::string const compact = hashed.dump();
    Sha256 hash;
    hash.add(compact.data(), compact.size());
    add_result(hash);
    j["hash"] = hash.hex();
    j["run"] = to_json(header.run);
    return j.dump(2) + "\n";
}

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

Json pairs(std::vector<std::pair<std::size_t, std::size_t>> const& entries)
{
    Json j = Json::object();
    for (auto const& [key, n] : entries) j[std::to_string(key)] = n;
    return j;
}

} // namespace

namespace {
void add_targets(Sha256& hash, ColorTarget const& color, DepthTarget const& depth)
{
    for (int y = 0; y < color.height(); ++y) hash.add(color.texel(0, y), color.row_bytes());
    std::size_t const codes = std::size_t(depth.width()) * std::size_t(depth.samples());
    for (int y = 0; y < depth.height(); ++y)
        hash.add(depth.codes() + depth.index(0, y), codes * sizeof(std::uint32_t));
}

std::uint64_t fetched_bytes(DrawStatistics const& s)
{
    std::uint64_t n = 0;
    for (StageStatistics const& stage : s.stages)
        for (FetchStatistics const& f : stage.fetches) n += f.bytes;
    return n;
}
} // namespace

std::string draw_report(ReportHeader const& header, Frame const& frame)
{
    Json j = start(header);
    add_statistics(j, frame.statistics);
    add_commands(j, frame.commands);
    return finish(std::move(j), header,
                  [&](Sha256& hash) { add_targets(hash, frame.color, frame.depth); });
}

std::string sha256_of_targets(ColorTarget const& color, DepthTarget const& depth)
{
    Sha256 hash;
    add_targets(hash, color, depth);
    return hash.hex();
}

std::string sequence_report(ReportHeader const& header, std::vector<SequenceFrame> const& frames)
{
    Json j = start(header);
    j["frames"] = Json::array();
    for (SequenceFrame const& f : frames) {
        Json frame{{"phase", f.phase}, {"upload_bytes", f.upload_bytes}};
        frame["fetched_bytes"] = fetched_bytes(f.statistics.total);
        add_statistics(frame, f.statistics.total);
        add_commands(frame, f.statistics.commands);
        frame["target_sha256"] = f.target_sha256;
        j["frames"].push_back(std::move(frame));
    }
    return finish(std::move(j), header, [](Sha256&) {});
}

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
                           counted(p.PSInvocations), counted(fetched_bytes(f.statistics.total)));
    }
    return out;
}

std::string export_report(ReportHeader const& header, ListStatistics const& statistics,
                          MeshWriter const& mesh)
{
    Json j = start(header);
    j["mesh"] = {{"vertices", mesh.vertices()}, {"triangles", mesh.triangles()}};
    add_statistics(j, statistics.total);
    add_commands(j, statistics.commands);
    return finish(std::move(j), header, [&](Sha256& hash) { mesh.add_to_hash(hash); });
}

std::string subdivide_report(ReportHeader const& header, ListStatistics const& statistics,
                             std::vector<SubdivisionRow> const& steps, ControlMesh const& mesh,
                             Placement const& placement)
{
    Json j = start(header);
    j["mesh"] = {{"vertices", mesh.positions.size()}, {"faces", mesh.faces()}};
    add_statistics(j, statistics.total);
    add_commands(j, statistics.commands);
    j["steps"] = Json::array();
    for (SubdivisionRow const& s : steps) {
        Json kernels = Json::array();
        for (KernelRow const& k : s.kernels) {
            Json loops = Json::array();
            for (LoopRow const& l : k.loops)
                loops.push_back({{"threads_in_step", l.threads_in_step},
                                 {"turns_needed", l.needed},
                                 {"turns_run", l.run},
                                 {"lanes_lost", l.lost}});
            kernels.push_back({{"kernel", k.kernel},
                               {"threads", k.threads},
                               {"flops", to_json(k.flops)},
                               {"flops_loop10", flops_loop10(k.flops)},
                               {"index_fetches", k.index_fetches},
                               {"vertex_fetches", k.vertex_fetches},
                               {"fetched_bytes", k.fetched_bytes},
                               {"loops", loops}});
        }
        j["steps"].push_back({{"faces", s.faces},
                              {"edges", s.edges},
                              {"vertices", s.vertices},
                              {"kernels", kernels}});
    }
    return finish(std::move(j), header, [&](Sha256& hash) { add_to_hash(mesh, placement, hash); });
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

std::string info_report(ReportHeader const& header, MeshSummary const& s,
                        std::vector<PatchCount> const& patches)
{
    Json j = start(header);
    j["mesh"] = {{"vertices", s.vertices},
                 {"faces", s.faces},
                 {"edges", s.edges},
                 {"boundary_edges", s.boundary_edges},
                 {"components", s.components},
                 {"unused_vertices", s.unused_vertices},
                 {"regular_faces", s.regular_faces},
                 {"faces_by_size", pairs(s.faces_by_size)},
                 {"interior_valences", pairs(s.interior_valences)},
                 {"boundary_valences", pairs(s.boundary_valences)}};
    j["patches"] = Json::array();
    for (PatchCount const& c : patches) {
        Json kind{{"kind", c.kind.name},
                  {"patches", c.patches},
                  {"connectivity_types", c.types},
                  {"min_inputs", c.min_inputs},
                  {"max_inputs", c.max_inputs}};
        for (auto const& [type, n] : c.valence_types)
            kind["valence_types"].push_back({{"valences", type.valence}, {"patches", n}});
        j["patches"].push_back(std::move(kind));
    }
    return finish(std::move(j), header, [](Sha256&) {});
}

std::string compare_report(ReportHeader const& header, double diagonal,
                           std::vector<ErrorRow> const& rows)
{
    Json j = start(header);
    j["diagonal"] = diagonal;
    j["errors"] = Json::array();
    // Without samples there is no error, which is not an error of 0.
    auto const value = [](ErrorRow const& r, double x) { return r.samples ? Json(x) : Json(); };
    for (ErrorRow const& r : rows)
        j["errors"].push_back({{"quantity", r.quantity},
                               {"measure", r.measure},
                               {"unit", r.unit},
                               {"max", value(r, r.max)},
                               {"mean", value(r, r.mean)},
                               {"rms", value(r, r.rms)},
                               {"samples", r.samples}});
    return finish(std::move(j), header, [](Sha256&) {});
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

std::string diff_report(ReportHeader const& header, std::vector<ResultValue> const& values)
{
    Json j = start(header);
    j["values"] = values.size();
    j["differences"] = Json::array();
    auto const value = [](std::string const& text) {
        return text.empty() ? Json() : Json::parse(text);
    };
    for (ResultValue const& v : values)
        if (v.differs)
            j["differences"].push_back(
                {{"path", v.path}, {"a", value(v.a)}, {"b", value(v.b)}, {"relative", v.relative}});
    return finish(std::move(j), header, [](Sha256&) {});
}

namespace {

// Equal numbers have the ratio 1, zeros too.
double ratio_of(PaperRow const& r)
{
    return r.ours == r.paper ? 1 : r.ours / r.paper;
}

} // namespace

std::string paper_report(ReportHeader const& header, std::string const& title,
                         std::vector<PaperRow> const& rows, std::vector<std::string> const& remarks)
{
    Json j = start(header);
    j["title"] = title;
    j["cells"] = Json::array();
    for (PaperRow const& r : rows)
        j["cells"].push_back({{"row", r.row},
                              {"column", r.column},
                              {"paper", r.paper},
                              {"ours", r.ours},
                              {"ratio", to_json(ratio_of(r))}});
    j["remarks"] = remarks;
    return finish(std::move(j), header, [](Sha256&) {});
}

std::string paper_table(std::string const& title, std::vector<PaperRow> const& rows,
                        std::vector<std::string> const& remarks)
{
    std::string out = fmt::format("{}\n\n{:<38} {:<46} {:>9} {:>9} {:>6}\n", title, "", "", "paper",
                                  "ours", "ratio");
    std::string row;
    for (PaperRow const& r : rows) {
        out += fmt::format("{:<38} {:<46} {:>9.4g} {:>9.4g} {:>6.2f}\n", r.row == row ? "" : r.row,
                           r.column, r.paper, r.ours, ratio_of(r));
        row = r.row;
    }
    for (std::string const& remark : remarks) out += "\n" + remark + "\n";
    return out;
}

std::string check_report(ReportHeader const& header, std::vector<VerdictRow> const& verdicts)
{
    Json j = start(header);
    j["verdicts"] = Json::object();
    auto const hex = [](std::uint32_t bits) { return fmt::format("0x{:08x}", bits); };
    for (VerdictRow const& v : verdicts) {
        j["verdicts"][v.name] = Json{{"verdict", v.verdict}};
        Json& out = v.witness ? j["witness"][v.name] : j["verdicts"][v.name];
        if (!v.reason.empty()) out["reason"] = v.reason;
        out["checked"] = v.checked;
        out["failures"] = v.failures;
        out["sites"] = Json::array();
        for (VerdictSite const& s : v.sites) {
            Json site;
            if (s.pixel[0] >= 0) site["pixel"] = {s.pixel[0], s.pixel[1]};
            if (s.component >= 0 || s.vertex[0] != s.vertex[1]) {
                site["faces"] = {s.face[0] + 1, s.face[1] + 1};
                site["vertices"] = {s.vertex[0] + 1, s.vertex[1] + 1};
                site["t"] = s.t / 65536.0;
                if (!s.edge.empty()) site["edge"] = s.edge;
            }
            if (s.component >= 0) {
                site["component"] = std::string(1, "xyz"[s.component]);
                site["bits"] = {hex(s.bits[0]), hex(s.bits[1])};
                site["ulp"] = s.ulp;
            }
            site["text"] = s.text;
            out["sites"].push_back(std::move(site));
        }
    }
    return finish(std::move(j), header, [](Sha256&) {});
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

std::string cost_report(ReportHeader const& header, CostSummary const& c)
{
    Json j = start(header);
    j["gpu"] = c.gpu;
    j["sources"] = Json::object();
    for (auto const& [number, source] : c.sources) j["sources"][number] = source;
    j["stages"] = Json::array();
    for (CostRow const& r : c.rows)
        j["stages"].push_back({{"stage", r.stage},
                               {"seconds", r.seconds},
                               {"bound", r.bound},
                               {"arithmetic_seconds", r.arithmetic},
                               {"fetch_seconds", r.fetch},
                               {"memory_seconds", r.memory},
                               {"fixed_function_seconds", r.fixed},
                               {"operations", r.operations},
                               {"fetches", r.fetches},
                               {"fetched_bytes", r.fetched_bytes},
                               {"memory_bytes", r.memory_bytes}});
    j["overhead_seconds"] = c.overhead;
    j["shader_seconds"] = c.shaders;
    j["seconds"] = c.seconds;
    j["bound"] = c.bound;
    return finish(std::move(j), header, [](Sha256&) {});
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

std::string tessellate_report(ReportHeader const& header, TessellatorCase const& c,
                              TessellatedPatch const& patch)
{
    Json j = start(header);
    j["case"] = format_tessellator_case(c);
    j["points"] = patch.points();
    j["u"] = patch.u;
    j["v"] = patch.v;
    j["indices"] = patch.indices;
    return finish(std::move(j), header, [](Sha256&) {});
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
    out += fmt::format(
        "\n{} patches, {} domain points, {} triangles, {} after clipping, {} pixels shaded\n",
        counted(p.HSInvocations), counted(p.DSInvocations), counted(p.CInvocations),
        counted(p.CPrimitives), counted(p.PSInvocations));
    return out;
}

namespace {

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

} // namespace

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
