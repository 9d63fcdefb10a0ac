// SPDX-License-Identifier: Apache-2.0
#include "sweep/manifest.h"

#include "io/input_file.h"
#include "io/output_file.h"
#include "io/sha256.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace tessemu {

using Json = nlohmann::ordered_json;

namespace {

constexpr char const* kSchema = "tessemu.sweep/1";
constexpr char const* kManifest = "manifest.jsonl";
// A block is what a run claims at a time: a thousand of them balance well, and cost a shared folder
// a file made and removed each.
constexpr std::size_t kBlocks = 1000;

Json to_json(CaseOptions const& options)
{
    Json j = Json::object();
    for (auto const& [name, texts] : options) {
        Json& value = j[name] = Json::array();
        for (std::string const& t : texts) value.push_back(t);
    }
    return j;
}

CaseOptions to_options(Json const& j)
{
    CaseOptions out;
    for (auto const& [name, texts] : j.items()) out[name] = texts.get<std::vector<std::string>>();
    return out;
}

// Inputs count by their names and hashes, wherever they lie.
std::string id_of(SweepManifest const& m, SweepCase const& c)
{
    CaseOptions options = m.resolved(c);
    Json hashes = Json::object();
    for (auto& [name, texts] : options)
        for (std::string& text : texts)
            if (SweepInput const* const input = m.input(text)) {
                hashes[name] = input->sha256;
                text = input->name;
            }
    return sha256_of(Json{
        {"version", m.version}, {"verb", m.verb}, {"options", to_json(options)}, {"inputs", hashes}}
                         .dump());
}

} // namespace

CaseOptions SweepManifest::resolved(SweepCase const& c) const
{
    CaseOptions out = c.options;
    out.insert(defaults.begin(), defaults.end());
    return out;
}

SweepInput const* SweepManifest::input(std::string const& text) const
{
    auto const found = std::find_if(inputs.begin(), inputs.end(),
                                    [&](SweepInput const& i) { return i.path == text; });
    return found == inputs.end() ? nullptr : &*found;
}

SweepPlan plan_sweep(Sweep const& sweep, SweepVerb const& verb, std::string const& version,
                     FindInput const& find_input)
{
    SweepPlan out;
    SweepManifest& m = out.manifest;
    m.version = version;
    m.verb = verb.name;
    for (SweepVerb::Option const& o : verb.options)
        if (!o.fallback.empty()) m.defaults[o.name] = o.fallback;

    // What an option's text becomes in the folder.
    std::unordered_map<std::string, std::string> places;
    auto const place = [&](std::string const& option,
                           std::string const& text) -> std::string const& {
        auto const [at, fresh] = places.try_emplace(option + '\n' + text, text);
        if (!fresh) return at->second;
        if (auto const file = find_input(option, text)) {
            std::string const hash = sha256_of(file->second);
            at->second = "inputs/" + hash.substr(0, 16) + "/" + file->first;
            if (!m.input(at->second)) {
                m.inputs.push_back({file->first, at->second, hash});
                out.bytes.push_back(file->second);
            }
        }
        return at->second;
    };
    std::unordered_set<std::string> seen;
    for (CaseOptions const& options : cases_of(sweep)) {
        SweepCase c{"", options};
        for (auto& [option, texts] : c.options)
            for (std::string& text : texts) text = place(option, text);
        c.id = id_of(m, c);
        if (seen.insert(c.id).second)
            m.cases.push_back(std::move(c));
        else
            ++out.repeated;
    }
    m.per_block = std::max<std::size_t>(1, m.cases.size() / kBlocks);
    return out;
}

void write_plan(SweepPlan const& plan, std::filesystem::path const& folder,
                std::string const& sweep_file)
{
    namespace fs = std::filesystem;
    SweepManifest const& m = plan.manifest;
    Json inputs = Json::array();
    for (SweepInput const& i : m.inputs)
        inputs.push_back({{"name", i.name}, {"path", i.path}, {"sha256", i.sha256}});
    std::string text = Json{{"schema", kSchema},
                            {"version", m.version},
                            {"verb", m.verb},
                            {"cases", m.cases.size()},
                            {"cases_per_block", m.per_block},
                            {"defaults", to_json(m.defaults)},
                            {"inputs", inputs}}
                           .dump() +
                       "\n";
    for (SweepCase const& c : m.cases)
        text += Json{{"case", c.id}, {"options", to_json(c.options)}}.dump() + "\n";

    std::error_code error;
    fs::path const manifest = folder / kManifest;
    if (fs::exists(manifest, error)) {
        if (read_file(manifest) == text) return; // planned before: results stay
        throw Error(folder.string() + ": another sweep is planned there; remove it or choose "
                                      "another folder");
    }
    bool const empty = !fs::exists(folder, error) || fs::is_empty(folder, error);
    fs::path const own = folder / "sweep.json"; // of a plan that was cut short
    bool const is_ours = fs::exists(own, error) && read_file(own) == sweep_file;
    if (!empty && !is_ours)
        throw Error(folder.string() + ": there is something that is no sweep; choose a new folder");
    auto const make = [&](fs::path const& p) {
        fs::create_directories(p, error);
        if (error) throw WriteError(p.string() + ": " + error.message());
    };
    make(folder);
    write_file(own, sweep_file);
    make(folder / "results");
    make(folder / "claims");
    for (std::size_t i = 0; i < m.inputs.size(); ++i) {
        make((folder / m.inputs[i].path).parent_path());
        write_file(folder / m.inputs[i].path, plan.bytes[i]);
    }
    write_file(manifest, text);
}

SweepManifest read_manifest(std::filesystem::path const& folder)
{
    std::filesystem::path const path = folder / kManifest;
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw FormatError(folder.string(), 0,
                          "there is no manifest.jsonl: 'tessemu sweep plan SWEEP.json -o " +
                              folder.string() + "' makes one");
    std::string const text = read_file(path);
    SweepManifest out;
    std::size_t all = 0;
    int line = 0;
    try {
        for (std::size_t at = 0; at < text.size();) {
            ++line;
            std::size_t const end = std::min(text.find('\n', at), text.size());
            Json const j =
                Json::parse(text.begin() + std::ptrdiff_t(at), text.begin() + std::ptrdiff_t(end));
            at = end + 1;
            if (line > 1) {
                out.cases.push_back({j.at("case").get<std::string>(), to_options(j.at("options"))});
                continue;
            }
            if (j.at("schema") != kSchema)
                throw FormatError(path.string(), 1, "not a " + std::string(kSchema));
            out.version = j.at("version");
            out.verb = j.at("verb");
            out.per_block = std::max<std::size_t>(1, j.at("cases_per_block"));
            out.defaults = to_options(j.at("defaults"));
            all = j.at("cases");
            for (Json const& i : j.at("inputs"))
                out.inputs.push_back({i.at("name"), i.at("path"), i.at("sha256")});
        }
    } catch (Json::exception const&) {
        throw FormatError(path.string(), line, "the manifest is damaged: plan the sweep again");
    }
    if (line == 0 || out.cases.size() != all)
        throw FormatError(path.string(), 0,
                          fmt::format("the manifest has {} of {} cases: plan the sweep again",
                                      out.cases.size(), all));
    return out;
}

void check_ids(SweepManifest const& manifest, std::filesystem::path const& folder)
{
    for (SweepCase const& c : manifest.cases)
        if (c.id != id_of(manifest, c))
            throw FormatError((folder / kManifest).string(), 0,
                              "case " + c.id + " is not what was planned: plan the sweep again");
}

} // namespace tessemu
