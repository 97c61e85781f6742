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
    return traced["on"], [({**NAMES, "64": "the defaults in 64^3 cells"}[each["image"]], each)
                          for each in rows]


@claim("shadows", "image", ARCADE)
def columns(read):
    """columns cast shadows beside the light that passes through curtains (Figure 5)

    Holds if: the wall behind the arcade is darker behind columns than behind curtains, by more
    than a tenth
    """
    traced, rows = of_arcade(read)
    for name, value in [("path traced", traced), *((name, each["on"]) for name, each in rows)]:
        yield name, value > 0.1, f"{value:+.2f}"


@claim("shadows", "image", ARCADE)
def arcade_soft(read):
    """the arcade's shadows are too soft

    Holds if: they are less than half of the path-traced ones
    """
    traced, rows = of_arcade(read)
    for name, each in rows:
        yield name, abs(each["on"]) < abs(traced) / 2, f"{each['on']:+.2f} of {traced:+.2f}"


@claim("shadows", "image", ARCADE)
def arcade_simulated(read):
    """they are still simulated

    Holds if: they are at least twice those without blockers
    """
    for name, each in of_arcade(read)[1]:
        yield (
            name,
            abs(each["on"]) >= 2 * abs(each["off"]),
            f"{each['on']:+.3f}, without {each['off']:+.3f}",
        )


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
