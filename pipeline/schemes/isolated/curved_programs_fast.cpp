// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/isolated/programs.h"

namespace tessemu {

TESSEMU_ISOLATED_CURVED_PROGRAMS(template, FastScalar)

} // namespace tessemu
