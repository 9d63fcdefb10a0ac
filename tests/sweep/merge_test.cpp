// SPDX-License-Identifier: Apache-2.0
#include "sweep/merge.h"

#include "sweep/results.h"
#include "tests/sweep/toy_sweep.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sqlite3.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <set>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Results as the verbs make them, each kind of figure once.
constexpr char const* kDraw = R"({"schema":"tessemu.draw/1","config":{"tess":1},
  "counters":{"VSInvocations":53,"DSInvocations":9007199254740993},
  "stages":[{"stage":"domain shader","invocations":12,"flops":{"add":3,"mul":4},
             "fetches":[{"resource":"patch constants","count":2,"bytes":32,"unique_bytes":16},
                        {"resource":"control points","count":5,"bytes":80,"unique_bytes":48}]}],
  "hash":"00ff"})";
constexpr char const* kCost = R"({"stages":{"hull_shader":{"seconds":1e-7,"bound":"arithmetic",
  "operations":120,"fetched_bytes":64}},"overhead_seconds":0.1,"seconds":0.30000000000000004})";
constexpr char const* kCompare = R"({"diagonal":2.5,"errors":[
  {"quantity":"position","measure":"equal parameter","unit":"diagonal","max":0.5,"mean":0.125,
   "rms":0.25,"samples":630},
  {"quantity":"normal","measure":"equal parameter","unit":"radians","max":1,"mean":0.1,"rms":0.2,
   "samples":630}]})";
constexpr char const* kCheck = R"({"verdicts":{"position":{"verdict":"fail","checked":10,
  "failures":2,"sites":[{"text":"x"}]},"raycast":{"verdict":"skipped","reason":"no rays"}}})";

// Six cases: four done, one failed, one missing.
struct Merged {
    test::Planned sweep{6};
    std::vector<CaseRecord> records;

    Merged()
    {
        std::size_t i = 0;
        for (char const* text : {kDraw, kCost, kCompare, kCheck})
            records.push_back({sweep.manifest.cases[i++].id, true, Json::parse(text).dump()});
        records.push_back({sweep.manifest.cases[4].id, false, "a \"b\", c\nd \xc3\xa9"});
    }
    /// Its records, as numbers from 0, in these files.
    void write(std::vector<std::vector<std::size_t>> const& files) const
    {
        fs::path const folder = sweep.folder / "results";
        fs::remove_all(folder);
        fs::create_directory(folder);
        for (std::size_t f = 0; f < files.size(); ++f) {
            for (std::size_t i : files[f]) ResultLog(folder).add(records[i]);
            std::string all;
            for (auto const& e : fs::directory_iterator(folder))
                if (e.path().filename().string().size() > 10) {
                    all += test::read_text(e.path());
                    fs::remove(e.path());
                }
            std::ofstream(folder / fmt::format("{}.jsonl", f), std::ios::binary) << all;
        }
    }
    SweepMerge merge() const { return merge_sweep(sweep.manifest, sweep.folder); }
};

std::size_t column(SweepTable const& t, std::string const& name)
{
    for (std::size_t i = 0; i < t.columns.size(); ++i)
        if (t.columns[i].name == name) return i;
    ADD_FAILURE() << "no column " << name;
    return 0;
}

SweepTable::Cell cell(SweepTable const& t, std::size_t row, std::string const& name)
{
    return t.rows.at(row).at(column(t, name));
}

using Int = std::int64_t;

