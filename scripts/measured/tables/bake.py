# SPDX-License-Identifier: MIT
"""Tables of docs/bake.md: errors of formats of light probes, and leaks."""
from .. import bake as probes
from .cells import found, load, number, table


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
