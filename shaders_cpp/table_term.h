// A term of a sum of weighted points, for schemes whose patches add the same ones in one order.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/records.h"

namespace tessemu {

/// sum + weight * point. A routine: whatever place the control point has in a patch's list, a
/// compiler fuses it alike.
template <class T> float3<T> add_term(float3<T> const& sum, T const& weight, float3<T> const& point)
{
    Routine<T> const here("table_term");
    return sum + weight * point;
}

} // namespace tessemu