TEST(SweepMerge, EachFigureIsAColumn)
{
    Merged m;
    m.write({{0, 1, 2, 3, 4}});
    SweepTable const t = m.merge().table;
    auto const is = [&](std::size_t row, std::string const& name, SweepTable::Cell const& value) {
        EXPECT_EQ(cell(t, row, name), value) << name;
    };
    is(0, "case", Int(1));
    is(0, "id", m.sweep.manifest.cases[0].id);
    is(0, "model", "jug");
    is(3, "samples", Int(4));
    is(0, "VSInvocations_count", Int(53));
    is(0, "DSInvocations_count", Int(9007199254740993));
    is(0, "domain_shader_invocations_count", Int(12));
    is(0, "domain_shader_add_count", Int(3));
    is(0, "domain_shader_mul_count", Int(4));
    is(0, "domain_shader_patch_constants_fetches_count", Int(2));
    is(0, "domain_shader_patch_constants_fetched_bytes", Int(32));
    is(0, "domain_shader_control_points_unique_bytes", Int(48));
    is(0, "domain_shader_fetches_count", Int(7));
    is(0, "domain_shader_fetched_bytes", Int(112));
    is(0, "domain_shader_unique_bytes", Int(64));
    is(0, "hash", "00ff");
    is(1, "hull_shader_seconds", 1e-7);
    is(1, "hull_shader_bound", "arithmetic");
    is(1, "hull_shader_operations_count", Int(120));
    is(1, "hull_shader_fetched_bytes", Int(64));
    is(1, "overhead_seconds", 0.1);
    is(1, "seconds", 0.1 + 0.2);
    is(2, "diagonal_length", 2.5);
    is(2, "position_equal_parameter_max_diagonals", 0.5);
    is(2, "position_equal_parameter_mean_diagonals", 0.125);
    is(2, "position_equal_parameter_rms_diagonals", 0.25);
    is(2, "position_equal_parameter_samples_count", Int(630));
    is(2, "normal_equal_parameter_rms_radians", 0.2);
    is(3, "position_verdict", "fail");
    is(3, "position_checked_count", Int(10));
    is(3, "position_failures_count", Int(2));
    is(3, "raycast_verdict", "skipped");
    is(0, "seconds", {}); // the case has none
}

TEST(SweepMerge, RowsAreTheManifestsCasesMissingAndFailedOnesToo)
{
    Merged m;
    m.write({{4, 2, 0}, {1, 3}});
    SweepMerge const merged = m.merge();
    SweepTable const& t = merged.table;
    EXPECT_EQ(merged.done, 4u);
    EXPECT_EQ(merged.failed, 1u);
    EXPECT_EQ(merged.missing, 1u);
    EXPECT_EQ(merged.first_failure, "case 5: a \"b\", c\nd \xc3\xa9");
    ASSERT_EQ(t.rows.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(t.rows[i].size(), t.columns.size());
        EXPECT_EQ(cell(t, i, "id"), SweepTable::Cell(m.sweep.manifest.cases[i].id));
        EXPECT_EQ(cell(t, i, "samples"), SweepTable::Cell(Int(i + 1)));
        EXPECT_EQ(cell(t, i, "status"), SweepTable::Cell(i < 4    ? "done"
                                                         : i == 4 ? "failed"
                                                                  : "missing"));
        EXPECT_EQ(cell(t, i, "message"),
                  i == 4 ? SweepTable::Cell("a \"b\", c\nd \xc3\xa9") : SweepTable::Cell());
    }
}

TEST(SweepMerge, NeitherTheOrderOfResultsNorTheirFilesNorTheirNumberChangesABit)
{
    Merged m;
    std::string csv, json, sqlite, dictionary;
    for (auto const& files : std::vector<std::vector<std::vector<std::size_t>>>{
             {{0, 1, 2, 3, 4}},
             {{4, 3, 2, 1, 0}},
             {{3}, {1}, {4}, {0}, {2}},
             {{2, 0}, {}, {4, 1, 3}},
             {{0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}, {4, 4, 0}}}) {
        m.write(files);
        SweepTable const t = m.merge().table;
        if (csv.empty()) {
            csv = csv_of(t);
            json = json_of(t);
            sqlite = sqlite_of(t);
            dictionary = dictionary_csv_of(t);
        }
        EXPECT_EQ(csv_of(t), csv);
        EXPECT_EQ(json_of(t), json);
        EXPECT_TRUE(sqlite_of(t) == sqlite);
        EXPECT_EQ(dictionary_csv_of(t), dictionary);
    }
}

