// SPDX-License-Identifier: Apache-2.0
#include "pipeline/gregory_stencils.h"

#include "pipeline/loop09_constants.h"

#include <algorithm>

namespace tessemu {

namespace {

using Row = std::vector<double>;

Row operator+(Row a, Row const& b)
{
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
    return a;
}
Row operator-(Row a, Row const& b)
{
    for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
    return a;
}
Row operator*(double s, Row a)
{
    for (double& x : a) x *= s;
    return a;
}

// The points that a corner contributes, by the sheet's letters.
class CornerRows {
public:
    CornerRows(CornerNeighbourhood const& corner, int inputs, GregoryParameters const& parameters)
        : c_(corner),
          n_(int(corner.faces.size())),
          inputs_(std::size_t(inputs)),
          parameters_(parameters)
    {
        if (!c_.boundary) return;
        a_ = Sum(*this).vertex(d(0), 0.5).vertex(d(n_), -0.5).row();
        if (n_ >= 2) b_ = boundary_across();
    }

    bool boundary() const { return c_.boundary; }
    int rings() const { return c_.boundary ? 1 : n_; }
    /// e+ is the ring's edge point j, e- edge point j+1 (sheet section 1).
    int plus() const { return c_.position; }
    int minus() const { return c_.boundary ? c_.position + 1 : 1; }
    bool is_boundary_edge(int j) const { return c_.boundary && (j == 0 || j == n_); }

    double C() const
    {
        if (!c_.boundary) return cos_pi(2, n_);
        return n_ >= 2 ? cos_pi(1, n_) : 0;
    }

