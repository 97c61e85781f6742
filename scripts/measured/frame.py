# SPDX-License-Identifier: MIT
"""Renders the pictures of docs/frame.md: one frame of the atrium, stage by stage.

    scripts/frame [--out DIR]

Output: frame-NAME.jpg in docs/images, or in DIR, a new or empty folder, or one of an earlier run.
First builds. Needs the packages of scripts/setup.
"""
import argparse
import io
import math
import pathlib
import subprocess

import numpy as np
from matplotlib import pyplot

from . import ROOT, native, output

clpv = native()  # main() builds the native module
from clpv.draw import style  # noqa: E402

CAMERA = "nave"
SIZE = {"width": 640, "height": 360}
# Pictures: view, exposure over the scene's [EV], options of `clpv render`. Steps without iterations
# leave injected light as it is.
PICTURES = {
    "direct": ("direct", 0, {}),
    "injected": ("cells", -0.5, {"transport": "sampled", "iterations": 0}),
    "swept": ("cells", -1.5, {}),
    "irradiance": ("irradiance", -1.5, {"near": "off"}),
    "near": ("irradiance", -1.5, {"near": "traced"}),
    "full": ("full", 0, {"near": "traced"}),
}
CASCADE = 25  # edge of the finest cascade [m], in scenes/atrium.json
# The section of the nave: where it cuts, its view, and cascades small enough to be seen.
SECTION, EYE, FROM_AFAR = 1.0, (-3.2, 2, 0), 90  # z [m], camera of the cascades, distance [m]
SHOWN = (-15.2, 15.2, -1, 10.4)  # x, then y [m]
GRID, SMALLEST, PIXELS_PER_METRE = 16, 8, 30


def rsm(scene, camera):
    """Content of the sun's RSM of the finest cascade: the light that each texel reflects."""
    from .claims import from_the_sun  # needs the native module
    above = from_the_sun(camera, scene.lights[0].direction, CASCADE)
    return clpv.Renderer(scene, width=SIZE["height"], height=SIZE["height"]).render("direct", above)


def section(scene):
    """Pixels of the nave cut open along its length, by the light of the volumes about EYE."""
    left, right, bottom, top = SHOWN
    size = round((right - left) * PIXELS_PER_METRE), round((top - bottom) * PIXELS_PER_METRE)
    eye = np.array([(left + right) / 2, (bottom + top) / 2, SECTION + FROM_AFAR])
    view = clpv.Camera(eye, eye - (0, 0, 1), near=FROM_AFAR,
                       fov=2 * math.degrees(math.atan((top - bottom) / 2 / FROM_AFAR)))
    with clpv.Renderer(scene, near="off", bounces=1, cascades=1) as renderer:
        direct = renderer.render("direct", view, size=size)
        depth, normal, albedo = (renderer.show(name).array for name in ("depth", "normal", "albedo"))
    y, x = np.mgrid[top:bottom:size[1] * 1j, left:right:size[0] * 1j]
    away = (np.stack([x, y, np.full_like(x, SECTION)], axis=-1) - eye) / FROM_AFAR
    array, seen = direct.array.copy(), depth[..., 0] > 0
    with clpv.Renderer(scene) as renderer:
        renderer.update(EYE)
        light = renderer.irradiance((eye + away * depth[..., :1])[seen], normal[seen, :3])
    array[seen, :3] += albedo[seen, :3] / math.pi * light
    return clpv.Image(array).display(scene.exposure)


def draw_grids(axis):
    """Cells of three cascades about EYE, each without the part that a finer one has."""
    inner = None
    for i in range(3):
        size = SMALLEST * 2**i
        low = np.floor((np.array(EYE[:2]) - size / 2) / (size / GRID)) * (size / GRID)
        for k, j in np.ndindex(GRID, GRID):
            corner = low + np.array([k, j]) * size / GRID
            if inner is None or not all((corner > inner - 1e-6) & (corner < inner + size / 2 - 1e-6)):
                axis.add_patch(pyplot.Rectangle(corner, size / GRID, size / GRID, fill=False, lw=0.5,
                                                ec=style.colour(i), alpha=0.75))
        axis.add_patch(pyplot.Rectangle(low, size, size, fill=False, lw=1.8, ec=style.colour(i)))
        axis.text(max(low[0], SHOWN[0]) + 0.15, min(low[1] + size, SHOWN[3]) - 0.15,
                  f"cascade {i + 1}", va="top", color="white", fontsize=9,
                  backgroundcolor=style.colour(i))
        inner = low


