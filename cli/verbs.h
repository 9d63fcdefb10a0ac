// The program's verbs, a file each. Such a function adds its verb: the options as a struct of typed
// values, and the work from there to library calls to what is printed. The work returns the exit
// status and throws Error for bad usage or bad input.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/command_line.h"

namespace tessemu {

void add_draw(CommandLine& program);
void add_export(CommandLine& program);
void add_tessellate(CommandLine& program);
void add_subdivide(CommandLine& program);
void add_tables(CommandLine& program);
void add_compare(CommandLine& program);
void add_check(CommandLine& program);
void add_cost(CommandLine& program);
void add_reproduce(CommandLine& program);
void add_diff(CommandLine& program);
void add_info(CommandLine& program);
void add_sweep(CommandLine& program);
void add_schemes(CommandLine& program);
void add_models(CommandLine& program);

} // namespace tessemu
