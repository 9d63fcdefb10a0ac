// SPDX-License-Identifier: Apache-2.0
#include "cli/command_line.h"

#include "cli/run_output.h"

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

} // namespace

struct Verb::Option {
    Syntax syntax;
    Set set;
    std::vector<std::string> texts; // as given
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
    app_.add_flag(name, value, about);
}

void Verb::exclude(std::string const& a, std::string const& b)
{
    app_.get_option(a)->excludes(app_.get_option(b));
}

bool Verb::given(std::string const& name) const
{
    return app_.count(name) > 0;
}

void Verb::needs(std::initializer_list<char const*> names, std::string const& what) const
{
    for (char const* name : names)
        if (given(name)) throw Error(fmt::format("{} needs {}", name, what));
}

int Verb::parse_and_work() const
{
    for (auto const& o : options_) {
        std::string const name = o->syntax.name.substr(0, o->syntax.name.find(','));
        for (std::string const& text : o->texts) o->set(text, name);
        if (o->texts.empty() && o->syntax.fallback) o->set(*o->syntax.fallback, name);
    }
    return work_();
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
    CLI::App* const app = app_->add_subcommand(name, about);
    app->set_version_flag("--version", version_);
    app->footer("Examples:\n" + examples);
    return *verbs_.emplace_back(std::make_unique<Verb>(*app));
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
    if (argc == 1) {
        print_message(app_->help());
        return 2;
    }
    // A verb that has options needs one, or an argument: given none, it shows its help.
    if (argc == 2)
        for (auto const& v : verbs_)
            if (v->app_.get_name() == argv[1] && !v->options_.empty()) {
                print_message(v->app_.help(name_));
                return 2;
            }
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
        if (app_->get_subcommands().empty()) { // CLI11 does not say which word it did not know
            std::string verbs;
            for (auto const& v : verbs_) verbs += " " + v->app_.get_name();
            throw Error(fmt::format("'{}' is not a verb; there are{}", argv[1], verbs));
        }
        std::string what = e.what();
        std::erase(what, kNumber);
        throw Error(what);
    }
    for (auto const& v : verbs_)
        if (v->app_.parsed()) return v->parse_and_work();
    return 2;
}

} // namespace tessemu
