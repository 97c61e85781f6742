# SPDX-License-Identifier: MIT
"""Table of docs/bake.md: errors of formats of light probes, by `clpv bake --check 1000`."""
from .cells import load, table

COARSE, FINE = (0.1, 2), (0.05, 1)  # spacings [m]: of the Cornell boxes, of the others


def mean(rows, field, spacings, source):
    values = [row[field] for row in rows if row["spacing"] in spacings and row["source"] == source]
    return sum(values) / len(values)


@table
def bake():
    rows = load("bake")["rows"]
    lines = [[
        "format", "numbers", "bytes", "traced, coarse", "traced, fine", "swept, coarse",
        "swept, fine", "negative [%]"
    ]]
    for name in dict.fromkeys(row["format"] for row in rows):
        of = [row for row in rows if row["format"] == name]
        lines.append([f"`{name}`", str(of[0]["numbers"]), str(of[0]["bytes"])] + [
            f"{mean(of, 'surface', spacings, source):.1f}, {mean(of, 'air', spacings, source):.1f}"
            for source in ("pathtrace", "sweep") for spacings in (COARSE, FINE)
        ] + [f"{mean(of, 'negative', FINE, 'pathtrace'):.1f}"])
    return lines
