# SPDX-License-Identifier: MIT
"""Rows of the docs' tables by title, with the options of `clpv`. scripts/measure measures
these rows."""
import itertools

# Sponza, camera `curtains`, 960x540: `clpv render --stats`.
BEST = {"preset": "best"}
PAPER = {"preset": "paper", "basis": "sh2"}
PAPER_SRBF = {"preset": "paper", "basis": "srbf8v2"}
IN_BUFFERS = {**PAPER, "layout": "soa", "storage": "float", "lobe-time": "host"}
FAST, FINE = {"preset": "fast"}, {"preset": "fine"}
HALF, FULL = {"near-size": "half"}, {"near-size": "full"}

FRAMES = {
    "the defaults": BEST,
    "`--preset fast --basis bins24`": {**FAST, "basis": "bins24"},
    "the defaults, `--near-size half`": {**BEST, **HALF},
    "the defaults, `--near-size full`": {**BEST, **FULL},
    "`--preset fast`": FAST,
    "`--preset fine`": FINE,
    "`--preset fast --medium 0.008,0,0.5`": {**FAST, "medium": "0.008,0,0.5"},
    "published scheme, sh2, in buffers": IN_BUFFERS,
    "published scheme, sh2, in images of halves": PAPER,
    "published scheme, srbf8v2, in images of halves": PAPER_SRBF,
}

# Errors against path tracing: `clpv quality`.
QUALITY = {
    "published scheme, sh2": PAPER,
    "published scheme, srbf8v2": PAPER_SRBF,
    "**the defaults**": BEST,
    "the same, `--near-size half`": HALF,
    "the same, `--near-rays 64`": {"near-rays": "64"},
    "`--preset fast`": FAST,
    "`--preset fine`": FINE,
    **{
        f"`--preset fast`, {grid}^3 cells": {**FAST, "grid": str(grid)}
        for grid in (16, 24, 48, 64)
    },
}
OTHER_BASES = "sh3", "bins24", "srbf4", "srbf6", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14"
# Parts of the method, without the near field.
CHANGED = [{"gather": "all"}, {"blockers": "seen"}, {"blockers": "none"}, {"transport": "sampled"},
           {"coarser-directions": "24"},
           *({"directions": n, "coarser-directions": n} for n in ("24", "216")),
           *({"basis": basis} for basis in OTHER_BASES),
           {"gather-offset": "0.5"}, {"storage": "float"}]
QUALITY_PARTS = {
    "`" + " ".join(f"--{name} {value}"
                   for name, value in options.items()) + "`": {**FAST, **options}
    for options in CHANGED
}
GRIDS = 16, 24, 32, 48, 64, 96, 128
BOUNCES = {"published scheme, sh2": {**PAPER, "bounces": "1"},
           **{f"`--preset fast --bounces {n}`": {**FAST, "bounces": n} for n in ("1", "2", "all")}}
SUNS = {"published scheme, sh2": PAPER, "`--preset fast`": FAST}

# The paper's lobes, exact in place of rotated through a table.
EXACT_LOBES = {"preset": "paper", "lobe": "exact", "lobe-time": "host", "evaluate": "exact"}
SETTINGS = [{"cascade-size": size, "iterations": steps}
            for size, steps in itertools.product(("12.5", "50"), ("8", "24"))]
STEPS = {
    **{
        f"published scheme, {basis}, exact lobes": {**EXACT_LOBES, "basis": basis}
        for basis in ("sh2", "srbf8v2", "srbf14")
    }, "srbf14, exact transport too": {**EXACT_LOBES, "basis": "srbf14", "transport": "exact"}
}

# Centres that the lab finds: over all directions, and for the normals that Sponza's light sees.
SEARCHED, SEARCHED_NORMALS = "out/searched8.json", "out/searched8-normals.json"
CENTRES = {
    "srbf8v2": {"basis": "srbf8v2"}, "eight searched centres": {"centres": SEARCHED},
    "the same, for Sponza's normals": {"centres": SEARCHED_NORMALS},
    **{basis: {"basis": basis}
       for basis in ("srbf6", "srbf8v1", "srbf8v3", "sh3")}
}  # without the near field

