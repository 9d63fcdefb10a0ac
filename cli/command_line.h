// Verbs and their options on the command line. CLI11 is behind it, in one file: its header takes
// four seconds to compile.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace CLI {
class App;
}

namespace tessemu {

struct Session;

/// What a verb takes and does.
///
/// A parser is a function (text, option) that gives a value, or throws Error that names the option,
/// the text and what is allowed. Parsers run once every word has its place, so help and missing
/// arguments come before bad values; in the order of the options; then the verb's work runs. Values
/// must live as long as the work: it holds them.
class Verb {
public:
    explicit Verb(CLI::App& app);
    Verb(Verb const&) = delete;
    ~Verb();

    /// An argument ("MODEL") or option that must be given.
    template <class T, class Parse>
    void required(std::string const& name, T& value, Parse parse, std::string const& about)
    {
        add({name, about, type_of<T>(), {}, true}, set(value, std::move(parse)));
    }
    /// \param fallback  is parsed where the option is not given, and shown in the help
    template <class T, class Parse>
    void option(std::string const& name, T& value, Parse parse, std::string const& about,
                std::string const& fallback)
    {
        add({name, about, type_of<T>(), fallback}, set(value, std::move(parse)));
    }
    /// Leaves the value alone where the option is not given.
    template <class T, class Parse>
    void option(std::string const& name, T& value, Parse parse, std::string const& about)
    {
        add({name, about, type_of<T>()}, set(value, std::move(parse)));
    }
    /// Takes any number of values, each through the parser.
    template <class T, class Parse>
    void list(std::string const& name, std::vector<T>& values, Parse parse,
              std::string const& about)
    {
        add({name, about, type_of<T>(), {}, false, Values::Many}, append(values, std::move(parse)));
    }
    /// May be given any number of times, with a value each.
    template <class T, class Parse>
    void repeated(std::string const& name, std::vector<T>& values, Parse parse,
                  std::string const& about)
    {
        add({name, about, type_of<T>(), {}, false, Values::OneEach},
            append(values, std::move(parse)));
    }
    void flag(std::string const& name, bool& value, std::string const& about);
    /// At most one of two options may be given.
    void exclude(std::string const& a, std::string const& b);
    bool given(std::string const& name) const;
    /// Throws Error where one of the options is given, which does nothing without `what`.
    void needs(std::initializer_list<char const*> names, std::string const& what) const;
    /// \param work  gives the exit status
    void runs(std::function<int(Session const&)> work) { work_ = std::move(work); }

    /// What a program that sets options by name knows of one.
    struct OptionInfo {
        std::string name; ///< as on the command line: "--tess", "MODEL"
        bool repeated, flag, required;
        std::optional<std::string> fallback;
    };
    std::vector<OptionInfo> options() const;
    /// Parses a text. Throws Error, in which the option is called `label`.
    void check(std::string const& name, std::string const& text, std::string const& label) const;
    /// Once: with options as texts by name, each checked before; of a flag "true" or "false".
    int run(std::map<std::string, std::vector<std::string>> const& options, Session const& session);

private:
    friend class CommandLine;
    using Set = std::function<void(std::string const& text, std::string const& option)>;
    enum class Values { One, OneEach, Many, Flag };
    struct Syntax {
        std::string name, about;
        char const* type;
        std::optional<std::string> fallback = {};
        bool required = false;
        Values values = Values::One;
    };
    struct Option;

    template <class T> static char const* type_of()
    {
        if constexpr (std::is_same_v<T, bool>) return "TEXT"; // two words
        if constexpr (std::is_integral_v<T> || std::is_same_v<T, std::optional<int>>) return "INT";
        if constexpr (std::is_floating_point_v<T> || std::is_same_v<T, std::optional<double>>)
            return "FLOAT";
        return "TEXT";
    }
    template <class T, class Parse> static Set set(T& value, Parse parse)
    {
        return [&value, p = std::move(parse)](std::string const& text, std::string const& option) {
            value = p(text, option);
        };
    }
    template <class T, class Parse> static Set append(std::vector<T>& values, Parse parse)
    {
        return [&values, p = std::move(parse)](std::string const& text, std::string const& option) {
            values.push_back(p(text, option));
        };
    }
    void add(Syntax syntax, Set set);
    int parse_and_work(Session const& session) const;
    Option& find(std::string const& name) const;

    CLI::App& app_;
    std::vector<std::unique_ptr<Option>> options_;
    std::function<int(Session const&)> work_;
};

/// Text as it is.
inline std::string plain(std::string const& text, std::string const&)
{
    return text;
}

class CommandLine {
public:
    CommandLine(std::string const& name, std::string_view version, std::string const& about);
    ~CommandLine();

    /// \param name  of two words: of a group that add_group() made
    Verb& add_verb(std::string const& name, std::string const& about, std::string const& examples);
    void add_group(std::string const& name, std::string const& about);
    /// The only verb, of a program that has one.
    Verb& verb() { return *verbs_.front(); }
    /// The exit status. Prints help, version, and an error as a line on standard error.
    int run(int argc, char const* const* argv);

private:
    int parse_and_work(int argc, char const* const* argv);
    bool show_help(std::vector<std::string> const& words) const;

    std::string name_, version_;
    std::unique_ptr<CLI::App> app_;
    std::vector<std::unique_ptr<Verb>> verbs_;
};

} // namespace tessemu
