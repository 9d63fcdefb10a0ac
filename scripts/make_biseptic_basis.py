#!/usr/bin/python3
"""Derives the biseptic patches of docs/math/subdivision.md, section 3, for valences 3 to 12.

    make_biseptic_basis.py            solves, measures, compares with the repository's weights
    make_biseptic_basis.py FILE.json  compares with a reference and writes basis_data.cpp: the
                                      solved weights, or the reference's if they differ by > 1e-13
Needs numpy. Patch p lies between the spokes p and p+1: spoke p is v = 0 of patch p and u = 0 of
patch p-1. Along it T = S_u, D1 = S_v, E1 = S_vv of patch p, D2 = S_u, E2 = S_uu of patch p-1,
M = D1 - D2. A patch has 8 x 8 Bezier coefficients [u-index, v-index].
"""
import json
import math
import pathlib
import re
import sys
import textwrap

import numpy as np

OUT = pathlib.Path(__file__).resolve().parent.parent / "pipeline/schemes/biseptic/basis_data.cpp"
PAIRS = [(i, j) for i in range(5) for j in range(i + 1)]
FAR = [(2, 2), (2, 1), (2, 0), (2, -1), (1, 2), (0, 2), (-1, 2)]  # (u, v) beyond the ring
e = lambda n, k: 1 + 2 * (k % n)  # places in the net: EV, e_0, f_0, e_1, f_1, ..., then FAR
f = lambda n, k: 2 + 2 * (k % n)


def grid(n):
    """Place in the net of each grid point (u, v) of the patch."""
    g = {(0, 0): 0, (1, 0): e(n, 0), (1, 1): f(n, 0), (0, 1): e(n, 1), (-1, 1): f(n, 1),
         (-1, 0): e(n, 2), (0, -1): e(n, -1), (1, -1): f(n, -1)}
    return g | {point: 2 * n + 1 + k for k, point in enumerate(FAR)}


# Every point but EV is, up to rotation, one of these; as which grid point patches know it.
POINTS = {"e": None, "f": None, "20": {0: (2, 0), -1: (0, 2)}, "21": {0: (2, 1), -1: (-1, 2)},
          "12": {0: (1, 2), 1: (2, -1)}, "22": {0: (2, 2)}}


def places(n, point):
    """[(patch, place in its net)] of one of POINTS: the support of its basis function."""
    if point in "ef":
        return [(p, (e if point == "e" else f)(n, -p)) for p in range(n)]
    return [(p % n, grid(n)[q]) for p, q in POINTS[point].items()]


def derivative(q):
    """Takes the Bernstein coefficients of a polynomial of degree q to those of its derivative."""
    return q * (np.eye(q, q + 1, 1) - np.eye(q, q + 1))


def elevation(q):
    """Takes them to those of the same polynomial in degree q+1."""
    i = np.arange(q + 2)[:, None] / (q + 1)
    return i * np.eye(q + 2, q + 1, -1) + (1 - i) * np.eye(q + 2, q + 1)


def at(t, k=0):
    """The row that takes 8 coefficients to the k-th derivative at t."""
    row = np.array([math.comb(7 - k, i) * t**i * (1 - t)**(7 - k - i) for i in range(8 - k)])
    for q in range(8 - k, 8):
        row = row @ derivative(q)
    return row


def outside(n):
    """8 x 8 x (2n+8): coefficients fixed by the B-splines beyond u = 1 and v = 1; others 0."""
    cubic = np.array([[1, 4, 1, 0], [0, 4, 2, 0], [0, 2, 4, 0], [0, 1, 4, 1]]) / 6
    septic = elevation(6) @ elevation(5) @ elevation(4) @ elevation(3) @ cubic  # of points -1 .. 2
    b = np.zeros((8, 8, 2 * n + 8))
    for (x, y), place in grid(n).items():  # (-1, -1) is no point of the net and has weight 0 here
        b[:, :, place] += np.outer(septic[:, x + 1], septic[:, y + 1])
    b[:5, :5] = 0
    return b


def direction(n, k):
    return np.array([math.cos(2 * math.pi * k / n), math.sin(2 * math.pi * k / n)])


