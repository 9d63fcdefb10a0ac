#!/usr/bin/env python3
"""Writes the project's own control cages into models/ (Apache-2.0, like everything here).

Standard library only; coordinates are rounded to 1/1024, so the files do not depend on the machine.
"""
import math
import pathlib

OUT = pathlib.Path(__file__).resolve().parent.parent / "models"


class Cage:
    def __init__(self):
        self.v, self.f = [], []
        self.vt, self.ft = [], []  # texture coordinates, and those of the faces' corners

    def vertex(self, x, y, z):
        self.v.append((x, y, z))
        return len(self.v) - 1

    def ring(self, n, r, y, turn=0.5, shape=lambda a: (0, 0, 0)):
        ids = []
        for k in range(n):
            a = 2 * math.pi * (k + turn) / n
            dx, dy, dz = shape(a)
            ids.append(self.vertex(r * math.cos(a) + dx, y + dy, -r * math.sin(a) + dz))
        return ids

    def strip(self, low, high, skip=()):
        n = len(low)
        for k in range(n):
            if k not in skip:
                self.f.append((low[k], low[(k + 1) % n], high[(k + 1) % n], high[k]))

    def write(self, name, about):
        q = lambda x: "%.10g" % (round(x * 1024) / 1024 + 0.0)
        with open(OUT / (name + ".obj"), "w", newline="\n") as out:
            out.write("# %s\n# SPDX-License-Identifier: Apache-2.0\n" % about)
            for p in self.v:
                out.write("v %s %s %s\n" % tuple(map(q, p)))
            for t in self.vt:
                out.write("vt %s %s\n" % tuple(map(q, t)))
            if not self.ft:
                for f in self.f:
                    out.write("f %s\n" % " ".join(str(i + 1) for i in f))
            for f, t in zip(self.f, self.ft):
                out.write("f %s\n" % " ".join("%d/%d" % (i + 1, k + 1) for i, k in zip(f, t)))


def jug():
    """Handle roots give irregular quads, the base and the collar triangles, the lip a boundary."""
    c = Cage()
    pole = c.vertex(0, 0.03, 0)
    rings = [c.ring(8, r, y) for r, y in
             ((0.56, 0.0), (0.94, 0.30), (1.10, 0.80), (0.90, 1.30), (0.55, 1.68), (0.48, 1.98))]
    for k in range(8):
        c.f.append((pole, rings[0][(k + 1) % 8], rings[0][k]))
    back = 3  # the face whose middle looks along -x
    for i in range(5):
        c.strip(rings[i], rings[i + 1], skip=(back,) if i in (2, 4) else ())

    def spout(a):
        t = max(0.0, math.cos(a)) ** 4
        return (0.26 * t, 0.10 * t, 0.0)
    collar = c.ring(16, 0.63, 2.24, 1.0, lambda a: tuple(0.5 * x for x in spout(a)))
    lip = c.ring(16, 0.74, 2.42, 1.0, spout)
    neck = rings[5]
    for k in range(8):  # 8 to 16: three triangles a side
        a, b = neck[k], neck[(k + 1) % 8]
        p, q, r = collar[2 * k], collar[2 * k + 1], collar[(2 * k + 2) % 16]
        c.f += [(a, q, p), (a, b, q), (b, r, q)]
    c.strip(collar, lip)

    def section(x, y, nx, ny, thick, wide):  # outer right, outer left, inner left, inner right
        s = math.hypot(nx, ny)
        nx, ny = thick * nx / s, thick * ny / s
        return [c.vertex(x + nx, y + ny, -wide), c.vertex(x + nx, y + ny, wide),
                c.vertex(x - nx, y - ny, wide), c.vertex(x - nx, y - ny, -wide)]

    n, m = (back + 1) % 8, back
    top = [rings[5][m], rings[5][n], rings[4][n], rings[4][m]]
    bottom = [rings[2][m], rings[2][n], rings[3][n], rings[3][m]]
    path = [top, section(-0.98, 1.96, 0.05, 1, 0.10, 0.13), section(-1.46, 1.84, -0.7, 0.75, 0.10, 0.13),
            section(-1.66, 1.45, -1, 0.0, 0.10, 0.13), section(-1.46, 1.12, -0.6, -0.75, 0.11, 0.14), bottom]
    for a, b in zip(path, path[1:]):
        for k in range(4):
            c.f.append((a[(k + 1) % 4], a[k], b[k], b[(k + 1) % 4]))
    c.write("jug", "A jug: irregular quads at the handle, triangles at base and collar, an open lip.")


