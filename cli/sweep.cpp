// sweep: thousands of configurations, planned, run by any number of processes, and merged.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/job.h"
#include "cli/process.h"
#include "cli/verbs.h"
#include "io/gpu_file.h"
#include "io/input_file.h"
#include "io/sha256.h"
#include "pipeline/mesh/builtin_models.h"
#include "sweep/merge.h"
#include "sweep/results.h"
#include "sweep/run.h"
#include "sweep/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <thread>

namespace tessemu {

namespace fs = std::filesystem;

namespace {

struct SweptVerb {
    char const* name;
    void (*add)(CommandLine&);
};
constexpr SweptVerb kVerbs[] = {
    {"draw", add_draw}, {"cost", add_cost}, {"compare", add_compare}, {"check", add_check}};

// A program of one verb, whose options take one case.
std::shared_ptr<CommandLine> program_of(std::string const& verb)
{
    std::vector<std::string> names;
    for (SweptVerb const& v : kVerbs) {
        if (verb == v.name) {
            auto const program = std::make_shared<CommandLine>("tessemu", tessemu_version(), "");
            v.add(*program);
            return program;
        }
        names.emplace_back(v.name);
    }
    throw Error("\"verb\" is \"" + verb + "\", it must be " + in_words(names));
}

std::string on_command_line(std::string const& option)
{
    return option == "model" ? "MODEL" : "--" + option;
}

// All options but those that say where a run goes or change no result.
SweepVerb sweep_verb(std::string const& name)
{
    std::shared_ptr<CommandLine> const program = program_of(name);
    SweepVerb out;
    out.name = name;
    for (Verb::OptionInfo const& o : program->verb().options()) {
        bool const is_model = o.name == "MODEL";
        if (!is_model && !o.name.starts_with("--")) continue;
        if (o.name == "--json" || o.name == "--lanes" || o.name == "--table-cache") continue;
        SweepVerb::Option option{is_model ? "model" : o.name.substr(2), o.repeated, o.flag,
                                 o.required};
        if (o.fallback) option.fallback = {*o.fallback};
        if (o.flag) option.fallback = {"false"};
        out.options.push_back(std::move(option));
    }
    out.check = [program](SweepVerb::Option const& o, std::string const& text,
                          std::string const& label) {
        program->verb().check(on_command_line(o.name), text, label);
    };
    return out;
}

struct PlanRequest {
    std::string sweep, folder;
};

// Models or GPUs that need no file.
std::vector<std::string> builtins(std::string const& option)
{
    std::vector<std::string> out;
    if (option == "model")
        for (BuiltinModel const& m : builtin_models()) out.emplace_back(m.name);
    else
        for (BuiltinGpu const& g : builtin_gpus()) out.emplace_back(g.name);
    return out;
}
bool is_builtin(std::string const& option, std::string const& word)
{
    auto const known = builtins(option);
    return std::find(known.begin(), known.end(), word) != known.end();
}

// A scheme's parameters, which --set takes as they come.
void check_parameters(SweepManifest const& m)
{
    std::set<std::pair<std::string, std::vector<std::string>>> checked;
    for (SweepCase const& c : m.cases) {
        auto const given = c.options.find("set");
        if (given == c.options.end()) continue;
        auto const own = c.options.find("scheme");
        std::string const scheme =
            (own == c.options.end() ? m.defaults.at("scheme") : own->second).at(0);
        if (!checked.emplace(scheme, given->second).second) continue;
        ParameterTexts texts;
        for (std::string const& t : given->second)
            texts.emplace_back(t.substr(0, t.find('=')), t.substr(t.find('=') + 1));
        try {
            resolve_parameters(find_scheme(scheme).info(), texts);
        } catch (Error const& e) {
            throw Error(std::string("\"set\": ") + e.what());
        }
    }
}

int plan(PlanRequest const& o)
{
    std::string const text = read_file(o.sweep);
    std::string const name = input_name(o.sweep);
    Sweep const sweep = read_sweep(text, name, sweep_verb);
    fs::path const beside = fs::path(o.sweep).parent_path();
    // Paths are relative to the sweep's file.
    FindInput const find_input =
        [&](std::string const& option,
            std::string const& word) -> std::optional<std::pair<std::string, std::string>> {
        bool const image = option == "displace" && word != "none" && word != "studs";
        if (option != "model" && option != "gpu" && !image) return {};
        fs::path const path = beside / word;
        try {
            std::error_code error;
            if (!image && !fs::is_regular_file(path, error)) {
                if (is_builtin(option, word)) return {};
                throw Error("'" + word + "' is neither a file beside the sweep's nor a built-in: " +
                            in_words(builtins(option)));
            }
            if (option == "model") load_model(path.string());
            if (option == "gpu") load_gpu_model(path.string());
            return std::pair(path.filename().string(), read_file(path));
        } catch (Error const& e) {
            throw FormatError(
                name, 0,
                fmt::format("\"{}{}\": {}", option, option == "model" ? "s" : "", e.what()));
        }
    };
    SweepPlan const plan = [&] {
        try {
            SweepPlan out = plan_sweep(sweep, sweep_verb(sweep.verb),
                                       std::string(tessemu_version()), find_input);
            check_parameters(out.manifest);
            return out;
        } catch (FormatError const&) {
            throw;
        } catch (Error const& e) {
            throw FormatError(name, 0, e.what());
        }
    }();
    if (plan.manifest.cases.empty()) throw FormatError(name, 0, "\"except\" leaves out every case");
    write_plan(plan, o.folder, text);
    std::string const repeated =
        plan.repeated ? fmt::format(" ({} that are there twice are left out)", plan.repeated) : "";
    print(fmt::format("{}: {} cases of {}{}\nnext: tessemu sweep run {}\n", o.folder,
                      plan.manifest.cases.size(), plan.manifest.verb, repeated, o.folder));
    return 0;
}

struct RunSweepRequest {
    std::string folder;
    Shard shard;
    int threads = 0;
    double lease = kDefaultLease;
    bool retry = false;
    int lanes = kNativeLanes;
    std::optional<std::string> table_cache;
};

Shard parse_shard(std::string const& text, std::string const& option)
{
    auto const parts = split(text, '/');
    if (parts.size() != 2) refuse(text, option, "I/N, such as 1/4");
    Shard out;
    out.count = std::size_t(whole_number(parts[1], option, 1, 1000000));
    out.index = std::size_t(whole_number(parts[0], option, 1, std::int64_t(out.count)));
    return out;
}

// Whoever computes a case must have what the plan has.
void check_plan(SweepManifest const& m, fs::path const& folder)
{
    if (m.version != tessemu_version())
        throw Error(fmt::format("{}: planned by version {}, this is {}; results of both would mix: "
                                "plan it again into another folder",
                                folder.string(), m.version, tessemu_version()));
    check_ids(m, folder);
    for (SweepInput const& i : m.inputs)
        if (sha256_of(read_file(folder / i.path)) != i.sha256)
            throw FormatError((folder / i.path).string(), 0,
                              "it is not what was planned with; plan the sweep again into another "
                              "folder");
}

// A message must not tell where the folder lies: the table is the same wherever it does.
std::string without_paths(std::string text, SweepManifest const& m, fs::path const& folder)
{
    for (SweepInput const& i : m.inputs) {
        std::string const path = (folder / i.path).string();
        for (std::size_t at = 0; (at = text.find(path, at)) != std::string::npos;)
            text.replace(at, path.size(), i.name);
    }
    return text;
}

std::string run_case(SweepManifest const& m, SweepCase const& c, RunSweepRequest const& o,
                     Session session)
{
    std::map<std::string, std::vector<std::string>> options;
    for (auto const& [name, texts] : c.options)
        for (std::string const& text : texts)
            options[on_command_line(name)].push_back(
                m.input(text) ? (fs::path(o.folder) / text).string() : text);
    options["--lanes"] = {std::to_string(o.lanes)};
    if (o.table_cache) options["--table-cache"] = {*o.table_cache};
    std::string result;
    session.result = &result;
    try {
        program_of(m.verb)->verb().run(options, session);
    } catch (Error const& e) {
        throw Error(without_paths(e.what(), m, o.folder));
    }
    return result;
}

std::string duration(double seconds)
{
    auto const s = std::int64_t(seconds + 0.5);
    if (s < 120) return fmt::format("{} s", s);
    if (s < 7200) return fmt::format("{} min", s / 60);
    return fmt::format("{} h {} min", s / 3600, s / 60 % 60);
}

int run(RunSweepRequest const& o)
{
    SweepManifest const manifest = read_manifest(o.folder);
    check_plan(manifest, o.folder);
    int const cores = std::max(1, int(std::thread::hardware_concurrency()));
    int const threads = o.threads ? o.threads : cores;
    // Many cases run side by side, a thread each; few of them one by one, on all threads.
    bool const many = sweep_state(manifest, o.folder, o.shard).open() >= std::size_t(threads);
    ThreadPool const pool(many ? 1 : threads);
    SurfaceStore surfaces(std::size_t(threads) + 2);
    Session session;
    session.threads = &pool;
    session.surfaces = &surfaces;

    ProgressBar bar;
    Stopwatch const clock;
    SweepRunSettings settings;
    settings.shard = o.shard;
    settings.workers = many ? threads : 1;
    settings.lease = o.lease;
    settings.retry = o.retry;
    settings.run_case = [&](SweepCase const& c) { return run_case(manifest, c, o, session); };
    std::string waits_for;
    settings.progress = [&](SweepProgress const& p) {
        double const rate = double(p.state.computed) / std::max(clock.seconds(), 1e-3);
        std::string note =
            fmt::format("  {} of {} cases", p.state.cases - p.state.open(), p.state.cases);
        if (!p.waits_for.empty())
            note += fmt::format(", waiting for {}", p.waits_for);
        else if (p.state.computed)
            note += fmt::format(", {:.3g} a second, {} left", rate,
                                duration(double(p.state.open()) / rate));
        if (p.state.failed) note += fmt::format(", {} failed", p.state.failed);
        bar(p.state.cases - p.state.open(), p.state.cases, note);
        if (p.waits_for.empty() || p.waits_for == waits_for) return;
        waits_for = p.waits_for;
        bar.clear();
        print_message(fmt::format("waiting for {}, which computes what is left\n", waits_for));
    };
    SweepState const state = run_sweep(manifest, o.folder, settings);
    bar.clear();
    print(fmt::format("{} of {} cases{} done, {} failed; {} have run now\n", state.done,
                      state.cases, o.shard.count > 1 ? " of the shard" : "", state.failed,
                      state.computed));
    if (state.failed)
        print_message(
            fmt::format("'tessemu sweep status {}' says why; --retry runs them again\n", o.folder));
    return state.failed ? 1 : 0;
}

struct StatusRequest {
    std::string folder;
};

int status(StatusRequest const& o)
{
    SweepManifest const manifest = read_manifest(o.folder);
    SweepState const s = sweep_state(manifest, o.folder);
    print(fmt::format("{}: {} cases of {}: {} done, {} failed, {} not yet\n", o.folder, s.cases,
                      manifest.verb, s.done, s.failed, s.open()));
    if (s.failed == 0) return 0;
    std::set<std::string> flags;
    for (SweepVerb::Option const& option : sweep_verb(manifest.verb).options)
        if (option.flag) flags.insert(option.name);
    std::string text;
    std::size_t shown = 0;
    for (CaseRecord const& r : failures(manifest, o.folder)) {
        auto const at = std::find_if(manifest.cases.begin(), manifest.cases.end(),
                                     [&](SweepCase const& c) { return c.id == r.id; });
        std::string words;
        for (auto const& [name, texts] : at->options)
            for (std::string const& t : texts)
                if (flags.count(name) == 0)
                    words += name == "model" ? " " + t : fmt::format(" --{} {}", name, t);
                else if (t == "true")
                    words += " --" + name;
        text += fmt::format("case {}: {}: {}\n", at - manifest.cases.begin() + 1,
                            manifest.verb + words, r.text);
        if (++shown == 20) break;
    }
    if (shown < s.failed) text += fmt::format("and {} more\n", s.failed - shown);
    print(text);
    return 0;
}

struct MergeRequest {
    std::string folder, output, dictionary;
};

// What is there already may be an older table, no sweep and nothing of one.
void keep_sweep(std::string const& output, std::string const& folder)
{
    std::error_code none;
    fs::path const path = fs::weakly_canonical(output, none);
    fs::path inside = fs::weakly_canonical(folder, none);
    if (!inside.has_filename()) inside = inside.parent_path(); // of "DIR/"
    if (std::mismatch(inside.begin(), inside.end(), path.begin(), path.end()).first == inside.end())
        throw WriteError("'" + output + "' is inside of the sweep; choose a place beside it");
    if (extension_of(path) == "json" && fs::exists(path, none) &&
        read_file(path).find("tessemu.sweep_table/1") == std::string::npos)
        throw WriteError("'" + output + "' is there and is no table of a sweep");
}

int merge(MergeRequest const& o)
{
    TableFormat const format = table_format(o.output);
    keep_sweep(o.output, o.folder);
    if (!o.dictionary.empty()) {
        if (extension_of(o.dictionary) != "csv")
            refuse(o.dictionary, "--dictionary", "a name that ends in .csv");
        keep_sweep(o.dictionary, o.folder);
    }
    RunOutput out;
    OutputFile& file = out.add(o.output);
    OutputFile* const dictionary = o.dictionary.empty() ? nullptr : &out.add(o.dictionary);
    if (dictionary && dictionary->is_same(file))
        throw WriteError("--dictionary is '" + o.dictionary + "', where -o goes");
    SweepManifest const manifest = read_manifest(o.folder);
    check_ids(manifest, o.folder);
    SweepMerge const merged = merge_sweep(manifest, o.folder);
    SweepTable const& table = merged.table;
    file.write(format == TableFormat::Csv    ? csv_of(table)
               : format == TableFormat::Json ? json_of(table)
                                             : sqlite_of(table));
    if (dictionary) dictionary->write(dictionary_csv_of(table));
    out.finish([] { return std::string(); }, fmt::format("{}: {} rows, {} columns\n", o.output,
                                                         table.rows.size(), table.columns.size()));
    if (merged.failed)
        print_warning(fmt::format("{} of {} cases failed; {}", merged.failed, table.rows.size(),
                                  merged.first_failure));
    if (merged.missing == 0) return 0;
    print_message(fmt::format("tessemu: {}: {} of {} cases have not run yet: 'tessemu sweep run "
                              "{}'; their rows say \"missing\"\n",
                              o.folder, merged.missing, table.rows.size(), o.folder));
    return 1;
}

struct SubmitRequest {
    std::string folder, table;
    bool is_slurm = true; ///< of one engine so far
    std::size_t tasks = 0;
    std::vector<std::string> options;
    bool dry_run = false;
};

std::string line_of(std::string text)
{
    while (text.ends_with('\n')) text.pop_back();
    return text;
}

int submit(SubmitRequest const& o)
{
    SweepManifest const manifest = read_manifest(o.folder);
    check_plan(manifest, o.folder);
    std::size_t const open = sweep_state(manifest, o.folder).open();
    SlurmJob job{own_path(), fs::canonical(o.folder), o.tasks, {}, o.options};
    if (job.tasks == 0) job.tasks = std::clamp<std::size_t>(open / manifest.per_block, 1, 16);
    if (!o.table.empty()) {
        table_format(o.table, "--merge");
        keep_sweep(o.table, o.folder);
        OutputFile const can_be_written(o.table); // or says why not
        job.table = fs::absolute(o.table);
    }
    std::string const array = slurm_array_script(job);
    std::string const last = job.table.empty() ? "" : slurm_merge_script(job);
    fs::path const scripts = job.folder / "slurm";
    std::vector<std::string> first{"sbatch", "--parsable", (scripts / "array.sh").string()};
    std::vector<std::string> then{"sbatch", "--parsable", "--dependency=afterany:JOB",
                                  (scripts / "merge.sh").string()};
    if (o.dry_run) {
        std::string text =
            fmt::format("# {}\n{}\n# {}\n", first.back(), array, fmt::join(first, " "));
        if (!last.empty())
            text += fmt::format("\n# {}\n{}\n# {}\n", then.back(), last, fmt::join(then, " "));
        print(text);
        return 0;
    }
    if (open == 0) {
        print(fmt::format("{}: all cases have run; 'tessemu sweep merge' makes the table\n",
                          o.folder));
        return 0;
    }
    std::error_code error;
    fs::create_directories(scripts, error);
    if (error) throw WriteError(scripts.string() + ": " + error.message());
    write_file(first.back(), array);
    if (!last.empty()) write_file(then.back(), last);
    try {
        std::string const id = line_of(run_program(first)); // JOB, or JOB;CLUSTER
        print(fmt::format("job {}: {} tasks for {} cases\n", id, job.tasks, open));
        if (last.empty()) return 0;
        then[2] = "--dependency=afterany:" + id.substr(0, id.find(';'));
        print(fmt::format("job {}: merges them into {} when they have ended\n",
                          line_of(run_program(then)), job.table.string()));
    } catch (Error const& e) {
        throw Error(fmt::format("{}; without Slurm: docs/sweeps.md has GNU parallel and Snakemake",
                                e.what()));
    }
    return 0;
}

double parse_lease(std::string const& text, std::string const& option)
{
    double const x = finite_number(text, option);
    if (!(x >= 1 && x <= 86400)) throw Error(option + " is " + text + ", it must be 1 to 86400");
    return x;
}

} // namespace

void add_sweep(CommandLine& program)
{
    program.add_group("sweep", "thousands of configurations: plan, run, status, merge, submit");

    auto const p = std::make_shared<PlanRequest>();
    Verb& plan_verb = program.add_verb(
        "sweep plan", "a grid of configurations becomes a folder of cases",
        "  tessemu sweep plan sweep.json -o results\n"
        "where sweep.json is\n"
        "  {\"verb\": \"cost\", \"models\": [\"jug\", \"cages/a.obj\"], \"schemes\": "
        "[\"acc\", \"pm\"],\n   \"tess\": [1, 2.5, 7], \"geometry-only\": true}");
    plan_verb.required("SWEEP", p->sweep, plain,
                       "JSON: \"verb\" (draw, cost, compare, check), \"models\", \"schemes\", "
                       "and any of the verb's long options, each a value or a list; \"cases\" "
                       "adds single ones, \"except\" leaves out those that match");
    plan_verb.required("-o", p->folder, output_path, "the sweep's folder, a new one");
    plan_verb.runs([p](Session const&) { return plan(*p); });

    auto const r = std::make_shared<RunSweepRequest>();
    Verb& run_verb = program.add_verb(
        "sweep run",
        "run the cases that have not run yet; any number of processes and hosts may share a folder",
        "  tessemu sweep run results\n"
        "  tessemu sweep run results -j 4 --shard 2/10");
    run_verb.required("DIR", r->folder, output_path, "a planned sweep");
    run_verb.option("--shard", r->shard, parse_shard, "I/N: a part of the cases, I from 1 to N",
                    "1/1");
    run_verb.option("-j", r->threads, whole(0, 1024), "threads; 0: all cores", "0");
    run_verb.option("--lease", r->lease, parse_lease,
                    "seconds after which a process on another host that has not been heard of is "
                    "taken for dead",
                    fmt::format("{}", kDefaultLease));
    run_verb.flag("--retry", r->retry, "run cases again that have failed");
    add_machine_of_sweep(run_verb, r->lanes, r->table_cache);
    run_verb.runs([r](Session const&) { return run(*r); });

    auto const s = std::make_shared<StatusRequest>();
    Verb& status_verb = program.add_verb("sweep status", "how far a sweep is, and what has failed",
                                         "  tessemu sweep status results");
    status_verb.required("DIR", s->folder, output_path, "a planned sweep");
    status_verb.runs([s](Session const&) { return status(*s); });

    auto const m = std::make_shared<MergeRequest>();
    Verb& merge_verb = program.add_verb(
        "sweep merge", "all results as one table; exit status 1 where some are missing",
        "  tessemu sweep merge results -o results.csv --dictionary columns.csv\n"
        "  tessemu sweep merge results -o results.sqlite");
    merge_verb.required("DIR", m->folder, output_path, "a planned sweep");
    merge_verb.required("-o", m->output, output_path, "the table, .csv, .json or .sqlite");
    merge_verb.option(
        "--dictionary", m->dictionary, output_path,
        "what the columns are: name, unit, meaning, as CSV; .json and .sqlite hold it");
    merge_verb.runs([m](Session const&) { return merge(*m); });

    auto const b = std::make_shared<SubmitRequest>();
    Verb& submit_verb = program.add_verb(
        "sweep submit", "run a sweep on a cluster: a job array, and a last job that merges",
        "  tessemu sweep submit results --tasks 32 --merge results.csv\n"
        "  tessemu sweep submit results --option --time=1:00:00 --option --cpus-per-task=4 "
        "--dry-run");
    submit_verb.required("DIR", b->folder, output_path,
                         "a planned sweep, in a folder that the nodes see too");
    submit_verb.option("--engine", b->is_slurm, one_of<bool>({{"slurm", true}}), "slurm", "slurm");
    submit_verb.option("--tasks", b->tasks, whole<std::size_t>(1, 100000),
                       "of the array; each runs cases until none is left [16 at most, by the "
                       "number of cases]");
    submit_verb.option("--merge", b->table, output_path, "the table, .csv, .json or .sqlite");
    submit_verb.repeated("--option", b->options, plain, "of sbatch, for both jobs; again for more");
    submit_verb.flag("--dry-run", b->dry_run, "print the scripts and commands instead");
    submit_verb.runs([b](Session const&) { return submit(*b); });
}

} // namespace tessemu
