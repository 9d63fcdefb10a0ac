#!/usr/bin/env python3
"""Draws the pictures of docs/images with the built program. Standard library only."""
import base64
import hashlib
import json
import math
import pathlib
import shutil
import struct
import subprocess
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "docs" / "images"
TESSEMU = ROOT / "build" / "release" / "tessemu"


def run(*arguments):
    return subprocess.run([TESSEMU, *arguments], check=True, capture_output=True, text=True).stdout


def pictures():
    run("draw", "jug", "--tess", "24", "--size", "640x640", "--view", "patches", "-o", str(OUT / "jug_patches.png"))
    run("draw", "saddle_star", "--scheme", "acc", "--view", "patches", "--tess", "12", "--size", "640x420",
        "-o", str(OUT / "saddle_star_acc.png"))
    run("draw", "spindle", "--scheme", "pm", "--view", "patches", "--tess", "12", "--size", "640x420",
        "-o", str(OUT / "spindle_pm.png"))
    for view in ("wire", "coverage"):
        run("draw", "jug", "--tess", "5", "--view", view, "--size", "480x480", "--samples", "4",
            "-o", str(OUT / f"jug_{view}.png"))


def subdivision():
    for name, steps in (("cage", "0"), ("step1", "1")):
        run("draw", "jug", "--view", "cage", "--subdivide", steps, "--size", "400x400", "--samples", "4",
            "-o", str(OUT / ("subdivision_%s.png" % name)))


def figures():
    for number in (1, 9, 11):
        run("reproduce", "loop09-figure%d" % number, "--models", "nowhere", "-o", str(OUT / ("figure%d.png" % number)))
    for number in (4, 5, 6, 7):
        run("reproduce", "holl10-figure%d" % number, "--models", "nowhere",
            "-o", str(OUT / ("holl10_figure%d.png" % number)))
    run("cost", "golem", "--tess", "24", "-o", str(OUT / "roofline.png"))
    run("reproduce", "schemes", "-o", str(OUT / "schemes.png"))
    cages = ROOT.parent / "shared" / "models"  # the paper's own are not the project's to give
    if cages.is_dir():
        for number in (4, 5):
            run("reproduce", "loop10-figure%d" % number, "--models", str(cages),
                "-o", str(OUT / ("loop10_figure%d.png" % number)))
        run("reproduce", "holl10-figure8", "--models", str(cages), "-o", str(OUT / "holl10_figure8.png"))
    with tempfile.TemporaryDirectory() as folder:
        run("draw", "golem", "--animate", "sway", "--frames", "4", "--tess", "16", "--size", "320x320", "--samples", "4",
            "--camera", "from=.3,.2,1", "-o", folder + "/sway.png")
        for i in (1, 3):
            shutil.copy(folder + "/sway_%04d.png" % i, OUT / ("sway%d.png" % i))


def star(valence):
    """An OBJ file: quads around a vertex of a valence, four rings of them, on a saddle."""
    rings, lines, number = 4, [], {}

    def vertex(sector, x, y):  # x along spoke `sector`, y along the next one
        if x == 0:
            sector, x, y = sector + 1, y, 0
        key = (sector % valence, x, y) if x else (0, 0, 0)
        if key not in number:
            a, b = (2 * math.pi * (sector + k) / valence for k in (0, 1))
            px, py = x * math.cos(a) + y * math.cos(b), x * math.sin(a) + y * math.sin(b)
            # Rings that lie one around the other also where sectors are narrow or wide.
            if x:
                scale = max(x, y) / math.hypot(px, py)
                px, py = px * scale, py * scale
            lines.append("v %.6f %.6f %.6f" % (px, py, 0.1 * px * px - 0.09 * py * py + 0.05 * px * py))
            number[key] = len(lines)
        return number[key]
    faces = []
    for sector in range(valence):
        for x in range(rings):
            for y in range(rings):
                faces.append("f %d %d %d %d" % (vertex(sector, x, y), vertex(sector, x + 1, y),
                                                vertex(sector, x + 1, y + 1), vertex(sector, x, y + 1)))
    return "\n".join(lines + faces) + "\n"


