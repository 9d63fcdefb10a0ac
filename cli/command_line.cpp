// SPDX-License-Identifier: Apache-2.0
#include "cli/command_line.h"

#include "cli/run_output.h"
#include "cli/session.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <sstream>

namespace tessemu {

namespace {

// CLI11 takes -1 for a number and -inf and -.5 for options. They reach it behind this sign.
constexpr char kNumber = '\x01';

std::string marked(std::string const& word)
{
    double x = 0;
    auto const [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
    bool const number = error == std::errc() && end == word.data() + word.size();
    return number && word.starts_with('-') ? kNumber + word : word;
}

std::vector<CLI::App const*> subcommands_of(CLI::App const& app)
{
    return app.get_subcommands([](CLI::App const*) { return true; });
}

} // namespace

struct Verb::Option {
    Syntax syntax;
    Set set;
    std::vector<std::string> texts; // as given

    std::string name() const { return syntax.name.substr(0, syntax.name.find(',')); }
};

Verb::Verb(CLI::App& app) : app_(app) {}

Verb::~Verb() = default;

void Verb::add(Syntax syntax, Set set)
{
    Option& o = *options_.emplace_back(
        std::make_unique<Option>(Option{std::move(syntax), std::move(set), {}}));
    Syntax const& s = o.syntax;
    // The callback that takes text as it is: CLI11's conversion to strings gives [a,b] and {} a
    // meaning.
    CLI::Option* const option = app_.add_option(
        s.name,
        [&o](CLI::results_t texts) {
            for (std::string& t : texts)
                if (t.starts_with(kNumber)) t.erase(0, 1);
            o.texts = std::move(texts);
            return true;
        },
        s.about);
    option->type_name(s.type);
    if (s.values != Values::One) option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    if (s.values == Values::Many) option->expected(1, -1)->allow_extra_args();
    if (s.required) option->required();
    if (s.fallback) option->default_str(*s.fallback);
}

void Verb::flag(std::string const& name, bool& value, std::string const& about)
{
    Option& o = *options_.emplace_back(std::make_unique<Option>(
        Option{{name, about, "", {}, false, Values::Flag},
               [&value](std::string const& text, std::string const&) { value = text == "true"; },
               {}}));
    app_.add_flag_function(
        name, [&o](std::int64_t) { o.texts = {"true"}; }, about);
}

void Verb::exclude(std::string const& a, std::string const& b)
{
    app_.get_option(a)->excludes(app_.get_option(b));
}

Verb::Option& Verb::find(std::string const& name) const
{
    for (auto const& o : options_)
        if (o->name() == name) return *o;
    throw Error(name + " is no option of " + app_.get_name());
}

bool Verb::given(std::string const& name) const
{
    return !find(name).texts.empty();
}

void Verb::needs(std::initializer_list<char const*> names, std::string const& what) const
{
    for (char const* name : names)
        if (given(name)) throw Error(fmt::format("{} needs {}", name, what));
}

std::vector<Verb::OptionInfo> Verb::options() const
{
    std::vector<OptionInfo> out;
    for (auto const& o : options_) {
        Syntax const& s = o->syntax;
        out.push_back({o->name(), s.values == Values::OneEach || s.values == Values::Many,
                       s.values == Values::Flag, s.required, s.fallback});
    }
    return out;
}

void Verb::check(std::string const& name, std::string const& text, std::string const& label) const
{
    find(name).set(text, label);
}

int Verb::run(std::map<std::string, std::vector<std::string>> const& options,
              Session const& session)
{
    for (auto const& [name, texts] : options) {
        Option& o = find(name);
        o.texts = texts;
        if (o.syntax.values == Values::Flag) std::erase(o.texts, "false");
    }
    return parse_and_work(session);
}

int Verb::parse_and_work(Session const& session) const
{
    for (auto const& o : options_) {
        for (std::string const& text : o->texts) o->set(text, o->name());
        if (o->texts.empty() && o->syntax.fallback) o->set(*o->syntax.fallback, o->name());
    }
    return work_(session);
}

CommandLine::CommandLine(std::string const& name, std::string_view version,
                         std::string const& about)
    : name_(name),
      version_(name + " " + std::string(version)),
      app_(std::make_unique<CLI::App>(about, name))
{
    app_->set_version_flag("--version", version_);
    app_->require_subcommand(1);
}

CommandLine::~CommandLine() = default;

Verb& CommandLine::add_verb(std::string const& name, std::string const& about,
                            std::string const& examples)
{
    std::size_t const space = name.find(' ');
    CLI::App* const parent =
        space == std::string::npos ? app_.get() : app_->get_subcommand(name.substr(0, space));
    CLI::App* const app = parent->add_subcommand(name.substr(space + 1), about);
    app->set_version_flag("--version", version_);
    app->footer("Examples:\n" + examples);
    return *verbs_.emplace_back(std::make_unique<Verb>(*app));
}

void CommandLine::add_group(std::string const& name, std::string const& about)
{
    app_->add_subcommand(name, about)->require_subcommand(1);
}

// A verb that has options needs one, or an argument, and a group a verb: given none, they show their
// help.
bool CommandLine::show_help(std::vector<std::string> const& words) const
{
    CLI::App const* app = app_.get();
    std::string path = name_;
    for (std::string const& word : words) {
        auto const below =
            app->get_subcommands([&](CLI::App const* a) { return a->get_name() == word; });
        if (below.empty()) return false;
        if (app != app_.get()) path += " " + app->get_name();
        app = below.front();
    }
    for (auto const& v : verbs_)
        if (&v->app_ == app && v->options_.empty()) return false;
    print_message(words.empty() ? app->help() : app->help(path));
    return true;
}

int CommandLine::run(int argc, char const* const* argv)
{
    try {
        return parse_and_work(argc, argv);
    } catch (std::bad_alloc const&) {
        print_message(fmt::format("{}: out of memory: fewer steps of subdivision, a smaller tess "
                                  "factor or a smaller picture need less\n",
                                  name_));
        return 2;
    } catch (std::exception const& e) {
        print_message(fmt::format("{}: {}\n", name_, e.what()));
        return 2;
    }
}

int CommandLine::parse_and_work(int argc, char const* const* argv)
{
    if (show_help({argv + 1, argv + argc})) return 2;
    try {
        std::vector<std::string> words; // CLI11 takes them from the last to the first
        for (int i = argc - 1; i > 0; --i) words.push_back(marked(argv[i]));
        app_->parse(std::move(words));
    } catch (CLI::ParseError const& e) {
        if (e.get_exit_code() == 0) {
            std::ostringstream text;
            app_->exit(e, text);
            print(text.str());
            return 0;
        }
        // CLI11 does not say which word it did not know.
        CLI::App const* app = app_.get();
        int known = 1;
        for (; !app->get_subcommands().empty(); ++known) app = app->get_subcommands().front();
        if (auto const verbs = subcommands_of(*app); !verbs.empty()) {
            std::string names;
            for (CLI::App const* v : verbs) names += " " + v->get_name();
            throw Error(fmt::format("'{}' is not a verb{}; there are{}", argv[known],
                                    known > 1 ? " of " + app->get_name() : "", names));
        }
        std::string what = e.what();
        std::erase(what, kNumber);
        throw Error(what);
    }
    for (auto const& v : verbs_)
        if (v->app_.parsed()) return v->parse_and_work({});
    return 2;
}

} // namespace tessemu
