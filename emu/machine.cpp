// SPDX-License-Identifier: Apache-2.0
#include "emu/machine.h"

#include <algorithm>
#include <iterator>

namespace tessemu {

void check_lanes(int lanes)
{
    if (std::find(std::begin(kBuiltLanes), std::end(kBuiltLanes), lanes) != std::end(kBuiltLanes))
        return;
    if (lanes != 4 && lanes != 8 && lanes != 16)
        throw Error("lanes is " + std::to_string(lanes) + ", it must be 4, 8 or 16");
    throw Error("lanes is " + std::to_string(lanes) + ", this build holds " +
                std::to_string(kNativeLanes) +
                ": the CMake option TESSEMU_ALL_LANES=ON builds 4, 8 and 16");
}

} // namespace tessemu
