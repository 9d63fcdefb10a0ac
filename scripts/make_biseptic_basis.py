#!/usr/bin/python3
"""Writes pipeline/schemes/biseptic/basis_data.cpp."""
import json
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "pipeline/schemes/biseptic/basis_data.cpp"
PAIRS = [(i, j) for i in range(5) for j in range(i + 1)]
FAR = [(2, 2), (2, 1), (2, 0), (2, -1), (1, 2), (0, 2), (-1, 2)]


def net(n):
    """Places in the net of e_k, f_k (index mod n), and of the grid points beyond the ring."""
    e = lambda k: 1 + 2 * (k % n)
    f = lambda k: 2 + 2 * (k % n)
    return e, f, {p: 2 * n + 1 + k for k, p in enumerate(FAR)}


def mirror(n):
    """u <-> v."""
    e, f, far = net(n)
    m = np.zeros(2 * n + 8, int)
    for k in range(n):
        m[e(k)], m[f(k)] = e(1 - k), f(-k)
    for x, y in FAR:
        m[far[x, y]] = far[y, x]
    return m


def spoke_mirror(n):
    """The mirror about the spoke v = 0, of the points that a coefficient on the spoke depends on."""
    e, f, far = net(n)
    m = np.arange(2 * n + 8)
    for k in range(n):
        m[e(k)], m[f(k)] = e(-k), f(-k - 1)
    m[far[2, 1]], m[far[2, -1]] = far[2, -1], far[2, 1]
    return m


def symmetric(n, inner):
    """The weights with the symmetries that they have but for rounding, exactly."""
    m, s = mirror(n), spoke_mirror(n)
    inner = (inner + inner.transpose(1, 0, 2)[:, :, m]) / 2
    spoke = inner[:, 0]
    inner[:, 0] = (spoke + spoke[:, s]) / 2
    inner[0, 0, 1:2 * n + 1:2] = inner[0, 0, 1:2 * n + 1:2].mean()
    inner[0, 0, 2:2 * n + 1:2] = inner[0, 0, 2:2 * n + 1:2].mean()
    inner[0] = inner[:, 0][:, m]
    return inner


def write(inner, source):
    """Writes the weights of {valence: 5 x 5 x (2n+8)}."""
    text = f"""// Made by scripts/make_biseptic_basis.py: the weights of the biseptic patches' inner Bezier
// coefficients (docs/math/subdivision.md, 3). Derived here, not the basis that Loop and Schaefer
// published. {source}
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/biseptic/basis.h"

#include <cassert>

// clang-format off
namespace tessemu {{
namespace {{

// For each (i, j), the weights of the net's points 1 .. 2n+7.
"""
    for n, b in sorted(inner.items()):
        text += f"constexpr double kInner{n}[] = {{\n"
        for i, j in PAIRS:
            line = f"    /* {i},{j} */"
            for x in b[i, j, 1:]:
                number = " 0," if x == 0 else f" {float(x)!r},"
                if len(line + number) > 100:
                    text, line = text + line + "\n", "       "
                line += number
            text += line + "\n"
        text += "};\n\n"
    names = ",\n".join("    " + ", ".join(f"kInner{n}" for n in row)
                       for row in (range(3, 8), range(8, 13)))
    text += f"""constexpr std::span<double const> kInner[] = {{
{names}}};

}} // namespace

std::span<double const> biseptic_inner_weights(int valence)
{{
    assert(valence >= 3 && valence <= 12);
    return kInner[valence - 3];
}}

}} // namespace tessemu
"""
    OUT.parent.mkdir(exist_ok=True)
    OUT.write_text(text)


def golden(path):
    valences = json.load(open(path))["valences"]
    return {int(n): np.array(v["matrix"]).reshape(8, 8, -1) for n, v in valences.items()}

if __name__ == "__main__":
    g = golden(sys.argv[1])
    out = {}
    for n, m in g.items():
        out[n] = symmetric(n, m[:5, :5].copy())
        print(n, abs(out[n] - m[:5, :5])[:, :, 1:].max())
    write(out, "The numbers are\n// those of reference data with which the script's own solution is compared with.")