TEST(SweepMerge, ASuccessReplacesAFailureWhicheverIsReadFirst)
{
    Merged m;
    m.records.push_back({m.records[4].id, true, R"({"seconds":1})"});
    for (auto const& files : std::vector<std::vector<std::vector<std::size_t>>>{
             {{4, 5}}, {{5, 4}}, {{4}, {5}}, {{5}, {4}}}) {
        m.write(files);
        SweepMerge const merged = m.merge();
        EXPECT_EQ(merged.failed, 0u);
        EXPECT_EQ(cell(merged.table, 4, "status"), SweepTable::Cell("done"));
        EXPECT_EQ(cell(merged.table, 4, "message"), SweepTable::Cell());
        EXPECT_EQ(cell(merged.table, 4, "seconds"), SweepTable::Cell(Int(1)));
    }
}

TEST(SweepMerge, OptionsAreColumnsAsTheCaseHasThem)
{
    std::string const text = R"({"verb": "toy", "models": ["x/a.obj", "7"], "tess": [1, 2.5, "1e3"],
        "cases": [{"model": "jug", "quick": true, "set": ["x=1", "y"]}]})";
    auto verb = test::toy_verb();
    verb.check = [](auto&&...) {};
    Sweep const sweep = read_sweep(text, "toy.json", [&](auto&&) { return verb; });
    SweepPlan const plan = plan_sweep(sweep, verb, "1",
                                      [](std::string const&, std::string const& word)
                                          -> std::optional<std::pair<std::string, std::string>> {
                                          if (word == "x/a.obj") return std::pair("a.obj", "mesh");
                                          return {};
                                      });
    fs::path const folder = test::scratch() / "sweep";
    write_plan(plan, folder, text);
    SweepTable const t = merge_sweep(read_manifest(folder), folder).table;
    EXPECT_TRUE(
        csv_of(t).starts_with("case,id,verb,version,status,message,model,quick,set,tess\r\n1," +
                              plan.manifest.cases[0].id + ",toy,1,"));
    EXPECT_EQ(cell(t, 0, "model"), SweepTable::Cell("a.obj"));
    EXPECT_EQ(cell(t, 0, "tess"), SweepTable::Cell(Int(1)));
    EXPECT_EQ(cell(t, 1, "tess"), SweepTable::Cell(2.5));
    EXPECT_EQ(cell(t, 2, "tess"), SweepTable::Cell(1000.0));
    EXPECT_EQ(cell(t, 0, "quick"), SweepTable::Cell("false")) << "by default";
    EXPECT_EQ(cell(t, 0, "set"), SweepTable::Cell());
    EXPECT_EQ(cell(t, 6, "quick"), SweepTable::Cell("true"));
    EXPECT_EQ(cell(t, 6, "set"), SweepTable::Cell("x=1 y"));
    EXPECT_EQ(cell(t, 6, "tess"), SweepTable::Cell());
}

// A table of everything that is awkward.
SweepTable awkward()
{
    return {{{"a", "text", "a, \"b\""}, {"b_count", "count", "n"}, {"c_seconds", "seconds", "t"}},
            {{"plain", Int(-3), 0.1},
             {"a,b", Int(9007199254740993), 5e-324},
             {"say \"no\"", {}, 1.7976931348623157e308},
             {"two\nlines", Int(0), -0.0},
             {"\r", INT64_MIN, 1.0 / 3},
             {"\xc3\xa9 ", INT64_MAX, 1e21},
             {{}, {}, {}}}};
}

TEST(SweepTables, CsvIsRfc4180)
{
    EXPECT_EQ(csv_of(awkward()), "a,b_count,c_seconds\r\n"
                                 "plain,-3,0.1\r\n"
                                 "\"a,b\",9007199254740993,5e-324\r\n"
                                 "\"say \"\"no\"\"\",,1.7976931348623157e+308\r\n"
                                 "\"two\nlines\",0,-0\r\n"
                                 "\"\r\",-9223372036854775808,0.3333333333333333\r\n"
                                 "\xc3\xa9 ,9223372036854775807,1e+21\r\n"
                                 ",,\r\n");
    EXPECT_EQ(dictionary_csv_of(awkward()), "name,unit,meaning\r\n"
                                            "a,text,\"a, \"\"b\"\"\"\r\n"
                                            "b_count,count,n\r\n"
                                            "c_seconds,seconds,t\r\n");
}

