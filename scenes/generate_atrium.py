#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes atrium.glb and atrium.json beside itself, a two-storey colonnade round an open court, hung
with curtains; atrium_overcast.json, the same without a sun; and atrium_living.gltf and .json, the
same for ten seconds of a day.

Python's standard library only; the same bytes every time. `generate_atrium.py [FOLDER]` writes into
FOLDER instead, which is new, empty, or of an earlier run.

Metres; x along the court, y up, z across. The court's floor is at y = 0 and its centre at the
origin. The light falls from +z to -z: through the open roof onto the floor's -z half and the
curtains of the -z arcade. """
import json
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "python"))
from clpv import output  # noqa: E402
from modelling import shapes, textures
from modelling.gltf import Document
from modelling.mesh import Mesh

BAYS_LONG, BAYS_SHORT = 8, 3
BAY_LONG, BAY_SHORT = 2.75, 2.05          # distance of columns along and across the court
HALF_X = BAYS_LONG * BAY_LONG / 2         # the arcade's centre lines
HALF_Z = BAYS_SHORT * BAY_SHORT / 2
AISLE = 3.2                               # from the arcade's centre line to the outer wall
WALL = 0.8  # outer walls and slabs' edges: more than a cell of the finest cascade
ARCADE = 0.60                             # thickness of the arcade's walls
GROUND, FIRST = 0.0, 5.1                  # floor levels
SPRINGING = (3.1, 2.3)                    # arches, above their storey's floor
WALL_TOP = (4.5, 3.7)                     # where the slab above begins, above the storey's floor
RADIUS = (0.30, 0.24)                     # columns, at their foot
PILLAR = 0.71                              # width of the wall between two arches' openings
ROOF = FIRST + WALL_TOP[1]
ROOF_TOP = ROOF + 0.6
OUT_X, OUT_Z = HALF_X + AISLE, HALF_Z + AISLE  # inner faces of the outer walls


def add_materials(document):
    floor = document.texture(textures.floor_tiles())
    stone = document.texture(textures.stone_courses())
    plaster = document.texture(textures.plaster())
    cloth = document.texture(textures.damask())
    document.material("floor", (1.0, 1.0, 1.0), floor)
    document.material("stone", (1.0, 0.97, 0.92), stone)
    document.material("carved", (0.95, 0.92, 0.86), plaster)
    document.material("plaster", (1.0, 0.93, 0.82), plaster)
    document.material("roof", (0.62, 0.30, 0.20), plaster)
    document.material("wood", (0.30, 0.17, 0.09), plaster)
    document.material("clay", (0.80, 0.40, 0.24), plaster)
    document.material("iron", (0.05, 0.05, 0.05))
    document.material("water", (0.05, 0.20, 0.24))
    document.material("crimson", (0.78, 0.055, 0.05), cloth, double_sided=True)
    document.material("emerald", (0.06, 0.50, 0.16), cloth, double_sided=True)
    document.material("azure", (0.06, 0.20, 0.72), cloth, double_sided=True)
    document.material("saffron", (0.95, 0.52, 0.06), cloth, double_sided=True)


def shell():
    """Floor, outer walls, slabs and roof: everything that keeps light in."""
    mesh = Mesh()
    x0, z0, x1, z1 = OUT_X, OUT_Z, OUT_X + WALL, OUT_Z + WALL
    mesh.box("floor", (-x1, -0.6, -z1), (x1, GROUND, z1))
    for side in (-1, 1):
        lo, hi = sorted((side * z0, side * z1))
        mesh.box("plaster", (-x1, GROUND, lo), (x1, ROOF, hi), "-y +y")
        lo, hi = sorted((side * x0, side * x1))
        mesh.box("plaster", (lo, GROUND, -z0), (hi, ROOF, z0), "-y +y -z +z")
    for low, high, top in ((GROUND + WALL_TOP[0], FIRST, "floor"), (ROOF, ROOF_TOP, "roof")):
        ring_slab(mesh, low, high, top, x0 if high == FIRST else x1, z0 if high == FIRST else z1)
    return mesh


def ring_slab(mesh, low, high, top, x1, z1):
    """A slab over the aisles, open over the court; reaches x1, z1 outwards and the arcade's inner
    face inwards."""
    xi, zi = HALF_X - ARCADE / 2, HALF_Z - ARCADE / 2
    for side in (-1, 1):
        lo, hi = sorted((side * zi, side * z1))
        slab_piece(mesh, (-x1, low, lo), (x1, high, hi), top, "")
        lo, hi = sorted((side * xi, side * x1))
        slab_piece(mesh, (lo, low, -zi), (hi, high, zi), top, "-z +z")


def slab_piece(mesh, low, high, top, omit):
    mesh.box("plaster", low, high, "+y " + omit)
    (x0, _, z0), (x1, y, z1) = low, high
    mesh.quad(top, [(x0, y, z1), (x1, y, z1), (x1, y, z0), (x0, y, z0)])


def sides():
    """The court's four sides: quarter turns, unit vector out of the court, distance, half length,
    bays, bay width."""
    return [
        ("south", 0, (0, 0, 1), HALF_Z, BAYS_LONG, BAY_LONG),
        ("east", 1, (1, 0, 0), HALF_X, BAYS_SHORT, BAY_SHORT),
        ("north", 2, (0, 0, -1), HALF_Z, BAYS_LONG, BAY_LONG),
        ("west", 3, (-1, 0, 0), HALF_X, BAYS_SHORT, BAY_SHORT),
    ]


def along_side(outward, distance, offset, y=0.0):
    """A point on an arcade's centre line; `offset` grows counter-clockwise seen from above."""
    return (outward[0] * distance + outward[2] * offset, y,
            outward[2] * distance - outward[0] * offset)


