# SPDX-License-Identifier: MIT
"""Shadows (section 6)."""
from .judge import SIMILAR, claim, row


NAMES = {
    "paper sh2": "sh2",
    "paper srbf8v2": "srbf8v2",
    "paper sh2 64 16": "sh2 in 64^3 cells",
    "best": "the defaults",
}
SHADOWS = "scripts/reproduce --part shadows"


def contrasts(read, *images):
    rows = {each["image"]: each for each in read("docs/claims")["shadows"]["rows"]}
    return [(NAMES[name], rows[name]) for name in images or NAMES]


@claim("shadows", "image", SHADOWS)
def soft(read):
    """indirect shadows are too soft in both bases

    Holds if: contrast on the floor < 0.9 of the path-traced 1
    """
    for name, each in contrasts(read, "paper sh2", "paper srbf8v2"):
        yield name, each["on"] < 0.9, f"{each['on']:.2f}"


@claim("shadows", "basis", SHADOWS)
def few_cells(read):
    """so few cells make shadows soft

    Holds if: contrast of SH by 64^3 cells and 16 steps > by 32^3 and 8
    """
    (_, coarse), (_, fine) = contrasts(read, "paper sh2", "paper sh2 64 16")
    yield ("sh2", fine["on"] > coarse["on"], f"{coarse['on']:.2f}, {fine['on']:.2f}")


@claim("shadows", "image", SHADOWS)
def simulated(read):
    """shadows are still simulated

    Holds if: contrast with blockers > without
    """
    for name, each in contrasts(read):
        yield (name, each["on"] > each["off"], f"{each['on']:.2f}, without {each['off']:.2f}")


ARCADE = "scripts/reproduce --part arcade"


def of_arcade(read):
    """The path-traced shadow, and the rows of all images."""
    traced, *rows = read("docs/claims")["arcade"]
    return traced["on"], [({**NAMES, "64": "the defaults in 64^3 cells"}[each["image"]], each) for each in rows]


@claim("shadows", "image", ARCADE)
def columns(read):
    """columns cast shadows in indirect light (Figure 5)

    Holds if: on the wall behind the arcade, their part of the irradiance is at least half of the
    path-traced one
    """
    traced, rows = of_arcade(read)
    for name, each in rows:
        yield name, each["on"] >= traced / 2, f"{each['on']:.2f} of {traced:.2f}"


@claim("shadows", "image", ARCADE)
def by_blockers(read):
    """they come from the geometry volume

    Holds if: their part with blockers is at least twice that without
    """
    for name, each in of_arcade(read)[1]:
        yield name, each["on"] >= 2 * each["off"], f"{each['on']:.2f}, without {each['off']:.2f}"


@claim("shadows", "camera", "clpv quality --vary blockers=seen,scene")
def curtains(read):
    """curtains cannot block indirect light

    Holds if: the defaults with seen blockers: energy over the ground truth's above that with
    triangles by more than a tenth
    """
    cells = read("docs/quality")["cells"]
    for camera in ("curtains", "atrium", "columns"):
        seen, scene = (
            row(cells, camera=camera, options=options)["energy_ratio"]
            for options in ({"blockers": "seen", "preset": "fast"}, {"preset": "fast"})
        )
        yield (camera, seen > (1 + SIMILAR) * scene, f"{seen:.2f}, {scene:.2f}")
