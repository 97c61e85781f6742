# SPDX-License-Identifier: MIT
"""frame-volume.jpg of docs/frame.md: the atrium cut open, cascades, and three steps in a cell."""
import math

import numpy as np

from . import native, output
from .claims import from_afar

clpv = native()
from clpv.draw import style  # noqa: E402

SHOWN, PIXELS = (-15.2, 15.2, -1, 10.4), (912, 342)  # x, then y [m]; size of the section
MIDDLE, AFAR = (0, 4.7, 1), 90  # of the section, which cuts at its z; distance of its camera [m]
EYE = -3.2, 2, 0  # about which the cascades lie [m]
GRID, SMALLEST = 16, 8  # cascades small enough to be seen: cells and metres along an edge
HEIGHT = 542  # of the picture with the steps below [pixels]
TITLES = ("1. The sun lights a point: a lobe of\nreflected light enters the cell above",
          "2. The sweep: 96 directions carry\nlight to the next cells; walls block it",
          "3. A pixel gathers from the cells\nthat it sees, over its hemisphere")


def section(scene):
    """Pixels of the nave cut open along its length, by the light of the volumes about EYE."""
    left, right, bottom, top = SHOWN
    view = from_afar(clpv.Camera(MIDDLE, EYE), (0, 0, -1), top - bottom, AFAR).replace(near=AFAR)
    with clpv.Renderer(scene, near="off") as renderer:
        array = renderer.render("direct", view, size=PIXELS).array.copy()
        depth, normal, albedo = (renderer.show(name).array[..., :3]
                                 for name in ("depth", "normal", "albedo"))
        y, x = np.mgrid[top:bottom:PIXELS[1] * 1j, left:right:PIXELS[0] * 1j]
        rays = (np.stack([x, y, np.full_like(x, MIDDLE[2])], axis=-1) - view.eye) / AFAR
        light = renderer.light(normal, positions=view.eye + rays * depth, eye=EYE)
    array[..., :3] += albedo / math.pi * light
    return clpv.Image(array, tuple("RGBA")).display(scene.exposure)


def draw_grids(axis):
    """Cells of three cascades about EYE. Lines of a finer one cover those of a coarser one."""
    for i in (2, 1, 0):
        size, ink = SMALLEST * 2**i, style.colour(i)
        low = np.floor(np.array(EYE[:2]) * GRID / size) * size / GRID - size / 2
        x, y = (start + size / GRID * np.arange(GRID + 1) for start in low)
        axis.vlines(x, y[0], y[-1], ink, lw=0.5)
        axis.hlines(y, x[0], x[-1], ink, lw=0.5)
        axis.add_patch(style.pyplot.Rectangle(low, size, size, fill=False, lw=1.8, ec=ink))
        axis.text(max(x[0], SHOWN[0]) + 0.15, min(y[-1], SHOWN[3]) - 0.15, f"cascade {i + 1}",
                  va="top", color="white", backgroundcolor=ink)
    axis.plot(*EYE[:2], "o", color="white", ms=7, mec=style.INK)
    axis.annotate("camera", EYE[:2], (8, -4), textcoords="offset points", color="white")


def arrows(axis, starts, ways):
    axis.quiver(*np.transpose(starts), *np.transpose(ways), angles="xy", scale_units="xy", scale=1,
                color=style.colour(1), width=0.006)


def draw_steps(axes):
    """What happens in a cell: injection, the sweep, and a pixel's gathering."""
    for axis, title in zip(axes, TITLES):
        axis.set(xlim=(-0.6, 2.2), ylim=(-0.35, 1.35), aspect="equal")
        axis.set_title(title, fontsize=9)
        for x in (0, 1):
            axis.add_patch(style.pyplot.Rectangle((x, 0), 1, 1, fill=False, ec=style.colour(0)))
        axis.plot([-0.5, 2.08, 2.08], [0, 0, 0 if axis is axes[0] else 1.3], color=style.INK, lw=3)
    ways = np.array([(math.cos(a), math.sin(a)) for a in np.arange(24) * math.pi / 12])
    arrows(axes[0], [(x, 1.3) for x in (-0.05, 0.25, 0.55)], [(0.25, -1.3)] * 3)
    axes[0].add_patch(style.pyplot.Circle((0.5, 0.4), 0.4, color=style.colour(1), alpha=0.5))
    arrows(axes[1], [(0.5, 0.5)] * 24, (0.15 + 0.55 * ways[:, 1:].clip(0)) * ways)
    arrows(axes[2], (2.05, 0.5) + 0.45 * ways[7:18], -0.45 * ways[7:18])  # to the left
    axes[2].plot([0.5, 1.5], [0.5, 0.5], "o", color=style.colour(0), ms=5)
    axes[2].plot([2.06], [0.5], "s", color=style.colour(3), ms=6)


def draw(scene, path):
    figure = style.pyplot.figure(figsize=(PIXELS[0] / 100, HEIGHT / 100), facecolor="white")
    axis = figure.add_axes((0, 1 - PIXELS[1] / HEIGHT, 1, PIXELS[1] / HEIGHT))
    axis.imshow(section(scene), extent=SHOWN)
    draw_grids(axis)
    axis.set(xlim=SHOWN[:2], ylim=SHOWN[2:])
    draw_steps([figure.add_axes((i / 3, 0, 1 / 3, 155 / HEIGHT)) for i in range(3)])
    for axis in figure.axes:
        axis.axis("off")
    output.write(path, style.rendered(figure, "jpg", dpi=100, pil_kwargs={"quality": 80}))
