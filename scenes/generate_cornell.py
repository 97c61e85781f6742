#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes cornell, cornell_lamp and empty_room, .glb and .json, beside itself: the Cornell box, by
its published corners.

Python's standard library only; the same bytes every time. `generate_cornell.py [FOLDER]` writes
into FOLDER instead, which is new, empty, or of an earlier run.

Millimetres, as published (Cornell University Program of Computer Graphics, "The Cornell Box:
Data"): the open front is at z = 0, the red wall at x = 552.8, the green one at x = 0. The
reflectances are the published spectra's usual linear RGB. In `cornell` the ceiling's lamp is left
out: the light comes through the open front, from two sides, because a single direction could reach
only one of the two coloured walls. `cornell_lamp` has the lamp, and no other light. Its walls get a
thickness (not published: they have none there), since light falls on them from outside too.
`empty_room` is `cornell` without blocks and with walls along the axes: light on the simplest
surfaces, which tests compare with path tracing as cells get smaller. """
import json
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "python"))
from clpv import output  # noqa: E402
from modelling.gltf import Document
from modelling.mesh import Mesh

WHITE, RED, GREEN = (0.725, 0.71, 0.68), (0.63, 0.065, 0.05), (0.14, 0.45, 0.091)

# Each face counter-clockwise seen from inside the room.
ROOM = [
    ("white", [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]),
    ("white", [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]),
    ("white", [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]),
    ("green", [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]),
    ("red", [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]),
]

CEILING = ROOM[1][1]
RIGHT = 552.8  # wall of the empty room
LAMP = [(343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227)]
LAMP_REFLECTANCE = (0.78, 0.78, 0.78)
# The published spectrum, 0 at 400 nm, 8 at 500, 15.6 at 600 and 18.4 at 700, by the CIE's 1931
# observer as linear sRGB, its white that of an even spectrum, as for the reflectances.
LAMP_RADIANCE = (17.2, 11.5, 3.0)

WALL = 80  # thickness: over a cell of the finest cascade

# The blocks' footprints, counter-clockwise seen from above (from +y, x to the right and z down),
# and heights.
BLOCKS = {
    "short block": ([(130, 65), (82, 225), (240, 272), (290, 114)], 165),
    "tall block": ([(423, 247), (265, 296), (314, 456), (472, 406)], 330),
}


def straight(corner):
    """Moves a corner of the room onto walls along the axes."""
    return (RIGHT if corner[0] else 0, *corner[1:])


def room(lamp, empty):
    mesh = Mesh()
    for material, corners in ROOM:
        if empty:
            corners = [straight(corner) for corner in corners]
        if lamp and corners is CEILING:
            for k in range(4):
                mesh.quad(material, [CEILING[k], CEILING[(k + 1) % 4], LAMP[(k + 1) % 4], LAMP[k]])
        else:
            mesh.quad(material, corners)
    if lamp:
        mesh.quad("lamp", LAMP)
    return mesh


def outside(empty):
    """The walls' outer faces, and the rim of the opening; the red wall leans a little, and the rim
    follows it."""
    mesh = Mesh()
    x0, x1, y0, y1, z1 = -WALL, 556 + WALL, -WALL, 548.8 + WALL, 559.2 + WALL
    mesh.box("white", (x0, y0, 0), (x1, y1, z1), "-z")
    outer = [(x0, y0, 0), (x1, y0, 0), (x1, y1, 0), (x0, y1, 0)]
    inner = [(0, 0, 0), (552.8, 0, 0), (556, 548.8, 0), (0, 548.8, 0)]
    if empty:
        inner = [straight(corner) for corner in inner]
    for k in range(4):
        mesh.quad("white", [outer[k], inner[k], inner[(k + 1) % 4], outer[(k + 1) % 4]])
    return mesh


def block(footprint, height):
    """Four sides and a top; it stands on the floor."""
    mesh = Mesh()
    mesh.quad("white", [(x, height, z) for x, z in footprint])
    for (x0, z0), (x1, z1) in zip(footprint, footprint[1:] + footprint[:1]):
        mesh.quad("white", [(x0, 0, z0), (x1, 0, z1), (x1, height, z1), (x0, height, z0)])
    return mesh


def scene_file(stem):
    front = {"eye": [278, 273, -180], "target": [278, 273, 280], "vertical_fov_degrees": 75}
    cameras = [
        {"name": "front", **front},
        {
            "name": "published", "eye": [278, 273, -800], "target": [278, 273, 0],
            "vertical_fov_degrees": 39.3
        },
    ]
    cascades = {"count": 2, "size_metres": 2.0}
    if stem == "cornell_lamp":
        return {
            "model": "cornell_lamp.glb", "metres_per_unit": 0.001, "exposure": 2.0,
            "cameras": cameras, "lights": [], "cascades": cascades
        }
    return {
        "model": stem + ".glb",
        "metres_per_unit": 0.001,
        "exposure": 0.0,
        "cameras": [
            *cameras,
            {"name": "red", **front, "light": "onto red"},
            {"name": "green", **front, "light": "onto green"},
        ],
        "lights": [
            {
                "name": "onto red", "kind": "directional", "direction": [0.5, -0.6, 0.6],
                "illuminance_lux": 4.0
            },
            {
                "name": "onto green", "kind": "directional", "direction": [-0.5, -0.6, 0.6],
                "illuminance_lux": 4.0
            },
        ],
        "cascades": cascades,
    }


def write(file, stem):
    lamp, empty = stem == "cornell_lamp", stem == "empty_room"
    document = Document("clpv scenes/generate_cornell.py")
    for name, colour in (("white", WHITE), ("red", RED), ("green", GREEN)):
        document.material(name, colour)
    if lamp:
        document.material("lamp", LAMP_REFLECTANCE, radiance=LAMP_RADIANCE)
    document.node("room", document.mesh("room", room(lamp, empty)))
    document.node("outside", document.mesh("outside", outside(empty)))
    for name, (footprint, height) in [] if empty else BLOCKS.items():
        document.node(name, document.mesh(name, block(footprint, height)))
    document.write(file(f"{stem}.glb"))
    output.write(file(f"{stem}.json"), json.dumps(scene_file(stem), indent=2) + "\n")


def main(arguments):
    file = HERE.joinpath
    if arguments:
        file = output.Folder(arguments[0], "scenes/generate_cornell.py").file
    for stem in ("cornell", "cornell_lamp", "empty_room"):
        write(file, stem)


if __name__ == "__main__":
    sys.exit(output.exit_code(main, sys.argv[1:]))
