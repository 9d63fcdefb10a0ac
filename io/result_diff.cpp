// SPDX-License-Identifier: Apache-2.0
#include "io/result_diff.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace tessemu {

namespace {

using Json = nlohmann::ordered_json;

Json parse(std::string const& text, std::string const& name)
{
    try {
        return Json::parse(text);
    } catch (Json::parse_error const& e) {
        auto const end = text.begin() + std::ptrdiff_t(std::min(e.byte, text.size()));
        throw FormatError(name, int(1 + std::count(text.begin(), end, '\n')), "is not JSON");
    }
}

// An element of an array goes by its name where it has one.
std::string key_of(Json const& element, std::size_t index)
{
    auto const text = [&](char const* name) -> std::string {
        bool const has = element.is_object() && element.contains(name) && element[name].is_string();
        return has ? element[name].get<std::string>() : "";
    };
    for (auto [first, second] : {std::pair{"resource", ""},
                                 {"kind", "name"},
                                 {"name", ""},
                                 {"quantity", "measure"},
                                 {"row", "column"}})
        if (std::string const key = text(first); !key.empty()) {
            std::string const more = text(second);
            return more.empty() ? key : key + "/" + more;
        }
    return std::to_string(index);
}

void flatten(Json const& j, std::string const& path, std::vector<std::pair<std::string, Json>>& out)
{
    auto const below = [&](std::string const& key) {
        return path.empty() ? key : path + "." + key;
    };
    if (j.is_object()) {
        for (auto const& [key, value] : j.items())
            if (!path.empty() || (key != "run" && key != "tool")) flatten(value, below(key), out);
    } else if (j.is_array()) {
        std::map<std::string, int> seen; // a second element of a name is another value
        for (std::size_t i = 0; i < j.size(); ++i) {
            std::string key = key_of(j[i], i);
            if (int const n = seen[key]++) key += "#" + std::to_string(n + 1);
            flatten(j[i], below(key), out);
        }
        if (j.empty()) out.emplace_back(path, j);
    } else {
        out.emplace_back(path, j);
    }
}

void compare(ResultValue& v, Json const& a, Json const& b, double tolerance)
{
    if (a == b) return;
    v.relative = 1;
    if (a.is_number() && b.is_number()) {
        double const x = a.get<double>(), y = b.get<double>();
        v.relative = std::abs(x - y) / std::max(std::abs(x), std::abs(y));
    }
    v.differs = v.relative > tolerance || !(a.is_number() && b.is_number());
}

} // namespace

std::vector<ResultValue> diff_results(std::string const& a, std::string const& b,
                                      std::pair<std::string, std::string> const& names,
                                      double tolerance)
{
    std::vector<std::pair<std::string, Json>> left, right;
    flatten(parse(a, names.first), "", left);
    flatten(parse(b, names.second), "", right);
    std::map<std::string, Json const*> other;
    for (auto const& [path, value] : right) other.emplace(path, &value);
    std::vector<ResultValue> out;
    for (auto const& [path, value] : left) {
        auto const it = other.find(path);
        ResultValue v{path, value.dump(), "", 1, true};
        if (it != other.end()) {
            v = {path, value.dump(), it->second->dump(), 0, false};
            compare(v, value, *it->second, tolerance);
            other.erase(it);
        }
        if (path != "hash" || tolerance == 0) out.push_back(std::move(v));
    }
    for (auto const& [path, value] : right)
        if (other.contains(path)) out.push_back({path, "", value.dump(), 1, true});
    return out;
}

std::string diff_table(std::vector<ResultValue> const& values, bool all)
{
    std::size_t width = 5, differing = 0;
    for (ResultValue const& v : values)
        if (all || v.differs) width = std::max(width, v.path.size());
    std::string out;
    auto const shown = [](std::string const& text) {
        return text.empty() ? "-" : text.size() > 24 ? text.substr(0, 21) + "..." : text;
    };
    for (ResultValue const& v : values) {
        differing += v.differs;
        if (!all && !v.differs) continue;
        if (out.empty())
            out = fmt::format("{:<{}} {:>24} {:>24} {:>9}\n", "value", width, "A", "B", "differ");
        out += fmt::format("{:<{}} {:>24} {:>24} {:>9}\n", v.path, width, shown(v.a), shown(v.b),
                           v.relative == 0 ? "" : fmt::format("{:.3g} %", 100 * v.relative));
    }
    return out + fmt::format("{} values, {} differ\n", values.size(), differing);
}

} // namespace tessemu