def spindle():
    """Triangles only, closed: two poles and antiprism bands."""
    c = Cage()
    south = c.vertex(0, -1.4, 0)
    rings = [c.ring(6, r, y, t) for r, y, t in
             ((0.55, -1.0, 0.0), (0.95, -0.35, 0.5), (0.95, 0.35, 0.0), (0.55, 1.0, 0.5))]
    north = c.vertex(0, 1.4, 0)
    for k in range(6):
        c.f.append((south, rings[0][(k + 1) % 6], rings[0][k]))
        c.f.append((north, rings[3][k], rings[3][(k + 1) % 6]))
    for i in range(3):
        low, high = rings[i], rings[i + 1]
        for k in range(6):
            if i % 2 == 0:
                c.f += [(low[k], low[(k + 1) % 6], high[k]), (low[(k + 1) % 6], high[(k + 1) % 6], high[k])]
            else:
                c.f += [(low[k], high[(k + 1) % 6], high[k]), (low[k], low[(k + 1) % 6], high[(k + 1) % 6])]
    c.write("spindle", "A spindle of triangles, closed.")


def star():
    """One vertex of valence 6 amid quads, open all round: three hills and three valleys."""
    c = Cage()
    n, size = 6, 3
    ids = {}

    def at(sector, i, j):
        if i == 0 and j == 0:
            key = (0, 0, 0)
        elif j == 0:
            key = (sector, i, 0)
        elif i == 0:
            key = ((sector + 1) % n, j, 0)
        else:
            key = (sector, i, j)
        if key not in ids:
            s, p, q = key
            a, b = 2 * math.pi * s / n, 2 * math.pi * (s + 1) / n
            x, z = p * math.cos(a) + q * math.cos(b), p * math.sin(a) + q * math.sin(b)
            r2 = x * x + z * z
            angle = math.atan2(z, x)
            ids[key] = c.vertex(0.5 * x, 0.09 * r2 * math.cos(3 * angle) * 0.6, -0.5 * z)
        return ids[key]

    for s in range(n):
        for i in range(size):
            for j in range(size):
                c.f.append((at(s, i, j), at(s, i + 1, j), at(s, i + 1, j + 1), at(s, i, j + 1)))
    c.write("saddle_star", "A monkey saddle around one vertex of valence 6, open all round.")


def golem():
    """The surface of a figure of blocks: quads only, closed, a texture chart for each of six directions."""
    blocks = {(x, y, 0) for x in (0, 1, 2) for y in (2, 3)}
    blocks |= {(x, y, 0) for x in (0, 2) for y in (0, 1)}
    blocks |= {(x, 3, 0) for x in (-2, -1, 3, 4)} | {(1, 4, 0), (1, 5, 0), (0, 0, 1), (2, 0, 1)}
    c = Cage()
    ids, charts = {}, {}
    # Of each direction: the corners of a block's face, counter-clockwise from outside.
    faces = {
        (1, 0, 0): ((1, 0, 1), (1, 0, 0), (1, 1, 0), (1, 1, 1)), (-1, 0, 0): ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)),
        (0, 1, 0): ((0, 1, 1), (1, 1, 1), (1, 1, 0), (0, 1, 0)), (0, -1, 0): ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)),
        (0, 0, 1): ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)), (0, 0, -1): ((1, 0, 0), (0, 0, 0), (0, 1, 0), (1, 1, 0))}

    def place(p):
        x, y, z = p[0] - 1.5, p[1] - 3, p[2] - 0.5
        if p[1] >= 5:  # a round head
            x, z = 1.5 * x, 1.5 * z
        if abs(x) > 2.9:  # fists
            z *= 1.4
        return (0.4 * x, 0.4 * y, 0.44 * z)

    def corner(p):
        if p not in ids:
            ids[p] = c.vertex(*place(p))
        return ids[p]

    def coordinates(direction, p):
        key = (direction, p)
        if key not in charts:
            k = list(faces).index(direction)
            axes = [a for a in range(3) if direction[a] == 0]
            u = (p[axes[0]] + 2) / 8 if axes[0] == 0 else p[axes[0]] / 8
            charts[key] = len(c.vt)
            c.vt.append(((k % 3 + 0.05 + 0.9 * u) / 3, (k // 3 + 0.05 + 0.9 * p[axes[1]] / 8) / 2))
        return charts[key]

    for b in sorted(blocks):
        for direction, corners in faces.items():
            if tuple(i + d for i, d in zip(b, direction)) in blocks:
                continue
            at = [tuple(i + k for i, k in zip(b, corner_)) for corner_ in corners]
            c.f.append(tuple(corner(p) for p in at))
            c.ft.append(tuple(coordinates(direction, p) for p in at))
    c.write("golem", "A figure of blocks: quads only, closed, irregular nearly everywhere; texture coordinates with seams.")


if __name__ == "__main__":
    jug()
    spindle()
    star()
    golem()
