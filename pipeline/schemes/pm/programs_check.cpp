// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/pm/programs.h"

namespace tessemu {

TESSEMU_PM_PROGRAMS(template, CheckScalar)

} // namespace tessemu
