// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/stam/programs.h"

namespace tessemu {

TESSEMU_STAM_CURVED_PROGRAMS(template, FastScalar)

} // namespace tessemu
