// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/biseptic/programs.h"

namespace tessemu {

TESSEMU_BISEPTIC_CURVED_PROGRAMS(template, CheckScalar)

} // namespace tessemu
