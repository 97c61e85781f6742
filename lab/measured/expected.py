# SPDX-License-Identifier: MIT
"""Values that a reproduction must find, with tolerances: results/paper/expected.json.

Only the standard library.
"""

import json
import pathlib

from . import cells


# Parts of scripts/reproduce. `file`: of results/docs. `tolerances`: by the end of a number's name:
# absolute, relative; null: no number has an expected value. `model`: needs Sponza. `quick`: belongs
# to a quick run too. Lobes are computed in double on the host. Tables are read in float, where
# fused multiply-adds decide single entries. Light: devices round differently, and the ground truth
# has a noise of 0.02 (views: 0.05).
PARTS = json.loads(pathlib.Path(__file__).with_name("parts.json").read_text(encoding="utf-8"))
CLAIMS = [name for name, part in PARTS.items() if part["file"] == "claims"]
# Fields that name a row, and fields that are no results.
IDENTITY = ("basis", "lobe", "transport", "n", "lambda", "entries", "cascade_size", "rsm_size",
            "iterations", "cascade-size", "image", "options", "camera", "size")
SKIPPED = ("floor_pixels", "views", "apart")


def label(row):
    """Name of a row: what identifies it."""
    return ",".join(str(row[key]) for key in IDENTITY if key in row)


def numbers(value, path):
    """Yields (name, number) of a document; rows of lists are named by what identifies them."""
    if isinstance(value, dict):
        for key, each in value.items():
            if key not in SKIPPED:
                yield from numbers(each, f"{path}/{key}")
    elif isinstance(value, list):
        for each in value:
            yield from numbers({key: one for key, one in each.items() if key not in IDENTITY},
                               f"{path}/{label(each)}")
    elif value is None or isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, value


def place(name):
    """Start of the names of a part's numbers."""
    return "figures/rows" if name == "figures" else f"claims/{name}"


def compared(name, result):
    """{place: what is compared of a part's result}."""
    if name == "figures":
        result = result["rows"] or None
    return {place(name): result} if PARTS[name]["tolerances"] else {}


def recorded():
    """{part: its result} of the record."""
    files = {name: cells.read(part["file"]) for name, part in PARTS.items()}
    return {name: file.get(name) if name in CLAIMS else file for name, file in files.items()}


def found(results):
    """{name: number, None if undefined} of {part: result}; parts that are None are left out."""
    return dict(pair for name, result in results.items() if result is not None
                for path, document in compared(name, result).items() if document is not None
                for pair in numbers(document, path))


def tolerance(name, value):
    part = next(part for key, part in PARTS.items() if name.startswith(place(key) + "/"))
    absolute, relative = next(allowed for end, allowed in part["tolerances"].items()
                              if name.endswith(end))
    return float(f"{max(absolute, relative * abs(value)):.2g}")


def expected():
    """expected.json: {number: [value, tolerance]}, and the file of each part."""
    return {
        "files": {place(name): "results/docs/" + part["file"] + ".json"
                  for name, part in PARTS.items() if part["tolerances"]},
        "numbers": {name: [float(f"{value:.6g}"), tolerance(name, value)]
                    for name, value in found(recorded()).items() if value is not None},
    }


def left(document, measured, whole=()):
    """Lines for numbers of `measured` that left their tolerance or are not expected, and for those
    of parts measured as a whole that are missing."""
    lines, parts = [], tuple(f"{part}/" for part in whole)
    for name, (wanted, allowed) in document["numbers"].items():
        found = measured.get(name)
        if found is None and (name in measured or name.startswith(parts)):
            kind = "null" if name in measured else "none"
            lines.append(f"{name}: found {kind}; allowed: {wanted:g}")
        elif found is not None and not abs(found - wanted) <= allowed:
            lines.append(f"{name}: found {found:.6g}; allowed: {wanted:g} +- {allowed:g}")
    lines += [f"{name}: found {value:.6g}; allowed: a number of results/paper/expected.json"
              for name, value in measured.items()
              if value is not None and name not in document["numbers"]]
    return lines