std::uint64_t bits(double x)
{
    std::uint64_t out = 0;
    std::memcpy(&out, &x, sizeof x);
    return out;
}

// Doubles of all magnitudes.
std::vector<double> doubles()
{
    std::vector<double> out{0.0,  -0.0, 1,    1e15,   1e16,
                            1e17, 1e22, 1e23, 5e-324, 1.7976931348623157e308};
    std::uint64_t state = 1;
    while (out.size() < 2000) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        double x = 0;
        std::memcpy(&x, &state, sizeof x);
        if (std::isfinite(x)) out.push_back(x);
    }
    return out;
}

SweepTable table_of(std::vector<double> const& values)
{
    SweepTable t{{{"x_seconds", "seconds", "x"}}, {}};
    for (double x : values) t.rows.push_back({x});
    return t;
}

TEST(SweepTables, NumbersReadBackTheSame)
{
    std::vector<double> const values = doubles();
    std::string const csv = csv_of(table_of(values));
    Json const json = Json::parse(json_of(table_of(values)));
    char const* at = csv.data() + csv.find('\n') + 1;
    for (std::size_t i = 0; i < values.size(); ++i) {
        double x = 1;
        at = std::from_chars(at, csv.data() + csv.size(), x).ptr + 2;
        EXPECT_EQ(bits(x), bits(values[i]));
        EXPECT_EQ(bits(json["rows"][i][0].get<double>()), bits(values[i]));
    }
    EXPECT_EQ(at, csv.data() + csv.size());
}

TEST(SweepTables, JsonHasColumnsAndRows)
{
    Json const j = Json::parse(json_of(awkward()));
    EXPECT_EQ(j["schema"], "tessemu.sweep_table/1");
    EXPECT_EQ(j["columns"][0].dump(), R"({"name":"a","unit":"text","meaning":"a, \"b\""})");
    EXPECT_EQ(j["columns"].size(), 3u);
    EXPECT_EQ(j["rows"].size(), 7u);
    EXPECT_EQ(j["rows"][1].dump(), R"(["a,b",9007199254740993,5e-324])");
    EXPECT_EQ(j["rows"][2].dump(), R"(["say \"no\"",null,1.7976931348623157e+308])");
    EXPECT_EQ(j["rows"][6].dump(), "[null,null,null]");
    EXPECT_EQ(Json::parse(json_of({})).at("rows").size(), 0u);
}

