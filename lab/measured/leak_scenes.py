# SPDX-License-Identifier: MIT
"""Writes scenes whose insides no light should reach, or little, for scripts/leaks and bake.py.

The same bytes every time.

A room of 4 x 3 x 4 m (albedo 0.8) stands 1.5 m above a ground of 30 x 30 m. Its walls are one
double-sided sheet, or two sheets some cells of 12.5 / 32 m apart. `turned` is turned by 20 degrees
about y, `slit` has a slit of half a cell in a wall, `door` has two rooms with a door between them,
one of them open to the sun, `corner` has two walls and a floor, `legs` a floor on four thin legs.
`hall` is 14 m wide, `windows` is a hall with three. All are lit by a sun, an even sky or a lamp.
"""
import itertools
import json
import math

import numpy as np

from . import native, output

CELL = 12.5 / 32
LOWER, UPPER = (-2, 0, -2), (2, 3, 2)
HALL, WALL = ((-3, 0, -7), (11, 4, 7)), 0.3  # inside, and thickness of its walls [m]
WINDOWS = [((-3.5, 1, -5), (-2.5, 3, -3)), ((-3.5, 1, 2), (-2.5, 3, 4)), ((3, 1, 6.5), (5, 3, 7.5))]
GREY = (0.8, 0.8, 0.8)
TURN = 20  # degrees
STEP = 2.0**-13  # of positions [m], so that the last bit of a machine's sine changes nothing
SUN = [0.4, -1, 0.3]
# Distance of the outer from the inner sheet in cells; 0: one sheet.
WALLS = {"sheet": 0, "wall0.03": 0.03, "wall0.1": 0.1, "wall0.5": 0.5, "wall1": 1, "wall2": 2,
         "wall3": 3}


def rectangle(axis, at, low, high, towards):
    """Corners of a rectangle across an axis, counter-clockwise seen from the side `towards`."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    corners = []
    for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
        p = [0, 0, 0]
        p[axis], p[u], p[v] = at, (low, high)[a][u], (low, high)[b][v]
        corners.append(tuple(p))
    return corners if towards > 0 else corners[::-1]


def box(low, high, inwards, without=()):
    """Faces of a box; `without`: (axis, side) of those left out."""
    sides = [(axis, side) for axis in range(3) for side in (0, 1) if (axis, side) not in without]
    return [rectangle(axis, (low, high)[side][axis], low, high, 1 if side != inwards else -1)
            for axis, side in sides]


def with_slit():
    """The face at x = -2 is two, half a cell apart."""
    return box(LOWER, UPPER, True, [(0, 0)]) + [
        rectangle(0, -2, (-2, low, -2), (-2, high, 2), 1)
        for low, high in ((0, 1.5 - CELL / 4), (1.5 + CELL / 4, 3))]


def turned(points, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [(c * x + s * z, y, c * z - s * x) for x, y, z in points]


def two_rooms():
    """The room beyond x = 2 lacks its roof; a door of 0.9 x 2 m joins both."""
    door = (2, 0, -0.45), (2, 2, 0.45)
    wall = [rectangle(0, 2, low, high, 1)
            for low, high in (((2, 0, -2), (2, 3, door[0][2])), ((2, 0, door[1][2]), (2, 3, 2)),
                              ((2, 2, door[0][2]), (2, 3, door[1][2])))]
    return (box(LOWER, UPPER, True, [(0, 1)]) + wall +
            box((2, 0, -2), (6, 3, 2), True, [(0, 0), (1, 1)]))


def legs():
    faces = [rectangle(1, 0, LOWER, UPPER, 1)]
    for x in (-1.9, 1.85):
        for z in (-1.9, 1.85):
            faces += box((x, -1.5, z), (x + 0.05, 0, z + 0.05), False, [(1, 0), (1, 1)])
    return faces


def quads(air, solid):
    """Corners of the walls' faces (n, 4, 3), counter-clockwise seen from the air: each lies between
    a cell of the boxes' planes that is solid and one that is not. `air` are boxes cut out of the
    box `solid`, or out of everything."""
    boxes = np.array([*air, *([solid] if solid else [])], float).reshape(-1, 2, 3)
    planes = [np.unique(boxes[..., axis]) for axis in range(3)]
    centres = np.stack(np.meshgrid(*((p[1:] + p[:-1]) / 2 for p in planes), indexing="ij"), axis=-1)
    within = [((centres > low) & (centres < high)).all(axis=-1) for low, high in boxes]
    full = within.pop() if solid else np.ones(centres.shape[:3], bool)
    full = np.pad(full & ~np.any(within, axis=0), 1, constant_values=not solid)
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        step = np.diff(full.astype(int), axis=axis)
        for cell in np.argwhere(step):
            corners = np.empty((4, 3))
            corners[:, axis] = planes[axis][cell[axis]]
            corners[:, u] = planes[u][cell[u] - 1 + np.array([0, 1, 1, 0])]
            corners[:, v] = planes[v][cell[v] - 1 + np.array([0, 0, 1, 1])]
            yield corners if step[tuple(cell)] < 0 else corners[::-1]


def walls(thickness, room=(LOWER, UPPER), windows=()):
    """Faces of a room's walls of that thickness [m]; 0: one sheet."""
    low, high = room
    outer = [a - thickness for a in low], [a + thickness for a in high]
    return [face.tolist() for face in quads([room, *windows], outer if thickness else None)]