    Row p() const
    {
        if (c_.boundary) {
            if (n_ == 1 && !parameters_.smooth_corners) return Sum(*this).vertex(v(), 1).row();
            return Sum(*this)
                .vertex(d(0), 1.0 / 6)
                .vertex(v(), 4.0 / 6)
                .vertex(d(n_), 1.0 / 6)
                .row();
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

    // LOOP09 3.3: q_j, and the same with sine, a quarter turn on.
    Row q(int j, bool sine = false) const
    {
        double const n = n_, sigma = loop09_sigma(n_);
        double const edge = 2 / n * (1 - sigma * cos_pi(1, n_)), face = 2 / n * 2 * sigma;
        Sum sum(*this);
        for (int i = 0; i < n_; ++i) {
            int const k = (i - j % n_ + n_) % n_;
            sum.middle(i, edge * (sine ? sin_pi(2 * k, n_) : cos_pi(2 * k, n_)));
            sum.centroid(i, face * (sine ? sin_pi(2 * k + 1, n_) : cos_pi(2 * k + 1, n_)));
        }
        return sum.row();
    }

    Row e(int j) const
    {
        if (!c_.boundary)
            return p() + (2.0 / 3 * (parameters_.lambda_scale * loop09_lambda(n_))) * q(j);
        if (j == 0 || j == n_) return Sum(*this).vertex(v(), 2.0 / 3).vertex(d(j), 1.0 / 3).row();
        return p() + 1.0 / 3 * (cos_pi(j, n_) * a_ + sin_pi(j, n_) * b_);
    }

    Row r(int j) const
    {
        Sum sum(*this);
        double const s = parameters_.r_scale;
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

    /// 3/2 (e_(j+1) - e_(j-1)): the transversal direction at this end of an inner edge.
    Row across(int j) const { return 1.5 * (e(j + 1) - e(j - 1)); }

    /// Two tangents, the surface normal's direction their cross product, for a ring that starts at
    /// s.
    std::pair<Row, Row> tangents(int s) const
    {
        if (!c_.boundary) return {q(s), q(s, true)};
        if (n_ >= 2) return {a_, b_};
        return {Sum(*this).vertex(d(0), 1).vertex(v(), -1).row(),
                Sum(*this).vertex(d(1), 1).vertex(v(), -1).row()};
    }

private:
    int v() const { return c_.vertex(); }
    int d(int j) const { return c_.edge_to(j); }

    // Contributions to each input; sorted before they are summed.
    class Sum {
    public:
        explicit Sum(CornerRows const& rows) : rows_(rows), terms_(rows.inputs_) {}
        Sum& vertex(int i, double w)
        {
            terms_[std::size_t(i)].push_back(w);
            return *this;
        }
        Sum& middle(int j, double w) { return vertex(rows_.v(), w / 2).vertex(rows_.d(j), w / 2); }
        Sum& centroid(int j, double w)
        {
            int const n = rows_.n_;
            auto const& face = rows_.c_.faces[std::size_t(((j % n) + n) % n)];
            for (int k = 0; k < face.sides; ++k) vertex(face.vertices[k], w / face.sides);
            return *this;
        }
        /// x_j = 4 c_j - v - d_j - d_(j+1)
        Sum& diagonal(int j, double w)
        {
            centroid(j, 4 * w);
            return vertex(rows_.v(), -w).vertex(rows_.d(j), -w).vertex(rows_.d(j + 1), -w);
        }
        Row row()
        {
            Row out(terms_.size());
            for (std::size_t i = 0; i < terms_.size(); ++i) {
                std::sort(terms_[i].begin(), terms_[i].end());
                for (double t : terms_[i]) out[i] += t;
            }
            return out;
        }

    private:
        CornerRows const& rows_;
        std::vector<std::vector<double>> terms_;
    };

    // LOOP09 4.6 with the divisor k (3 + cos(pi/k)).
    Row boundary_across() const
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

    CornerNeighbourhood const& c_;
    int n_;
    std::size_t inputs_;
    GregoryParameters const& parameters_;
    Row a_, b_;
};

} // namespace

GregoryStencils make_gregory_stencils(Neighbourhood const& patch, bool regular,
                                      GregoryParameters const& parameters)
{
    int const N = patch.sides;
    auto const sides = std::size_t(N);
    GregoryStencils out;
    out.inputs = int(patch.inputs.size());
    out.control_points = regular ? 16 : 5 * N;

    std::vector<CornerRows> corner;
    for (int i = 0; i < N; ++i) corner.emplace_back(patch.corner[i], out.inputs, parameters);
    std::vector<Row> p(sides), e_plus(sides), e_minus(sides), f_plus(sides), f_minus(sides);
    for (std::size_t i = 0; i < sides; ++i) {
        p[i] = corner[i].p();
        e_plus[i] = corner[i].e(corner[i].plus());
        e_minus[i] = corner[i].e(corner[i].minus());
    }
    double const d = N == 4 ? 3 : 4;
    for (std::size_t i = 0; i < sides; ++i) {
        std::size_t const next = (i + 1) % sides, previous = (i + sides - 1) % sides;
        double const c = corner[i].C(), c_next = corner[next].C(),
                     c_previous = corner[previous].C();
        // LOOP09 eq. (6), whose first vector must be p, not v (sheet section 10).
        f_plus[i] = 1 / d *
                    (c_next * p[i] + (d - 2 * c - c_next) * e_plus[i] + 2 * c * e_minus[next] +
                     corner[i].r(corner[i].plus()));
        // r for the other edge is seen from its other side: minus r of that edge.
        f_minus[i] = 1 / d *
                     (c_previous * p[i] + (d - 2 * c - c_previous) * e_minus[i] +
                      2 * c * e_plus[previous] - corner[i].r(corner[i].minus()));
    }
    for (auto const* rows : {&p, &e_plus, &e_minus, &f_plus})
        out.rows.insert(out.rows.end(), rows->begin(), rows->end());
    if (!regular) out.rows.insert(out.rows.end(), f_minus.begin(), f_minus.end());

    for (std::size_t k = 0; k < sides; ++k) {
        std::size_t const next = (k + 1) % sides;
        int const ja = corner[k].plus(), jb = corner[next].minus();
        if (corner[k].is_boundary_edge(ja) && corner[next].is_boundary_edge(jb)) {
            // An edge with one patch: its own inward field (sheet section 2).
            out.rows.push_back(3.0 * (e_minus[k] - p[k]));
            out.rows.push_back(d * (f_plus[k] - e_plus[k]));
            out.rows.push_back(-d * (f_minus[next] - e_minus[next]));
            out.rows.push_back(-3.0 * (e_plus[next] - p[next]));
        } else {
            out.rows.push_back(corner[k].across(ja));
            out.rows.push_back(corner[k].r(ja));
            out.rows.push_back(corner[next].r(jb));
            out.rows.push_back(corner[next].across(jb));
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
    return out;
}

} // namespace tessemu