class Conditions:
    """What 3.1 asks of all n x 64 coefficients and the 5 numbers of L and Q, as rows."""

    def __init__(self, n):
        self.n = n
        c = self.c = math.cos(2 * math.pi / n)
        subdominant = (5 + c + math.cos(math.pi / n) * math.sqrt(18 + 2 * c)) / 16
        self.alpha = 4 * (1 - 2 * subdominant) / (4 * subdominant - 1)
        self.w = c * (self.alpha - 3) / (1 + c)
        self.b0 = (self.alpha * (1 - c) * (1 + 2 * c) + 6 * c * c) / (1 + c)
        self.exact = np.array([row for p in range(n)
                               for row in self.shared(p) + self.g1(p) + self.jet(p)])
        nodes = [(1 - math.cos((k + 0.5) * math.pi / 12)) / 2 for k in range(12)]
        g2 = np.array([self.g2(p, t) for p in range(n) for t in nodes])
        x, weight = np.polynomial.legendre.leggauss(8)  # exact for squares of septics
        values, fourth = (np.sqrt(weight / 2)[:, None] * np.array([at((1 + t) / 2, k) for t in x])
                          for k in (0, 4))
        energy = np.vstack([np.kron(fourth, values), np.kron(values, fourth)])
        energy = np.hstack([np.kron(np.eye(n), energy), np.zeros((n * len(energy), 5))])
        self.least = np.vstack([g2, math.sqrt(1e-6) * energy])

    def row(self, p, u, v):
        """Sum of u_i v_j times coefficient (i, j) of patch p."""
        row = np.zeros(64 * self.n + 5)
        row[64 * (p % self.n):][:64] = np.outer(u, v).ravel()
        return row

    def sides(self, p, along, k):
        """`along` spoke p, of the k-th derivative across it, on its two patches."""
        return self.row(p, along, at(0, k)), self.row(p - 1, at(0, k), along)

    def shared(self, p):
        return [np.subtract(*self.sides(p, unit, 0)) for unit in np.eye(8)]

    def g1(self, p):
        """D1 + D2 = a T in degree 9, where B_i^6 (1-t)^3 = C(6,i)/C(9,i) B_i^9."""
        rows = [np.add(*self.sides(p, along, 1)) for along in elevation(8) @ elevation(7)]
        for i, along in enumerate(derivative(7)):
            t, _ = self.sides(p, along, 0)
            rows[i] -= 2 * self.c * math.comb(6, i) / math.comb(9, i) * t
        return [row / 7 for row in rows]

    def g2(self, p, t):
        """E1 - E2 - a M' - b M at t."""
        (e1, e2), (m1, m2), (d1, d2) = (self.sides(p, at(t, k), across)
                                        for k, across in ((0, 2), (1, 1), (0, 1)))
        return e1 - e2 - (1 - t)**3 * (2 * self.c * (m1 - m2) + self.b0 * (d1 - d2))

    def jet(self, p):
        """S_u, S_uu and S_uv of patch p at EV, from L and Q."""
        x, y = direction(self.n, p), direction(self.n, p + 1)
        q = lambda a, b: [a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[1] * b[1]]
        rows = [self.row(p, at(0, 1), at(0)), self.row(p, at(0, 2), at(0)),
                self.row(p, at(0, 1), at(0, 1))]
        rows[0][-5:-3] = -x
        rows[1][-5:] = -np.array([*(self.alpha * x), *q(x, x)])
        rows[2][-5:] = -np.array([*(self.w * (x + y)), *q(x, y)])
        return [rows[0] / 7, rows[1] / 42, rows[2] / 49]


def constrained_least_squares(exact, exact_rhs, least, least_rhs):
    """The x with exact x = exact_rhs that minimises |least x - least_rhs|."""
    u, s, vt = np.linalg.svd(exact)
    rank = int((s > 1e-10 * s[0]).sum())  # many conditions follow from others
    x = vt[:rank].T @ (u[:, :rank].T @ exact_rhs / s[:rank])
    assert abs(exact @ x - exact_rhs).max() < 1e-13, "the conditions contradict each other"
    null = vt[rank:].T
    return x + null @ np.linalg.lstsq(least @ null, least_rhs - least @ x, rcond=None)[0]


def solve(c):
    """8 x 8 x (2n+8): weights of the net for patch 0's coefficients, as 3.3 has them."""
    n, basis = c.n, outside(c.n)
    exact = np.vstack([c.exact, np.eye(1, 64 * n + 5)])  # and the position of EV
    for point in POINTS:
        x, free = np.zeros(64 * n + 5), np.zeros(64 * n + 5, bool)
        free[-5:] = point in "ef"  # L = Q = 0 for the others
        for p, place in places(n, point):
            x[64 * p:][:64] = basis[:, :, place].ravel()
            free[64 * p:][:64].reshape(8, 8)[:5, :5] = True
        rhs = -exact @ x
        rhs[-1] += {"e": 4, "f": 1}.get(point, 0) / (n * (n + 5))
        x[free] = constrained_least_squares(exact[:, free], rhs, c.least[:, free], -c.least @ x)
        for p, place in places(n, point):
            basis[:, :, place] = x[64 * p:][:64].reshape(8, 8)
    basis[:, :, 0] = 1 - basis[:, :, 1:].sum(2)
    return basis


def symmetric(n, basis):
    """The inner weights, exactly as symmetric as they are but for rounding."""
    g, inner = grid(n), basis[:5, :5].copy()
    swap, spoke = np.arange(2 * n + 8), np.arange(2 * n + 8)  # u <-> v; about spoke 0
    for k in range(n):
        swap[e(n, k)], swap[f(n, k)] = e(n, 1 - k), f(n, -k)
        spoke[e(n, k)], spoke[f(n, k)] = e(n, -k), f(n, -k - 1)
    for x, y in FAR:
        swap[g[x, y]] = g[y, x]
    spoke[[g[2, 1], g[2, -1]]] = g[2, -1], g[2, 1]  # other FAR have weight 0 on the spoke
    inner = (inner + inner.transpose(1, 0, 2)[:, :, swap]) / 2
    inner[:, 0] = (inner[:, 0] + inner[:, 0, spoke]) / 2
    for first in (1, 2):
        inner[0, 0, first:2 * n + 1:2] = inner[0, 0, first:2 * n + 1:2].mean()
    inner[0] = inner[:, 0][:, swap]
    return inner


