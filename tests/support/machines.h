// All machines of a build that must give the same bits and counts.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/machine.h"

#include <ostream>
#include <vector>

namespace tessemu {

inline void PrintTo(Machine const& m, std::ostream* out)
{
    *out << m.lanes << " lanes, " << (m.checking ? "checking" : "fast") << ", contraction "
         << int(m.contraction) << ", seed " << m.seed;
}

namespace test {

/// Fast and checking form at every lane count that the build holds; with a contraction the two are
/// the same and there is one of each.
inline std::vector<Machine> machines(Contraction contraction = Contraction::None,
                                     std::uint64_t seed = 0)
{
    std::vector<Machine> out;
    for (int lanes : kBuiltLanes) {
        out.push_back({lanes, contraction, seed});
        if (contraction == Contraction::None) out.push_back({lanes, contraction, seed, true});
    }
    return out;
}

} // namespace test
} // namespace tessemu