def smoothness():
    """Closely at a vertex of each valence: rows of docs/smoothness.md."""
    with tempfile.TemporaryDirectory() as folder:
        for valence in (3, 5, 8):
            cage = pathlib.Path(folder) / ("star%d.obj" % valence)
            cage.write_text(star(valence))
            for scheme in ("stam", "biseptic"):
                for view, options in (("zebra", []), ("curvature", ["--curvature-max", "0.12"])):
                    run("draw", str(cage), "--scheme", scheme, "--tess", "64", "--size", "240x240", "--samples", "4",
                        "--view", view, "--camera", "eye=0,-1.5,5:target=0,0,0:up=0,1,0:focal=8", *options,
                        "-o", str(OUT / ("smoothness_%d_%s_%s.png" % (valence, scheme, view))))


def cracks():
    """Exit status 1 is what these runs are for."""
    for name, options in (("cracks_ulp.png", []), ("cracks_parity.png", ["--parity", "0.01"])):
        subprocess.run([TESSEMU, "check", "golem", "--tess", "7.3", "--break", "order", "--rays", "0", "--size", "480x480",
                        "--camera", "from=.4,.3,1", *options, "-o", str(OUT / name)], capture_output=True)


def patterns():
    rows = [
        ("quad, integer 5", "quad", "integer", [5] * 6),
        ("quad, fractional_odd 5.4", "quad", "fractional_odd", [5.4] * 6),
        ("quad, edges 2 9 5 3, inside 6 4", "quad", "fractional_even", [2, 9, 5, 3, 6, 4]),
        ("tri, integer 5", "tri", "integer", [5] * 4),
        ("tri, fractional_even 5.4", "tri", "fractional_even", [5.4] * 4),
        ("tri, edges 2 9 5, inside 4", "tri", "fractional_odd", [2, 9, 5, 4]),
    ]
    size, gap = 200, 30
    svg = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" font-family="sans-serif" font-size="12">'
           % (3 * (size + gap) + gap, 2 * (size + gap + 20) + gap), '<rect width="100%" height="100%" fill="white"/>']
    for i, (title, domain, partitioning, factors) in enumerate(rows):
        x0, y0 = gap + (i % 3) * (size + gap), gap + (i // 3) * (size + gap + 20)
        patch = json.loads(run("tessellate", "--domain", domain, "--partitioning", partitioning, "--factors",
                               *map(str, factors)))

        def at(k):
            u, v = patch["u"][k] / 65536, patch["v"][k] / 65536
            if domain == "tri":  # u = 1 lower left, v = 1 lower right, w = 1 on top
                u, v = (1 - u + v) / 2, 0.933 - 0.866 * (1 - u - v)
            return x0 + size * u, y0 + size * v
        lines = set()
        for t in range(0, len(patch["indices"]), 3):
            a = patch["indices"][t:t + 3]
            lines |= {tuple(sorted((a[k], a[(k + 1) % 3]))) for k in range(3)}
        path = "".join("M%.1f %.1fL%.1f %.1f" % (*at(a), *at(b)) for a, b in sorted(lines))
        svg.append('<path d="%s" stroke="#2563a8" stroke-width="0.8" fill="none"/>' % path)
        svg += ['<circle cx="%.1f" cy="%.1f" r="1.6" fill="#e07b1a"/>' % at(k) for k in range(len(patch["u"]))]
        svg.append('<text x="%d" y="%d" fill="#333">%s</text>' % (x0, y0 + size + 18, title))
    (OUT / "patterns.svg").write_text("\n".join(svg + ["</svg>\n"]))


def stages():
    boxes = [("input assembler", 0), ("vertex cache", 0), ("vertex shader", 1), ("hull shader", 1), ("tessellator", 0),
             ("domain shader", 1), ("geometry shader", 1), ("stream output", 0), ("assembly, clip", 0), ("rasterizer", 0), ("pixel shader", 1), ("output merger", 0)]
    flows = ["vertices", "misses", "control points", "output points, patch constants, tess factors",
             "domain points u, v and triangles", "clip-space vertices", "whole primitives", "points, lines, triangles", "16.8 primitives", "fragments", "colours"]
    w, h, step = 170, 30, 56
    svg = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 560 %d" font-family="sans-serif" font-size="13">'
           % (len(boxes) * step + 10), '<rect width="100%" height="100%" fill="white"/>']
    for i, (name, programmable) in enumerate(boxes):
        y = 10 + i * step
        svg.append('<rect x="20" y="%d" width="%d" height="%d" rx="6" fill="%s" stroke="#555"/>'
                   % (y, w, h, "#cfe3fb" if programmable else "#eeeeee"))
        svg.append('<text x="%d" y="%d" text-anchor="middle">%s</text>' % (20 + w / 2, y + 20, name))
        if i < len(flows):
            svg.append('<path d="M%d %dv%d" stroke="#555" marker-end="url(#a)"/>' % (20 + w / 2, y + h, step - h - 5))
            svg.append('<text x="%d" y="%d" fill="#666" font-size="12">%s</text>' % (30 + w / 2, y + h + 17, flows[i]))
    svg.append('<text x="230" y="30" fill="#333">blue: programmable (a shader, counted)</text>')
    svg.append('<text x="230" y="50" fill="#333">grey: fixed function</text>')
    svg.append('<defs><marker id="a" viewBox="0 0 6 6" refX="3" refY="3" markerWidth="6" markerHeight="6" orient="auto">'
               '<path d="M0 0L6 3L0 6z" fill="#555"/></marker></defs>')
    (OUT / "stages.svg").write_text("\n".join(svg + ["</svg>\n"]))


