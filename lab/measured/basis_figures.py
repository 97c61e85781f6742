# SPDX-License-Identifier: MIT
"""The paper's figures of bases and lobes (2, 3 and 6), as sheets of spherical plots."""
import numpy

from . import native, sphere
from .sheets import sheet

clpv = native()
BASES = ("sh2", "sh3", "sh4", "sh5", "srbf4", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14")
LAMBDA_ALONE = 0.4  # of Figure 2's single kernel
GRID = sphere.directions((46, 91))  # 4 degrees: facets appear smooth
ROOM = 1.13  # extent of a plot over its largest value; axes extend beyond the surface
COLUMNS = 5
SHEET = {"size": (2.0, 2.0), "dpi": 120, "below": 2, "projection": "3d",
         "draw": lambda axis, plotted: sphere.plot(axis, **plotted)}
MAIN_AXES = {"+x": (1, 0, 0), "-x": (-1, 0, 0), "+y": (0, 1, 0), "-y": (0, -1, 0),
             "+z": (0, 0, 1), "-z": (0, 0, -1)}
SLANTED = {"+z": (0, 0, 1), "(-2, 1, -3)": (-2, 1, -3)}
TABLE_SIZES = {"exact": None, "rotate": 256}  # of lobes, as clpv.Basis.clamped_cosine() takes them
METHODS = {"exact": "each projected exactly",
           "rotate": "SRBF: projected along +z, then rotated, as in the paper"}
# Neighbours differ strongly.
PALETTE = [(0.91, 0.31, 0.27), (0.27, 0.58, 0.85), (0.95, 0.70, 0.15), (0.25, 0.70, 0.48),
           (0.76, 0.35, 0.70), (0.22, 0.74, 0.76), (0.88, 0.81, 0.28), (0.58, 0.41, 0.27)]


def figure2(path):
    """The Abel-Poisson kernel; the eight functions of srbf8v2, joint and one by one."""
    basis, six = clpv.Basis("srbf8v2"), clpv.Basis("srbf6", bandwidth=LAMBDA_ALONE)
    alone = six.evaluate(GRID)[..., six.centres[:, 2].argmax()]
    eight = numpy.moveaxis(basis.evaluate(GRID), -1, 0).astype("f4")  # equal ones are equal
    peak, eight_peak = alone.max(), eight.max() * ROOM
    values, colours = sphere.joint(eight, PALETTE)
    tiles = [({"values": alone, "extent": peak * ROOM},
              f"lambda {LAMBDA_ALONE:g}\npeak {peak:.2f}"),
             ({"values": values, "colours": colours, "extent": eight_peak},
              f"all eight, lambda {basis.bandwidths[0]:g}\njoint")]
    for i, (kernel, centre) in enumerate(zip(eight, basis.centres)):
        colour = numpy.broadcast_to(PALETTE[i], (*kernel.shape, 3))
        corner = ", ".join(f"{numpy.sign(x):.0f}" for x in centre)
        tiles.append(({"values": kernel, "colours": colour, "extent": eight_peak},
                      f"b{i + 1} about\n({corner})"))
    sheet(path, "Figure 2: the Abel-Poisson kernel, and the eight functions of srbf8v2\n"
                "radius: the value", COLUMNS, tiles=tiles, **SHEET)


def cosine(name, axis):
    return {"values": numpy.maximum(0, GRID @ sphere.unit(axis))}, \
        f"max(0, cos), {name}"


def lobe(basis, kind, name, axis):
    coefficients = basis.clamped_cosine(axis, TABLE_SIZES[kind])
    errors = basis.lobe(axis, coefficients)
    return ({"values": basis.evaluate(GRID) @ coefficients,
             "outline": (sphere.unit(axis) / 2, 0.5)},
            f"{basis.name}, {name}\nerror {errors['relative_l2']:.3f}, min {errors['minimum']:.2f}")


def title(what, basis, kind):
    return (f"{what}; lambda {basis.bandwidths[0]:g}; {METHODS[kind]}\n"
            "blue: f > 0; red: f < 0; dashed: the clamped cosine; error: relative L2")


def draw(out, kind, bases=BASES):
    """Writes figures 2, 3 and 6, by lobes of that kind. Returns their names."""
    bases = [clpv.Basis(name) for name in bases]
    names = [f"lobes-{kind}/figure{number}.png" for number in (2, 3, 6)]
    figure2(out.file(names[0]))
    lines = []  # all bases for each axis; an axis starts a new row
    for along in SLANTED.items():
        lines += [cosine(*along), *(lobe(basis, kind, *along) for basis in bases)]
        lines += [(None, "")] * (-len(lines) % COLUMNS)
    sheet(out.file(names[1]), title("Figure 3: the clamped cosine along two axes", bases[-1], kind),
          COLUMNS, tiles=lines, **SHEET)
    columns = [cosine(*along) for along in MAIN_AXES.items()]  # one per axis; one row per basis
    columns += [lobe(basis, kind, *along) for basis in bases for along in MAIN_AXES.items()]
    sheet(out.file(names[2]),
          title("Figure 6: the clamped cosine along the six main axes", bases[-1], kind),
          len(MAIN_AXES), tiles=columns, **SHEET)
    return names
