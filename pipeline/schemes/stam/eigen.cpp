// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/stam/eigen.h"

#include "pipeline/mesh/limit_constants.h"

#include <cassert>
#include <cmath>
#include <utility>

namespace tessemu {

namespace {

constexpr std::size_t kOuter = 7;
// The outer points in their order.
constexpr std::array<std::array<int, 2>, kOuter> kOuterAt{
    {{2, 2}, {2, 1}, {2, 0}, {2, -1}, {1, 2}, {0, 2}, {-1, 2}}};

// Eigenvectors of the outer points' own block, by columns, and the inverse. The block couples
// (2,1) (2,0) (2,-1), which a step maps by the cubic B-spline's masks with eigenvalues 1/8, 1/16,
// 1/32; the same for (1,2) (0,2) (-1,2); and both feed (2,2), whose own eigenvalue is 1/64.
struct OuterBlock {
    std::array<double, kOuter> eigenvalues{1. / 8,  1. / 16, 1. / 32, 1. / 8,
                                           1. / 16, 1. / 32, 1. / 64};
    double vectors[kOuter][kOuter] = {};
    double inverse[kOuter][kOuter] = {};

    OuterBlock()
    {
        constexpr double column[3][3] = {{1, 1, 1}, {1, 0, -1}, {1, -0.5, 1}}; // by eigenvalue
        constexpr double row[3][3] = {
            {1. / 6, 2. / 3, 1. / 6}, {0.5, 0, -0.5}, {1. / 3, -2. / 3, 1. / 3}};
        for (std::size_t k = 0; k < 3; ++k) {
            // mu x = 1/64 x + 3/32 (2,1) + 1/64 (2,0)
            double const fed =
                (3. / 32 * column[k][0] + 1. / 64 * column[k][1]) / (eigenvalues[k] - 1. / 64);
            for (std::size_t side : {0, 3}) {
                vectors[0][side + k] = fed;
                for (std::size_t i = 0; i < 3; ++i) {
                    vectors[1 + side + i][side + k] = column[k][i];
                    inverse[side + k][1 + side + i] = row[k][i];
                    inverse[6][1 + side + i] -= fed * row[k][i];
                }
            }
        }
        vectors[0][6] = inverse[6][0] = 1;
    }
};

// The fine points (x, y) with 2 <= max(x, y) <= 3, all in regular surroundings: weights of the
// coarse ones by the cubic B-spline's rule, a parameter at a time.
template <class Use> void for_each_term(int x, int y, Use const& use)
{
    auto const along = [](int fine, auto const& term) {
        if (fine % 2 == 0) {
            term(fine / 2 - 1, 1. / 8);
            term(fine / 2, 6. / 8);
            term(fine / 2 + 1, 1. / 8);
        } else {
            term((fine - 1) / 2, 1. / 2);
            term((fine + 1) / 2, 1. / 2);
        }
    };
    along(x, [&](int i, double a) { along(y, [&](int j, double b) { use(i, j, a * b); }); });
}

// Adds functions in turn: eigenvectors as columns of V, and the rows of V^-1 that belong to them.
class Waves {
public:
    explicit Waves(StamEigen& out)
        : out_(out),
          n_(std::size_t(out.valence)),
          size_(2 * n_ + 8),
          vectors(size_ * size_)
    {
    }

    // The mean around the vertex: (EV, every e, every f).
    void add_means()
    {
        double const n = double(n_), sum = 3. / 4 - 7 / (4 * n), product = (n - 3) / (16 * n);
        double const larger = (sum + std::sqrt(sum * sum - 4 * product)) / 2;
        double const mu[3] = {1, larger, product / larger}; // the last of valence 3: exactly 0
        double v[3][3];
        for (std::size_t k = 0; k < 3; ++k) {
            v[2][k] = 1;
            v[1][k] = (1.5 * mu[k] - 0.25) / (mu[k] + 0.25);
            v[0][k] = 4 * mu[k] - 1 - 2 * v[1][k];
        }
        // V^-1 by cofactors.
        double w[3][3], determinant = 0;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                std::size_t const a = (i + 1) % 3, b = (i + 2) % 3, c = (k + 1) % 3,
                                  d = (k + 2) % 3;
                w[i][k] = v[c][a] * v[d][b] - v[c][b] * v[d][a];
            }
        for (std::size_t k = 0; k < 3; ++k) determinant += w[0][k] * v[k][0];
        constexpr std::size_t place[3] = {0, 3, 4}; // behind the subdominant pair
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t const at = place[k];
            out_.eigenvalues[at] = mu[k];
            vector(0, at) = v[0][k];
            inverse(at, 0) = w[k][0] / determinant;
            for (std::size_t j = 0; j < n_; ++j) {
                vector(1 + 2 * j, at) = v[1][k];
                vector(2 + 2 * j, at) = v[2][k];
                inverse(at, 1 + 2 * j) = w[k][1] / determinant / n;
                inverse(at, 2 + 2 * j) = w[k][2] / determinant / n;
            }
        }
        // Its eigenvector is all ones, its row the limit position's mask.
        for (std::size_t p = 0; p < 2 * n_ + 1; ++p) vector(p, 0) = 1;
    }

