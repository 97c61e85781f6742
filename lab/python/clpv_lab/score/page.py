# SPDX-License-Identifier: MIT
"""A page of images of several methods beside the truths of a suite, and their errors as a table."""
import html
import pathlib

import numpy

from clpv.draw import viewer
from clpv_lab.score import errors, suite
from clpv_lab.score.exr import BadImage

LARGEST = 30_000_000  # bytes of a page


def entry_with_error(title, frames, view, truth, alpha):
    """Entry of the mean of frames, with its map of FLIP."""
    image = numpy.mean([rgb for rgb, _ in frames], axis=0)
    valid = suite.shared(alpha, frames)
    return viewer.entry(title, image, errors.flip_map(image, truth, valid, view["exposure"]))


def compared(suite_folder, methods, only):
    """HTML of the viewer and the table, then what is suspected. `methods`: (title, folder)."""
    shown, rows, methods = [], [], list(methods)
    for view in suite.chosen(suite.read_suite(suite_folder), only):
        truth, alpha = suite.read_truth(suite_folder, view)
        images = [viewer.entry("path tracing", truth)]
        for title, folder in methods:
            read = suite.read_view(suite_folder, view, suite.frames_of(folder, view["name"]))
            rows.append({**suite.score_view(*read), "image": title})
            images.append(entry_with_error(title, read[-1], view, truth, alpha))
        shown.append({"name": view["name"], "width": truth.shape[1], "height": truth.shape[0],
                      "exposure": view["exposure"], "images": images})
    said = [f"{row['view']}, {row['image']}: {words}" for row in rows for words in row["suspected"]]
    return "\n".join([viewer.markup(shown, rows),
                      *(f'<p class="soft">{html.escape(words)}</p>' for words in said)])


def made(suite_folder, methods, only=("*",)):
    """HTML of a page. Throws BadImage for more than 30 MB."""
    page = pathlib.Path(__file__).with_name("page.html").read_text(encoding="utf-8")
    page = page.replace("VIEWER", compared(suite_folder, methods, only), 1)
    if len(page) > LARGEST:
        raise BadImage(
            f"--page: found {len(page)} bytes; allowed: {LARGEST}; use --only for fewer views")
    return page
