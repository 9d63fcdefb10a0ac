// Statements, words and numbers of an OBJ file.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tessemu {

/// What a line is to a surface.
enum class Meaning {
    Vertex,
    Coordinates,
    Normal,
    Face,
    Tag,
    Lines,
    Points,
    FreeForm,
    Command, ///< reads or runs something else
    None,    ///< names, materials, how something is shown
    Unknown
};

Meaning meaning_of(std::string_view keyword);

/// The text, statement by statement. Throws FormatError for more than 2^31 - 1 lines.
class Statements {
public:
    Statements(std::string_view text, std::string const& name) : rest_(text), name_(name) {}

    /// To the next line that says something; false at the end. One that continues is whole only
    /// after join().
    bool next();
    /// Takes the lines that continue this one.
    void join()
    {
        while (continues_ && !rest_.empty()) continues_ = take_line();
    }

    std::vector<std::string_view> words; ///< the keyword first, without comments
    int line = 0;                        ///< where the statement begins

private:
    // Adds a line's words; says whether a backslash ends it.
    bool take_line();

    std::string_view rest_;
    std::string const& name_;
    std::int64_t next_line_ = 1;
    bool continues_ = false;
};

/// Where a decimal number, `e` its exponent's letter or its end, has the decimal point if that is
/// moved by the exponent: characters from its first one.
std::int64_t point_of(std::string_view s, std::size_t e);
/// Where a number's exponent begins, or its end.
std::size_t exponent_in(std::string_view s);
/// Of a number that is not representable: whether it is so small that it is 0.
bool is_tiny(std::string_view s);

enum class Reading { Number, TooLarge, NoNumber };

/// A decimal number, rounded once. "nan", "inf", hexadecimal and half-read words are none.
template <class Number> Reading read_number(std::string_view s, Number& out)
{
    if (s.starts_with('+')) s.remove_prefix(s.substr(1).starts_with('-') ? 0 : 1);
    auto const [end, error] = std::from_chars(s.data(), s.data() + s.size(), out);
    if (error == std::errc::invalid_argument || end != s.data() + s.size())
        return Reading::NoNumber;
    if (error == std::errc::result_out_of_range) {
        if constexpr (std::is_integral_v<Number>) return Reading::TooLarge;
        if (!is_tiny(s)) return Reading::TooLarge;
        out = 0;
    }
    if constexpr (!std::is_integral_v<Number>)
        if (!std::isfinite(out)) return Reading::NoNumber;
    return Reading::Number;
}

template <class Number> bool is_number(std::string_view s, Number& out)
{
    return read_number(s, out) == Reading::Number;
}

/// Whether a double lies in the middle between two floats, where rounding twice may go wrong.
bool is_between_floats(double x);
/// A word of the file in a message.
std::string shown(std::string_view s);

} // namespace tessemu
