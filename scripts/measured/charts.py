# SPDX-License-Identifier: MIT
"""Charts and pictures of the docs.

    scripts/charts lambda -o FILE.png     condition, error and energy of SRBF bases over the
                                          bandwidth; lambdas that clpv rejects are missing
    scripts/charts probes -o FILE.png     results/docs/bake.json: error of light probes over bytes
    scripts/charts spheres -o FILE.jpg    spheres that baked probes light, and by path tracing

Needs a build, Debian's Python and the packages of scripts/setup."""
import argparse
import json
import math
import pathlib
import sys

import numpy

from . import CLPV, RESULTS, ROOT, bake, native, output

clpv = native()
from clpv.draw import style  # noqa: E402

sys.path.insert(0, str(ROOT / "examples"))
import probes  # noqa: E402  pylint: disable=wrong-import-position

BASES = ("srbf4", "srbf6", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14")
FORMATS = ("sh2", "zh3", "sh3", "srbf8v2", "ambient-cube", "ambient-cube-mean")
LAMBDAS = [round(0.05 * i, 2) for i in range(1, 15)]

# Moving objects of draw_spheres: centres and radius [m], reflectance; probes; size of a picture.
SPHERES = [(x, y, z) for x in (-6.5, -4, -1.5, 1.5) for z, y in ((-2.9, 1.2), (-0.3, 2.6), (1.9, 1.2))]
RADIUS, WHITE, SPACING, SHOWN = 0.45, 0.8, 1, (400, 225)
PATHS = 256


def save(figure, target, dpi):
    figure.tight_layout()
    output.write(target, style.rendered(figure, "png", dpi=dpi))
    print(target)


def draw_errors(series, target):
    """Error over the time of a frame. `series`: variants of `clpv quality` by label."""
    figure, (axis,) = style.panels(1, 1, (8, 4.5))
    for i, (label, rows) in enumerate(series.items()):
        points = sorted((row["frame_ms"], 100 * row["nrmse"], row["options"].get("grid", ""))
                        for row in rows if row["rejected"] == 0)
        axis.plot(*list(zip(*points))[:2], marker="os^Dv"[i % 5], color=style.colour(i), label=label)
        for j, (*place, grid) in enumerate(points):
            axis.annotate(grid, place, textcoords="offset points", ha="center",
                          xytext=(0, -13 if j % 2 else 6))
    axis.set(ylim=(0, 110), xlabel="frame [ms]", ylabel="mean NRMSE [%]")
    style.logarithmic(axis.xaxis)
    axis.legend()
    save(figure, target, 110)


def measures(name, bandwidth):
    """Condition, mean error and energy of a basis; nothing if clpv rejects this lambda."""
    try:
        basis = clpv.Basis(name, bandwidth)
        return [(bandwidth, basis.condition, basis.mean_error, basis.energy(24))]
    except clpv.UsageError:
        return []


def draw_lambda(target):
    curves = {name: list(zip(*(point for value in LAMBDAS for point in measures(name, value))))
              for name in BASES}
    figure, panels = style.panels(3, 3, (4.27, 4.2))
    titles = ("condition number of A", "clamped cosine: relative L2 error, mean over all axes",
              "energy after 24 steps, sampled transport")
    for k, (panel, title) in enumerate(zip(panels, titles), 1):
        for i, (name, points) in enumerate(curves.items()):
            panel.plot(points[0], points[k], marker="o", markersize=3, label=name,
                       color=style.colour(i))
        panel.set_title(title, fontsize=10)
        panel.set_xlabel("lambda")
        panel.axvline(0.25, color=style.LINE, lw=2, zorder=0)
    style.logarithmic(panels[0].yaxis)
    panels[0].axhline(1e7, color=style.INK, linestyle="--")
    panels[1].axhline(0.354, color=style.INK, linestyle=":", label="sh2")
    panels[1].axhline(0.088, color=style.INK, linestyle="--", label="sh3")
    panels[1].set_ylim(0, 0.7)
    panels[2].axhline(1, color=style.INK, linestyle="--")
    panels[2].set_ylim(0, 2)
    panels[1].legend(fontsize=8)
    save(figure, target, 80)


def draw_probes(target):
    """Errors of light probes by format, from coarse to fine spacing, over bytes of the volume."""
    rows = json.loads((RESULTS / "docs/bake.json").read_text(encoding="utf-8"))["rows"]
    figure, panels = style.panels(4, 2, (5.2, 3.6))
    places = [(source, place) for source in bake.SOURCES for place in ("surface", "air")]
    for panel, (source, place) in zip(panels, places):
        for i, name in enumerate(FORMATS):
            line = bake.over_bytes(rows, name, source, place)
            panel.plot(*zip(*line), lw=1.5, marker="osv^Dp"[i], ms=5, color=style.colour(i), label=name)
        where = {"surface": "on surfaces", "air": "in the air"}[place]
        panel.set(title=f"{'path-traced' if source == 'pathtrace' else 'swept'} probes, {where}",
                  xlabel="bytes in a cube of the coarse spacing", ylabel="mean NRMSE [%]")
        style.logarithmic(panel.xaxis)
    panels[0].legend()
    save(figure, target, 90)


def seen_spheres(camera, depth):
    """Pixels (height, width) that show a sphere before `depth`, then its points and normals there."""
    eye, target, up = map(numpy.array, (camera.eye, camera.target, camera.up))
    z = (target - eye) / numpy.linalg.norm(target - eye)
    x = numpy.cross(z, up)
    x /= numpy.linalg.norm(x)
    half = math.tan(math.radians(camera.fov / 2))
    height, width = depth.shape
    v, u = (numpy.mgrid[:height, :width] + 0.5) * 2 - numpy.array([height, width])[:, None, None]
    rays = z + half / height * (u[..., None] * x - v[..., None] * numpy.cross(x, z))
    points, normals, nearest = numpy.zeros_like(rays), numpy.zeros_like(rays), depth.copy()
    for centre in SPHERES:
        a, b = (rays**2).sum(axis=-1), (rays * (eye - centre)).sum(axis=-1)
        root = b * b - a * (((eye - centre)**2).sum() - RADIUS**2)
        t = numpy.where(root > 0, (-b - numpy.sqrt(abs(root))) / a, 0)
        hit = (t > 0) & ((t < nearest) | (nearest == 0))
        nearest[hit], points[hit] = t[hit], eye + t[hit, None] * rays[hit]
        normals[hit] = (points[hit] - centre) / RADIUS
    shown = (normals != 0).any(axis=-1)
    return shown, points[shown], normals[shown]


def draw_spheres(target):
    """The atrium with spheres that the scene does not have, by probes and by path tracing."""
    file = ROOT / "scenes/atrium.json"
    scene = clpv.Scene(file)
    camera = next(each for each in scene.cameras if each.name == "nave")
    with clpv.Renderer(scene) as renderer:
        picture = renderer.render("full", camera, size=SHOWN)
        depth = renderer.show("depth").array[..., 0].astype(float)
    shown, points, normals = seen_spheres(camera, depth)
    truth = scene.pathtrace_points(points, normals, samples=PATHS)
    light = {}
    for title, source in (("swept probes", "sweep"), ("path-traced probes", "pathtrace")):
        baked = probes.bake(CLPV, file, ("--format=ambient-cube-mean", f"--spacing={SPACING}",
                                         f"--from={source}", f"--bounds={bake.BOXES['atrium']}",
                                         *([bake.PATHS] if source == "pathtrace" else [])))
        light[title] = probes.irradiance(baked, points, normals)
    light["path traced"] = truth["indirect"]
    made = style.Sheet([f"Spheres in the atrium, lit by probes {SPACING} m apart"], len(light), len(light),
                       tuple(length / 100 for length in SHOWN), above=True)
    for i, (title, indirect) in enumerate(light.items()):
        array = picture.array.copy()
        array[shown, :3] = WHITE / math.pi * (truth["direct"] + indirect)
        array[shown, 3] = 1
        if title != "path traced":
            error = clpv.compare(indirect[None], truth["indirect"][None]).nrmse
            title += f": NRMSE {100 * error:.0f} %"
        made.tile(i, title).imshow(clpv.Image(array, ("R", "G", "B", "A")).display(scene.exposure))
    made.save(target, 100)


CHARTS = {"lambda": draw_lambda, "probes": draw_probes, "spheres": draw_spheres}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("chart", choices=CHARTS)
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path, metavar="FILE")
    arguments = parser.parse_args()
    CHARTS[arguments.chart](output.target_of(arguments.output))
    return 0
