// SPDX-License-Identifier: Apache-2.0
#include "io/gpu_file.h"

#include "emu/error.h"
#include "io/input_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace tessemu {

namespace {

using Json = nlohmann::json;

class Reader {
public:
    Reader(std::string_view json, std::string const& name) : name_(name)
    {
        try {
            j_ = Json::parse(json);
        } catch (Json::parse_error const& e) {
            throw FormatError(name, 0, std::string("is not JSON: ") + e.what());
        }
        if (!j_.is_object()) fail("the file", "is not an object");
    }

    GpuModel read()
    {
        static char const* const kKnown[] = {
            "name",           "about",      "clocks",       "arithmetic",
            "special",        "fetch",      "bandwidth",    "cache_bytes",
            "tessellator",    "setup",      "raster",       "tessellated_triangles",
            "group_width",    "overhead",   "vertex_cache", "issues",
            "fragment_batch", "components", "bus",          "target_switches",
            "stages",         "cpu_stages"};
        for (auto const& [key, value] : j_.items())
            if (std::find(std::begin(kKnown), std::end(kKnown), key) == std::end(kKnown))
                fail("'" + key + "'", "is no number of a GPU");
        m_.name = text("name");
        m_.about = text("about");
        if (j_.contains("clocks")) {
            if (!j_["clocks"].is_object()) fail("'clocks'", "is not an object");
            for (auto const& [key, value] : j_["clocks"].items())
                clocks_[key] = number(value, "clocks." + key);
        }
        rate("arithmetic", m_.arithmetic);
        rate("special", m_.special);
        rate("bandwidth", m_.bandwidth);
        rate("tessellator", m_.tessellator);
        rate("tessellated_triangles", m_.tessellated_triangles);
        rate("setup", m_.setup);
        rate("raster", m_.raster);
        if (j_.contains("fetch")) read_fetch();
        if (j_.contains("cache_bytes")) m_.cache_bytes = number(j_["cache_bytes"], "cache_bytes");
        if (j_.contains("group_width")) {
            double const w = number(j_["group_width"], "group_width");
            if (w != double(int(w)) || w > 1024)
                fail("group_width", fmt::format("is {}, it must be a whole number up to 1024", w));
            m_.group_width = int(w);
        }
        if (j_.contains("overhead")) m_.overhead = number(j_["overhead"], "overhead", true);
        if (j_.contains("vertex_cache")) read_vertex_cache();
        if (j_.contains("issues")) read_issues();
        if (j_.contains("components")) {
            m_.components = number(j_["components"], "components");
            if (m_.components > 4)
                fail("components", fmt::format("is {}, it must be up to 4", m_.components));
        }
        if (j_.contains("fragment_batch")) {
            double const n = number(j_["fragment_batch"], "fragment_batch");
            if (n != std::floor(n))
                fail("fragment_batch", fmt::format("is {}, it must be a whole number", n));
            m_.fragment_batch = n;
        }
        rate("target_switches", m_.target_switches);
        rate("bus", m_.bus);
        read_stages("stages", m_.stages);
        read_stages("cpu_stages", m_.cpu_stages);
        for (std::string const& stage : m_.cpu_stages)
            if (m_.stages.empty() || m_.has(stage))
                fail("'cpu_stages'", "names " + stage + ", which the GPU has");
        return m_;
    }

private:
    [[noreturn]] void fail(std::string const& what, std::string const& why) const
    {
        throw FormatError(name_, 0, what + " " + why);
    }
    std::string text(char const* key) const
    {
        if (!j_.contains(key) || !j_[key].is_string()) fail(fmt::format("'{}'", key), "is missing");
        return j_[key].get<std::string>();
    }
    void note_source(Json const& j, std::string const& at)
    {
        if (!j.is_object() || !j.contains("value")) fail("'" + at + "'", "has no value");
        if (!j.contains("source") || !j["source"].is_string())
            fail("'" + at + "'", "has no source: every number says where it comes from");
        m_.sources[at] = j["source"].get<std::string>();
    }
    double number(Json const& j, std::string const& at, bool may_be_0 = false)
    {
        note_source(j, at);
        if (!j["value"].is_number()) fail("'" + at + "'", "is not a number");
        auto const x = j["value"].get<double>();
        if (!(x > 0 || (may_be_0 && x == 0)))
            fail("'" + at + "'", fmt::format("is {}, it must be above 0", x));
        return x;
    }
    double rate_of(Json const& j, std::string const& at)
    {
        double const x = number(j, at);
        if (!j.contains("per") || !j["per"].is_string())
            fail("'" + at + "'", "does not say per what: a clock's name or 'second'");
        auto const per = j["per"].get<std::string>();
        if (per == "second") return x;
        auto const it = clocks_.find(per);
        if (it == clocks_.end())
            fail("'" + at + "'", "is per '" + per + "', which is no clock of the GPU");
        return x * it->second;
    }
    void rate(char const* key, double& out)
    {
        if (j_.contains(key)) out = rate_of(j_[key], key);
    }
    void read_fetch()
    {
        if (!j_["fetch"].is_object()) fail("'fetch'", "is not an object");
        for (auto const& [key, value] : j_["fetch"].items()) {
            double const x = rate_of(value, "fetch." + key);
            if (key == "any") {
                m_.any_fetch = x;
                continue;
            }
            bool found = false;
            for (ResourceKind k :
                 {ResourceKind::Vertex, ResourceKind::Index, ResourceKind::ControlPoint,
                  ResourceKind::PatchConstant, ResourceKind::Buffer, ResourceKind::Texture,
                  ResourceKind::Shared})
                if (key == name_of(k)) m_.fetch[k] = x, found = true;
            if (!found) fail("'fetch." + key + "'", "is no kind of fetch");
        }
    }
    void check_stage(std::string const& name, std::string const& at) const
    {
        static constexpr char const* kStages[] = {
            "input_assembler", "vertex_shader",   "hull_shader",   "tessellator",
            "domain_shader",   "geometry_shader", "stream_output", "rasterizer",
            "pixel_shader",    "output_merger",   "compute_shader"};
        if (std::find(std::begin(kStages), std::end(kStages), name) == std::end(kStages))
            fail("'" + at + "'", "names " + name + ", which is no stage");
    }
    void read_issues()
    {
        if (!j_["issues"].is_object()) fail("'issues'", "is not an object");
        for (auto const& [stage, value] : j_["issues"].items()) {
            check_stage(stage, "issues");
            if (!stage.ends_with("_shader"))
                fail("'issues." + stage + "'", "is of no shader: nothing issues there");
            m_.issues[stage] = rate_of(value, "issues." + stage);
        }
    }
    void read_stages(char const* key, std::vector<std::string>& out)
    {
        if (!j_.contains(key)) return;
        note_source(j_[key], key);
        if (!j_[key]["value"].is_array()) fail(fmt::format("'{}'", key), "is not a list of stages");
        for (Json const& stage : j_[key]["value"]) {
            if (!stage.is_string()) fail(fmt::format("'{}'", key), "is not a list of stages");
            check_stage(out.emplace_back(stage.get<std::string>()), key);
        }
    }
    void read_vertex_cache()
    {
        note_source(j_["vertex_cache"], "vertex_cache");
        if (!j_["vertex_cache"]["value"].is_string()) fail("'vertex_cache'", "is not a text");
        try {
            m_.vertex_cache =
                vertex_cache_from_name(j_["vertex_cache"]["value"].get<std::string>());
        } catch (Error const& e) {
            fail("'vertex_cache':", e.what());
        }
    }

    std::string const& name_;
    Json j_;
    GpuModel m_;
    std::map<std::string, double> clocks_;
};

} // namespace

GpuModel parse_gpu_model(std::string_view json, std::string const& name)
{
    return Reader(json, name).read();
}

GpuModel load_gpu_model(std::string const& path_or_name)
{
    if (std::filesystem::exists(path_or_name))
        return parse_gpu_model(read_file(path_or_name), path_or_name);
    std::string known;
    for (BuiltinGpu const& m : builtin_gpus()) {
        if (m.name == path_or_name) return parse_gpu_model(m.json, path_or_name);
        known += (known.empty() ? "" : ", ") + std::string(m.name);
    }
    throw FormatError(path_or_name, 0, "no such file, and no built-in GPU (" + known + ")");
}

} // namespace tessemu
