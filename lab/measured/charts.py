# SPDX-License-Identifier: MIT
"""Charts and pictures of the docs, which scripts/measure and lab/scripts/standing draw.

Needs a build, Debian's Python and the packages of scripts/setup."""
import io
import json
import math
import sys

import numpy
from matplotlib import pyplot

from . import CLPV, RESULTS, ROOT, bake, native, output

clpv = native()
from clpv.draw import style  # noqa: E402
from .sheets import sheet  # noqa: E402

sys.path.insert(0, str(ROOT / "examples"))
import probes  # noqa: E402  pylint: disable=wrong-import-position

FORMATS = ("sh2", "zh3", "sh3", "srbf8v2", "ambient-cube", "ambient-cube-mean")

# Moving objects of draw_spheres: centres and radius [m], reflectance; probes; size of a picture.
SPHERES = [(x, y, z) for x in (-6.5, -4, -1.5, 1.5) for z, y in ((-2.9, 1.2), (-0.3, 2.6), (1.9, 1.2))]
RADIUS, WHITE, SPACING, SHOWN = 0.45, 0.8, 1, (400, 225)
PATHS = 256
# Pictures of draw_frame: view, exposure over the scene's [EV], options of `clpv render`. Steps
# without iterations leave injected light as it is. rsm: what the sun sees of a cascade.
FRAME = {
    "direct": ("direct", 0, {}),
    "rsm": ("direct", 0, {}),
    "injected": ("cells", -0.5, {"transport": "sampled", "iterations": 0}),
    "swept": ("cells", -1.5, {}),
    "irradiance": ("irradiance", -1.5, {"near": "off"}),
    "near": ("irradiance", -1.5, {"near": "traced"}),
    "full": ("full", 0, {"near": "traced"}),
}
CASCADE = 25  # edge of the finest cascade [m], in scenes/atrium.json


def save(figure, target, dpi):
    figure.tight_layout()
    output.write(target, style.rendered(figure, "png", dpi=dpi))


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
    tiles = []
    for title, indirect in light.items():
        array = picture.array.copy()
        array[shown, :3] = WHITE / math.pi * (truth["direct"] + indirect)
        array[shown, 3] = 1
        if title != "path traced":
            error = clpv.compare(indirect[None], truth["indirect"][None]).nrmse
            title += f": NRMSE {100 * error:.0f} %"
        tiles.append((clpv.Image(array, ("R", "G", "B", "A")).display(scene.exposure), title))
    sheet(target, f"Spheres in the atrium, lit by probes {SPACING} m apart", len(light),
          [length / 100 for length in SHOWN], tiles)


def draw_frame(folder):
    """A frame of the atrium stage by stage: frame-NAME.jpg of docs/frame.md."""
    from . import claims, section  # these need the native module
    scene = clpv.Scene(ROOT / "scenes/atrium.json")
    camera = next(each for each in scene.cameras if each.name == "nave")
    above = claims.from_afar(camera, scene.lights[0].direction, CASCADE)
    for name, (view, exposure, options) in FRAME.items():
        size = (360, 360) if name == "rsm" else (640, 360)
        image = clpv.Renderer(scene, **options).render(view, above if name == "rsm" else camera,
                                                       size=size)
        made, pixels = io.BytesIO(), image.display(scene.exposure + exposure)[..., :3]
        pyplot.imsave(made, pixels, format="jpg", pil_kwargs={"quality": 80, "optimize": True})
        output.write(folder / f"frame-{name}.jpg", made.getvalue())
    section.draw(scene, folder / "frame-volume.jpg")