def place_arcades(document):
    """Columns, corner piers and arches of both storeys."""
    for storey, floor in enumerate((GROUND, FIRST)):
        name = ("ground", "first")[storey]
        column = document.mesh(f"{name} column", shapes.column(
            SPRINGING[storey], RADIUS[storey], 24 - 4 * storey, "carved", "carved"))
        bays = {}
        for width in (BAY_LONG, BAY_SHORT):
            bays[width] = document.mesh(
                f"{name} arch {width}",
                shapes.arch_bay(width, SPRINGING[storey], (width - PILLAR) / 2, WALL_TOP[storey],
                                ARCADE, 24, "stone", "carved"))
        pier = Mesh()
        half = 0.5 * ARCADE + 0.06
        pier.box("stone", (-half, 0, -half), (half, WALL_TOP[storey], half), "-y +y")
        pier.box("carved", (-half - 0.06, 0, -half - 0.06), (half + 0.06, 0.25, half + 0.06), "-y")
        pier.box("carved", (-half - 0.05, SPRINGING[storey] - 0.16, -half - 0.05),
                 (half + 0.05, SPRINGING[storey], half + 0.05))
        pier = document.mesh(f"{name} pier", pier)
        for side, turns, outward, distance, count, width in sides():
            for bay in range(count):
                offset = (bay - (count - 1) / 2) * width
                document.node(f"{name} {side} arch {bay}", bays[width],
                              along_side(outward, distance, offset, floor), turns)
                if bay > 0:
                    place = along_side(outward, distance, offset - width / 2, floor)
                    document.node(f"{name} {side} column {bay}", column, place, turns)
            document.node(f"{name} {side} pier", pier,
                          along_side(outward, distance, count * width / 2, floor), turns)


def place_balustrades(document):
    """Turned balusters between the columns of the first floor, and its rails."""
    profile = [(0.055, 0.0), (0.055, 0.04)] + shapes.arc((0.03, 0.06), 0.02, -90, 90, 3)
    profile += [(0.028, 0.10), (0.045, 0.18), (0.062, 0.27), (0.058, 0.34), (0.036, 0.44),
                (0.026, 0.54), (0.030, 0.60)]
    profile += shapes.arc((0.03, 0.62), 0.018, -90, 90, 3) + [(0.05, 0.66), (0.05, 0.70)]
    baluster = document.mesh("baluster", shapes.turned(profile, 10, "carved"))
    rails = {}
    for width in (BAY_LONG, BAY_SHORT):
        mesh = Mesh()
        half = width / 2 - 0.8 * RADIUS[1]
        mesh.box("carved", (-half, 0, -0.10), (half, 0.16, 0.10), "-y -x +x")
        mesh.box("carved", (-half, 0.86, -0.11), (half, 0.98, 0.11), "-x +x")
        rails[width] = document.mesh(f"rails {width}", mesh)
    for side, turns, outward, distance, count, width in sides():
        for bay in range(count):
            offset = (bay - (count - 1) / 2) * width
            document.node(f"{side} rails {bay}", rails[width],
                          along_side(outward, distance, offset, FIRST), turns)
            number = 9 if width == BAY_LONG else 6
            for i in range(number):
                place = along_side(outward, distance, offset + (i - (number - 1) / 2) * 0.23,
                                   FIRST + 0.16)
                document.node(f"{side} baluster {bay}.{i}", baluster, place)


