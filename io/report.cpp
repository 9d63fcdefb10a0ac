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
    if (!header.levels.empty()) j["levels"] = header.levels;
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

} // namespace

std::uint64_t SequenceFrame::fetched_bytes() const
{
    std::uint64_t n = 0;
    for (StageStatistics const& stage : statistics.total.stages)
        for (FetchStatistics const& f : stage.fetches) n += f.bytes;
    return n;
}

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
        frame["fetched_bytes"] = f.fetched_bytes();
        add_statistics(frame, f.statistics.total);
        add_commands(frame, f.statistics.commands);
        frame["target_sha256"] = f.target_sha256;
        j["frames"].push_back(std::move(frame));
    }
    return finish(std::move(j), header, [](Sha256&) {});
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

std::string tables_report(ReportHeader const& header, std::vector<TableSetRow> const& sets)
{
    Json j = start(header);
    j["sets"] = Json::array();
    for (TableSetRow const& row : sets) {
        Json families = Json::array();
        for (TableSet::Family const& f : row.set.families)
            families.push_back({{"family", in_words(f.family)},
                                {"types", f.types},
                                {"tables", f.tables},
                                {"tables_but_2_faces", f.tables_but_2},
                                {"bytes", f.bytes()}});
        SymmetryReport const& r = row.set.symmetry;
        auto const classes = [](SymmetryReport::Classes const& c) {
            return Json{{"table_edges", c.table_edges},
                        {"directed", c.directed},
                        {"undirected", c.undirected}};
        };
        j["sets"].push_back({{"rules", row.rules},
                             {"families", families},
                             {"symmetry",
                              {{"joints", r.joints},
                               {"off_corner", classes(r.off_corner)},
                               {"off_corner_at_a_tag", classes(r.off_corner_at_a_tag)},
                               {"on_corner", classes(r.on_corner)},
                               {"two_ring", classes(r.two_ring)},
                               {"entries", r.entries},
                               {"changed", r.changed},
                               {"zeroed", r.zeroed},
                               {"changed_ulps", r.changed_ulps},
                               {"most_ulps", r.most_ulps},
                               {"passes", r.passes}}}});
    }
    return finish(std::move(j), header, [](Sha256&) {});
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
                              {"ratio", to_json(r.ratio())}});
    j["remarks"] = remarks;
    return finish(std::move(j), header, [](Sha256&) {});
}

std::string plots_report(ReportHeader const& header, std::string const& title,
                         PlotSheet const& sheet, std::vector<ClaimRow> const& claims,
                         std::vector<std::string> const& remarks, NumberTable const& table)
{
    Json j = start(header);
    j["title"] = title;
    j["x"] = sheet.x.name;
    j["y"] = sheet.y.name;
    j["plots"] = Json::array();
    for (Plot const& panel : sheet.panels) {
        Json plot{{"title", panel.title}, {"curves", Json::array()}};
        for (PlotSeries const& s : panel.series) {
            Json curve{{"name", s.name}, {"points", Json::array()}};
            for (PlotPoint const& p : s.points)
                curve["points"].push_back({{"x", p.x}, {"y", p.y}, {"bound", p.label}});
            plot["curves"].push_back(std::move(curve));
        }
        j["plots"].push_back(std::move(plot));
    }
    j["claims"] = Json::array();
    for (ClaimRow const& c : claims)
        j["claims"].push_back({{"letter", c.letter},
                               {"claim", c.claim},
                               {"verdict", c.verdict},
                               {"criterion", c.criterion},
                               {"ours", c.ours},
                               {"bound", c.bound},
                               {"other_readings", c.other_readings}});
    for (NumberTable::Row const& r : table.rows) {
        Json row{{table.name, r.name}};
        for (std::size_t i = 0; i < table.columns.size(); ++i)
            if (!std::isnan(r.numbers[i])) row[table.columns[i]] = r.numbers[i];
        row[table.note] = r.note;
        j["table"].push_back(std::move(row));
    }
    j["remarks"] = remarks;
    return finish(std::move(j), header, [](Sha256&) {});
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

} // namespace tessemu
