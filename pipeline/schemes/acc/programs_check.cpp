// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/acc/programs.h"

namespace tessemu {

TESSEMU_ACC_PROGRAMS(template, CheckScalar)

} // namespace tessemu
