// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/table_shaders.h"

namespace tessemu {

template struct TableShaders<TriangleSamples>;

} // namespace tessemu