    // e_j = a cos(2 pi f j / n), f_j = cos(2 pi f (j + 1/2) / n), and the same with sines; two
    // eigenvalues, each twice. The larger of frequency 1 is the subdominant one.
    void add_pairs(int f)
    {
        int const n = int(n_);
        double const c = cos_pi(2 * f, n), h = cos_pi(f, n), root = std::sqrt(2 * (9 + c));
        double const a[2] = {(2 * h + root) / 8, (2 * h - root) / 8};
        for (std::size_t k = 0; k < 2; ++k)
            for (bool sine : {false, true}) {
                std::size_t const at = f == 1 && k == 0 ? 1 + std::size_t(sine) : next_++;
                out_.eigenvalues[at] = 0.25 + h * a[k] / 2;
                double const sign = k == 0 ? 1 : -1, scale = sign * 2 / n / (a[0] - a[1]);
                for (int j = 0; j < n; ++j) {
                    std::size_t const e = 1 + 2 * std::size_t(j);
                    double const edge = wave(2 * f * j, sine), face = wave(f * (2 * j + 1), sine);
                    vector(e, at) = a[k] * edge;
                    vector(e + 1, at) = face;
                    inverse(at, e) = scale * edge;
                    inverse(at, e + 1) = -scale * a[1 - k] * face;
                }
            }
    }

    // Of even valence: edges alone, and faces alone, whose sign alternates.
    void add_alternating()
    {
        for (std::size_t face : {0, 1}) {
            std::size_t const at = next_++;
            out_.eigenvalues[at] = 0.25;
            for (std::size_t j = 0; j < n_; ++j) {
                double const sign = j % 2 ? -1 : 1;
                vector(1 + 2 * j + face, at) = sign;
                inverse(at, 1 + 2 * j + face) = sign / double(n_);
            }
        }
    }

    // The outer points of the ring's eigenvectors, and the eigenvectors of the outer points alone.
    void add_outer()
    {
        std::size_t const ring = 2 * n_ + 1;
        assert(next_ == ring);
        OuterBlock const block;
        for (std::size_t at = 0; at < ring; ++at) {
            // (S12 - mu) y = -S11 x, in the block's eigenvectors.
            std::array<double, kOuter> fed{};
            for (std::size_t o = 0; o < kOuter; ++o)
                for_each_term(kOuterAt[o][0], kOuterAt[o][1], [&](int i, int j, double weight) {
                    if (i < 2 && j < 2) fed[o] += weight * vector(point(i, j), at);
                });
            for (std::size_t k = 0; k < kOuter; ++k) {
                double right = 0;
                for (std::size_t o = 0; o < kOuter; ++o) right += block.inverse[k][o] * fed[o];
                double const gap = out_.eigenvalues[at] - block.eigenvalues[k];
                // Where the ring has an eigenvalue of the block the right side is 0 as well, but
                // for rounding, and any multiple of the block's eigenvector may be added.
                double const y = std::abs(gap) < 1e-9 ? 0 : right / gap;
                for (std::size_t o = 0; o < kOuter; ++o)
                    vector(ring + o, at) += block.vectors[o][k] * y;
                for (std::size_t p = 0; p < ring; ++p) inverse(ring + k, p) -= y * inverse(at, p);
            }
        }
        for (std::size_t k = 0; k < kOuter; ++k) {
            out_.eigenvalues[ring + k] = block.eigenvalues[k];
            for (std::size_t o = 0; o < kOuter; ++o) {
                vector(ring + o, ring + k) = block.vectors[o][k];
                inverse(ring + k, ring + o) = block.inverse[k][o];
            }
        }
    }

    void add_splines()
    {
        constexpr int first[3][2] = {{0, -1}, {0, 0}, {-1, 0}}; // column, row of each sub-patch
        for (std::size_t s = 0; s < 3; ++s) {
            std::vector<double>& spline = out_.splines[s];
            spline.assign(16 * size_, 0);
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row) {
                    int const x = first[s][0] + column, y = first[s][1] + row;
                    double* const to = spline.data() + std::size_t(4 * column + row) * size_;
                    if (x < 3 && y < 3) { // a point of the net, which a step only scales
                        for (std::size_t f = 0; f < size_; ++f)
                            to[f] = out_.eigenvalues[f] * vector(point(x, y), f);
                        continue;
                    }
                    for_each_term(x, y, [&](int i, int j, double weight) {
                        for (std::size_t f = 0; f < size_; ++f)
                            to[f] += weight * vector(point(i, j), f);
                    });
                }
        }
    }

private:
    double wave(int a, bool sine) const { return sine ? sin_pi(a, int(n_)) : cos_pi(a, int(n_)); }
    std::size_t point(int x, int y) const { return std::size_t(stam_net_point(int(n_), x, y)); }
    double& vector(std::size_t p, std::size_t f) { return vectors[p * size_ + f]; }
    double& inverse(std::size_t f, std::size_t p) { return out_.inverse[f * size_ + p]; }

    StamEigen& out_;
    std::size_t n_, size_, next_ = 5;
    std::vector<double> vectors; // [point][function]
};

} // namespace

int stam_net_point(int n, int x, int y)
{
    auto const e = [&](int i) { return 1 + 2 * ((i + n) % n); };
    auto const f = [&](int i) { return 2 + 2 * ((i + n) % n); };
    int const outer = 2 * n + 1;
    if (x == 2) return outer + 2 - y;
    if (y == 2) return outer + 5 - x;
    if (x == 1) return y == 1 ? f(0) : y == 0 ? e(0) : f(-1);
    if (x == 0) return y == 1 ? e(1) : y == 0 ? 0 : e(-1);
    assert(y >= 0 || n == 4);
    return y == 1 ? f(1) : y == 0 ? e(2) : f(2);
}

StamEigen stam_eigen(int valence)
{
    assert(valence >= 3);
    StamEigen out;
    out.valence = valence;
    auto const functions = std::size_t(out.functions());
    out.eigenvalues.assign(functions, 0);
    out.inverse.assign(functions * functions, 0);
    Waves waves(out);
    waves.add_means();
    for (int f = 1; 2 * f < valence; ++f) waves.add_pairs(f);
    if (valence % 2 == 0) waves.add_alternating();
    waves.add_outer();
    waves.add_splines();
    return out;
}

} // namespace tessemu
