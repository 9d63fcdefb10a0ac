// Eigen-analysis of Catmull-Clark subdivision at an extraordinary vertex: what Stam's exact
// evaluation (1998; LOOP10 4.2) needs, for any valence, in double.
//
// The net of a quad (EV, e_0, f_0, e_1) whose only extraordinary corner is EV, u from EV to e_0, v
// from EV to e_1; n = 5:
//
//    (-1,2) (0,2) (1,2) (2,2)      v     Order: EV; then e_i and f_i in turn, i = 0, ..., n-1,
//      f_1   e_1   f_0  (2,1)      |     counter-clockwise; then (2,2) (2,1) (2,0) (2,-1) (1,2)
//      e_2   EV    e_0  (2,0)      +-u   (0,2) (-1,2): 2n + 8 points. Of valence 3, e_2 is both
//        f_2 e_3 e_4 f_4  (2,-1)         (-1,0) and (0,-1).
//             f_3
//
// A step of subdivision gives the same net at half the size: C' = A C, A = V diag(lambda) V^-1. The
// ring's part of A is a circulant of blocks, so its eigenvectors are waves around the vertex and
// have closed forms; those of the outer seven points are rational numbers. No routine for
// eigenvalues is needed, which multiple eigenvalues would trouble (docs/math/subdivision.md, 2.2).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tessemu {

struct StamEigen {
    int valence = 0;
    std::vector<double> eigenvalues; ///< the first is 1, the next two the subdominant pair
    std::vector<double> inverse;     ///< V^-1, [function][point]
    /// The eigenvectors as B-spline patches, [sub-patch][4 column + row][function]: columns along
    /// u. Sub-patch 0 is u > 1/2, v < 1/2; 1 is u > 1/2, v > 1/2; 2 is u < 1/2, v > 1/2.
    std::array<std::vector<double>, 3> splines;

    int functions() const { return 2 * valence + 8; }
};

/// \param valence  3 or more
/// \cost  operations: some 30 times the square of the valence
StamEigen stam_eigen(int valence);

/// Where (x, y) of the picture above stands in a net's order; both from -1 to 2, (-1, -1) of
/// valence 4 alone.
int stam_net_point(int valence, int x, int y);

} // namespace tessemu
