# SPDX-License-Identifier: MIT
"""Images of several methods beside the truths of a suite: slider, zoom, exposure, error maps, and
their errors as a table. A page of its own, or a part of a report."""
import base64
import json
import pathlib
import re

import numpy

from clpv.score import errors, suite, table
from clpv.score.exr import BadImage

LARGEST = 30_000_000  # bytes of a page
LARGEST_HALF = 65504


def text_of(values):
    return base64.b64encode(values.tobytes()).decode("ascii")


def entry(title, image):
    return {
        "title": title,
        "halves": text_of(numpy.clip(image, -LARGEST_HALF, LARGEST_HALF).astype("<f2"))
    }


def entry_with_error(title, frames, view, truth, alpha):
    """Entry of the mean of frames, with its map of FLIP."""
    image = numpy.mean([rgb for rgb, _ in frames], axis=0)
    valid = suite.shared(alpha, frames)
    seen = numpy.where(valid, errors.flip_map(image, truth, valid, view["exposure"]), 0)
    return {**entry(title, image), "flip": text_of(numpy.round(255 * seen).astype(numpy.uint8))}


def part(name):
    return pathlib.Path(__file__).with_name(name).read_text(encoding="utf-8")


def viewer(suite_folder, methods, only=("*",)):
    """HTML of the viewer and the table, to stand in a page. `methods`: (title, folder), which may
    lack views."""
    shown, rows, methods = [], [], list(methods)
    for view in suite.chosen(suite.read_suite(suite_folder), only):
        truth, alpha, _ = suite.read_truth(suite_folder, view)
        images = [entry("path tracing", truth)]
        for title, folder in methods:
            files = suite.frames_of(folder, view["name"])
            if files:
                read = suite.read_view(suite_folder, view, files)
                rows.append({**suite.score_view(*read), "image": title})
                images.append(entry_with_error(title, read[-1], view, truth, alpha))
        shown.append({
            "name": view["name"], "width": truth.shape[1], "height": truth.shape[0],
            "exposure": view["exposure"], "images": images
        })
    parts = {"TABLE": table.markup(rows), "DATA": json.dumps(shown).replace("<", "\\u003c")}
    return re.sub("TABLE|DATA", lambda found: parts[found[0]], part("viewer.html"))


def made(suite_folder, methods, only=("*",)):
    """HTML of a page. Throws BadImage for more than 30 MB."""
    page = part("page.html").replace("VIEWER", viewer(suite_folder, methods, only), 1)
    if len(page) > LARGEST:
        raise BadImage(
            f"--page: found {len(page)} bytes; allowed: {LARGEST}; use --only for fewer views")
    return page
