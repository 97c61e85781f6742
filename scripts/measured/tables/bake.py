# SPDX-License-Identifier: MIT
"""Tables of docs/bake.md: errors of formats of light probes, verdicts, and leaks."""
from .. import bake as probes
from ..verdicts.judge import sentence
from .cells import found, load, number, table

RESOLVED = 0.5  # [points of %] smaller differences are none
PLACES = [(source, place) for source in probes.SOURCES for place in ("surface", "air")]
NAMES = {"pathtrace": "traced", "sweep": "swept", "surface": "surfaces", "air": "air"}
# (a, b): does a have a smaller error than b at equal bytes?
PAIRS = (("dice", "srbf8v2"), ("dice-srbf", "srbf8v2"), ("zh3", "srbf8v2"), ("zh3", "sh3"),
         ("zh3-hallucinated", "sh2"), ("srbf8v2", "sh2"), ("srbf14", "sh3"),
         ("ambient-cube-mean", "ambient-cube"), ("sh2", "ambient-cube"))


@table
def bake():
    rows, times = load("bake")["rows"], load("probes")["benchmarks"]
    lines = [[
        "format", "numbers", "bytes", "traced, coarse", "traced, fine", "swept, coarse",
        "swept, fine", "negative [%]", "look-up [ns]"
    ]]
    for name in dict.fromkeys(row["format"] for row in rows):
        one = next(row for row in rows if row["format"] == name)
        lines.append([f"`{name}`", str(one["numbers"]), str(one["bytes"])] + [
            ", ".join(f"{probes.mean(rows, name, source, place, fine):.1f}"
                      for place in ("surface", "air"))
            for source in probes.SOURCES for fine in (0, 1)
        ] + [f"{probes.mean(rows, name, 'pathtrace', 'negative', 1):.1f}",
             number(look_up_ns(found(times, name=f"probe/{name}")))])
    return lines


def look_up_ns(row):
    """Of one point."""
    return row["median"] * 1e6 / row["pixels"] if row and row["status"] == "ok" else None


@table
def bake_part():
    """Errors in a part of a scene, from coarse to dense probes."""
    rows = load("bake")["part"]
    columns = [(spacing, source) for source in probes.SOURCES for spacing in probes.PART_SPACINGS]
    lines = [["format", *(f"{NAMES[source]}, {spacing:g} m" for spacing, source in columns)]]
    for name in dict.fromkeys(row["format"] for row in rows):
        cells = [found(rows, format=name, spacing=spacing, source=source)
                 for spacing, source in columns]
        lines.append([f"`{name}`", *(f"{row['surface']:.1f}, {row['air']:.1f}" for row in cells)])
    return lines


def difference(rows, a, b, source, place):
    """Error of a minus that of b [%] at the middle of the bytes that both have."""
    lines = [probes.over_bytes(rows, name, source, place) for name in (a, b)]
    size = (max(line[0][0] for line in lines) * min(line[1][0] for line in lines))**0.5
    return probes.error_at(lines[0], size) - probes.error_at(lines[1], size)


@table
def bake_verdicts():
    rows = load("bake")["rows"]
    lines = [["at equal bytes of the volume", "verdict", "difference [points of %]"]]
    for a, b in PAIRS:
        points = []
        for source, place in PLACES:
            off = difference(rows, a, b, source, place)
            outcome = None if abs(off) < RESOLVED else off < 0
            points.append((f"{NAMES[source]} {NAMES[place]}", outcome, f"{off:+.1f}"))
        lines.append([f"`{a}` beats `{b}`", sentence("", points),
                      ", ".join(text for _, _, text in points)])
    return lines


@table
def bake_leaks():
    rows = load("bake-leaks")["rows"]
    columns = list(dict.fromkeys((row["room"], row["spacing"]) for row in rows))
    lines = [["format", *(f"{room}, {spacing:g} m" for room, spacing in columns)]]
    for name in dict.fromkeys(row["format"] for row in rows):
        leaks = {(row["room"], row["spacing"], row["filled"]): row["leak"]
                 for row in rows if row["format"] == name}
        lines.append([f"`{name}`"] + [
            ", ".join(number(leaks[*column, filled]) for filled in (True, False))
            for column in columns
        ])
    return lines