def trim():
    """Mouldings round the court, beams and pilasters of the aisles, doors."""
    mesh = Mesh()
    slab = FIRST - GROUND - WALL_TOP[0]
    string_course = [(0, -0.10), (0.06, -0.06), (0.06, 0.0), (0.14, 0.06), (0.16, 0.12),
                     (0.16, slab - 0.04), (0.10, slab), (0, slab)]
    cornice = [(0, -0.22), (0.05, -0.18), (0.05, -0.06), (0.12, 0.0), (0.26, 0.08), (0.32, 0.18),
               (0.32, 0.34), (0.38, 0.48), (0.38, 0.6), (0, 0.6)]
    for profile, level in ((string_course, GROUND + WALL_TOP[0]), (cornice, ROOF)):
        for _, _, outward, distance, count, width in sides():
            inner = distance - ARCADE / 2
            half = count * width / 2 - ARCADE / 2
            ends = [along_side(outward, inner, s * half, level) for s in (-1, 1)]
            shapes.moulding(mesh, "carved", profile, ends[0], ends[1],
                            (-outward[0], 0, -outward[2]))
    for storey, floor in enumerate((GROUND, FIRST)):
        top = floor + WALL_TOP[storey]
        for bay in range(BAYS_LONG + 1):
            x = (bay - BAYS_LONG / 2) * BAY_LONG
            for side in (-1, 1):
                beam = sorted((side * (HALF_Z + ARCADE / 2), side * OUT_Z))
                mesh.box("wood", (x - 0.13, top - 0.26, beam[0]), (x + 0.13, top, beam[1]), "+y")
                wall = sorted((side * (OUT_Z - 0.12), side * OUT_Z))
                mesh.box("carved", (x - 0.22, floor, wall[0]), (x + 0.22, top - 0.26, wall[1]),
                         "-y")
    for side in (-1, 1):
        door(mesh, side)
    return mesh


def door(mesh, side):
    """Two wooden leaves in a stone frame, on an end wall."""
    def put(material, depth, low, high):
        x = sorted((side * OUT_X, side * (OUT_X - depth)))
        mesh.box(material, (x[0], low[0], low[1]), (x[1], high[0], high[1]))

    put("carved", 0.16, (0, -1.25), (3.25, -0.95))
    put("carved", 0.16, (0, 0.95), (3.25, 1.25))
    put("carved", 0.20, (2.95, -1.35), (3.25, 1.35))
    for leaf in (-1, 1):
        edge = sorted((leaf * 0.01, leaf * 0.95))
        put("wood", 0.06, (0, edge[0]), (2.95, edge[1]))
        panel = sorted((leaf * 0.16, leaf * 0.80))
        for low in (0.25, 1.15, 2.05):
            put("wood", 0.10, (low, panel[0]), (low + 0.7, panel[1]))


def place_curtains(document):
    """Curtains between the columns of the ground floor: drawn ones and tied pairs, one colour a
    bay."""
    top, z = SPRINGING[0] - 0.10, HALF_Z - 0.02
    colours = ("crimson", "saffron", "azure", "crimson", "emerald", "saffron", "crimson", "azure")
    patterns = ("drawn", "tied", "drawn", "drawn", "drawn", "tied", "drawn", "drawn")
    shapes_made, meshes = {}, {}
    rod = document.mesh("rod", rod_mesh())
    for row, (sign, turns) in enumerate(((-1, 0), (1, 2))):
        for bay in range(BAYS_LONG):
            x = sign * -(bay - (BAYS_LONG - 1) / 2) * BAY_LONG
            colour = colours[bay if row == 0 else (3 * bay + 4) % BAYS_LONG]
            pattern = patterns[bay] if row == 0 else ("tied" if bay % 2 else "drawn")
            seed = (bay + 2 * row) % 3 if pattern == "drawn" else 0
            key = (pattern, colour, seed)
            if key not in meshes:
                if (pattern, seed) not in shapes_made:
                    shapes_made[pattern, seed] = curtain(pattern, seed)
                meshes[key] = document.mesh(f"{colour} {pattern} {seed}",
                                            shapes_made[pattern, seed], {"cloth": colour})
            document.node(f"rod {row}.{bay}", rod, (x, top, sign * z), turns)
            name = f"curtain {row}.{bay}"
            if pattern == "drawn":
                document.node(name, meshes[key], (x, top, sign * z), turns)
            else:
                half = BAY_LONG / 2 - RADIUS[0]
                document.node(f"{name} left", meshes[key], (x - half, top, sign * z), 0)
                document.node(f"{name} right", meshes[key], (x + half, top, sign * z), 2)