def basis_tables(faces, sector=False):
    """Position and du of a patch at a smooth vertex, or at the first edge of a crease's sector: by control point, rows of
    samples. From the file that `tessemu tables` writes; io/table_cache.h has its format, PatchType::bytes() a type's."""
    key = struct.pack("<BHHfHH", not sector, faces, 0, 0, 0, 0) + bytes(3) + struct.pack("<BHBB", 0, 0, 0, 0)
    magic = b"tessemu basis tables 1\n"
    with tempfile.TemporaryDirectory() as folder:
        run("tables", "--valences", str(faces), "--rules", "opensubdiv", "-o", folder)
        name = hashlib.sha256(magic + key).hexdigest() + ".tables"
        rest = (pathlib.Path(folder) / name).read_bytes()[len(magic) + 65 + 4 + len(key) + 4:]
    points, side = struct.unpack("<I", rest[:4])[0], 33
    weights = struct.unpack("<%dd" % (3 * points * side * side), rest[4:])

    def table(number):
        at = number * side * side
        return [weights[at + j * side:at + (j + 1) * side] for j in range(side)]
    return [table(k) for k in range(points)], [table(points + k) for k in range(points)]


def png(rows):
    """A file of rows of (r, g, b)."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    raw = b"".join(b"\0" + bytes(c for pixel in row for c in pixel) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def bolz_tables():
    """Tables of basis functions as images, as they lie in the texture but for the turn: v runs up."""
    position, du = basis_tables(5)
    names = ["V, the corner (0,0)", "e_0, a neighbour (1,0)", "f_0, the opposite corner (1,1)"]
    texel, size, gap, left, top = 5, 165, 44, 106, 34

    def colour(x):  # -1: red, 0: white, 1: blue
        end = (24, 79, 150) if x > 0 else (178, 24, 43)
        return tuple(round(255 + (c - 255) * min(abs(x), 1) ** 0.8) for c in end)

    def image(x, y, w, h, rows):
        data = base64.b64encode(png(rows)).decode()
        return ('<image x="%d" y="%d" width="%d" height="%d" href="data:image/png;base64,%s"/>'
                '<rect x="%d" y="%d" width="%d" height="%d" fill="none" stroke="#333"/>' % (x, y, w, h, data, x, y, w, h))
    width, height = left + 3 * (size + gap) + 70, top + 2 * (size + gap) + 10
    svg = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" font-family="sans-serif" font-size="13">'
           % (width, height), '<rect width="100%" height="100%" fill="white"/>']
    for row, (title, tables, most, ticks) in enumerate([("position", position, 0.5, [0, 0.25, 0.5]),
                                                        ("du", du, 0.6, [-0.6, -0.3, 0, 0.3, 0.6])]):
        y = top + row * (size + gap)
        svg.append('<text x="%d" y="%d" text-anchor="end" font-size="15">%s</text>' % (left - 30, y + size / 2, title))
        for column in range(3):
            x = left + column * (size + gap)
            rows = [[colour(w / most) for w in line for _ in range(texel)]
                    for line in reversed(tables[column]) for _ in range(texel)]
            svg.append(image(x, y, size, size, rows))
            if row == 0:
                svg.append('<text x="%d" y="%d" text-anchor="middle">%s</text>' % (x + size / 2, top - 12, names[column]))
            svg.append('<text x="%d" y="%d" fill="#555" font-size="11">u = 0</text>' % (x, y + size + 14))
            svg.append('<text x="%d" y="%d" fill="#555" font-size="11" text-anchor="end">1</text>' % (x + size, y + size + 14))
            svg.append('<text x="%d" y="%d" fill="#555" font-size="11" text-anchor="end">v = 0</text>' % (x - 3, y + size))
            svg.append('<text x="%d" y="%d" fill="#555" font-size="11" text-anchor="end">1</text>' % (x - 3, y + 10))
        x, low = left + 3 * (size + gap), ticks[0]
        svg.append(image(x, y, 16, size, [[colour((most + (low - most) * i / size) / most)] * 16 for i in range(size)]))
        for t in ticks:
            at = y + size * (most - t) / (most - low)
            svg.append('<path d="M%d %.1fh4" stroke="#333"/><text x="%d" y="%.1f" font-size="11">%g</text>'
                       % (x + 16, at, x + 23, at + 4, t))
    (OUT / "bolz03_tables.svg").write_text("\n".join(svg + ["</svg>\n"]))


def bolz_classes():
    """Control points in colours of their classes: those with the same weights along an edge (BOLZ03 figures 3 to 5)."""
    palette = ["#d7301f", "#2171b5", "#238b45", "#ff9f1c", "#7b3fa0", "#17a2a2", "#e377c2", "#8c564b", "#bcbd22"]
    size, top = 290, 40

    def net(faces, sector):
        """Places of the control points, in the tables' order, and lines between them."""
        theta = math.pi / faces if sector else 2 * math.pi / faces
        edges = faces + 1 if sector else faces

        def polar(radius, turn):
            return radius * math.cos(turn * theta), radius * math.sin(turn * theta)

        def plus(a, b):
            return a[0] + 0.85 * b[0], a[1] + 0.85 * b[1]
        out, lines = [(0, 0)], []
        e, f = [polar(1, j) for j in range(edges)], [polar(1.3, j + .5) for j in range(faces)]
        for j in range(edges):
            out.append(e[j])
            if j < faces:
                out.append(f[j])
            lines.append(((0, 0), e[j]))
        for j in range(faces):
            lines += [(e[j], f[j]), (f[j], e[(j + 1) % edges])]
        a, b = [plus(e[0], e[0]), plus(f[0], e[0])], [plus(e[1], e[1]), plus(f[0], e[1])]
        out += [a[0], a[1], plus(f[0], (1.1 * f[0][0], 1.1 * f[0][1])), b[1], b[0]]
        c = out[-5:]
        lines += [(e[0], c[0]), (f[0], c[1]), (f[0], c[3]), (e[1], c[4])] + [(c[i], c[i + 1]) for i in range(4)]
        if not sector:
            out.append(plus(f[-1], e[0]))
            lines += [(f[-1], out[-1]), (out[-1], c[0])]
        out.append(plus(f[1], e[1]))
        lines += [(f[1], out[-1]), (out[-1], c[4])]
        return out, lines

    svg = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" font-family="sans-serif" font-size="14">'
           % (3 * size, size + top + 22), '<rect width="100%" height="100%" fill="white"/>']
    for panel, (title, sector, is_right) in enumerate([("off-corner", False, True), ("off-corner, at a tag", True, True),
                                                       ("on-corner", False, False)]):
        faces = 3 if sector else 5
        position, _ = basis_tables(faces, sector)
        places, lines = net(faces, sector)
        # Weights along the edge, and the same from its other end where that may be the same class.
        both_ways = is_right and not sector
        classes, of_point = [], []
        for table in position:
            row = [table[i][32] for i in range(33)] if is_right else list(table[0])
            if max(map(abs, row)) < 1e-12:
                of_point.append(None)
                continue

            def is_equal(a, b):
                return max(abs(x - y) for x, y in zip(a, b)) < 1e-12
            found = [i for i, c in enumerate(classes) if is_equal(c, row) or both_ways and is_equal(c, row[::-1])]
            if not found:
                classes.append(row)
            of_point.append(found[0] if found else len(classes) - 1)
        xs, ys = [p[0] for p in places], [p[1] for p in places]
        scale = (size - 56) / max(max(xs) - min(xs), max(ys) - min(ys))
        x0 = panel * size + size / 2 - scale * (max(xs) + min(xs)) / 2
        y0 = top + size / 2 + scale * (max(ys) + min(ys)) / 2

        def at(p):
            return x0 + scale * p[0], y0 - scale * p[1]

        def path(a, b, stroke, width):
            return '<path d="M%.1f %.1fL%.1f %.1f" stroke="%s" stroke-width="%g"/>' % (*at(a), *at(b), stroke, width)
        V, e0, f0, e1 = places[0], places[1], places[2], places[3]
        svg.append('<path d="%sz" fill="#fff3d6"/>' % "".join("%s%.1f %.1f" % (c, *at(p)) for c, p in zip("MLLL", (V, e0, f0, e1))))
        svg += [path(a, b, "#aaa", 1) for a, b in lines]
        if sector:  # both sharp edges, and what goes on from the first
            svg += [path(a, b, "#444", 2.5) for a, b in ((V, e0), (V, places[7]), (e0, places[8]))]
        edge = (e0, f0) if is_right else (V, e0)
        svg.append(path(*edge, "#000", 5))
        for p, c in zip(places, of_point):
            svg.append('<circle cx="%.1f" cy="%.1f" r="%g" fill="%s" stroke="#222"/>'
                       % (*at(p), 4 if c is None else 8, "#fff" if c is None else palette[c]))
        x, y = at(V)
        svg.append('<text x="%.1f" y="%.1f" text-anchor="end" font-weight="bold">V</text>' % (x - 11, y - 8))
        svg.append('<text x="%d" y="24" text-anchor="middle" font-size="15">%s</text>' % (panel * size + size / 2, title))
        svg.append('<text x="%d" y="%d" text-anchor="middle" fill="#444">%d classes</text>'
                   % (panel * size + size / 2, top + size + 12, len(classes)))
    (OUT / "bolz03_classes.svg").write_text("\n".join(svg + ["</svg>\n"]))


