# SPDX-License-Identifier: MIT
"""Measures how much light leaks into the rooms of leak_scenes.py.

    scripts/leaks --shapes sheet,wall1 --lights sun,sky,lamp --bounces 1,all [--OPTION=VALUE...]

Prints a Markdown table. Leak: mean indirect irradiance of the room's walls, floor and ceiling, in %
of the irradiance of the open ground; the worst of positions of the room between the cells. Open
rooms have the mean over the positions, and path tracing's beside it. Bounces `direct`: mean
irradiance of direct light on 240x135 pixels of sealed rooms. FILE.json has a row for each number. Other options
are those of `clpv render`. Needs a build.
"""
import itertools
import math
import pathlib
import re
import tempfile

import numpy

from . import json_lines, leak_scenes as scenes, native, output, parser_of, rows as known, tables

clpv = native()
POINTS = 5  # along each edge of a face
SIZE = 240, 135  # size of the images of direct light
NOISE = 0.05  # noise of path tracing
# Irradiance of open ground: by the sun, by the even sky, and 3.5 m below the lamp.
GROUND = {"sun": 1e4 / math.hypot(*scenes.SUN), "sky": math.pi * 1e3, "lamp": 1e4 / 3.5**2}


def offsets(count):
    """Positions between the cells of the finest cascade [m]; the first is 0."""
    return [[scenes.CELL * 0.37 * (i >> axis & 1) for axis in range(3)] for i in range(count)]


def share(light, irradiance):
    return 100 * float(irradiance[..., 1].mean()) / GROUND[light]


class Room:
    """A shape under a light at one of the positions."""

    def __init__(self, folder, shape, light, offset):
        self.shape, self.light = shape, light
        self.scene = clpv.Scene(f"{folder}/{shape}-{light}.json")
        points, self.normals = map(numpy.array, zip(*scenes.inner_points(shape, POINTS)))
        self.points = points + numpy.array(offset)

    def leak(self, bounces, options):
        """Indirect light inside, or with bounces "direct" direct light [%]."""
        if bounces != "direct":
            options = {**options, "bounces": bounces}
        with clpv.Renderer(self.scene, **options) as renderer:
            if bounces == "direct":
                image = renderer.render("direct", size=SIZE).array
                return share(self.light, math.pi / scenes.GREY[1] * image)
            renderer.update(self.scene.cameras[0].eye)
            return share(self.light, renderer.irradiance(self.points, self.normals))

    def traced(self, bounces):
        """Indirect light inside by path tracing [%]."""
        light = self.scene.pathtrace_points(self.points, self.normals, bounces=bounces,
                                            noise=NOISE)
        return share(self.light, light["indirect"])


def measure(shapes, columns, count, options):
    """Rows: shape, light, bounces ("direct": direct light), leak and, in open rooms, truth.
    `columns`: pairs of light and bounces."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        found = {}
        for offset in offsets(count):
            scenes.write(folder, offset, shapes)
            for shape, (light, n) in itertools.product(shapes, columns):
                if n != "direct" or shape not in known.OPEN_ROOMS:
                    room = Room(folder, shape, light, offset)
                    found.setdefault((shape, light, n), []).append(room.leak(n, options))
        for (shape, light, n), leaks in found.items():
            row = {"shape": shape, "light": light, "bounces": n, "leak": max(leaks)}
            if shape in known.OPEN_ROOMS:
                row["leak"] = sum(leaks) / len(leaks)
                row["truth"] = Room(folder, shape, light, offset).traced(n)
            rows.append(row)
    return rows


def lines(rows):
    """Cells of a table: a line for each shape."""
    columns = dict.fromkeys((f"{row['light']}, {row['bounces']}" for row in rows), "-")
    cells = {row["shape"]: dict(columns) for row in rows}
    for row in rows:
        truth = f" ({row['truth']:.2g})" if "truth" in row else ""
        cells[row["shape"]][f"{row['light']}, {row['bounces']}"] = f"{row['leak']:.2g}{truth}"
    return [["room", *columns], *([shape, *line.values()] for shape, line in cells.items())]


def main():
    parser = parser_of(__doc__, model=False)
    parser.add_argument("--shapes", default=",".join(name for name, _ in scenes.shapes()))
    parser.add_argument("--lights", default="sun")
    parser.add_argument("--bounces", default="1,all")
    parser.add_argument("--offsets", type=int, default=8)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE.json")
    arguments, others = parser.parse_known_args()
    names = [name for name, _ in scenes.shapes()]
    shapes = arguments.shapes.split(",")
    if unknown := set(shapes) - set(names):
        parser.error(f"--shapes {','.join(unknown)}: allowed: {', '.join(names)}")
    if wrong := [other for other in others if not re.fullmatch("--.+=.*", other)]:
        parser.error(f"{wrong[0]}: allowed: --OPTION=VALUE of clpv render")
    bounces = [int(n) if n.isdigit() else n for n in arguments.bounces.split(",")]
    columns = list(itertools.product(arguments.lights.split(","), bounces))
    if arguments.output:
        output.target_of(arguments.output)  # found before the work
    rows = measure(shapes, columns, arguments.offsets, known.keywords_of(" ".join(others)))
    if arguments.output:
        output.write(arguments.output, json_lines({"leaks": rows}))
    print(tables.drawn(lines(rows)), end="")
