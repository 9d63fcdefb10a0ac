// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/vertex_stencils.h"

#include "pipeline/mesh/limit_constants.h"

#include <algorithm>

namespace tessemu {

StencilRow operator+(StencilRow a, StencilRow const& b)
{
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
    return a;
}
StencilRow operator-(StencilRow a, StencilRow const& b)
{
    for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
    return a;
}
StencilRow operator*(double s, StencilRow a)
{
    for (double& x : a) x *= s;
    return a;
}

// Contributions to each input; sorted before they are summed.
class VertexStencils::Sum {
public:
    explicit Sum(VertexStencils const& of) : of_(of) {}
    Sum& vertex(int i, double w)
    {
        terms_.push_back({i, w});
        return *this;
    }
    Sum& middle(int j, double w) { return vertex(of_.v(), w / 2).vertex(of_.d(j), w / 2); }
    Sum& centroid(int j, double w)
    {
        int const n = of_.n_;
        auto const& face = of_.c_.faces[std::size_t(((j % n) + n) % n)];
        for (int k = 0; k < face.sides; ++k) vertex(face.vertices[k], w / face.sides);
        return *this;
    }
    /// x_j = 4 c_j - v - d_j - d_(j+1)
    Sum& diagonal(int j, double w)
    {
        centroid(j, 4 * w);
        return vertex(of_.v(), -w).vertex(of_.d(j), -w).vertex(of_.d(j + 1), -w);
    }
    StencilRow row()
    {
        std::sort(terms_.begin(), terms_.end());
        StencilRow out(of_.inputs_);
        for (auto const& [input, weight] : terms_) out[std::size_t(input)] += weight;
        return out;
    }

private:
    VertexStencils const& of_;
    std::vector<std::pair<int, double>> terms_;
};

VertexStencils::VertexStencils(CornerNeighbourhood const& corner, int inputs, bool smooth_corners)
    : c_(corner),
      n_(int(corner.faces.size())),
      inputs_(std::size_t(inputs)),
      smooth_corners_(smooth_corners)
{
    if (!c_.boundary) return;
    a_ = Sum(*this).vertex(d(0), 0.5).vertex(d(n_), -0.5).row();
    if (n_ >= 2) b_ = boundary_across();
}

double VertexStencils::C() const
{
    if (!c_.boundary) return cos_pi(2, n_);
    return n_ >= 2 ? cos_pi(1, n_) : 0;
}

StencilRow VertexStencils::p() const
{
    if (c_.boundary) {
        if (n_ == 1 && !smooth_corners_) return Sum(*this).vertex(v(), 1).row();
        return Sum(*this).vertex(d(0), 1.0 / 6).vertex(v(), 4.0 / 6).vertex(d(n_), 1.0 / 6).row();
    }
    double const n = n_;
    Sum sum(*this);
    sum.vertex(v(), (n - 3) / (n + 5));
    for (int j = 0; j < n_; ++j) {
        sum.middle(j, 4 / (n * (n + 5)));
        sum.centroid(j, 4 / (n * (n + 5)));
    }
    return sum.row();
}

StencilRow VertexStencils::q(int j, bool sine) const
{
    if (c_.boundary) {
        if (n_ == 1) return Sum(*this).vertex(d(j), 1).vertex(v(), -1).row();
        return cos_pi(j, n_) * a_ + sin_pi(j, n_) * b_;
    }
    double const n = n_, sigma = loop09_sigma(n_);
    double const edge = 2 / n * (1 - sigma * cos_pi(1, n_)), face = 2 / n * 2 * sigma;
    Sum sum(*this);
    for (int i = 0; i < n_; ++i) {
        int const k = ((i - j) % n_ + n_) % n_;
        sum.middle(i, edge * (sine ? sin_pi(2 * k, n_) : cos_pi(2 * k, n_)));
        sum.centroid(i, face * (sine ? sin_pi(2 * k + 1, n_) : cos_pi(2 * k + 1, n_)));
    }
    return sum.row();
}

StencilRow VertexStencils::r(int j, double s) const
{
    Sum sum(*this);
    if (c_.boundary && j == 0) { // reflected across the boundary (4.6)
        sum.middle(1, 2.0 / 3 * s).vertex(v(), -2.0 / 3 * s);
        sum.centroid(0, 4.0 / 3 * s).middle(0, -4.0 / 3 * s);
    } else if (c_.boundary && j == n_) {
        sum.middle(n_ - 1, -2.0 / 3 * s).vertex(v(), 2.0 / 3 * s);
        sum.centroid(n_ - 1, -4.0 / 3 * s).middle(n_, 4.0 / 3 * s);
    } else {
        sum.middle(j + 1, 1.0 / 3 * s).middle(j - 1, -1.0 / 3 * s);
        sum.centroid(j, 2.0 / 3 * s).centroid(j - 1, -2.0 / 3 * s);
    }
    return sum.row();
}

StencilRow VertexStencils::inner(int j) const
{
    // (n v + 2 d_j + 2 d_(j+1) + x_j) / (n + 5); a boundary vertex counts as half of one.
    double const n = !c_.boundary ? n_ : n_ == 1 ? 4 : 2 * n_, w = 1 / (n + 5);
    Sum sum(*this);
    sum.vertex(v(), n * w).vertex(d(j), 2 * w).vertex(d(j + 1), 2 * w).diagonal(j, w);
    return sum.row();
}

StencilRow VertexStencils::inner_mean(int j) const
{
    double const n = !c_.boundary ? n_ : 2 * n_, w = 1 / (2 * n + 10);
    Sum sum(*this);
    sum.vertex(v(), 2 * n * w).vertex(d(j), 4 * w);
    sum.vertex(d(j - 1), 2 * w).vertex(d(j + 1), 2 * w).diagonal(j, w).diagonal(j - 1, w);
    return sum.row();
}

StencilRow VertexStencils::third(int j) const
{
    return Sum(*this).vertex(v(), 2.0 / 3).vertex(d(j), 1.0 / 3).row();
}

std::pair<StencilRow, StencilRow> VertexStencils::tangents(int s) const
{
    if (!c_.boundary) return {q(s), q(s, true)};
    if (n_ >= 2) return {a_, b_};
    return {q(0), q(1)};
}

// LOOP09 4.6 with the divisor k (3 + cos(pi/k)).
StencilRow VertexStencils::boundary_across() const
{
    int const k = n_;
    double const co = cos_pi(1, k), s = sin_pi(1, k);
    double const ratio = (1 + co) / s; // sqrt(1 + co) / sqrt(1 - co)
    double const w0 = -(1 + 2 * co) * ratio, scale = 1 / (k * (3 + co));
    Sum sum(*this);
    sum.vertex(v(), -4 * s * scale).vertex(d(0), w0 * scale).vertex(d(k), w0 * scale);
    for (int j = 1; j < k; ++j) sum.vertex(d(j), 4 * sin_pi(j, k) * scale);
    for (int j = 0; j < k; ++j) sum.diagonal(j, (sin_pi(j, k) + sin_pi(j + 1, k)) * scale);
    return sum.row();
}

} // namespace tessemu
