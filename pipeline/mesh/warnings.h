// Who hears warnings as they arise, so that one stands before the error that follows from it.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace tessemu {

/// Called with each warning, a line of text; may be empty.
using WarningSink = std::function<void(std::string const&)>;

} // namespace tessemu
