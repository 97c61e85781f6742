# SPDX-License-Identifier: MIT
"""Tables of docs/bake_results.md: errors of formats of light probes, and leaks."""
from .. import bake as probes
from .cells import load, number, table


@table
def bake():
    rows = load("bake")["rows"]
    lines = [[
        "format", "numbers", "bytes", "traced, coarse", "traced, fine", "swept, coarse",
        "swept, fine", "negative [%]"
    ]]
    for name in dict.fromkeys(row["format"] for row in rows):
        one = next(row for row in rows if row["format"] == name)
        lines.append([f"`{name}`", str(one["numbers"]), str(one["bytes"])] + [
            ", ".join(f"{probes.mean(rows, name, source, place, fine):.1f}"
                      for place in ("surface", "air"))
            for source in probes.SOURCES for fine in (0, 1)
        ] + [f"{probes.mean(rows, name, 'pathtrace', 'negative', 1):.1f}"])
    return lines


@table
def bake_leaks():
    rows = load("bake-leaks")["rows"]
    columns = list(dict.fromkeys((row["room"], row["spacing"]) for row in rows))
    lines = [["format", *(f"{room}, {spacing:g} m" for room, spacing in columns)]]
    for name in ("sh2", "sh2-geomerics", "sh3"):  # others differ little
        leaks = {(row["room"], row["spacing"], row["filled"]): row["leak"]
                 for row in rows if row["format"] == name}
        lines.append([f"`{name}`"] + [
            ", ".join(number(leaks[*column, filled]) for filled in (True, False))
            for column in columns
        ])
    return lines