def curvatures(b, u, v):
    """(mean curvature, size of the largest curvature) of the patch b, 8 x 8 x 3, at u, v."""
    s = lambda i, j: np.einsum("i,j,ijc", at(u, i), at(v, j), b)
    tangents = np.array([s(1, 0), s(0, 1)])
    normal = np.cross(*tangents) / np.linalg.norm(np.cross(*tangents))
    second = np.array([[s(2, 0) @ normal, s(1, 1) @ normal], [s(1, 1) @ normal, s(0, 2) @ normal]])
    shape = np.linalg.solve(tangents @ tangents.T, second)
    h, k = np.trace(shape) / 2, np.linalg.det(shape)
    return h, abs(h) + math.sqrt(max(h * h - k, 0))


def curvature_jump(n, basis):
    """Largest jump of H across spokes over the largest curvature; net on a saddle."""
    def vertex(p, u, v):
        x, y = u * direction(n, p) + v * direction(n, p + 1)
        return x, y, 0.3 * x * x - 0.1 * y * y
    patches, jump, largest = [], 0, 0
    for p in range(n):
        ring = [vertex(p + k, 1, v) for k in range(n) for v in (0, 1)]
        beside = {(2, -1): (p - 1, 1, 2), (0, 2): (p + 1, 2, 0), (-1, 2): (p + 1, 2, 1)}
        far = [vertex(*beside.get(q, (p, *q))) for q in FAR]
        patches.append(basis @ np.array([vertex(p, 0, 0), *ring, *far]))
    for p in range(n):
        for t in np.linspace(0, 1, 41):
            one, two = curvatures(patches[p], t, 0), curvatures(patches[p - 1], 0, t)
            largest = max(largest, one[1], curvatures(patches[p], t, t)[1])
            jump = max(jump, abs(one[0] - two[0]))
    return jump / largest


def text_of(inner, about):
    text = f"""// The weights of the biseptic patches' inner Bezier coefficients, made by
// scripts/make_biseptic_basis.py. Derived (docs/math/subdivision.md, 3), not the basis that Loop
// and Schaefer published. {about}
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/biseptic/basis.h"

#include <cassert>

// clang-format off
namespace tessemu {{
namespace {{

// For each (u-index, v-index), the weights of the net's points 1 .. 2n+7.
"""
    fill = lambda words, width, indent: textwrap.fill(
        words, width, initial_indent="    ", subsequent_indent=" " * indent, break_on_hyphens=False)
    for n, b in inner.items():
        text += f"constexpr double kInner{n}[] = {{\n"
        for i, j in PAIRS:
            numbers = ", ".join("0" if x == 0 else repr(float(x)) for x in b[i, j, 1:])
            text += fill(f"/* {i},{j} */ {numbers},", 100, 8) + "\n"
        text += "};\n\n"
    return text + f"""constexpr std::span<double const> kInner[] = {{
{fill(", ".join(f"kInner{n}" for n in inner), 60, 4)}}};

}} // namespace

std::span<double const> biseptic_inner_weights(int valence)
{{
    assert(valence >= 3 && valence <= 12);
    return kInner[valence - 3];
}}

}} // namespace tessemu
"""


def stored_weights():
    """{valence: [weights of each of PAIRS]} of OUT."""
    tables = re.findall(r"kInner(\d+)\[\] = \{(.*?)\};", OUT.read_text(), re.S)
    return {int(n): np.array(re.sub(r"/\*.*?\*/", "", body).split(",")[:-1], float).reshape(15, -1)
            for n, body in tables}


def main():
    reference = None
    if len(sys.argv) > 1:
        valences = json.load(open(sys.argv[1]))["valences"]
        reference = {int(n): np.array(v["matrix"]).reshape(8, 8, -1) for n, v in valences.items()}
    inner, worst = {}, 0
    print(" n      alpha         b0          w  jump of H  difference")
    for n in range(3, 13):
        c = Conditions(n)
        basis = solve(c)
        inner[n] = symmetric(n, basis)
        other = symmetric(n, reference[n]) if reference else None
        weights = [other[pair][1:] for pair in PAIRS] if reference else stored_weights()[n]
        difference = max(abs(inner[n][pair][1:] - w).max() for pair, w in zip(PAIRS, weights))
        worst = max(worst, difference)
        print(f"{n:2}  {c.alpha:9.6f}  {c.b0:9.6f}  {c.w + 1e-9:9.6f}"
              f"    {curvature_jump(n, basis):.1e}     {difference:.1e}")
    if reference:
        about = ""
        if worst > 1e-13:
            about = ("The numbers are those of a reference, another\n// solution of the "
                     f"same equations; the script's own differ by at most {worst:.1e}.")
            inner = {n: symmetric(n, reference[n]) for n in inner}
        OUT.write_text(text_of(inner, about))


if __name__ == "__main__":
    main()
