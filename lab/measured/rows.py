# SPDX-License-Identifier: MIT
"""Rows of the docs' tables by title, with the options of `clpv`: rows.json. scripts/measure
measures these rows.

FRAMES         Sponza, camera `curtains`, 960x540: `clpv render --stats`
QUALITY        errors against path tracing: `clpv quality`; QUALITY_PARTS: parts of the method,
               without the near field
STEPS          the paper's lobes, exact in place of rotated through a table
CENTRES        centres of lab/results/centres: for all directions, and for the normals that Sponza's
               light sees; without the near field
QUALITY_FILES  files of results/docs by `clpv quality`: scenes and options of all runs, and what
               each run sets
MEDIA          scenes in a medium: sigma_s, sigma_a [1/m], options, numbers of bounces, views
SEALED         rooms of scripts/leaks: what their walls are, and how far apart the sheets [cells]
DOCS_SUITES    suites of `clpv bench` and their options; "sponza" is replaced by the scene, its
               model and the camera `curtains`
"""
import itertools
import json
import pathlib

DATA = json.loads(pathlib.Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))


def options_of(text):
    return dict(word[2:].split("=", 1) for word in text.split())


def table(name):
    """{title: options}."""
    return {title: options_of(text) for title, text in DATA[name].items()}


OPTIONS = table("options")
BEST, PAPER, FAST = (OPTIONS[name] for name in ("BEST", "PAPER", "FAST"))
EXACT_LOBES = OPTIONS["EXACT_LOBES"]
FRAMES, QUALITY, QUALITY_PARTS = map(table, ("FRAMES", "QUALITY", "QUALITY_PARTS"))
BOUNCES, SUNS, STEPS, CENTRES = map(table, ("BOUNCES", "SUNS", "STEPS", "CENTRES"))
SETTINGS, GRIDS = map(table, ("SETTINGS", "GRIDS"))
SEALED, OPEN_ROOMS, MEDIA, ROOMS = (DATA[name] for name in ("SEALED", "OPEN_ROOMS", "MEDIA", "ROOMS"))
DEVICE_SUITES, DOCS_SUITES = DATA["DEVICE_SUITES"], DATA["DOCS_SUITES"]
SEARCHED, SEARCHED_NORMALS = "lab/results/centres/eight.json", "lab/results/centres/eight-normals.json"
LEAKS = {"shapes": [*SEALED, *OPEN_ROOMS], "columns": [tuple(pair) for pair in DATA["LEAKS"]],
         "count": 8, "options": FAST}
# Other methods of lab/docs/results.md, and stages whose time they do not get.
METHODS, SHARED = DATA["METHODS"], DATA["SHARED"]


def runs_of(name):
    """Options of each run of a file: options, the rows of a table, or of two tables, "A x B"."""
    for text in DATA["QUALITY_FILES"][name]["runs"]:
        if text.startswith("--"):
            yield options_of(text)
        else:
            tables = ([OPTIONS[part]] if part in OPTIONS else table(part).values()
                      for part in text.split(" x "))
            for parts in itertools.product(*tables):
                yield {key: value for part in parts for key, value in part.items()}


QUALITY_FILES = {name: (each["given"].split(), list(runs_of(name)))
                 for name, each in DATA["QUALITY_FILES"].items()}
VIEWS = QUALITY_FILES["quality"][0][:-1]
