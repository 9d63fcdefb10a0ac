// Errors that tessemu throws at its public edge.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace tessemu {

/// Base of every error; what() names the thing, its value and the limit.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A limit of Direct3D 11, or of a scheme, is exceeded.
struct LimitError : Error {
    LimitError(std::string const& thing, std::uint64_t value_, std::uint64_t limit_)
        : Error(thing + " is " + std::to_string(value_) + ", the limit is " +
                std::to_string(limit_)),
          value(value_),
          limit(limit_)
    {
    }
    std::uint64_t value, limit;
};

/// "a, b or c": what is allowed
inline std::string in_words(std::vector<std::string> const& words)
{
    std::string out;
    for (std::size_t i = 0; i < words.size(); ++i)
        out += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    return out;
}

/// A file cannot be read or holds something that is not valid.
struct FormatError : Error {
    FormatError(std::string const& file_, int line_, std::string const& what)
        : Error(message(file_, line_, what)),
          file(file_),
          line(line_)
    {
    }
    std::string file;
    int line; ///< counted from 1; 0: the whole file

private:
    static std::string message(std::string text, int line, std::string const& what)
    {
        if (line > 0) text.append(":").append(std::to_string(line));
        return text.append(": ").append(what);
    }
};

} // namespace tessemu
