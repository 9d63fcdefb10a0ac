// Built-in control cages: the files of models/, as text inside the library.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace tessemu {

struct BuiltinModel {
    std::string_view name;
    std::string_view obj; ///< OBJ text; its first comment line says what it shows
};

/// The first one is the default cage.
std::span<BuiltinModel const> builtin_models();

} // namespace tessemu
