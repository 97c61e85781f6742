# SPDX-License-Identifier: MIT
"""Images of several methods beside path-traced truths: slider, zoom, exposure, error maps, and a
table of errors. A part of the report page and of the lab's. Needs NumPy alone."""
import base64
import html
import json
import pathlib
import re

import numpy

LARGEST_HALF = 65504
# Title, key, factor and digits.
COLUMNS = [("NRMSE [%]", "nrmse", 100, 1), ("at best gain", "nrmse_best_gain", 100, 1),
           ("energy", "energy_ratio", 1, 3), ("FLIP", "flip", 1, 3), ("bias [%]", "bias", 100, 1),
           ("noise [%]", "noise", 100, 1), ("change [%]", "change", 100, 1)]


def text_of(values):
    return base64.b64encode(values.tobytes()).decode("ascii")


def entry(title, image, flip=None):
    """An image of a view: linear colours (height x width x 3), and FLIP of each pixel."""
    halves = numpy.clip(image, -LARGEST_HALF, LARGEST_HALF).astype("<f2")
    errors = {} if flip is None else {"flip": text_of(numpy.round(255 * flip).astype(numpy.uint8))}
    return {"title": title, "halves": text_of(halves), **errors}


def cells(rows, names):
    """Titles, then a line for each row: its `names` and errors. `-`: undefined."""
    columns = [column for column in COLUMNS if any(column[1] in row for row in rows)]
    return [[*names, *(title for title, *_ in columns)]] + [[
        *(row[name] for name in names),
        *("-" if row.get(key) is None else f"{factor * row[key]:.{digits}f}"
          for _, key, factor, digits in columns)
    ] for row in rows]


def table(rows):
    """HTML: a line for each view and image."""
    title, *lines = cells(rows, ["view", "image"])

    def line(tag, values):
        return f"<tr>{''.join(f'<{tag}>{html.escape(value)}</{tag}>' for value in values)}</tr>"

    return "\n".join(['<div class="scroll" id="scores"><table>', line("th", title),
                      *(line("td", cells) for cells in lines), "</table></div>"])


def markup(views, rows):
    """HTML of the viewer and the table, to stand in a page. `views`: each with "name", "width",
    "height", "exposure" [EV] and "images", entries of which the first is the truth. `rows`: errors,
    each with "view" and "image"."""
    parts = {"TABLE": table(rows), "DATA": json.dumps(views).replace("<", "\\u003c")}
    text = pathlib.Path(__file__).with_name("viewer.html").read_text(encoding="utf-8")
    return re.sub("TABLE|DATA", lambda found: parts[found[0]], text)
