// A biseptic patch outside a pipeline, in single or double precision.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/schemes/biseptic/basis.h"
#include "shaders_cpp/biseptic/biseptic_quad.h"

#include <vector>

namespace tessemu::test {

template <class F> class BisepticEvaluation {
public:
    /// As the hull shader makes the points: net[point][coordinate], in the net's order.
    template <class Net> BisepticEvaluation(int valence, Net const& net)
    {
        BisepticBasis const basis(valence);
        for (int i = 0; i < kBisepticSide; ++i)
            for (int j = 0; j < kBisepticSide; ++j) {
                F sum[3] = {};
                for (std::size_t p = 0; p < std::size_t(basis.points()); ++p)
                    for (std::size_t k = 0; k < 3; ++k)
                        sum[k] += F(basis.weights(i, j)[p]) * F(double(net[p][k]));
                points_.push_back({sum[0], sum[1], sum[2]});
            }
    }
    TangentFrame<F> at(double u, double v) const
    {
        return biseptic_quad<F>([&](int i, int j) { return point(i, j); }, F(u), F(v));
    }
    SecondOrderFrame<F> second_order_at(double u, double v) const
    {
        return biseptic_second_order<F>([&](int i, int j) { return point(i, j); }, F(u), F(v));
    }

private:
    float3<F> point(int i, int j) const { return points_[std::size_t(kBisepticSide * i + j)]; }
    std::vector<float3<F>> points_; // [8 i + j]
};

} // namespace tessemu::test
