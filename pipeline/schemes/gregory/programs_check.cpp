// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/gregory/programs.h"

namespace tessemu {

TESSEMU_GREGORY_PROGRAMS(template, CheckScalar)

} // namespace tessemu