def curtain(pattern, seed):
    width = BAY_LONG - 1.75 * RADIUS[0]
    if pattern == "drawn":
        return shapes.drawn_curtain(width, 2.85, 7.0 + 0.7 * seed, 0.07, seed, "cloth")
    return shapes.tied_curtain(width / 2, 2.83, 4.0, 0.055, seed, "cloth")


def place_banners(document):
    """Cloths over the first floor's rails on the lit side."""
    cloths = [shapes.draped_cloth(1.5, 1.55, 0.2, seed, "cloth") for seed in range(2)]
    rail_front = HALF_Z - 0.11
    for i, (bay, colour) in enumerate(
        ((1, "emerald"), (3, "azure"), (4, "crimson"), (6, "saffron"))):
        mesh = document.mesh(f"{colour} banner", cloths[i % 2], {"cloth": colour})
        x = (bay - (BAYS_LONG - 1) / 2) * BAY_LONG
        document.node(f"banner {bay}", mesh, (x, FIRST + 0.98, -rail_front), 0)


def rod_mesh():
    mesh = Mesh()
    half = BAY_LONG / 2 - 0.8 * RADIUS[0]
    mesh.box("iron", (-half, -0.02, -0.02), (half, 0.02, 0.02))
    return mesh


def place_furniture(document):
    """A basin in the court and clay vases along the arcades."""
    basin = Mesh()
    shapes.lathe(basin, "carved", [(1.55, 0), (1.55, 0.14), (1.40, 0.18), (1.40, 0.50),
                                   (1.52, 0.56), (1.52, 0.64), (1.26, 0.64), (1.26, 0.30)], 8, 0.5)
    shapes.lathe(basin, "water", [(1.27, 0.40), (1.27, 0.52)], 8)
    shapes.lathe(basin, "carved", [(0.26, 0.3), (0.22, 0.6), (0.12, 0.8), (0.11, 1.15), (0.2, 1.3),
                                   (0.52, 1.42), (0.60, 1.5), (0.56, 1.52), (0.2, 1.42),
                                   (0.06, 1.48), (0.05, 1.62), (0.1, 1.7), (0.06, 1.8)], 20, 0.5)
    document.node("basin", document.mesh("basin", basin), (4.1, 0, 0), 0, (0.85, 0.9, 0.85))
    vase = [(0.16, 0), (0.17, 0.04), (0.13, 0.08), (0.24, 0.28), (0.31, 0.5), (0.30, 0.66),
            (0.22, 0.82), (0.14, 0.90), (0.13, 0.97), (0.20, 1.04), (0.20, 1.07), (0.15, 1.06)]
    vase = document.mesh("vase", shapes.turned(vase, 20, "clay"))
    z = HALF_Z - 0.9
    for i, x in enumerate((-3, -1, 1, 3)):
        document.node(f"lit vase {i}", vase, (x * BAY_LONG, 0, -z), 0,
                      (0.85, 0.8, 0.85) if i % 2 else (1, 1, 1))
    for i, x in enumerate((-2, 0, 2)):
        document.node(f"shaded vase {i}", vase, (x * BAY_LONG, 0, z), 0, (1, 1, 1) if i % 2 else
                      (0.85, 0.8, 0.85))


def scene_file():
    return {
        "model": "atrium.glb",
        "metres_per_unit": 1.0,
        "exposure": -0.4,
        "cameras": [
            {
                "name": "nave", "eye": [-10.3, 1.9, 0.9], "target": [4.0, 1.95, -0.75],
                "vertical_fov_degrees": 55
            },
            {
                "name": "curtains", "eye": [-5.6, 1.5, 1.9], "target": [0.2, 1.6, -2.6],
                "vertical_fov_degrees": 60
            },
            {
                "name": "gallery", "eye": [-10.6, 6.75, -4.6], "target": [2.0, 6.15, -4.3],
                "vertical_fov_degrees": 60
            },
        ],
        "lights": [{
            "name": "sun", "kind": "directional", "direction": [0.06, -0.98, -0.18],
            "illuminance_lux": 16.0, "colour": [1.0, 0.95, 0.86]
        }],
        "cascades": {"count": 3, "size_metres": 25.0},
    }


