// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/gregory/stencils.h"

#include "pipeline/mesh/limit_constants.h"

#include <array>

namespace tessemu {

PatchStencils make_gregory_stencils(Neighbourhood const& patch, bool regular,
                                    GregoryParameters const& parameters)
{
    auto const sides = std::size_t(patch.sides);
    PatchStencils out;
    out.inputs = int(patch.inputs.size());
    std::vector<VertexStencils> const corner = corners_of(patch, parameters.smooth_corners);
    // LOOP09 3.3: e_j = p + 2/3 lambda q_j; boundary 4.6.
    auto const e = [&](VertexStencils const& v, int j) {
        if (v.is_boundary_edge(j)) return v.third(j);
        double const length =
            v.boundary() ? 1.0 / 3 : 2.0 / 3 * (parameters.lambda_scale * loop09_lambda(v.faces()));
        return v.p() + length * v.q(j);
    };
    auto const r = [&](VertexStencils const& v, int j) { return v.r(j, parameters.r_scale); };

    std::vector<StencilRow> p(sides), e_plus(sides), e_minus(sides), f_plus(sides), f_minus(sides);
    for (std::size_t i = 0; i < sides; ++i) {
        p[i] = corner[i].p();
        e_plus[i] = e(corner[i], corner[i].plus());
        e_minus[i] = e(corner[i], corner[i].minus());
    }
    double const d = sides == 4 ? 3 : 4;
    for (std::size_t i = 0; i < sides; ++i) {
        std::size_t const next = (i + 1) % sides, previous = (i + sides - 1) % sides;
        double const c = corner[i].C(), c_next = corner[next].C(),
                     c_previous = corner[previous].C();
        // LOOP09 eq. (6), whose first vector must be p, not v (docs/math/loop09.md, 10).
        f_plus[i] = 1 / d *
                    (c_next * p[i] + (d - 2 * c - c_next) * e_plus[i] + 2 * c * e_minus[next] +
                     r(corner[i], corner[i].plus()));
        // r for the other edge is seen from its other side: minus r of that edge.
        f_minus[i] = 1 / d *
                     (c_previous * p[i] + (d - 2 * c - c_previous) * e_minus[i] +
                      2 * c * e_plus[previous] - r(corner[i], corner[i].minus()));
    }
    for (auto const* rows : {&p, &e_plus, &e_minus, &f_plus}) out.add(*rows);
    if (!regular) out.add(f_minus);
    out.control_points = int(out.rows.size());
    add_boundary_rows(
        out, corner,
        [&](VertexStencils const& v, int j) { return 1.5 * (e(v, j + 1) - e(v, j - 1)); }, r,
        [&](std::size_t k) {
            std::size_t const next = (k + 1) % sides;
            return std::array{3.0 * (e_minus[k] - p[k]), d * (f_plus[k] - e_plus[k]),
                              d * (f_minus[next] - e_minus[next]), 3.0 * (e_plus[next] - p[next])};
        });
    return out;
}

} // namespace tessemu
