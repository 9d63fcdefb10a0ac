// tessemu: the program. Parses, calls a verb, prints errors.
//
// SPDX-License-Identifier: Apache-2.0
#include "cli/process.h"
#include "cli/verbs.h"
#include "io/report.h"

int main(int argc, char** argv)
{
    using namespace tessemu;
    set_up_process();
    CommandLine program("tessemu", tessemu_version(),
                        "The Direct3D 11 tessellation pipeline, emulated and counted.\n");
    for (auto const add_verb :
         {add_draw, add_export, add_tessellate, add_subdivide, add_tables, add_compare, add_check,
          add_cost, add_reproduce, add_sweep, add_diff, add_info, add_schemes, add_models})
        add_verb(program);
    int const status = program.run(argc, argv);
    return close_standard_output() ? status : 2;
}
