// The program as a process: its descriptors and signals.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace tessemu {

/// Call first, before there are threads.
///
/// A descriptor of 0 to 2 that the caller closed is taken, so that no file gets its number and what
/// is printed; it can neither be read nor written. Of a reader that is gone and of a file beyond a
/// limit the writer hears instead of being killed. SIGINT, SIGTERM and SIGHUP remove temporaries
/// before they end the process.
void set_up_process();

/// Closes standard output. False, with a message, where that shows that bytes are lost.
bool close_standard_output();

/// Another program to its end, its errors where ours go. Throws Error where it cannot be started, or
/// ends otherwise than with status 0.
/// \returns  what it prints
std::string run_program(std::vector<std::string> const& words);

/// Where this program's file is.
std::string own_path();

} // namespace tessemu
