# SPDX-License-Identifier: MIT
"""Rooms that are turned against the grid, beside path tracing: results/docs/rooms.json and a
picture, for scripts/measure. ROOMS of rows.json has them: `air` and `solid` of
leak_scenes.quads() (without `solid` one sheet, seen from inside)."""
import itertools
import math

import numpy as np

from . import native
from .leak_scenes import quads, turned
from .rows import ROOMS
from .sheets import sheet

clpv = native()

SIZE, PATHS = (120, 68), 256  # of a row of the table; paths a pixel
SHOWN = 240, 135  # pixels of a tile of the picture
CASCADES = {"cascades": 3, "cascade_size": 12.5}


def scene_of(room, degrees):
    corners = np.array(list(quads(room["air"], room.get("solid"))))
    faces = 4 * np.arange(len(corners))[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])
    scene = clpv.Scene.from_arrays(
        turned(corners.reshape(-1, 3), degrees), faces.reshape(-1, 3),
        material=clpv.Material(base_colour=room["albedo"], emission=room.get("emission", 0)))
    eye, target = turned(room["camera"], degrees)
    scene.cameras = [clpv.Camera(eye, target, fov=70)]
    scene.lights = [clpv.Light(**{key: turned([value], degrees)[0]
                                  if key in ("position", "direction") else value
                                  for key, value in light.items()})
                    for light in room.get("lights", [])]
    return scene


def irradiance(scene, bounces, size, options):
    with clpv.Renderer(scene, bounces=bounces, **CASCADES, **options) as renderer:
        return renderer.render("irradiance", size=size)


def row_of(room, degrees, bounces):
    scene = scene_of(room, degrees)
    image = irradiance(scene, bounces, SIZE, room.get("options", {}))
    if "emission" in room:  # radiance is the same everywhere
        light = math.pi * room["emission"] / (1 if bounces == 1 else 1 - room["albedo"])
        truth = clpv.Image(np.full_like(image.array, light))
    else:
        truth = clpv.pathtrace(scene, "irradiance", None, *SIZE, bounces=bounces, samples=PATHS)
    compared = clpv.compare(image.array[..., :3], truth.array[..., :3])
    return {"room": room["title"], "degrees": degrees, "bounces": bounces,
            "energy": compared.energy_ratio, "nrmse": compared.nrmse}


def measure():
    return [row_of(room, degrees, bounces) for room in ROOMS
            for degrees, bounces in itertools.product((0, room["degrees"]),
                                                      ["all"] if "options" in room else [1, "all"])]


def smooth(image):
    """Means of 3 x 3 pixels: less noise."""
    padded = np.pad(image.array, ((1, 1), (1, 1), (0, 0)), mode="edge")
    around = np.lib.stride_tricks.sliding_window_view(padded, (3, 3), axis=(0, 1))
    return clpv.Image(around.mean(axis=(3, 4)))


def draw(path):
    """All bounces above, path tracing below, at one exposure for both."""
    rooms = [(room, degrees) for room in ROOMS if "shown" in room
             for degrees in (0, room["degrees"])]
    title = "All bounces, by clpv above and by path tracing below (means of 3 x 3 pixels)"
    tiles, traced = [], []
    for room, degrees in rooms:
        scene = scene_of(room, degrees)
        truth = clpv.pathtrace(scene, "full", None, *SHOWN, samples=room["paths"])
        with clpv.Renderer(scene, **CASCADES) as renderer:
            image = renderer.render("full", size=SHOWN)
        energy = clpv.compare(image, truth).energy_ratio
        exposure, caption = truth.automatic_exposure(), f"{room['shown']}, {degrees} degrees"
        tiles.append((image.display(exposure), f"{caption}: energy {energy:.2f}"))
        traced.append((smooth(truth).display(exposure), "path traced"))
    sheet(path, title, len(rooms), [length / 100 for length in SHOWN], tiles + traced)
