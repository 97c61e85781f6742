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
import functools
import itertools
import json
import operator
import pathlib

DATA = json.loads(pathlib.Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))


def options_of(text):
    """{option: value} of "--preset=best --grid=16"; FAST stands for the options of that name."""
    options = {}
    for word in text.split():
        if word.startswith("--"):
            name, value = word[2:].split("=", 1)
            options[name] = value
        else:
            options |= options_of(DATA["options"][word])
    return options


def keywords_of(text):
    """The same as arguments of clpv.Renderer."""
    return {name.replace("-", "_"): value for name, value in options_of(text).items()}


def table(name):
    """{title: options}."""
    return {title: options_of(text) for title, text in DATA[name].items()}


MEDIA, ROOMS, SHARED = (DATA[name] for name in ("MEDIA", "ROOMS", "SHARED"))
OPEN_ROOMS = DATA["OPEN_ROOMS"]
DEVICE_SUITES, DOCS_SUITES = DATA["DEVICE_SUITES"], DATA["DOCS_SUITES"]
LEAKS = {"shapes": [*DATA["SEALED"], *OPEN_ROOMS], "count": 8, "options": options_of("FAST"),
         "columns": [(row["light"], row["bounces"]) for row in DATA["LEAKS"]]}


def runs_of(text):
    """Options of each run: those of the text, the rows of a table, or of two tables, "A x B"."""
    tables = [table(part).values() if part in DATA else [options_of(part)]
              for part in text.split(" x ")]
    for parts in itertools.product(*tables):
        yield functools.reduce(operator.or_, parts)


QUALITY_FILES = {name: (each["given"].split(),
                        [run for text in each["runs"] for run in runs_of(text)])
                 for name, each in DATA["QUALITY_FILES"].items()}
VIEWS = QUALITY_FILES["quality"][0][:-1]
