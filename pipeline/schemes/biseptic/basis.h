// The basis of biseptic patches at extraordinary vertices of 3 to 12 edges: weights of a net's 2n + 8
// points (net order: pipeline/schemes/stam/eigen.h) in the 8 x 8 Bezier points.
//
// Loop and Schaefer's coefficients are not to be had. This basis is derived from what LOOP10 says of
// theirs: joined to the bicubics outside with two derivatives, with one tangent plane along spokes,
// with one curvature at the vertex (docs/math/subdivision.md, 3).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tessemu {

inline constexpr int kMinBisepticValence = 3, kMaxBisepticValence = 12;

/// Of one valence. A patch's point (j, i) has the weights of point (i, j) at the net's points
/// mirrored in u = v, and on a spoke also those mirrored in the spoke, to the bit: so both patches
/// at a spoke have its points.
class BisepticBasis {
public:
    /// \param valence  3 to 12
    explicit BisepticBasis(int valence);

    int valence() const { return valence_; }
    int points() const { return 2 * valence_ + 8; } ///< of the net
    /// Of Bezier point i along u, j along v, for each point of the net. They add up to 1.
    std::span<double const> weights(int i, int j) const
    {
        auto const n = std::size_t(points());
        return {weights_.data() + std::size_t(8 * i + j) * n, n};
    }

    /// Points of the net that a spoke, the edge to e_0, depends on: EV, the ring, (2,1) (2,0) (2,-1).
    std::vector<int> spoke() const;
    /// Where the spoke to e_1 has the same points.
    std::vector<int> next_spoke() const;

private:
    int valence_;
    std::vector<double> weights_; // [8 i + j][point]
};

/// Of Bezier points (i, j), 4 >= i >= j, in the order (0,0), (1,0), (1,1), (2,0), ...: the weights
/// of the net's points but EV, whose weight is 1 without the others'.
std::span<double const> biseptic_inner_weights(int valence);

} // namespace tessemu
