// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/pm/constants.h"

#include "pipeline/mesh/limit_constants.h"
#include "shaders_cpp/pm/pm_vertex_shader.h"

namespace tessemu {

std::vector<double> make_pm_constants()
{
    using C = PmConstants;
    std::vector<double> out(std::size_t((RingLayout::kEdges + 1) * C::kRow));
    for (int n = 2; n <= RingLayout::kEdges; ++n) {
        double* const row = out.data() + n * C::kRow;
        double const all = n * (n + 5), length = 1 / (n * loop09_lambda(n));
        row[0] = n * n / all;
        row[1] = 4 / all;
        row[2] = 1 / all;
        for (int j = 0; j < n; ++j) {
            double* const each = row + 3 + C::kEach * j;
            each[0] = length * cos_pi(2 * j, n);
            each[1] = length * sin_pi(2 * j, n);
            each[2] = cos_pi(2 * j, n);
            each[3] = sin_pi(2 * j, n);
        }
    }
    return out;
}

} // namespace tessemu