# Files of results/docs by `clpv quality`: scenes and options of all runs, and what each run sets.
VIEWS = [
    "sponza_suns", "cornell", "--camera=curtains", "--camera=atrium", "--camera=columns",
    "--camera=front"
]
QUALITY_FILES = {
    "quality": ([*VIEWS, "--noise=0.03"], [*QUALITY.values(), *QUALITY_PARTS.values()]),
    "quality-grid": ([*VIEWS, "--noise=0.03"], [{**FAST, "grid": str(grid)} for grid in GRIDS]),
    "quality-grid-published": ([
        *VIEWS, "--noise=0.03", *(f"--{name}={value}" for name, value in IN_BUFFERS.items())
    ], [{"grid": str(grid)} for grid in GRIDS[:5]]),
    "quality-suns": (["sponza_other_suns",
                      "--noise=0.03"], [*QUALITY.values(), *QUALITY_PARTS.values()]),
    "quality-scenes": (["atrium", "atrium_overcast", "sponza_overcast",
                        "--noise=0.03"], list(SUNS.values())),
    "quality-bounces": ([*VIEWS, "--noise=0.05", "--bounces=all"], list(BOUNCES.values())),
    "quality-lamp": (["cornell_lamp", "--noise=0.02"], [FAST]),
    "quality-lamp-bounces": (["cornell_lamp", "--noise=0.02",
                              "--bounces=all"], [{**FAST, "bounces": n}
                                                 for n in ("1", "2", "all")]),
    "quality-steps": (["sponza_suns", "--camera=atrium", "--noise=0.03"], [
        *({**row, **setting} for row, setting in itertools.product(STEPS.values(), SETTINGS)),
        {**FAST, "cascade-size": "12.5"}, {**FAST, "cascade-size": "50"}
    ]),
    "quality-centres": ([*VIEWS, "--noise=0.03"], [
        *({**EXACT_LOBES, **CENTRES[name]}
          for name in ("srbf8v2", "sh3", "eight searched centres")), {**FAST, "centres": SEARCHED},
        {**FAST, "centres": SEARCHED_NORMALS}
    ]),
}

# `clpv quality` of scenes in a medium: sigma_s, sigma_a [1/m], options, numbers of bounces, views.
MEDIA = [
    ("0.002, 0.02", [
        "sponza_suns", "--medium=0.002,0.02,0.3", "--camera=curtains", "--camera=atrium",
        "--camera=columns", "--width=480", "--height=270"
    ], ["1"], ["medium"]),
    ("0.02, 0", ["sponza_suns", "--medium=0.02,0,0.3",
                 "--camera=atrium"], ["1", "all"], ["medium", "indirect"]),
    ("0.02, 0", ["atrium", "--medium=0.02,0,0.3",
                 "--camera=nave"], ["1", "all"], ["medium", "indirect"]),
    ("0.5, 0", ["cornell_fog"], ["1", "all"], ["medium", "indirect"]),
]

# scripts/leaks. Sealed rooms: what their walls are, and how far apart the sheets [cells].
SEALED = {
    "sheet": ("one sheet", "0"), "wall0.1": ("two sheets", "0.1"),
    "wall1": ("two sheets", "1"),
    "turned": ("one sheet, turned by 20 degrees", "0")
}
OPEN_ROOMS = {
    "slit": "a slit of half a cell in a wall", "door": "a door to a room without a roof",
    "corner": "two walls and a floor", "legs": "a floor on four thin legs"
}
LEAKS = {
    "shapes": [*SEALED, *OPEN_ROOMS],
    "columns": [("sun", 1), ("sun", 2), ("sun", "all"), ("sky", 1), ("sky", "all"), ("lamp", 1),
                ("lamp", "all"), ("sun", "direct"), ("lamp", "direct")],
    "count": 8, "options": FAST
}

# Suites of `clpv bench` and their options. "sponza" is replaced by the scene, its model and the
# camera `curtains`.
DEVICE_SUITES = {
    "table1": ["--repetitions=7"],
    "layouts": ["--repetitions=7"],
    "frame": ["--repetitions=5", "--basis=sh2,srbf8v2"],
}
DOCS_SUITES = {
    "layouts": [],
    "bases": [],
    "frame": ["sponza", "--repetitions=9", "--basis=sh2", "--filter=best"],
}
OF_LAB = ("quality-centres", )  # needs a built lab
