// A patch's control points in any scalar type, by the hull shader that draws.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/patch_stencils.h"
#include "shaders_cpp/stencil_form/stencil_hull_shader.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessemu::test {

inline ControlMesh mesh_from(nlohmann::json const& j)
{
    ControlMesh m;
    for (auto const& v : j["vertices"]) m.positions.emplace_back(v[0], v[1], v[2]);
    for (auto const& f : j["faces"]) m.add_face(f.get<std::vector<std::uint32_t>>());
    return m;
}

template <class F> struct StencilPatch {
    std::vector<F> points;    ///< control points, record by record
    double scale = 0;         ///< largest sum over the inputs of |weight| |coordinate|, for bounds
    double largest_point = 0; ///< largest absolute coordinate
};

/// \tparam Hull  StencilHullShader or one that derives from it, with weights of type F
template <class F, class Hull>
StencilPatch<F> run_stencils(ControlMesh const& mesh, Neighbourhood const& n,
                             PatchStencils const& s)
{
    using Point = typename Hull::template ControlPoint<F>;
    constexpr auto kScalars = std::size_t(scalar_count<Point>());
    std::vector<F> weights, input;
    std::vector<std::uint32_t> masks;
    std::vector<std::uint8_t> order(n.inputs.size());
    StencilPatch<F> out;
    for (std::size_t i = 0; i < n.inputs.size(); ++i) {
        for (auto const& row : s.rows) weights.push_back(F(row[i]));
        for (int k = 0; k < 3; ++k) input.push_back(F(mesh.positions[n.inputs[i]][k]));
    }
    for (double c : s.constants) weights.push_back(F(c));
    for (auto const& row : s.rows) {
        std::uint32_t mask = 0;
        double sum[3] = {};
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (F(row[i]) != 0) mask |= 1u << i;
            for (std::size_t k = 0; k < 3; ++k)
                sum[k] += std::abs(row[i] * double(input[3 * i + k]));
        }
        masks.push_back(mask);
        for (double x : sum) out.scale = std::max(out.scale, x);
    }
    std::vector<std::uint32_t> const words{0, 0, std::uint32_t(s.rows.size()), 0, 0, 0, 0, 0};
    std::iota(order.begin(), order.end(), std::uint8_t(0));
    std::sort(order.begin(), order.end(),
              [&](auto a, auto b) { return n.inputs[a] < n.inputs[b]; });
    Hull hs;
    hs.points = s.control_points;
    hs.rows = {
        {weights, 0, "weights"}, {masks, 1, "masks"}, {words, 2, "words"}, {order, 3, "order"}};
    ControlPoints<ControlVertex<F>> const in(input.data(), int(n.inputs.size()));
    out.points.resize(std::size_t(hs.control_points()) * kScalars);
    for (int id = 0; id < hs.control_points(); ++id) {
        std::size_t k = std::size_t(id) * kScalars;
        Point const point = hs.template control_point<F>({0}, in, id);
        for_each_scalar(point, [&](F x) {
            out.points[k++] = x;
            out.largest_point = std::max(out.largest_point, std::abs(double(x)));
        });
    }
    return out;
}

} // namespace tessemu::test
