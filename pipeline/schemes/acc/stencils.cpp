// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/acc/stencils.h"

#include <array>

namespace tessemu {

PatchStencils make_acc_stencils(Neighbourhood const& patch, bool regular, bool smooth_corners)
{
    constexpr std::size_t sides = 4;
    PatchStencils out;
    out.inputs = int(patch.inputs.size());
    std::vector<VertexStencils> const corner = corners_of(patch, smooth_corners);
    auto const e = [](VertexStencils const& v, int j) {
        return v.is_boundary_edge(j) ? v.third(j) : v.inner_mean(j);
    };
    std::vector<StencilRow> p(sides), e_plus(sides), e_minus(sides), inner(sides), t_plus(sides),
        t_minus(sides);
    for (std::size_t i = 0; i < sides; ++i) {
        VertexStencils const& v = corner[i];
        p[i] = v.p();
        e_plus[i] = e(v, v.plus());
        e_minus[i] = e(v, v.minus());
        inner[i] = v.inner(v.plus());
        t_plus[i] = v.q(v.plus());
        t_minus[i] = v.q(v.minus());
        out.constants.push_back(v.C() / 3);
    }
    for (auto const* rows : {&p, &e_plus, &e_minus, &inner}) out.add(*rows);
    if (!regular)
        for (auto const* rows : {&t_plus, &t_minus}) out.add(*rows);
    out.control_points = int(out.rows.size());
    add_boundary_rows(
        out, corner, [](VertexStencils const& v, int j) { return 0.5 * (v.q(j + 1) - v.q(j - 1)); },
        [](VertexStencils const& v, int j) { return 1.5 * (v.inner(j) - v.inner(j - 1)); },
        [&](std::size_t k) {
            std::size_t const next = (k + 1) % sides;
            double const c0 = corner[k].C() / 3, c1 = corner[next].C() / 3;
            StencilRow const middle = 3.0 * (e_minus[next] - e_plus[k]);
            return std::array{
                t_minus[k], 2 * c0 * middle - c1 * t_plus[k] + 3.0 * (inner[k] - e_plus[k]),
                -c0 * t_minus[next] - 2 * c1 * middle + 3.0 * (inner[next] - e_minus[next]),
                t_plus[next]};
        });
    return out;
}

} // namespace tessemu