def move_curtain(document):
    """Draws a curtain of the lit row open to one side, so that the sun gets into the aisle, and
    shut again."""
    node, (x, y, z) = document.node_named("curtain 0.4")
    half, folded = BAY_LONG / 2 - 1.75 * RADIUS[0] / 2, 0.25
    still, shut, open_ = (0, 0, 0), ((1, 1, 1), (x, y, z)), ((folded, 1, 1),
                                                             (x - (1 - folded) * half, y, z))
    times, keys = (2, 4, 7, 9), (shut, open_, open_, shut)
    for i, path in enumerate(("scale", "translation")):
        values = [row for key in keys for row in (still, key[i], still)]
        document.animate(node, path, times, values, "CUBICSPLINE")


def throw_ball(document):
    """A ball that bounces down the court, each time less high, and rolls to rest before the
    basin."""
    radius, gravity, speed, z = 0.45, 9.81, 1.75, -0.9
    ball = document.mesh(
        "ball", shapes.turned(shapes.arc((0.0, 0.0), radius, -90, 90, 24)[1:-1], 36, "saffron"))
    times, values = [], []
    x, time, fall = -9.4, 0.0, 0.0
    for rise in (4.6, 3.9, 3.2, 2.5, 1.8, 1.1, 0.5):  # [m/s], upwards as it leaves the floor
        times.append(time)
        values += [(speed, -fall, 0), (x, radius, z), (speed, rise, 0)]
        time += 2 * rise / gravity
        x += speed * 2 * rise / gravity
        fall = rise
    for wait, going in ((0, speed), (10 - time, 0)):  # the last stretch slows down evenly
        time += wait
        x += wait * speed / 2
        times.append(time)
        values += [(going, -fall if going else 0, 0), (x, radius, z), (going, 0, 0)]
    node = document.node("ball", ball, values[1])
    document.animate(node, "translation", times, values, "CUBICSPLINE")


def living_scene_file():
    """The atrium while its sun crosses the sky and someone walks down the court."""
    return {
        "model": "atrium_living.gltf",
        "exposure": -0.2,
        "cameras": [{
            "name": "walk", "vertical_fov_degrees": 60, "interpolation": "smooth",
            "keys": [{"time": 0, "eye": [-10.2, 1.7, 1.4], "target": [-5.0, 1.6, -0.8]},
                     {"time": 4, "eye": [-6.4, 1.7, 1.9], "target": [-1.0, 1.5, -2.2]},
                     {"time": 7, "eye": [-2.6, 1.7, 1.6], "target": [2.6, 1.7, -2.4]},
                     {"time": 10, "eye": [0.6, 1.8, 1.9], "target": [6.0, 2.0, -1.6]}]
        }],
        "lights": [{
            "name": "sun", "kind": "directional", "keys": [{
                "time": 0, "direction": [0.52, -0.84, -0.15], "illuminance_lux": 12.0,
                "colour": [1.0, 0.80, 0.58]
            }, {
                "time": 5, "direction": [0.0, -0.98, -0.18], "illuminance_lux": 16.0,
                "colour": [1.0, 0.95, 0.86]
            }, {
                "time": 10, "direction": [-0.52, -0.84, -0.15], "illuminance_lux": 12.0,
                "colour": [1.0, 0.80, 0.58]
            }]
        }],
        "cascades": {"count": 3, "size_metres": 25.0},
    }


def overcast_scene_file():
    """No sun, and a sky that is the same all over: 8 pi lux of white on open ground."""
    return {
        **scene_file(), "exposure": 0.6, "sky": {"radiance": [7.2, 8.0, 9.2], "ground": [0, 0, 0]},
        "lights": []
    }


def write_scene(path, scene):
    output.write(path, json.dumps(scene, indent=2) + "\n")


def main(arguments):
    file = HERE.joinpath
    if arguments:
        file = output.Folder(arguments[0], "scenes/generate_atrium.py").file
    document = Document("clpv scenes/generate_atrium.py")
    add_materials(document)
    document.node("shell", document.mesh("shell", shell()))
    document.node("trim", document.mesh("trim", trim()))
    place_arcades(document)
    place_balustrades(document)
    place_curtains(document)
    place_banners(document)
    place_furniture(document)
    glb = document.write(file("atrium.glb"))
    write_scene(file("atrium.json"), scene_file())
    write_scene(file("atrium_overcast.json"), overcast_scene_file())
    move_curtain(document)
    throw_ball(document)
    document.write_beside(file("atrium_living.gltf"), "atrium.glb", glb)
    write_scene(file("atrium_living.json"), living_scene_file())


if __name__ == "__main__":
    sys.exit(output.exit_code(main, sys.argv[1:]))
