# SPDX-License-Identifier: MIT
"""A suite of views: suite.json names their truths. Scores a folder of images SCENE-CAMERA.exr."""
import fnmatch
import glob
import json
import pathlib
import re
from collections.abc import Sequence
from typing import Any

import numpy

from clpv_lab.score import errors, exr
from clpv_lab.score.exr import BadImage

SCHEMA = 1
MAX_NUMBER = 1000  # noise, and exposures [EV], whose powers of 2 are finite
MEASURES = "nrmse", "nrmse_best_gain", "energy_ratio", "flip", "bias", "noise", "change"
LIGHT = "indirect"  # layer that a score is of
LAYERS = LIGHT, "depth", "normal", "albedo", "direct", "irradiance"  # layers of a truth
DIGITS = 5  # digits of printed errors
NUMBER = int, float
UNKNOWN = type(None)
FIELDS = {"name": str, "truth": str, "noise": (*NUMBER, UNKNOWN), "exposure": NUMBER}  # fields of a view


def printable(text):
    """Foreign text for a terminal: control characters become `?`."""
    return "".join(c if c.isprintable() else "?" for c in str(text))


def is_valid(value, kind):
    if kind is str:
        return isinstance(value, str) and value.isprintable() and value != ""
    return type(value) in kind and (value is None or abs(value) <= MAX_NUMBER)  # not NaN


def unique(pairs):
    """An object of JSON, whose keys must be unique: json would keep the last value of each."""
    made = dict(pairs)
    if len(made) < len(pairs):
        keys = [key for key, _ in pairs]
        raise ValueError(f"duplicate key {json.dumps(next(k for k in keys if keys.count(k) > 1))}")
    return made


def read_suite(folder):
    """Returns the document suite.json of a folder. Throws BadImage."""
    file = folder / "suite.json"
    try:
        suite = json.loads(file.read_text(), object_pairs_hook=unique)
    except OSError as error:
        raise BadImage(f"{file}: {error.strerror}; allowed: a folder that lab/scripts/suite "
                       "wrote") from None
    except (ValueError, RecursionError) as error:
        raise BadImage(f"{file}: {error}") from None
    views = suite.get("views") if isinstance(suite, dict) else None
    if not isinstance(views, list) or not views or suite.get("schema") != SCHEMA:
        raise BadImage(f"{file}: allowed: schema {SCHEMA} with views")
    if not is_valid(suite.get("hash"), str):
        raise BadImage(f"{file}: /hash: found {json.dumps(suite.get('hash'))}; allowed: text")
    for i, view in enumerate(views):
        for name, kind in FIELDS.items():
            value = view.get(name) if isinstance(view, dict) else None
            if not is_valid(value, kind):
                allowed = "printable text" if kind is str else f"a finite number, -{MAX_NUMBER}..{MAX_NUMBER}"
                raise BadImage(
                    f"{file}: /views/{i}/{name}: found {json.dumps(value)}; allowed: {allowed}")
    return suite


def frames_of(folder, view):
    """Files of a view: VIEW.exr, or its frames VIEW.NUMBER.exr in the order of their numbers."""
    numbered = [(int(found[1]), file) for file in folder.glob(f"{glob.escape(view)}.*.exr")
                if (found := re.fullmatch(rf"{re.escape(view)}\.(\d+)\.exr", file.name))]
    single = folder / f"{view}.exr"
    if single.exists() and numbered:
        raise BadImage(
            f"{single}: found frames {view}.NUMBER.exr beside it; allowed: one of the two")
    return [single] if single.exists() else [file for _, file in sorted(numbered)]


def read_image(file, truth, layer=LIGHT):
    """Returns colours and alpha: of a layer other than light if the file has it, else its own.
    Throws BadImage for another size."""
    planes = exr.read(file)
    has_layer = layer != LIGHT and f"{layer}.R" in planes
    rgb, alpha = exr.colours(planes, file, layer if has_layer else "")
    height, width = truth.shape[:2]
    if rgb.shape != truth.shape:
        raise BadImage(
            f"{file}: found {rgb.shape[1]} x {rgb.shape[0]} pixels; allowed: {width} x {height}")
    return rgb, alpha


