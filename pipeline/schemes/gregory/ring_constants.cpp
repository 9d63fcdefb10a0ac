// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/gregory/ring_constants.h"

#include "pipeline/mesh/limit_constants.h"
#include "shaders_cpp/gregory/ring_vertex_shader.h"

namespace tessemu {

namespace {

void set_interior(double* row, int n, double lambda_scale) // LOOP09 3.3
{
    row[0] = double(n - 3) / (n + 5);
    row[1] = 4.0 / (n * (n + 5));
    double const sigma = loop09_sigma(n);
    double const edge = 2.0 / n * (1 - sigma * cos_pi(1, n)), face = 2.0 / n * 2 * sigma;
    double const length = 2.0 / 3 * lambda_scale * loop09_lambda(n);
    for (int j = 0; j < n; ++j) {
        double* const each = row + 2 + RingConstants::kEach * j;
        each[0] = edge * cos_pi(2 * j, n);
        each[1] = edge * sin_pi(2 * j, n);
        each[2] = face * cos_pi(2 * j + 1, n);
        each[3] = face * sin_pi(2 * j + 1, n);
        each[4] = length * cos_pi(2 * j, n);
        each[5] = length * sin_pi(2 * j, n);
    }
}

void set_boundary(double* row, int k) // LOOP09 4.6
{
    auto const each = [&](int j) { return row + 2 + RingConstants::kEach * j; };
    if (k == 1) { // A and B are the two edges
        each(0)[4] = each(1)[5] = 1.0 / 3;
        return;
    }
    double const co = cos_pi(1, k), s = sin_pi(1, k), scale = 1 / (k * (3 + co));
    row[0] = -4 * s * scale;
    row[1] = -(1 + 2 * co) * ((1 + co) / s) * scale;
    for (int j = 0; j <= k; ++j) {
        if (j > 0 && j < k) each(j)[1] = 4 * sin_pi(j, k) * scale;
        if (j < k) each(j)[3] = (sin_pi(j, k) + sin_pi(j + 1, k)) * scale;
        each(j)[4] = cos_pi(j, k) / 3;
        each(j)[5] = sin_pi(j, k) / 3;
    }
}

} // namespace

std::vector<double> make_ring_constants(double lambda_scale)
{
    using C = RingConstants;
    std::vector<double> out(std::size_t(RingRows::kCount * C::kRow));
    for (int n = 2; n <= RingLayout::kEdges; ++n)
        set_interior(out.data() + n * C::kRow, n, lambda_scale);
    for (int k = 1; k < RingLayout::kEdges; ++k)
        set_boundary(out.data() + (RingRows::kBoundary + k) * C::kRow, k);
    return out;
}

std::vector<double> ring_constants_of(int faces, bool boundary, double lambda_scale)
{
    std::vector<double> out(std::size_t(2 + RingConstants::kEach * (faces + boundary)));
    if (boundary)
        set_boundary(out.data(), faces);
    else
        set_interior(out.data(), faces, lambda_scale);
    return out;
}

} // namespace tessemu
