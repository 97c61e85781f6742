# SPDX-License-Identifier: MIT
"""Style and output of all charts."""
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
    **dict.fromkeys(("text.color", "axes.labelcolor", "xtick.color", "ytick.color",
                     "legend.labelcolor"), INK),
    **dict.fromkeys(("axes.spines.top", "axes.spines.right", "legend.frameon"), False),
    **dict.fromkeys(("axes.grid", "axes.axisbelow"), True),
    "axes.edgecolor": SOFT,
    "grid.color": LINE,
    "grid.linewidth": 0.6,
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
