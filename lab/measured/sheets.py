# SPDX-License-Identifier: MIT
"""Sheets of tiles with captions, for the pictures of the docs."""
import math

from . import output
from clpv.draw import style

FONT, LINE = 8.5, 8.5 * 1.45 / 72  # of captions: points, and inches from line to line


def sheet(path, title, columns, size, tiles, dpi=100, below=0, draw=style.pyplot.Axes.imshow,
          projection=None, **options):
    """Draws tiles (drawn, caption), row by row, under a title. PNG or JPEG, by the suffix.

    size: width and height of a tile [inches]; below: number of lines of a caption below its tile,
    0: one above. draw(axis, drawn, **options): what fills a tile. A tile of None stays empty."""
    caption, gap = max(1, below) * LINE + 0.06, 0.03
    heading = len(title.split("\n")) * 11 * 1.45 / 72 + 0.1
    rows = math.ceil(len(tiles) / columns)
    width, height = columns * (size[0] + gap) + gap, heading + rows * (size[1] + caption) + gap
    figure = style.pyplot.figure(figsize=(width, height), facecolor="white")
    figure.text(0.06 / width, 1 - 0.06 / height, title, fontsize=11, va="top", linespacing=1.35)
    y, anchor, offset = (0, "top", -1) if below else (1, "bottom", 3)
    for i, (drawn, text) in enumerate(tiles):
        if drawn is None:
            continue
        left = gap + i % columns * (size[0] + gap)
        top = heading + i // columns * (size[1] + caption) + (0 if below else caption)
        axis = figure.add_axes((left / width, 1 - (top + size[1]) / height, size[0] / width,
                                size[1] / height), projection=projection)
        axis.axis("off")
        axis.annotate(text, (0.5, y), xycoords="axes fraction", xytext=(0, offset),
                      textcoords="offset points", ha="center", va=anchor, fontsize=FONT,
                      linespacing=1.3, annotation_clip=False)
        draw(axis, drawn, **options)
    suffix = path.suffix.lstrip(".")
    saved = {"pil_kwargs": {"quality": 80, "optimize": True}} if suffix == "jpg" else {}
    output.write(path, style.rendered(figure, suffix, dpi=dpi, **saved))
