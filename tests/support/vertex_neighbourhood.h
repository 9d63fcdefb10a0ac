// The faces around an extraordinary vertex and the next ones, as nets of its patches.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace tessemu::test {

/// Around EV lie n sectors; of sector j, x along e_j and y along e_(j+1), the points (1,0) = e_j
/// and (1,1) = f_j, then (2,0), (2,1), (2,2) and (1,2).
class VertexNeighbourhood {
public:
    using Point = std::array<double, 3>;

    /// In general position: a regular star on a saddle, each coordinate moved by up to 0.04.
    VertexNeighbourhood(int valence, unsigned seed) : n_(std::size_t(valence))
    {
        std::mt19937 random(seed);
        auto const moved = [&] {
            return 0.04 * (double(random()) / double(std::mt19937::max()) * 2 - 1);
        };
        auto const point = [&](double x, double y) -> Point {
            double const z = 0.3 * x * x + 0.2 * x * y - 0.2 * y * y;
            double const dx = moved(), dy = moved(), dz = moved();
            return {x + dx, y + dy, z + dz};
        };
        center_ = point(0, 0);
        constexpr int places[kPoints][2] = {{1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}, {1, 2}};
        double const turn = 2 * std::acos(-1.0) / double(n_);
        for (std::size_t j = 0; j < n_; ++j)
            for (auto const [x, y] : places) {
                double const a = turn * double(j), b = turn * double(j + 1);
                points_.push_back(
                    point(x * std::cos(a) + y * std::cos(b), x * std::sin(a) + y * std::sin(b)));
            }
    }

    /// Of the patch between e_j and e_(j+1), in the order of pipeline/schemes/stam/eigen.h.
    std::vector<Point> net(int patch) const
    {
        std::vector<Point> out{center_};
        auto const j = std::size_t(patch);
        for (std::size_t i = 0; i < n_; ++i) {
            out.push_back(at(j + i, 0));
            out.push_back(at(j + i, 1));
        }
        // (2,2) (2,1) (2,0) (2,-1) (1,2) (0,2) (-1,2); below e_j lies sector j - 1.
        for (auto const& [sector, point] :
             {std::pair{j, 4}, {j, 3}, {j, 2}, {j + n_ - 1, 5}, {j, 5}, {j + 1, 2}, {j + 1, 3}})
            out.push_back(at(sector, std::size_t(point)));
        return out;
    }

private:
    static constexpr std::size_t kPoints = 6;
    Point const& at(std::size_t sector, std::size_t point) const
    {
        return points_[sector % n_ * kPoints + point];
    }

    std::size_t n_;
    Point center_;
    std::vector<Point> points_; // [sector][point]
};

} // namespace tessemu::test
