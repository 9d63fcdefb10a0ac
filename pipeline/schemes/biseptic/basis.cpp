// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/biseptic/basis.h"

#include "pipeline/schemes/stam/eigen.h"

#include <array>
#include <cassert>

namespace tessemu {

namespace {

constexpr int kSide = 8, kInner = 5; // points with an index from kInner on are the bicubics'

// B-spline coefficients to a Bezier polynomial of degree 7: [point][row].
std::array<std::array<double, 4>, kSide> raised_bspline()
{
    std::array<std::array<double, 4>, kSide> c{{{1. / 6, 4. / 6, 1. / 6, 0},
                                                {0, 4. / 6, 2. / 6, 0},
                                                {0, 2. / 6, 4. / 6, 0},
                                                {0, 1. / 6, 4. / 6, 1. / 6}}};
    for (int degree = 3; degree < 7; ++degree) {
        auto const lower = c;
        for (int i = 0; i <= degree + 1; ++i)
            for (std::size_t k = 0; k < 4; ++k) {
                double const t = double(i) / (degree + 1);
                double const before = i > 0 ? lower[std::size_t(i - 1)][k] : 0,
                             here = i <= degree ? lower[std::size_t(i)][k] : 0;
                c[std::size_t(i)][k] = t * before + (1 - t) * here;
            }
    }
    return c;
}

// Points 5, 6, 7 along u of the raised bicubic, whose value and two derivatives at u = 1 are those of
// columns 0, 1, 2 of the net: [point - 5][column].
constexpr double kAtOne[3][3] = {
    {1. / 3, 13. / 21, 1. / 21}, {5. / 21, 2. / 3, 2. / 21}, {1. / 6, 2. / 3, 1. / 6}};

// A net's points by their places.
class Net {
public:
    explicit Net(int n) : n_(n) {}
    int points() const { return 2 * n_ + 8; }
    int e(int i) const { return 1 + 2 * modulo(i); }
    int f(int i) const { return 2 + 2 * modulo(i); }
    /// A permutation of all points: those of the ring by ring(e_i or f_i, i), others by `outer`,
    /// which maps (2,2) (2,1) (2,0) (2,-1) (1,2) (0,2) (-1,2) by their number in this list.
    template <class Edge, class Face>
    std::vector<int> permutation(Edge const& edge, Face const& face,
                                 std::array<int, 7> const& outer) const
    {
        std::vector<int> out(std::size_t(points()), 0);
        for (int i = 0; i < n_; ++i) {
            out[std::size_t(e(i))] = e(edge(i));
            out[std::size_t(f(i))] = f(face(i));
        }
        for (int k = 0; k < 7; ++k)
            out[std::size_t(2 * n_ + 1 + k)] = 2 * n_ + 1 + outer[std::size_t(k)];
        return out;
    }
    /// In u = v.
    std::vector<int> mirrored() const
    {
        return permutation([](int i) { return 1 - i; }, [](int i) { return -i; },
                           {0, 4, 5, 6, 1, 2, 3});
    }
    /// In the spoke to e_0, of points that it depends on.
    std::vector<int> mirrored_in_spoke() const
    {
        return permutation([](int i) { return -i; }, [](int i) { return -i - 1; },
                           {0, 3, 2, 1, 4, 5, 6});
    }

private:
    int modulo(int i) const { return ((i % n_) + n_) % n_; }
    int n_;
};

} // namespace

BisepticBasis::BisepticBasis(int valence) : valence_(valence)
{
    assert(valence >= kMinBisepticValence && valence <= kMaxBisepticValence);
    Net const net(valence);
    auto const size = std::size_t(net.points());
    weights_.assign(kSide * kSide * size, 0);
    auto const row = [&](int i, int j) {
        return weights_.data() + std::size_t(kSide * i + j) * size;
    };
    auto const raised = raised_bspline();
    double const* inner = biseptic_inner_weights(valence).data();
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j <= i; ++j) {
            double* const w = row(i, j);
            if (i < kInner) {
                for (std::size_t p = 1; p < size; ++p) w[p] = *inner++;
            } else {
                for (int x = 0; x < 3; ++x)
                    for (int y = -1; y <= 2; ++y)
                        w[stam_net_point(valence, x, y)] =
                            kAtOne[i - kInner][x] * raised[std::size_t(j)][std::size_t(y + 1)];
            }
        }
    // What a symmetry maps to itself is symmetric but for rounding.
    auto const symmetric = [&](double* w, std::vector<int> const& mirror) {
        for (std::size_t p = 0; p < size; ++p)
            if (auto const q = std::size_t(mirror[p]); p < q) w[p] = w[q] = (w[p] + w[q]) / 2;
    };
    std::vector<int> const diagonal = net.mirrored(), spoke = net.mirrored_in_spoke();
    for (int i = 1; i < kSide; ++i) {
        symmetric(row(i, i), diagonal);
        symmetric(row(i, 0), spoke);
    }
    double const n = valence; // point (0,0), which all symmetries map to itself, is the limit
    for (int i = 0; i < valence; ++i) {
        row(0, 0)[net.e(i)] = 4 / (n * (n + 5));
        row(0, 0)[net.f(i)] = 1 / (n * (n + 5));
    }
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j <= i; ++j) {
            double* const w = row(i, j);
            double others = 0;
            for (std::size_t p = 1; p < size; ++p) others += w[p];
            w[0] = 1 - others;
            for (std::size_t p = 0; p < size; ++p) row(j, i)[std::size_t(diagonal[p])] = w[p];
        }
}

std::vector<int> BisepticBasis::spoke() const
{
    std::vector<int> out;
    for (int p = 0; p <= 2 * valence_; ++p) out.push_back(p);
    for (int p : {2, 3, 4}) out.push_back(2 * valence_ + p); // (2,1) (2,0) (2,-1)
    return out;
}

std::vector<int> BisepticBasis::next_spoke() const
{
    std::vector<int> out{0};
    for (int p = 0; p < 2 * valence_; ++p) out.push_back(1 + (p + 2) % (2 * valence_));
    for (int p : {7, 6, 5}) out.push_back(2 * valence_ + p); // (-1,2) (0,2) (1,2)
    return out;
}

} // namespace tessemu
