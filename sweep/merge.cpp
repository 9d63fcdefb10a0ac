// SPDX-License-Identifier: Apache-2.0
#include "sweep/merge.h"

#include "sweep/results.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <unordered_map>

namespace tessemu {

using Json = nlohmann::ordered_json;

namespace {

// What a figure is called, and what it is, by the last key of its path in a result.
struct Leaf {
    char const *key, *unit, *suffix, *meaning;
};
constexpr Leaf kLeaves[] = {
    {"invocations", "count", "invocations_count", "runs of the stage"},
    {"add", "count", "add_count", "additions and subtractions"},
    {"mul", "count", "mul_count", "multiplications"},
    {"mad", "count", "mad_count", "multiply-adds"},
    {"div", "count", "div_count", "divisions"},
    {"sqrt", "count", "sqrt_count", "square roots"},
    {"rsqrt", "count", "rsqrt_count", "reciprocal square roots"},
    {"compare", "count", "compare_count", "comparisons, minima and maxima"},
    {"flops_loop10", "count", "flops_loop10_count",
     "multiplications, multiply-adds and divisions, as LOOP10 counts"},
    {"count", "count", "fetches_count", "fetches"},
    {"bytes", "bytes", "fetched_bytes", "bytes of all fetches"},
    {"unique_bytes", "bytes", "unique_bytes", "bytes fetched, each element once a draw"},
    {"missed_bytes", "bytes", "missed_bytes", "bytes that missed the modelled cache"},
    {"output_bytes", "bytes", "output_bytes", "bytes written"},
    {"seconds", "seconds", "seconds", "predicted time"},
    {"arithmetic_seconds", "seconds", "arithmetic_seconds", "predicted time of arithmetic alone"},
    {"fetch_seconds", "seconds", "fetch_seconds", "predicted time of fetches alone"},
    {"memory_seconds", "seconds", "memory_seconds", "predicted time of memory traffic alone"},
    {"fixed_function_seconds", "seconds", "fixed_function_seconds",
     "predicted time of fixed function alone"},
    {"overhead_seconds", "seconds", "overhead_seconds", "time of a frame before any stage"},
    {"shader_seconds", "seconds", "shader_seconds", "predicted time of the shader cores"},
    {"operations", "count", "operations_count", "operations, as the GPU counts"},
    {"fetches", "count", "fetches_count", "fetches, as the GPU counts"},
    {"fetched_bytes", "bytes", "fetched_bytes", "bytes of all fetches"},
    {"memory_bytes", "bytes", "memory_bytes", "bytes from and to memory"},
    {"samples", "count", "samples_count", "points that were compared"},
    {"checked", "count", "checked_count", "things that were checked"},
    {"failures", "count", "failures_count", "things that failed"},
    {"verdict", "text", "verdict", "pass, fail or skipped"},
    {"bound", "text", "bound", "what bounds the time"},
    {"diagonal", "length", "diagonal_length", "the model's diagonal in its own unit of length"},
    {"hash", "text", "hash", "SHA-256 of the result and of what it made"},
    {"samples_passed", "count", "samples_passed_count", "samples that passed depth and stencil"},
};

std::string slug(std::string_view text)
{
    std::string out;
    for (char const c : text) {
        bool const word =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (word)
            out += c;
        else if (!out.empty() && out.back() != '_')
            out += '_';
    }
    while (out.ends_with('_')) out.pop_back();
    return out;
}

// Cells of results become columns as they are met.
class Table {
public:
    SweepTable out;

    std::size_t column(SweepTable::Column column)
    {
        auto const [at, fresh] = number_.try_emplace(column.name, out.columns.size());
        if (fresh) out.columns.push_back(std::move(column));
        return at->second;
    }
    void set(SweepTable::Column const& c, SweepTable::Cell cell)
    {
        std::size_t const i = column(c);
        auto& row = out.rows.back();
        if (row.size() <= i) row.resize(i + 1);
        row[i] = std::move(cell);
    }
    void finish()
    {
        for (auto& row : out.rows) row.resize(out.columns.size());
    }

private:
    std::unordered_map<std::string, std::size_t> number_;
};

SweepTable::Cell to_cell(Json const& j)
{
    if (j.is_number_float()) return j.get<double>();
    if (j.is_number()) return j.get<std::int64_t>();
    if (j.is_string()) return j.get<std::string>();
    return j.dump();
}

class ResultColumns {
public:
    explicit ResultColumns(Table& table) : table_(table) {}

