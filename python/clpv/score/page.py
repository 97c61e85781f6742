# SPDX-License-Identifier: MIT
"""A page that shows images of several methods beside the truths: slider, zoom, exposure, error maps. One HTML file."""
import base64
import json
import pathlib

import numpy

from clpv.score import errors, suite
from clpv.score.exr import BadImage

LARGEST = 30_000_000  # bytes of a page
LARGEST_HALF = 65504


def text_of(values):
    return base64.b64encode(values.tobytes()).decode("ascii")


def entry(title, image):
    return {"title": title, "halves": text_of(numpy.clip(image, -LARGEST_HALF, LARGEST_HALF).astype("<f2"))}


def view_of(view, suite_folder, folders):
    """A view with the truth and each method's image, the mean of its frames."""
    truth, alpha = suite.read_truth(suite_folder, view)
    images = [entry("path tracing", truth)]
    for title, folder in folders.items():
        frames = [suite.read_image(file, truth) for file in suite.frames_of(folder, view["name"])]
        mean = numpy.mean([rgb for rgb, _ in frames], axis=0)
        valid = numpy.logical_and.reduce([alpha > 0, *(mask > 0 for _, mask in frames)])
        seen = numpy.where(valid, errors.flip_map(mean, truth, valid, view["exposure"]), 0)
        images.append({**entry(title, mean), "flip": text_of(numpy.round(255 * seen).astype(numpy.uint8))})
    return {"name": view["name"], "width": truth.shape[1], "height": truth.shape[0], "exposure": view["exposure"],
            "images": images}


def write(target, suite_folder, folders, only=("*",)):
    """Writes the page. `folders`: {title: folder}, which suite.score() accepts. Throws BadImage for more than 30 MB."""
    views = [view_of(view, suite_folder, folders) for view in suite.chosen(suite.read_suite(suite_folder), only)]
    data = json.dumps(views).replace("<", "\\u003c")
    page = pathlib.Path(__file__).with_name("page.html").read_text(encoding="utf-8").replace("DATA", data, 1)
    if len(page) > LARGEST:
        raise BadImage(f"{target}: found {len(page)} bytes; allowed: {LARGEST}; use --only for fewer views")
    target.write_text(page, encoding="utf-8")
