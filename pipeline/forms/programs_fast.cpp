// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/programs.h"

namespace tessemu {

TESSEMU_FORM_PROGRAMS(template, FastScalar)

} // namespace tessemu
