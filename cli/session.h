// What a verb's run shares with others of its process, and where its result goes.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/parallel.h"

#include <optional>
#include <string>

namespace tessemu {

class SurfaceStore;

/// A run of the program has one with nothing in it.
struct Session {
    ThreadPool const* threads = nullptr; ///< null: as -j says
    SurfaceStore* surfaces = nullptr;    ///< null: a run opens its model for itself
    /// Takes the result as JSON; then nothing is printed and nothing written. Null: it goes where the
    /// options say.
    std::string* result = nullptr;

    /// \param own  is made where threads are not shared
    ThreadPool const& pool(int count, std::optional<ThreadPool>& own) const
    {
        return threads ? *threads : own.emplace(count);
    }
    void warn(std::string const& warning) const;
};

} // namespace tessemu