    void add(Json const& result)
    {
        for (auto const& [key, value] : result.items()) {
            if (key == "counters") {
                for (auto const& [counter, n] : value.items())
                    table_.set(
                        {counter + "_count", "count", "Direct3D's pipeline statistic " + counter},
                        to_cell(n));
            } else if (key == "stages") {
                stages(value);
            } else if (key == "warnings") {
                std::vector<std::string> const texts = value;
                table_.set({"warnings", "text", "of the case"},
                           texts.empty() ? SweepTable::Cell()
                                         : fmt::format("{}", fmt::join(texts, "; ")));
            } else if (key == "verdicts") {
                bool fails = false;
                for (auto const& [name, v] : value.items())
                    fails = fails || v.value("verdict", "") == "fail";
                table_.set({"verdict", "text", "fail where one of the checks fails, else pass"},
                           std::string(fails ? "fail" : "pass"));
                for (auto const& [name, v] : value.items()) leaves(name, "check of " + name, v);
            } else if (key == "errors") {
                for (Json const& e : value) error(e);
            } else {
                leaf("", "", key, value);
            }
        }
    }

private:
    // An object by stage, or a list with the stage's name in each.
    void stages(Json const& stages)
    {
        if (stages.is_object())
            for (auto const& [name, s] : stages.items()) stage(name, s);
        else
            for (Json const& s : stages) stage(s.value("stage", "stage"), s);
    }
    void stage(std::string const& name, Json const& s)
    {
        std::string const of = slug(name);
        leaves(of, name, s);
        if (s.contains("flops")) leaves(of, name, s["flops"]);
        if (!s.contains("fetches") || !s["fetches"].is_array()) return;
        std::map<std::string, std::int64_t> sums;
        for (Json const& f : s["fetches"]) {
            std::string const resource = f.value("resource", "resource");
            leaves(of + "_" + slug(resource), name + ", of " + resource, f);
            for (char const* key : {"count", "bytes", "unique_bytes"})
                sums[key] += f.value(key, std::int64_t(0));
        }
        for (auto const& [key, n] : sums) leaf(of, name + ", of all resources", key, n);
    }
    void leaves(std::string const& prefix, std::string const& of, Json const& object)
    {
        for (auto const& [key, value] : object.items()) leaf(prefix, of, key, value);
    }
    // What has no entry among the leaves is no figure: names, lists, sources.
    void leaf(std::string const& prefix, std::string const& of, std::string const& key,
              Json const& value)
    {
        if (value.is_object() || value.is_array()) return;
        for (Leaf const& l : kLeaves)
            if (key == l.key)
                table_.set({prefix.empty() ? l.suffix : prefix + "_" + l.suffix, l.unit,
                            of.empty() ? l.meaning : of + ": " + l.meaning},
                           to_cell(value));
    }
    void error(Json const& e)
    {
        std::string const quantity = e.value("quantity", ""), measure = e.value("measure", ""),
                          prefix = slug(quantity) + "_" + slug(measure);
        std::string unit = e.value("unit", "");
        if (unit == "diagonal") unit = "diagonals";
        for (char const* key : {"max", "mean", "rms"})
            if (e.contains(key))
                table_.set({prefix + "_" + key + "_" + unit, unit,
                            std::string(key) + " error of the " + quantity + ", " + measure},
                           to_cell(e[key]));
        leaf(prefix, quantity + ", " + measure, "samples", e.value("samples", Json()));
    }

