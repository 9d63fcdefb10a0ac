// Warnings of a file as it is read.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace tessemu {

/// Warnings by line; like ones are counted and told once.
class Notes {
public:
    Notes(std::string const& name, WarningSink const& sink) : name_(name), sink_(sink) {}

    void add(int line, std::string const& text) { notes_.push_back({line, text, 1}); }
    /// \param kind  what is counted together
    template <class Text> void count(std::string const& kind, int line, Text const& text)
    {
        auto const [at, fresh] = kinds_.try_emplace(kind, notes_.size());
        if (fresh)
            add(line, text());
        else
            ++notes_[at->second].number;
    }

    std::vector<std::string> tell()
    {
        std::stable_sort(notes_.begin(), notes_.end(),
                         [](Note const& a, Note const& b) { return a.line < b.line; });
        std::vector<std::string> out;
        for (Note const& n : notes_) {
            out.push_back(fmt::format("{}:{}: {}", name_, n.line, n.text));
            if (n.number > 1) out.back() += fmt::format(" (and {} more)", n.number - 1);
            if (sink_) sink_(out.back());
        }
        return out;
    }

private:
    struct Note {
        int line;
        std::string text;
        std::size_t number;
    };
    std::string const& name_;
    WarningSink const& sink_;
    std::vector<Note> notes_;
    std::map<std::string, std::size_t> kinds_;
};

} // namespace tessemu
