# SPDX-License-Identifier: MIT
"""The paper's figures of bases and lobes (2, 3 and 6), as sheets of spherical plots.

figures.json: "lambda" of all bases; "lobe": exact or rotate; "kernels": "lambda" and "centre" of a
single kernel, then of those of srbf8v2; "lobes": "basis", "axis", "relative_l2" and "minimum" of
each. surfaces.npy: their values on the grid of sphere.py, kernels first, in the same order.
"""
import pathlib

import numpy

from clpv.draw import documents, sphere, style

ROOM = 1.13  # extent of a plot over its largest value; axes extend beyond the surface
TILE, DPI = (2.0, 2.0), 120
COLUMNS = 5
MAIN_AXES = {
    "+x": (1, 0, 0), "-x": (-1, 0, 0), "+y": (0, 1, 0), "-y": (0, -1, 0), "+z": (0, 0, 1),
    "-z": (0, 0, -1)
}
SLANTED = {"+z": (0, 0, 1), "(-2, 1, -3)": (-2, 1, -3)}
# Linear colours; neighbours differ strongly.
PALETTE = [(0.80, 0.08, 0.06), (0.06, 0.30, 0.70), (0.90, 0.45, 0.02), (0.05, 0.45, 0.20),
           (0.55, 0.10, 0.45), (0.04, 0.50, 0.55), (0.75, 0.62, 0.05), (0.30, 0.14, 0.06)]


def sheet(title, columns, tiles):
    """A sheet of tiles (caption, arguments of sphere.plot); None leaves a tile empty."""
    made = style.Sheet(title, columns, len(tiles), TILE, caption_lines=2)
    for i, tile in enumerate(tiles):
        if tile:
            caption, plotted = tile
            sphere.plot(made.tile(i, caption), **plotted)
    return made


def painted(values, colour):
    return numpy.broadcast_to(colour, (*values.shape, 3))


def figure2(document, kernels):
    alone, eight = kernels[0], kernels[1:]
    peak, eight_peak = alone.max(), eight.max() * ROOM
    values, colours = sphere.joint(eight, PALETTE)
    tiles = [(f"lambda {document['kernels'][0]['lambda']:g}\npeak {peak:.2f}",
              {"values": alone, "extent": peak * ROOM}),
             (f"all eight, lambda {document['lambda']:g}\njoint",
              {"values": values, "colours": colours, "extent": eight_peak})]
    for i, (kernel, row) in enumerate(zip(eight, document["kernels"][1:])):
        corner = ", ".join(f"{numpy.sign(x):.0f}" for x in row["centre"])
        tiles.append(
            (f"b{i + 1} about\n({corner})",
             {"values": kernel, "colours": painted(kernel, PALETTE[i]), "extent": eight_peak}))
    return sheet([
        "Figure 2: the Abel-Poisson kernel, and the eight functions of srbf8v2", "radius: the value"
    ], COLUMNS, tiles)


class Lobes:
    """Lobes by basis and axis, and the clamped cosine that they approximate."""

    def __init__(self, document, surfaces):
        self.rows = document["lobes"]
        self.surfaces = surfaces
        self.bases = list(dict.fromkeys(row["basis"] for row in self.rows))
        method = {
            "exact": "each projected exactly",
            "rotate": "SRBF: projected along +z, then rotated, as in the paper"
        }[document["lobe"]]
        self.about = [f"; lambda {document['lambda']:g}; {method}",
                      "blue: f > 0; red: f < 0; dashed: the clamped cosine; error: relative L2"]

    def cosine(self, name, axis):
        values = numpy.maximum(
            0,
            sphere.directions(self.surfaces.shape[1:]) @ sphere.unit(numpy.array(axis, float)))
        return f"max(0, cos), {name}", {"values": values}

    def lobe(self, basis, name, axis):
        axis = sphere.unit(numpy.array(axis, float))
        i, row = next((i, row) for i, row in enumerate(self.rows)
                      if row["basis"] == basis and numpy.dot(row["axis"], axis) > 1 - 1e-9)
        return (f"{basis}, {name}\nerror {row['relative_l2']:.3f}, min {row['minimum']:.2f}",
                {"values": self.surfaces[i], "outline": (axis / 2, 0.5)})

    def title(self, what):
        return [what + self.about[0], self.about[1]]


def figure3(lobes):
    """All bases for each axis; an axis starts a new row."""
    columns = min(COLUMNS, 1 + len(lobes.bases))
    tiles = []
    for name, axis in SLANTED.items():
        tiles += [lobes.cosine(name, axis)
                  ] + [lobes.lobe(basis, name, axis) for basis in lobes.bases]
        tiles += [None] * (-len(tiles) % columns)
    return sheet(lobes.title("Figure 3: the clamped cosine along two axes"), columns, tiles)


def figure6(lobes):
    """One column per axis, one row per basis."""
    tiles = [lobes.cosine(name, axis) for name, axis in MAIN_AXES.items()]
    tiles += [
        lobes.lobe(basis, name, axis) for basis in lobes.bases for name, axis in MAIN_AXES.items()
    ]
    return sheet(lobes.title("Figure 6: the clamped cosine along the six main axes"),
                 len(MAIN_AXES), tiles)


def draw(source: pathlib.Path, folder: pathlib.Path) -> None:
    document = documents.read(source / "figures.json")
    surfaces = numpy.load(source / "surfaces.npy")
    kernels = len(document["kernels"])
    lobes = Lobes(document, surfaces[kernels:])
    for name, made in (("figure2", figure2(document, surfaces[:kernels])),
                       ("figure3", figure3(lobes)), ("figure6", figure6(lobes))):
        made.save(folder / f"{name}.png", DPI)