def bracket(is_concave):
    """An OBJ file: an L of blocks with tags of every kind. Sharpness below 10 only where no corner is concave: Biermann's
    rules know none."""
    depth = 3
    solid = {(x, y, z) for x in range(4) for y in range(depth) for z in range(4) if x < 2 or z < 2}
    number, lines, faces = {}, [], []

    def vertex(p):
        if p not in number:
            number[p] = len(number)
            lines.append("v %g %g %g" % (p[0], p[2], -p[1]))  # y up
        return number[p]
    for x, y, z in sorted(solid):
        for axis in range(3):
            for side in (0, 1):
                beyond = [x, y, z]
                beyond[axis] += 2 * side - 1
                if tuple(beyond) in solid:
                    continue
                corner = [x, y, z]
                corner[axis] += side
                quad = []
                for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    p = list(corner)
                    p[(axis + 1) % 3] += a
                    p[(axis + 2) % 3] += b
                    quad.append(vertex(tuple(p)))
                faces.append("f " + " ".join(str(v + 1) for v in (quad if side else quad[::-1])))
    tags = []

    def crease(points, sharpness):
        for a, b in zip(points, points[1:]):
            tags.append("t crease 2/1/0 %d %d %g" % (number[a], number[b], sharpness))
    front = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0), (4, 0, 0), (4, 0, 1), (4, 0, 2), (3, 0, 2), (2, 0, 2), (2, 0, 3),
             (2, 0, 4), (1, 0, 4), (0, 0, 4), (0, 0, 3), (0, 0, 2), (0, 0, 1), (0, 0, 0)]
    crease(front, 10)
    crease([(2, y, 2) for y in range(depth)], 10)  # from the front's inner corner to a dart
    crease([(2, 0, 4), (2, 1, 4)], 10)
    crease([(4, y, 2) for y in range(depth + 1)], 10 if is_concave else 2.5)
    return "\n".join(lines + faces + tags) + "\n"


def bolz():
    bolz_tables()
    bolz_classes()
    with tempfile.TemporaryDirectory() as folder:
        for name, is_concave in (("opensubdiv", False), ("biermann", True)):
            cage = pathlib.Path(folder) / (name + ".obj")
            cage.write_text(bracket(is_concave))
            run("draw", str(cage), "--scheme", "bolz", "--set", "rules=" + name, "--tess", "16", "--view", "patches",
                "--size", "480x420", "--samples", "4", "--camera", "from=.55,.6,1", "--table-cache", "none",
                "-o", str(OUT / ("bolz03_families_%s.png" % name)))
        run("draw", str(cage.with_stem("opensubdiv")), "--scheme", "bolz", "--set", "adapt=2e-3", "--view", "wire", "--size",
            "700x420", "--samples", "4", "--camera", "eye=4.2,6.4,3:target=1.45,3.78,-.3:up=0,1,0:focal=4.2",
            "--table-cache", "none", "-o", str(OUT / "bolz03_adaptive.png"))


if __name__ == "__main__":
    OUT.mkdir(parents=True, exist_ok=True)
    pictures()
    subdivision()
    smoothness()
    bolz()
    figures()
    cracks()
    patterns()
    stages()
