#!/usr/bin/env python3
"""Draws the pictures of docs/images with the built program. Standard library only."""
import json
import math
import pathlib
import shutil
import subprocess
import tempfile

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
    run("cost", "golem", "--tess", "24", "-o", str(OUT / "roofline.png"))
    cages = ROOT.parent / "shared" / "models"  # the paper's own are not the project's to give
    if cages.is_dir():
        for number in (4, 5):
            run("reproduce", "loop10-figure%d" % number, "--models", str(cages),
                "-o", str(OUT / ("loop10_figure%d.png" % number)))
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


if __name__ == "__main__":
    OUT.mkdir(parents=True, exist_ok=True)
    pictures()
    subdivision()
    smoothness()
    figures()
    cracks()
    patterns()
    stages()