def read_truth(folder, view, layer=LIGHT):
    """Returns colours and alpha of a layer."""
    file = folder / view["truth"]
    return exr.colours(exr.read(file), file, layer)


def inputs(folders, suite_folder):
    """Files that a score of these folders may read: suite.json, all truths and images."""
    truths = [suite_folder / view["truth"] for view in read_suite(suite_folder)["views"]]
    images = [file for folder in folders for file in folder.glob("*.exr")]
    return [suite_folder / "suite.json", *truths, *images]


def shared(alpha, images):
    """Pixels with a surface in the truth and in all images."""
    return numpy.logical_and.reduce([alpha > 0, *(mask > 0 for _, mask in images)])


def read_view(folder, view, files, layer=LIGHT):
    """Returns what score_view() takes: view, truth, its alpha, and images with their alpha, of
    `files`."""
    truth, alpha = read_truth(folder, view, layer)
    images = [read_image(file, truth, layer) for file in files]
    if not shared(alpha, images).any():
        raise BadImage(
            f"{files[0]}: found no pixel with alpha above 0 where the truth has a surface")
    return view, truth, alpha, images


def score_view(view, truth, alpha, images, layer=LIGHT):
    valid = shared(alpha, images)
    frames = numpy.stack([rgb for rgb, _ in images])
    exposure = view["exposure"] if layer == LIGHT else None
    found = errors.errors(frames, truth, valid, exposure)
    rounded = {name: None if value is None else round(float(value), DIGITS)
               for name, value in found.items()}
    missing = 1 - valid.sum() / (alpha > 0).sum()
    suspected = [f"has no surface in {100 * missing:.0f} % of the truth's: other camera or scene"
                 ] if missing > 0.02 else []
    return {"view": view["name"], **rounded, "frames": len(images), "truth_noise": view["noise"],
            "suspected": suspected}


def chosen(suite, only):
    views = [view for view in suite["views"]
             if any(fnmatch.fnmatch(view["name"], pattern) for pattern in only)]
    if not views:
        names = ", ".join(view["name"] for view in suite["views"])
        raise BadImage(f"--only {' '.join(only)}: found no view; allowed: {names}")
    return views


def score(folder: pathlib.Path, suite_folder: pathlib.Path, method: str | None = None,
          only: Sequence[str] = ("*", ), layer: str = LIGHT) -> dict[str, Any]:
    """Scores the images of `folder` for the views whose names match a pattern of `only`; `folder`
    must have all of them. layer: of the truths, to compare with. Returns the errors of each view,
    their means, and in how many views each is undefined (None); its mean is then None. Throws
    BadImage."""
    suite = read_suite(suite_folder)
    views = chosen(suite, only)
    files = {view["name"]: frames_of(folder, view["name"]) for view in views}
    if not folder.is_dir():
        raise BadImage(f"{folder}: no folder")
    absent = [name for name, found in files.items() if not found]
    if absent:
        raise BadImage(
            f"{folder}: found no image of {', '.join(f'{name}.exr' for name in absent)}; allowed: all "
            f"{len(views)} views, or --only PATTERN")
    rows = [score_view(*read_view(suite_folder, view, files[view["name"]], layer), layer)
            for view in views]
    means, undefined = {}, {}
    for measure in MEASURES:
        values = [row[measure] for row in rows if measure in row]
        if len(values) == len(rows):  # bias, noise and change need frames of all views
            undefined[measure] = values.count(None)
            means[measure] = None if None in values else round(sum(values) / len(values), DIGITS)
    return {"schema": SCHEMA, "suite": suite["hash"], "method": method or folder.resolve().name,
            **({} if layer == LIGHT else {"layer": layer}), "mean": means, "undefined": undefined,
            "complete": len(views) == len(suite["views"]), "views": rows}