// Rows of a query, as cells.
std::vector<std::vector<SweepTable::Cell>> query(std::string const& bytes, std::string const& sql)
{
    fs::path const path = test::scratch() / "t.sqlite";
    std::ofstream(path, std::ios::binary) << bytes;
    sqlite3* db = nullptr;
    sqlite3_stmt* s = nullptr;
    std::vector<std::vector<SweepTable::Cell>> out;
    EXPECT_EQ(sqlite3_open_v2(path.c_str(), &db, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
    EXPECT_EQ(sqlite3_prepare_v2(db, sql.c_str(), -1, &s, nullptr), SQLITE_OK)
        << sqlite3_errmsg(db);
    while (sqlite3_step(s) == SQLITE_ROW) {
        auto& row = out.emplace_back();
        for (int i = 0; i < sqlite3_column_count(s); ++i) switch (sqlite3_column_type(s, i)) {
            case SQLITE_INTEGER:
                row.emplace_back(Int(sqlite3_column_int64(s, i)));
                break;
            case SQLITE_FLOAT:
                row.emplace_back(sqlite3_column_double(s, i));
                break;
            case SQLITE_TEXT:
                row.emplace_back(
                    std::string(reinterpret_cast<char const*>(sqlite3_column_text(s, i)),
                                std::size_t(sqlite3_column_bytes(s, i))));
                break;
            default:
                row.emplace_back();
            }
    }
    sqlite3_finalize(s);
    sqlite3_close(db);
    return out;
}

TEST(SweepTables, SqliteHasTheSameRowsAndTheDictionary)
{
    EXPECT_EQ(query(sqlite_of(awkward()), "SELECT * FROM cases"), awkward().rows);
    EXPECT_EQ(query(sqlite_of(awkward()), "SELECT meaning, unit FROM columns WHERE name = 'a'"),
              (std::vector<std::vector<SweepTable::Cell>>{{"a, \"b\"", "text"}}));
    EXPECT_EQ(query(sqlite_of(awkward()), "PRAGMA integrity_check"),
              (std::vector<std::vector<SweepTable::Cell>>{{"ok"}}));
    auto const rows = query(sqlite_of(table_of(doubles())), "SELECT * FROM cases");
    for (std::size_t i = 0; i < rows.size(); ++i)
        EXPECT_EQ(std::get<double>(rows[i][0]), doubles()[i]);
    Merged m;
    m.write({{0, 1, 2, 3, 4}});
    SweepTable const t = m.merge().table;
    auto const sums = query(sqlite_of(t), "SELECT count(*), sum(domain_shader_fetched_bytes), "
                                          "max(seconds), typeof(samples) FROM cases");
    EXPECT_EQ(sums, (std::vector<std::vector<SweepTable::Cell>>{
                        {Int(6), Int(112), 0.1 + 0.2, "integer"}}));
    EXPECT_EQ(query(sqlite_of(t), "SELECT * FROM columns").size(), t.columns.size());
}

TEST(SweepTables, ColumnsBeyondSqlitesLimitAreRefused)
{
    SweepTable t{{}, {{}}};
    for (int i = 0; i < 40000; ++i) {
        t.columns.push_back({fmt::format("c{}", i), "count", "n"});
        t.rows[0].emplace_back(Int(i));
    }
    EXPECT_THROW(sqlite_of(t), LimitError);
    EXPECT_NE(csv_of(t), "");
}

TEST(SweepTables, TheDictionaryHasEachColumnAndANameEndsInItsUnit)
{
    Merged m;
    m.write({{0, 1, 2, 3, 4}});
    SweepTable const t = m.merge().table;
    std::string const dictionary = dictionary_csv_of(t);
    EXPECT_EQ(std::count(dictionary.begin(), dictionary.end(), '\n'),
              std::ptrdiff_t(t.columns.size()) + 1);
    std::set<std::string> names;
    for (SweepTable::Column const& c : t.columns) {
        EXPECT_TRUE(names.insert(c.name).second) << c.name;
        EXPECT_NE(c.meaning, "") << c.name;
        EXPECT_NE(dictionary.find("\n" + c.name + "," + c.unit + ","), std::string::npos);
        if (c.unit != "text" && c.unit != "option" && c.unit != "number") {
            EXPECT_TRUE(c.name.ends_with(c.unit)) << c.name << " in " << c.unit;
        }
    }
    // A column of each verb's results, so that the loop has seen them.
    for (char const* name : {"DSInvocations_count", "hull_shader_seconds",
                             "position_equal_parameter_max_diagonals", "verdict"})
        EXPECT_EQ(names.count(name), 1u) << name;
}

TEST(SweepMerge, ADamagedResultIsNamed)
{
    Merged m;
    m.records[1].text = R"({"seconds":1)";
    m.write({{0, 1}});
    std::string const said = test::refusal([&] { m.merge(); });
    EXPECT_NE(said.find("the result of case " + m.records[1].id + " is damaged"), std::string::npos)
        << said;
}

TEST(TableFormat, IsByTheExtension)
{
    EXPECT_EQ(table_format("a.csv"), TableFormat::Csv);
    EXPECT_EQ(table_format("b.csv/a.JSON"), TableFormat::Json);
    EXPECT_EQ(table_format("a.sqlite"), TableFormat::Sqlite);
    for (char const* path : {"a.txt", "csv", "-", "a.csv.gz"})
        EXPECT_EQ(test::refusal([&] { table_format(path); }),
                  "-o is '" + std::string(path) + "', its name must end in .csv, .json or .sqlite");
}

} // namespace
} // namespace tessemu