def arrow(axis, start, end, ink, width=1.2):
    axis.annotate("", end, start, arrowprops={"arrowstyle": "->", "color": ink, "lw": width})


def draw_steps(axes):
    """What happens in a cell: injection, the sweep, and a pixel's gathering."""
    angles = np.linspace(0, 2 * math.pi, 24, endpoint=False)
    titles = ("1. The sun lights a point: a lobe of\nreflected light enters the cell above",
              "2. The sweep: 96 directions carry\nlight to the next cells; walls block it",
              "3. A pixel gathers from the cells\nthat it sees, over its hemisphere")
    for axis, title in zip(axes, titles):
        axis.set(xlim=(-0.6, 2.2), ylim=(-0.35, 1.35), aspect="equal")
        axis.set_title(title, fontsize=9)
        axis.axis("off")
        for k in range(2):
            axis.add_patch(pyplot.Rectangle((k, 0), 1, 1, fill=False, lw=1, ec=style.colour(0)))
        axis.plot([-0.5, 2.1], [0, 0], color=style.INK, lw=3)
    for x in (0.2, 0.5, 0.8):
        arrow(axes[0], (x - 0.25, 1.3), (x, 0), style.colour(1))
    lobe = np.linspace(0, math.pi, 50)
    axes[0].fill(0.5 + 0.8 * np.sin(lobe) * np.cos(lobe), 0.8 * np.sin(lobe)**2,
                 color=style.colour(1), alpha=0.5)
    for angle in angles:
        way = np.array([math.cos(angle), math.sin(angle)])
        length = 0.15 + 0.55 * max(0, way[1])
        arrow(axes[1], (0.5, 0.5), (0.5, 0.5) + length * way, style.colour(1), 0.8)
        if way[0] < -0.01:
            arrow(axes[2], (2.05, 0.5) + 0.45 * way, (2.05, 0.5), style.colour(1), 0.8)
    for axis in axes[1:]:
        axis.plot([2.08, 2.08], [0, 1.3], color=style.INK, lw=3)
    axes[2].plot([0.5, 1.5], [0.5, 0.5], "o", color=style.colour(0), ms=5)
    axes[2].plot([2.06], [0.5], "s", color=style.colour(3), ms=6)


def volume(scene):
    """Bytes of the picture of the cascades and of what happens in a cell."""
    left, right, bottom, top = SHOWN
    width = (right - left) * PIXELS_PER_METRE / 100
    height = (top - bottom) * PIXELS_PER_METRE / 100
    figure = pyplot.figure(figsize=(width, height + 2), facecolor="white")
    axis = figure.add_axes((0, 2 / (height + 2), 1, height / (height + 2)))
    axis.imshow(section(scene), extent=SHOWN)
    draw_grids(axis)
    axis.plot(*EYE[:2], "o", color="white", ms=7, mec=style.INK)
    axis.annotate("camera", EYE[:2], textcoords="offset points", xytext=(8, -4), color="white")
    axis.set(xlim=SHOWN[:2], ylim=SHOWN[2:])
    axis.axis("off")
    draw_steps([figure.add_axes((i / 3, 0, 1 / 3, 1.55 / (height + 2))) for i in range(3)])
    return style.rendered(figure, "jpg", dpi=100, pil_kwargs={"quality": 85, "optimize": True})


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, help="output folder (default: docs/images)")
    out = parser.parse_args().out
    folder = out and output.Folder(out, "scripts/frame")
    subprocess.run([str(ROOT / "scripts/build"), "clpv", "clpv_python"], check=True)
    scene = clpv.Scene(ROOT / "scenes/atrium.json")
    camera = next(each for each in scene.cameras if each.name == CAMERA)

    def save(name, image, exposure):
        file = f"frame-{name}.jpg"
        file, made = folder.file(file) if folder else ROOT / "docs/images" / file, io.BytesIO()
        pixels = image.display(scene.exposure + exposure)[..., :3]
        pyplot.imsave(made, pixels, format="jpg", pil_kwargs={"quality": 80, "optimize": True})
        output.write(file, made.getvalue())
        print(file)

    file = folder.file("frame-volume.jpg") if folder else ROOT / "docs/images/frame-volume.jpg"
    output.write(file, volume(scene))
    save("rsm", rsm(scene, camera), 0)
    for name, (view, exposure, options) in PICTURES.items():
        save(name, clpv.Renderer(scene, **SIZE, **options).render(view, camera), exposure)
