// SPDX-License-Identifier: Apache-2.0
#include "sweep/sweep_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace tessemu {

using Json = nlohmann::ordered_json;

namespace {

// Parses JSON that names no key twice: the parser keeps the last one and says nothing.
Json parse(std::string_view text, std::string const& file)
{
    std::vector<std::vector<std::string>> keys;
    auto const see = [&](int, Json::parse_event_t event, Json& value) {
        if (event == Json::parse_event_t::object_start) keys.emplace_back();
        if (event == Json::parse_event_t::object_end) keys.pop_back();
        if (event == Json::parse_event_t::key) {
            auto const& key = value.get_ref<std::string const&>();
            if (std::find(keys.back().begin(), keys.back().end(), key) != keys.back().end())
                throw FormatError(file, 0, "\"" + key + "\" is there twice");
            keys.back().push_back(key);
        }
        return true;
    };
    try {
        return Json::parse(text, see);
    } catch (Json::out_of_range const&) {
        throw FormatError(file, 0, "a number is beyond what a double holds");
    } catch (Json::parse_error const& e) {
        auto const end = text.begin() + std::ptrdiff_t(std::min<std::size_t>(e.byte, text.size()));
        throw FormatError(file, 1 + int(std::count(text.begin(), end, '\n')), "this is not JSON");
    }
}

class Reader {
public:
    Reader(std::string const& file, SweepVerb const& verb) : file_(file), verb_(verb) {}

    Sweep read(Json const& j) const
    {
        Sweep out;
        out.verb = verb_.name;
        for (auto const& [key, value] : j.items()) {
            if (key == "verb") continue;
            if (key == "cases") {
                for (Json const& c : objects(key, value)) out.cases.push_back(single(c));
            } else if (key == "except") {
                for (Json const& e : objects(key, value)) out.except.push_back(axes(e));
            } else {
                out.grid.push_back(axis(key, value));
            }
        }
        check_names_once(out.grid);
        std::stable_sort(out.grid.begin(), out.grid.end(),
                         [](Sweep::Axis const& a, Sweep::Axis const& b) {
                             return option_rank(a.option) < option_rank(b.option);
                         });
        for (SweepVerb::Option const& o : verb_.options) {
            if (!o.required) continue;
            auto const names = [&](Sweep::Axis const& a) { return a.option == o.name; };
            if (!out.grid.empty() && std::none_of(out.grid.begin(), out.grid.end(), names))
                fail(fmt::format("there is no \"{}s\"", o.name));
            for (CaseOptions const& c : out.cases)
                if (c.count(o.name) == 0)
                    fail(fmt::format("one of \"cases\" has no \"{}\"", o.name));
        }
        if (out.grid.empty() && out.cases.empty())
            fail("there is no case: no \"models\", no \"cases\"");
        return out;
    }

private:
    [[noreturn]] void fail(std::string const& what) const { throw FormatError(file_, 0, what); }

