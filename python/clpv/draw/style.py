# SPDX-License-Identifier: MIT
"""Style and output of all charts, and sheets of tiles."""
import io
import math

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot, ticker  # noqa: E402  (the backend comes first)

from clpv import output  # noqa: E402

INK, SOFT, LINE = "#1c1e21", "#5d646e", "#d8dce1"
# Distinguishable by colour-blind readers (Okabe and Ito).
COLOURS = ["#0072b2", "#e69f00", "#009e73", "#d55e00", "#56b4e9", "#cc79a7", "#8c8c00", "#5a5a5a"]
SHORT = 500  # a logarithmic axis with a smaller range also labels 2 and 5

matplotlib.rcParams.update({
    "svg.hashsalt": "clpv",  # reproducible bytes
    "svg.fonttype": "none",
    "text.parse_math": False,  # dollar signs in names are literal
    "font.size": 9,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": SOFT,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": LINE,
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "legend.frameon": False,
    "legend.labelcolor": INK,
})


def colour(i):
    return COLOURS[i % len(COLOURS)]


def logarithmic(axis):
    """Makes the x or y axis logarithmic, with plain numbers. Call after plotting."""
    (axis.axes.set_xscale if axis is axis.axes.xaxis else axis.axes.set_yscale)("log")
    low, high = axis.get_view_interval()
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5) if high < SHORT * low else (1,)))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(ticker.NullFormatter())


def rendered(figure, suffix, **options):
    """Returns the bytes of a file of that format, without a date; closes the figure."""
    out = io.BytesIO()
    if suffix == "svg":  # no creator or date: reproducible bytes
        options["metadata"] = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    figure.savefig(out, format=suffix, **options)
    pyplot.close(figure)
    return out.getvalue()


def panels(count, columns, size):
    """Returns a figure of `count` panels in rows, each of that size [inches], and their axes."""
    columns = min(columns, count)
    rows = math.ceil(count / columns)
    figure, axes = pyplot.subplots(rows, columns, figsize=(size[0] * columns, size[1] * rows),
                                   squeeze=False)
    for axis in list(axes.flat)[count:]:
        axis.axis("off")
    return figure, list(axes.flat)[:count]


class Sheet:
    """Tiles of one size in rows, each with caption lines below or above, under title lines."""

    def __init__(self, title, columns, count, tile, caption_lines=1, above=False, font=8.5):
        """`tile`: width and height [inches] without captions."""
        self.above, self.font = above, font
        self.line = font * 1.45 / 72
        caption, gap = caption_lines * self.line + 0.06, 0.03
        heading = len(title) * 11 * 1.45 / 72 + 0.1
        rows = math.ceil(count / columns)
        width, height = columns * (tile[0] + gap) + gap, heading + rows * (tile[1] + caption) + gap
        self.figure = pyplot.figure(figsize=(width, height), facecolor="white")
        self.figure.text(0.06 / width, 1 - 0.06 / height, "\n".join(title), fontsize=11, va="top",
                         linespacing=1.35)
        self.places = []
        for i in range(count):
            left = gap + i % columns * (tile[0] + gap)
            top = heading + i // columns * (tile[1] + caption) + (caption if above else 0)
            self.places.append(
                (left / width, 1 - (top + tile[1]) / height, tile[0] / width, tile[1] / height))

    def tile(self, i, caption):
        """Returns the empty axes of tile i, with its caption."""
        axis = self.figure.add_axes(self.places[i])
        axis.axis("off")
        y, anchor, offset = (1, "bottom", 3) if self.above else (0, "top", -1)
        axis.annotate(caption, (0.5, y), xycoords="axes fraction", xytext=(0, offset),
                      textcoords="offset points", ha="center", va=anchor, fontsize=self.font,
                      linespacing=1.3, annotation_clip=False)
        return axis

    def save(self, path, dpi):
        """Writes PNG or JPEG, by the suffix."""
        suffix = path.suffix.lstrip(".")
        options = {"pil_kwargs": {"quality": 80, "optimize": True}} if suffix == "jpg" else {}
        output.write(path, rendered(self.figure, suffix, dpi=dpi, **options))