    Table& table_;
};

// Its name, with the beginning of its hash where another input has the same.
std::string told_apart(SweepManifest const& m, SweepInput const& input)
{
    auto const same = std::count_if(m.inputs.begin(), m.inputs.end(),
                                    [&](SweepInput const& i) { return i.name == input.name; });
    return same > 1 ? input.name + " " + input.sha256.substr(0, 8) : input.name;
}

std::string joined(std::vector<std::string> const& texts)
{
    return fmt::format("{}", fmt::join(texts, " "));
}

// Numbers as numbers, for who plots by them.
SweepTable::Cell option_cell(std::string const& text)
{
    auto const read = [&](auto& x) {
        auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
        return error == std::errc() && end == text.data() + text.size();
    };
    if (std::int64_t i = 0; read(i)) return i;
    if (double x = 0; read(x) && std::isfinite(x)) return x;
    return text.empty() ? SweepTable::Cell() : SweepTable::Cell(text);
}

std::string to_text(SweepTable::Cell const& cell)
{
    return std::visit(
        [](auto const& v) -> std::string {
            using V = std::decay_t<decltype(v)>;
            if constexpr (std::is_same_v<V, std::monostate>)
                return "";
            else if constexpr (std::is_same_v<V, std::string>)
                return v;
            else
                return fmt::format("{}", v);
        },
        cell);
}

std::string csv_field(std::string const& text)
{
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (char const c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

} // namespace

SweepMerge merge_sweep(SweepManifest const& manifest, std::filesystem::path const& folder)
{
    // Where a case was computed twice, both results are the same; a later success replaces a failure.
    std::unordered_map<std::string, CaseRecord> records;
    ResultReader(folder / "results").read([&](CaseRecord const& r) {
        auto const [at, fresh] = records.try_emplace(r.id, r);
        if (!fresh && !at->second.done) at->second = r;
    });
    SweepMerge out;
    Table table;
    ResultColumns results(table);
    std::vector<std::string> options; // that any case gives
    for (SweepCase const& c : manifest.cases)
        for (auto const& [name, texts] : c.options)
            if (std::find(options.begin(), options.end(), name) == options.end())
                options.push_back(name);
    std::sort(options.begin(), options.end(), [](std::string const& a, std::string const& b) {
        return std::pair(option_rank(a), a) < std::pair(option_rank(b), b);
    });
    for (std::size_t i = 0; i < manifest.cases.size(); ++i) {
        SweepCase const& c = manifest.cases[i];
        table.out.rows.emplace_back();
        table.set({"case", "number", "place in the manifest, from 1"}, std::int64_t(i + 1));
        table.set({"id", "text", "SHA-256 of options, inputs and version"}, c.id);
        auto const found = records.find(c.id);
        table.set({"verb", "text", "the program's"}, manifest.verb);
        table.set({"version", "text", "of the program"}, manifest.version);
        bool const there = found != records.end(), done = there && found->second.done;
        table.set({"status", "text", "done, failed or missing"}, std::string(done    ? "done"
                                                                             : there ? "failed"
                                                                                     : "missing"));
        table.set({"message", "text", "why the case failed"},
                  there && !done ? SweepTable::Cell(found->second.text) : SweepTable::Cell());
        CaseOptions const resolved = manifest.resolved(c);
        for (std::string const& o : options) {
            auto const own = resolved.find(o);
            std::string text = own == resolved.end() ? "" : joined(own->second);
            if (SweepInput const* const input = manifest.input(text))
                text = told_apart(manifest, *input);
            table.set({slug(o), "option", o == "model" ? "the model" : "option --" + o},
                      option_cell(text));
        }
        if (done) {
            ++out.done;
            Json const result = Json::parse(found->second.text, nullptr, false);
            if (!result.is_object())
                throw FormatError((folder / "results").string(), 0,
                                  "the result of case " + c.id + " is damaged");
            results.add(result);
        } else if (there) {
            ++out.failed;
            if (out.first_failure.empty())
                out.first_failure = fmt::format("case {}: {}", i + 1, found->second.text);
        } else {
            ++out.missing;
        }
    }
    table.finish();
    out.table = std::move(table.out);
    return out;
}

TableFormat table_format(std::filesystem::path const& path, std::string const& option)
{
    std::string const extension = extension_of(path);
    if (extension == "csv") return TableFormat::Csv;
    if (extension == "json") return TableFormat::Json;
    if (extension == "sqlite") return TableFormat::Sqlite;
    throw Error(option + " is '" + path.string() +
                "', its name must end in .csv, .json or .sqlite");
}

std::string csv_of(SweepTable const& t)
{
    std::string out;
    for (std::size_t i = 0; i < t.columns.size(); ++i)
        out += (i ? "," : "") + csv_field(t.columns[i].name);
    out += "\r\n";
    for (auto const& row : t.rows) {
        for (std::size_t i = 0; i < row.size(); ++i)
            out += (i ? "," : "") + csv_field(to_text(row[i]));
        out += "\r\n";
    }
    return out;
}

std::string json_of(SweepTable const& t)
{
    Json columns = Json::array();
    for (SweepTable::Column const& c : t.columns)
        columns.push_back({{"name", c.name}, {"unit", c.unit}, {"meaning", c.meaning}});
    std::string out = "{\n\"schema\": \"tessemu.sweep_table/1\",\n\"columns\": " + columns.dump(1) +
                      ",\n\"rows\": [";
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        Json row = Json::array();
        for (SweepTable::Cell const& cell : t.rows[i])
            std::visit(
                [&](auto const& v) {
                    if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
                        row.push_back(nullptr);
                    else
                        row.push_back(v);
                },
                cell);
        out += (i ? ",\n" : "\n") + row.dump();
    }
    return out + "\n]\n}\n";
}

std::string dictionary_csv_of(SweepTable const& t)
{
    std::string out = "name,unit,meaning\r\n";
    for (SweepTable::Column const& c : t.columns)
        out += csv_field(c.name) + "," + csv_field(c.unit) + "," + csv_field(c.meaning) + "\r\n";
    return out;
}

} // namespace tessemu
