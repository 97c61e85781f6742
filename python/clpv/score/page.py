# SPDX-License-Identifier: MIT
"""Images of several methods beside the truths: slider, zoom, exposure, error maps. A page of its
own, or a part of a report."""
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
    return {
        "title": title,
        "halves": text_of(numpy.clip(image, -LARGEST_HALF, LARGEST_HALF).astype("<f2"))
    }


def view(name, exposure, truth, alpha, shots):
    """A view of the viewer. `shots`: (title, image, its alpha); images have the truth's size."""
    images = [entry("path tracing", truth)]
    for title, image, mask in shots:
        valid = (alpha > 0) & (mask > 0)
        seen = numpy.where(valid, errors.flip_map(image, truth, valid, exposure), 0)
        images.append(
            {**entry(title, image), "flip": text_of(numpy.round(255 * seen).astype(numpy.uint8))})
    return {
        "name": name, "width": truth.shape[1], "height": truth.shape[0], "exposure": exposure,
        "images": images
    }


def part(name):
    return pathlib.Path(__file__).with_name(name).read_text(encoding="utf-8")


def viewer(views):
    """HTML of the viewer, to stand in a page."""
    return part("viewer.html").replace("DATA", json.dumps(views).replace("<", "\\u003c"), 1)


def mean_of(frames):
    """Mean and common alpha of a method's frames: (image, alpha)."""
    images, masks = zip(*frames)
    return numpy.mean(images, axis=0), numpy.min(masks, axis=0)


def made(suite_folder, folders, only=("*",)):
    """HTML of a page. `folders`: {title: folder}, which suite.score() accepts. Throws BadImage for
    more than 30 MB."""
    views = []
    for each in suite.chosen(suite.read_suite(suite_folder), only):
        truth, alpha, _ = suite.read_truth(suite_folder, each)
        shots = [(title, *mean_of(
            [suite.read_image(file, truth) for file in suite.frames_of(folder, each["name"])]))
                 for title, folder in folders.items()]
        views.append(view(each["name"], each["exposure"], truth, alpha, shots))
    page = part("page.html").replace("VIEWER", viewer(views), 1)
    if len(page) > LARGEST:
        raise BadImage(
            f"--page: found {len(page)} bytes; allowed: {LARGEST}; use --only for fewer views")
    return page
