// Stam's evaluation outside a pipeline, in single or double precision.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/schemes/stam/eigen.h"
#include "shaders_cpp/stam/stam_quad.h"

#include <vector>

namespace tessemu::test {

/// A valence's tables, and a net in eigen space.
template <class F> struct Evaluation {
    StamEigen eigen;
    std::vector<F> splines, powers, projected;

    explicit Evaluation(int valence) : eigen(stam_eigen(valence))
    {
        auto const size = std::size_t(eigen.functions());
        for (auto const& spline : eigen.splines)
            for (std::size_t f = 0; f < size; ++f)
                for (std::size_t p = 0; p < 16; ++p) splines.push_back(F(spline[p * size + f]));
        std::vector<double> power(size, 1);
        for (int k = 0; k < kStamRings; ++k)
            for (std::size_t f = 0; f < size; ++f) {
                powers.push_back(F(power[f]));
                power[f] *= eigen.eigenvalues[f];
            }
    }
    StamTables<F> tables() const
    {
        return {eigen.functions(), {splines, 0, "splines"}, {powers, 1, "powers"}};
    }
    /// As the hull shader does: net[point][coordinate], in the net's order.
    template <class Net> void project(Net const& net)
    {
        auto const size = std::size_t(eigen.functions());
        projected.assign(3 * size, F(0));
        for (std::size_t f = 0; f < size; ++f)
            for (std::size_t p = 0; p < size; ++p)
                for (std::size_t k = 0; k < 3; ++k)
                    projected[3 * f + k] += F(eigen.inverse[f * size + p]) * F(double(net[p][k]));
    }
    TangentFrame<F> at(double u, double v) const
    {
        return stam_quad<F>(
            tables(), [&](int i) { return point(i); }, F(u), F(v));
    }
    SecondOrderFrame<F> second_order_at(double u, double v) const
    {
        return stam_second_order<F>(
            tables(), [&](int i) { return point(i); }, F(u), F(v));
    }

private:
    float3<F> point(int i) const
    {
        F const* const p = projected.data() + 3 * i;
        return {p[0], p[1], p[2]};
    }
};

} // namespace tessemu::test
