// Domain points as the stages after the tessellator want them, and the patterns that patches share.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/tessellator.h"

#include <memory>
#include <unordered_map>

namespace tessemu {

/// A tessellated patch with its domain points as floats, ready for the domain shader.
struct DomainPoints {
    TessellatedPatch patch;
    std::vector<float> u, v; ///< exact; padded by a whole group of lanes, the last point again
    /// Of triangle output: the indices by corner, padded to a whole group by degenerate triangles.
    std::array<std::vector<std::uint32_t>, 3> corner;

    /// How a group of kLanes triangles finds its corners among two runs of kLanes points each,
    /// which most groups of a ring do: corner k of triangle i is point place[k][i] of the runs, or
    /// `gather` is set.
    template <int kLanes> struct Strip {
        std::uint32_t run[2];
        bool gather;
        std::uint8_t place[3][kLanes];
    };
    std::vector<Strip<16>> strips16;
    std::vector<Strip<8>> strips8;
};

/// Serves repeated factors. One per thread; holds at most `capacity` patterns.
class TessellatorCache {
public:
    explicit TessellatorCache(TessellatorState state, std::size_t capacity = 256)
        : state_(state),
          capacity_(capacity)
    {
    }

    /// The pattern of these factors, tessellated now or before. It stays valid as long as it is
    /// held.
    std::shared_ptr<DomainPoints const> find(TessFactors const& factors);

private:
    struct Hash {
        std::size_t operator()(FixedFactors const& f) const;
    };
    TessellatorState state_;
    std::size_t capacity_;
    std::unordered_map<FixedFactors, std::shared_ptr<DomainPoints const>, Hash> entries_;
};

} // namespace tessemu