def shapes():
    yield from ((name, walls(cells * CELL)) for name, cells in WALLS.items())
    yield "turned", [turned(face, TURN) for face in walls(0)]
    yield "slit", with_slit()
    yield "door", two_rooms()
    yield "corner", box(LOWER, UPPER, True, [(0, 1), (1, 1), (2, 1)])
    yield "legs", legs()
    yield "hall", walls(WALL, HALL)
    yield "windows", walls(WALL, HALL, WINDOWS)


def inner_points(shape, count):
    """(point, normal) on the faces inside, `count`^2 a face. Legs have a floor only."""
    degrees = TURN if shape == "turned" else 0
    low, high = HALL if shape in ("hall", "windows") else (LOWER, UPPER)
    for axis, side, k in itertools.product(range(3), (0, 1), range(count**2)):
        if shape == "legs" and (axis, side) != (1, 0) or shape == "corner" and side == 1:
            continue
        p, n = [0.0] * 3, [0] * 3
        p[axis], n[axis] = (low, high)[side][axis], 1 - 2 * side
        for along, i in (((axis + 1) % 3, k % count), ((axis + 2) % 3, k // count)):
            p[along] = low[along] + (high[along] - low[along]) * (i + 0.5) / count
        yield turned([p, n], degrees)


LIGHTS = {
    "sun": {"lights": [{"name": "sun", "kind": "directional", "direction": SUN,
                        "illuminance_lux": 1e4}]},
    "sky": {"lights": [], "sky": {"radiance": [1000, 1000, 1000]}},
    "lamp": {"lights": [{"name": "lamp", "kind": "point", "position": [-4, 2, -4],
                         "intensity_candela": 1e4}]},
}


def write(folder, offset=(0, 0, 0), names=None, double_sided=True):
    """Writes the shapes named, all by default, moved by `offset` [m]. `double_sided`: surfaces have
    no back."""
    clpv, file = native(), output.Folder(folder, "scripts/leaks").file
    look = clpv.Material(base_colour=GREY, double_sided=double_sided)
    ground = [(-15, -1.5, 15), (15, -1.5, 15), (15, -1.5, -15), (-15, -1.5, -15)]
    for name, faces in shapes():
        if names and name not in names:
            continue
        corners = [[round(v / STEP) * STEP + o for v, o in zip(corner, offset)]
                   for face in faces + [ground] for corner in face]
        triangles = [[i, i + j, i + j + 1] for i in range(0, len(corners), 4) for j in (1, 2)]
        clpv.Scene.from_arrays(corners, triangles, material=look).save(file(name + ".glb"))
        for light, values in LIGHTS.items():
            inside = {"name": "in", "eye": [-1, 1.6, -1.2], "target": [1, 1.2, 1.3],
                      "vertical_fov_degrees": 90}
            scene = {"model": name + ".glb", **values, "cameras": [inside],
                     "cascades": {"count": 3, "size_metres": 12.5}}
            output.write(file(f"{name}-{light}.json"), json.dumps(scene, indent=1) + "\n")
