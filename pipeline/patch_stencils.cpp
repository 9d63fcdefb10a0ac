// SPDX-License-Identifier: Apache-2.0
#include "pipeline/patch_stencils.h"

#include "pipeline/loop09_constants.h"

#include <array>

namespace tessemu {

namespace {

std::vector<VertexStencils> corners_of(Neighbourhood const& patch, bool smooth_corners)
{
    std::vector<VertexStencils> out;
    for (int i = 0; i < patch.sides; ++i)
        out.emplace_back(patch.corner[i], int(patch.inputs.size()), smooth_corners);
    return out;
}

// Edge and corner rows.
//
// across(vertex, j), transversal(vertex, j): the two vectors at an end of an inner edge; half of
// the difference of the inward fields of its two patches. own(k): a boundary edge's inward field.
template <class Across, class Transversal, class Own>
void add_boundary_rows(PatchStencils& out, std::vector<VertexStencils> const& corner,
                       Across const& across, Transversal const& transversal, Own const& own)
{
    auto const sides = corner.size();
    for (std::size_t k = 0; k < sides; ++k) {
        std::size_t const next = (k + 1) % sides;
        int const ja = corner[k].plus(), jb = corner[next].minus();
        if (corner[k].is_boundary_edge(ja) && corner[next].is_boundary_edge(jb)) {
            std::array<StencilRow, 4> const field = own(k);
            out.rows.push_back(field[0]);
            out.rows.push_back(field[1]);
            // The hull shader turns the second half's signs round.
            out.rows.push_back(-1.0 * field[2]);
            out.rows.push_back(-1.0 * field[3]);
        } else {
            out.rows.push_back(across(corner[k], ja));
            out.rows.push_back(transversal(corner[k], ja));
            out.rows.push_back(transversal(corner[next], jb));
            out.rows.push_back(across(corner[next], jb));
        }
    }
    for (std::size_t i = 0; i < sides; ++i) {
        out.corner_row[i] = int(out.rows.size());
        for (int s = 0; s < corner[i].rings(); ++s) {
            auto [a, b] = corner[i].tangents(s);
            out.rows.push_back(std::move(a));
            out.rows.push_back(std::move(b));
        }
    }
}

void add(PatchStencils& out, std::vector<StencilRow> const& rows)
{
    out.rows.insert(out.rows.end(), rows.begin(), rows.end());
}

} // namespace

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
        // LOOP09 eq. (6), whose first vector must be p, not v (sheet section 10).
        f_plus[i] = 1 / d *
                    (c_next * p[i] + (d - 2 * c - c_next) * e_plus[i] + 2 * c * e_minus[next] +
                     r(corner[i], corner[i].plus()));
        // r for the other edge is seen from its other side: minus r of that edge.
        f_minus[i] = 1 / d *
                     (c_previous * p[i] + (d - 2 * c - c_previous) * e_minus[i] +
                      2 * c * e_plus[previous] - r(corner[i], corner[i].minus()));
    }
    for (auto const* rows : {&p, &e_plus, &e_minus, &f_plus}) add(out, *rows);
    if (!regular) add(out, f_minus);
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
    for (auto const* rows : {&p, &e_plus, &e_minus, &inner}) add(out, *rows);
    if (!regular)
        for (auto const* rows : {&t_plus, &t_minus}) add(out, *rows);
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
