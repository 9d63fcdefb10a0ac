// The program's verbs: from options to library calls to what is printed. Each returns the exit
// status and throws Error for bad usage or bad input.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/options.h"

namespace tessemu {

int run_draw(Options const& o);
int run_export(Options const& o);
int run_compare(Options const& o);
int run_check(Options const& o);
int run_cost(Options const& o);
int run_reproduce(Options const& o);
int run_diff(Options const& o);
int run_info(Options const& o);
int run_tessellate(Options const& o);
int run_schemes(Options const& o);
int run_models(Options const& o);

} // namespace tessemu
