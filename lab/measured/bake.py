# SPDX-License-Identifier: MIT
"""Errors of light probes by format, for results/docs: `bake` by `clpv bake --check`, `bake-leaks`
by `clpv bake --points`."""
import csv
import itertools
import math
import pathlib
import sys
import tempfile

from . import cells, leak_scenes as scenes, run_clpv

POINTS = 1000
PATHS = "--spp=512"
BOXES = {"cornell": "0.02,0.02,0.02,0.53,0.52,0.53", "atrium": "-13.5,0.3,-6.5,13.5,9,6.5",
         "sponza": "-16,0.3,-9,15,12,8"}
SPACINGS = {"cornell": (0.1, 0.05), "atrium": (2, 1), "sponza": (2, 1)}  # [m] coarse and fine
# Scenes, with the camera whose sun lights them.
SCENES = ("cornell", "cornell_lamp", "atrium", "atrium_overcast", "sponza_suns:curtains",
          "sponza_suns:atrium", "sponza_suns:columns", "sponza_overcast")
# Part of a scene, with probes as dense as limits and time allow.
PART, PART_BOX, PART_SPACINGS = "atrium", "-4,0.3,-4,4,4.3,4", (2, 1, 0.5)
SOURCES = "pathtrace", "sweep"
COLUMNS = "surface", "surface_energy", "air", "air_energy", "negative"

# Rooms without light inside, their walls' faces without a back or with one.
ROOMS = {"sheet": True, "wall0.5": False, "wall2": False}
ROOM_LOW, ROOM_HIGH = (-3, -1, -3), (3, 4, 3)  # outermost probes, before the shifts
ROOM_SPACINGS = 1, 0.5, 0.25
SHIFTS = (0.2, 0.5, 0.8), (0.7, 0.1, 0.4)  # shifts of the probes [spacings]: walls lie between them
ROOM_PATHS = "--spp=64"
ROOM_POINTS = 5  # along each edge of a face


def printed(scene, *options):
    """Words of the lines that `clpv bake SCENE` prints below the head."""
    print("scripts/measure: clpv bake", scene, *options, file=sys.stderr)
    return [line.split() for line in run_clpv("bake", scene, *options).splitlines()[1:]]


def values(words, names):
    return {name: None if word == "-" else float(word) for name, word in zip(names, words)}


def kind_of(scene):
    return scene.split(":")[0].split("_")[0]


def measure_scene(scene, box, spacing, source, model):
    """Rows of one scene, by format."""
    file, _, camera = scene.partition(":")
    options = [f"--bounds={box}", f"--spacing={spacing}", f"--from={source}", f"--check={POINTS}",
               PATHS, *([f"--camera={camera}"] if camera else []),
               *([f"--model={model}"] if kind_of(scene) == "sponza" else [])]
    return [{"scene": scene, "spacing": spacing, "source": source, "format": name,
             "numbers": int(numbers), "bytes": int(size), **values(words, COLUMNS)}
            for name, numbers, size, *words in printed(f"scenes/{file}.json", *options)]


def measure(model):
    return [row for scene in SCENES for spacing in SPACINGS[kind_of(scene)] for source in SOURCES
            for row in measure_scene(scene, BOXES[kind_of(scene)], spacing, source, model)]


def measure_part():
    return [row for spacing in PART_SPACINGS for source in SOURCES
            for row in measure_scene(PART, PART_BOX, spacing, source, None)]


def mean(rows, name, source, place, fine):
    """Mean of a column over all scenes, at the fine or the coarse spacing."""
    found = cells.matching(rows, {"format": name, "source": source})
    return cells.mean_of(row[place] for row in found
                         if row["spacing"] == SPACINGS[kind_of(row["scene"])][fine])


def over_bytes(rows, name, source, place):
    """(bytes in a cube of the coarse spacing, mean error in %) at both spacings."""
    size = next(row["bytes"] for row in rows if row["format"] == name)
    return [(size * 8**fine, mean(rows, name, source, place, fine)) for fine in (0, 1)]


def error_at(line, size):
    """Interpolates over the logarithm of bytes."""
    (low, first), (high, last) = line
    return first + (last - first) * math.log(size / low) / math.log(high / low)


def leaks_of(folder, room, spacing, fill):
    """Mean irradiance on the inner faces of a closed room under an even sky, in % of that of open
    ground, by format; mean over all shifts. `folder`: where the scene is written."""
    scenes.write(folder / room, names=[room], double_sided=ROOMS[room])
    points = folder / "points.csv"
    with open(points, "w", encoding="utf-8") as file:
        csv.writer(file).writerows(p + n for p, n in scenes.inner_points(room, ROOM_POINTS))
    found = {}
    for shift in SHIFTS:
        bounds = [a + spacing * b for corner in (ROOM_LOW, ROOM_HIGH)
                  for a, b in zip(corner, shift)]
        lines = printed(folder / room / f"{room}-sky.json", "--from=pathtrace", ROOM_PATHS,
                        f"--spacing={spacing}", f"--bounds={','.join(f'{b:g}' for b in bounds)}",
                        f"--points={points}", *([] if fill else ["--no-dilate"]))
        for name, _, _, light, _ in lines[1:]:
            leak = 100 * float(light) / (math.pi * 1e3) / len(SHIFTS)
            found[name] = found.get(name, 0) + leak
    return found


def measure_leaks():
    with tempfile.TemporaryDirectory() as folder:
        return [{"room": room, "spacing": spacing, "filled": fill, "format": name,
                 "leak": round(leak, 3)}
                for room, spacing, fill in itertools.product(ROOMS, ROOM_SPACINGS, (True, False))
                for name, leak in leaks_of(pathlib.Path(folder), room, spacing, fill).items()]