    void check_names_once(std::vector<Sweep::Axis> const& axes) const
    {
        for (std::size_t i = 0; i < axes.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                if (axes[i].option == axes[k].option)
                    fail(fmt::format("\"{0}\" and \"{0}s\" are the same", axes[i].option));
    }

    Json const& objects(std::string const& key, Json const& list) const
    {
        bool const good =
            list.is_array() &&
            std::all_of(list.begin(), list.end(), [](Json const& j) { return j.is_object(); });
        if (!good)
            fail("\"" + key + "\" must be a list of objects, such as [{\"model\": \"jug\"}]");
        return list;
    }

    SweepVerb::Option const& option(std::string const& key) const
    {
        std::string const name = key == "models" ? "model" : key == "schemes" ? "scheme" : key;
        std::vector<std::string> known;
        for (SweepVerb::Option const& o : verb_.options) {
            if (o.name == name) return o;
            known.push_back(o.name);
        }
        std::sort(known.begin(), known.end());
        fail(fmt::format("\"{}\" is no option of {} that a sweep can set; there are {}", key,
                         verb_.name, in_words(known)));
    }

    std::string text_of(std::string const& key, Json const& j) const
    {
        if (j.is_string()) return j.get<std::string>();
        if (j.is_number_float()) return fmt::format("{}", j.get<double>());
        if (j.is_number() || j.is_boolean()) return j.dump();
        fail(fmt::format("\"{}\" has {}, which is neither a text nor a number", key,
                         j.dump().substr(0, 60)));
    }

    // One value: several texts only of an option that may be given several times.
    std::vector<std::string> value(SweepVerb::Option const& o, std::string const& key,
                                   Json const& j) const
    {
        std::vector<std::string> texts;
        if (o.repeated && j.is_array())
            for (Json const& t : j) texts.push_back(text_of(key, t));
        else
            texts.push_back(text_of(key, j));
        for (std::string const& text : texts) {
            if (o.flag && text != "true" && text != "false")
                fail(fmt::format("\"{}\" is {}, it must be true or false", key, j.dump()));
            if (!o.flag) check(o, key, text);
        }
        return texts;
    }

    void check(SweepVerb::Option const& o, std::string const& key, std::string const& text) const
    {
        std::string const label = "\"" + key + "\"";
        try {
            verb_.check(o, text, label);
        } catch (Error const& e) {
            std::string const what = e.what();
            fail(what.starts_with(label) ? what : label + ": " + what);
        }
    }

    Sweep::Axis axis(std::string const& key, Json const& list) const
    {
        SweepVerb::Option const& o = option(key);
        Sweep::Axis out{o.name, {}};
        if (!list.is_array())
            out.values.push_back(value(o, key, list));
        else
            for (Json const& j : list) out.values.push_back(value(o, key, j));
        if (out.values.empty()) fail("\"" + key + "\" is an empty list: there would be no case");
        return out;
    }

    std::vector<Sweep::Axis> axes(Json const& object) const
    {
        std::vector<Sweep::Axis> out;
        for (auto const& [key, list] : object.items()) out.push_back(axis(key, list));
        if (out.empty()) fail("one of \"except\" is {}, which is every case");
        check_names_once(out);
        return out;
    }

    CaseOptions single(Json const& object) const
    {
        CaseOptions out;
        for (Sweep::Axis& a : axes_of_case(object)) out[a.option] = std::move(a.values[0]);
        return out;
    }
    std::vector<Sweep::Axis> axes_of_case(Json const& object) const
    {
        std::vector<Sweep::Axis> out;
        for (auto const& [key, j] : object.items()) {
            SweepVerb::Option const& o = option(key);
            if (j.is_array() && !o.repeated)
                fail(
                    fmt::format("\"{}\" of one of \"cases\" is a list; a case has one value", key));
            out.push_back({o.name, {value(o, key, j)}});
        }
        check_names_once(out);
        return out;
    }

    std::string const& file_;
    SweepVerb const& verb_;
};

} // namespace

Sweep read_sweep(std::string_view text, std::string const& file,
                 std::function<SweepVerb(std::string const& name)> const& find_verb)
{
    Json const j = parse(text, file);
    if (!j.is_object() || !j.contains("verb") || !j["verb"].is_string())
        throw FormatError(file, 0,
                          "a sweep is an object with a \"verb\", such as {\"verb\": \"draw\", "
                          "\"models\": [\"jug\"], \"tess\": [1, 2, 4]}");
    SweepVerb verb;
    try {
        verb = find_verb(j["verb"].get<std::string>());
    } catch (Error const& e) {
        throw FormatError(file, 0, e.what());
    }
    return Reader(file, verb).read(j);
}

// Tables of a model are made once where its cases follow each other.
int option_rank(std::string const& option)
{
    return option == "model" ? 0 : option == "scheme" ? 1 : 2;
}

std::vector<CaseOptions> cases_of(Sweep const& sweep)
{
    std::vector<CaseOptions> out;
    std::uint64_t all = sweep.grid.empty() ? 0 : 1;
    for (Sweep::Axis const& a : sweep.grid) {
        all *= a.values.size();
        if (all > kMostCases) throw LimitError("cases of the sweep", all, kMostCases);
    }
    std::vector<bool> used(sweep.except.size());
    for (std::uint64_t i = 0; i < all; ++i) {
        CaseOptions c;
        std::uint64_t rest = i;
        for (auto a = sweep.grid.rbegin(); a != sweep.grid.rend(); ++a) {
            c[a->option] = a->values[rest % a->values.size()];
            rest /= a->values.size();
        }
        auto const matches = [&](std::vector<Sweep::Axis> const& exception) {
            return std::all_of(exception.begin(), exception.end(), [&](Sweep::Axis const& a) {
                auto const own = c.find(a.option);
                return own != c.end() &&
                       std::find(a.values.begin(), a.values.end(), own->second) != a.values.end();
            });
        };
        bool left_out = false;
        for (std::size_t e = 0; e < sweep.except.size(); ++e)
            if (matches(sweep.except[e])) left_out = used[e] = true;
        if (!left_out) out.push_back(std::move(c));
    }
    for (std::size_t e = 0; e < used.size(); ++e)
        if (!used[e])
            throw Error(
                fmt::format("number {} of \"except\" leaves out no case of the grid", e + 1));
    out.insert(out.end(), sweep.cases.begin(), sweep.cases.end());
    return out;
}

} // namespace tessemu
