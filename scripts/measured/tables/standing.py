# SPDX-License-Identifier: MIT
"""Tables of docs/results.md: the standing benchmark."""
import json

from clpv import ms_of

from .. import RESULTS, rows as known
from ..rows import SHARED
from .cells import found, number, percent, shown, table


METHODS = {
    "clpv": "**clpv, the defaults**", "clpv, near off": "clpv, `--preset fast`",
    "published scheme": "published scheme, sh2", **{name: f"`{name}`"
                                                    for name in known.METHODS}
}


def handed_in():
    """Scores of other renderers, as `python3 -m clpv_lab.score -o` writes them."""
    return [
        json.loads(path.read_text(encoding="utf-8"))
        for path in sorted((RESULTS / "quality/scores").glob("*.json"))
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
                f"{mean_of('energy_ratio'):.3f}", f"{mean_of('flip'):.3f}"
            ])
    return lines


def standing():
    """(name, document) of each device and commit."""
    return [(f"{i + 1}", json.loads(path.read_text(encoding="utf-8")))
            for i, path in enumerate(sorted((RESULTS / "quality").glob("*.json")))]


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
    return ms_of(cell["times"], "frame") - sum(ms_of(cell["times"], stage) for stage in SHARED)


@table
def standing_small():
    return standing_lines("small")


@table
def standing_time_of_large():
    return standing_lines("small_with_time_of_large")


@table
def standing_large():
    return standing_lines("large")


@table
def standing_runs():
    return shown({
        "run": "{run}", "clpv": "{measured[commit]}", "device": "{measured[device]}",
        "driver": "{measured[driver]}", "threads": "{small[0][compute_units]}",
        "date": "{measured[date]}", "time of 960x540 [ms]": "{time_of_large_ms:#}",
        "except": "{except}"
    }, [{**document, "run": run, "except": document["measured"].get("except", "-")}
        for run, document in standing()])
