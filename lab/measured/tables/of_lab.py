# SPDX-License-Identifier: MIT
"""Tables of the lab's pages: other methods and renderers, and formats of light probes."""
import functools
import json

from clpv import ms_of

from .. import ROOT, bake as probes, rows as known
from ..cells import TABLES, Form, found, load, number, percent, shown, table
from ..verdicts import sentence

RESULTS = ROOT / "lab/results/quality"


METHODS = {
    "clpv": "**clpv, the defaults**", "clpv, near off": "clpv, `--preset fast`",
    "published scheme": "published scheme, sh2", **{name: f"`{name}`"
                                                    for name in known.METHODS}
}


def handed_in():
    """Scores of other renderers, as `python3 -m clpv_lab.score -o` writes them."""
    return [
        json.loads(path.read_text(encoding="utf-8"))
        for path in sorted((RESULTS / "scores").glob("*.json"))
    ]


@table
def scores():
    """A line for each method and scene: means over its views."""
    lines = [["method", "scene", "views", "NRMSE [%]", "bias [%]", "noise [%]", "energy", "FLIP"]]
    for document in handed_in():
        scenes = {}
        for row in document["views"]:
            scenes.setdefault(row["view"].partition("-")[0], []).append(row)
        for scene, rows in scenes.items():
            def mean_of(name, rows=rows):
                values = [row.get(name) for row in rows]
                return None if None in values else sum(values) / len(values)

            lines.append([
                document["method"], scene,
                str(len(rows)), *(percent(mean_of(name), 1) for name in ("nrmse", "bias", "noise")),
                *(Form().format("{0:.3f}", mean_of(name)) for name in ("energy_ratio", "flip"))
            ])
    return lines


def standing():
    """(name, document) of each device and commit."""
    return [(f"{i + 1}", json.loads(path.read_text(encoding="utf-8")))
            for i, path in enumerate(sorted(RESULTS.glob("*.json")))]


def standing_lines(group):
    """A line for each run and method: the error of each view, then means."""
    views = list(
        dict.fromkeys((cell["scene"], cell["camera"]) for _, document in standing()
                      for cell in document[group]))
    lines = [[
        "run", "NRMSE [%]", *(f"{scene}, {camera}" for scene, camera in views), "mean", "energy",
        "FLIP", "light [ms]"
    ]]
    for run, document in standing():
        for method, title in METHODS.items():
            cells = [
                found(document[group], method=method, scene=scene, camera=camera)
                for scene, camera in views
            ]
            there = [cell for cell in cells if cell and not cell["rejected"]]
            if there:
                def mean_of(get):
                    return sum(map(get, there)) / len(there)
                lines.append([
                    run, title, *(percent(cell and cell["nrmse"]) for cell in cells),
                    percent(mean_of(lambda cell: cell["nrmse"]),
                            1), f"{mean_of(lambda cell: cell['energy_ratio']):.2f}",
                    f"{mean_of(lambda cell: cell['flip']):.3f}",
                    number(mean_of(light_ms))
                ])
    return lines


def light_ms(cell):
    """Time that baselines get: the frame without G-buffer, shadow maps and shading."""
    return ms_of(cell["times"], "frame") - sum(
        ms_of(cell["times"], stage) for stage in known.SHARED)


for name, group in (("small", "small"), ("time-of-large", "small_with_time_of_large"), ("large", "large")):
    TABLES[f"standing-{name}"] = functools.partial(standing_lines, group)


@table
def standing_runs():
    return shown({
        "run": "{run}", "clpv": "{measured[commit]}", "device": "{measured[device]}",
        "driver": "{measured[driver]}", "threads": "{small[0][compute_units]}",
        "date": "{measured[date]}", "time of 960x540 [ms]": "{time_of_large_ms:#}",
        "except": "{except}"
    }, [{**document, "run": run, "except": document["measured"].get("except", "-")}
        for run, document in standing()])


# Formats of light probes: probes.md.

RESOLVED = 0.5  # [points of %] smaller differences are none
PLACES = [(source, place) for source in probes.SOURCES for place in ("surface", "air")]
NAMES = {"pathtrace": "traced", "sweep": "swept", "surface": "surfaces", "air": "air"}
# (a, b): does a have a smaller error than b at equal bytes?
PAIRS = (("zh3", "srbf8v2"), ("zh3", "sh3"), ("srbf8v2", "sh2"), ("srbf14", "sh3"),
         ("ambient-cube-mean", "ambient-cube"), ("sh2", "ambient-cube"))


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
