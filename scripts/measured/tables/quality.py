# SPDX-License-Identifier: MIT
"""Tables of docs/quality_results.md and README.md: NRMSE of indirect light in %, and energy over the ground
truth's."""
import json

from clpv import ms_of

from .. import ROOT, rows as known
from ..rows import PAPER
from .cells import found, load, number, percent, shown, table

# Methods of README.md, and stages whose time other methods do not get.
PEERS = {
    "clpv": "**clpv, the defaults**", "ddgi-converged": "DDGI, converged",
    "clpv, near off": "clpv, `--preset fast`", "paths-filtered": "path tracing, filtered",
    "vpl-interleaved": "virtual point lights, interleaved",
    "published scheme": "CLPV as published, four harmonics"
}
SHARED = "rasterize-camera", "rasterize-shadow", "shade"

VIEWS = {
    "curtains": "curtains", "atrium": "atrium", "columns": "columns", "front": "Cornell, front"
}


def nrmse(name, options, **view):
    row = found(load(name)["cells"], options=options, **view)
    return percent(row and row["nrmse"])


def mean(name, options, digits=1):
    row = found(load(name)["variants"], options=options)
    return percent(row and row["nrmse"], digits)


def energy(row):
    return f"{row['energy_ratio']:.2f}" if row and row.get("energy_ratio") else "-"


def energies(name, options):
    return " ".join(
        energy(found(load(name)["cells"], options=options, camera=camera)) for camera in VIEWS)


def quality_lines(variants):
    lines = [["variant", *VIEWS.values(), "mean", "energy", "other suns, mean"]]
    for name, options in variants.items():
        lines.append(
            [name] + [nrmse("quality", options, camera=camera) for camera in VIEWS] +
            [mean("quality", options),
             energies("quality", options),
             mean("quality-suns", options)])
    return lines


@table
def quality():
    return quality_lines(known.QUALITY)


@table
def quality_parts():
    return quality_lines(known.QUALITY_PARTS)


@table
def quality_grid():
    return shown({
        "cells along each axis": "{options[grid]}", "mean": "{nrmse:%1}",
        "worst": "{worst_nrmse:%1}", "energy": "{energy_ratio:.2f}", "frame [ms]": "{frame_ms:#}",
        "propagate [ms]": "{stage_ms[propagate]:#}", "gather [ms]": "{stage_ms[gather]:#}"
    }, [found(load("quality-grid")["variants"], options={**known.FAST, "grid": str(grid)})
        for grid in known.GRIDS])


@table
def quality_suns():
    views = list(VIEWS)[:3]
    return [["sun", "variant", *views]] + [
        [sun, name, *(nrmse("quality-suns", options, camera=f"{view}-{sun}") for view in views)]
        for sun in ("low", "noon", "cross") for name, options in known.SUNS.items()]


@table
def quality_scenes():
    lines = [["scene", "variant", "each view", "mean", "energy"]]
    for scene, name in (("atrium", "atrium, its sun"), ("atrium_overcast", "atrium, overcast"),
                        ("sponza_overcast", "Sponza, overcast")):
        for label, options in known.SUNS.items():
            rows = [
                row for row in load("quality-scenes")["cells"]
                if (row["scene"], row["options"]) == (scene, options)
            ]
            if rows and all(row["nrmse"] is not None for row in rows):  # steps reject skies
                lines.append([
                    name, label,
                    ", ".join(f"{row['camera']} {percent(row['nrmse'])}" for row in rows),
                    percent(sum(row["nrmse"] for row in rows) / len(rows)),
                    " ".join(map(energy, rows))
                ])
    return lines


@table
def quality_media():
    lines = [["scene, camera", "sigma_s, sigma_a [1/m]", "bounces", "`medium`", "`indirect`"]]
    rows = {}  # cells by view
    for cell in load("quality-media")["cells"]:
        rows.setdefault((cell["scene"], cell["camera"], cell["medium"], cell["bounces"]),
                        {})[cell["view"]] = cell
    for (scene, camera, medium, bounces), views in rows.items():
        lines.append([
            f"{scene}, {camera}", medium, bounces,
            *(f"{percent(views[view]['nrmse'])} %, {energy(views[view])}" if view in views else "-"
              for view in ("medium", "indirect"))
        ])
    return lines


@table
def quality_bounces():
    lines = [["variant", *VIEWS.values(), "mean", "energy"]]
    for name, options in known.BOUNCES.items():
        lines.append([name] + [nrmse("quality-bounces", options, camera=camera) for camera in VIEWS]
                     + [mean("quality-bounces", options), energies("quality-bounces", options)])
    return lines


@table
def quality_lamp():
    lines = [["ground truth", "variant", "front", "published"]]
    for truth, file, options, name in (("one bounce", "quality-lamp", known.FAST,
                                        "`--preset fast`"),
                                       *(("all bounces", "quality-lamp-bounces", {
                                           **known.FAST, "bounces": n
                                       }, f"`--preset fast --bounces {n}`")
                                         for n in ("1", "2", "all"))):
        lines.append([truth, name] +
                     [nrmse(file, options, camera=camera) for camera in ("front", "published")])
    return lines


@table
def quality_steps():
    lines = [[
        "NRMSE [%], energy",
        *(f"{s['cascade-size']} m, {s['iterations']} steps" for s in known.SETTINGS)
    ]]
    for name, options in known.STEPS.items():
        cells = [
            found(load("quality-steps")["cells"], options={**options, **setting})
            for setting in known.SETTINGS
        ]
        lines.append([name] +
                     [f"{percent(row['nrmse'])}, {energy(row)}" if row else "-" for row in cells])
    return lines


BOUNCES = {1: "one", 2: "two"}


def short(value):
    return "0" if value < 0.0005 else f"{value:.2g}" if value < 10 else f"{value:.0f}"


def leak(**fields):
    row = found(load("leaks")["leaks"], **fields)
    return "-" if row is None else short(row["leak"])


@table
def leaks():
    columns = known.LEAKS["columns"]
    return [["walls", "thickness over cell", *(f"{a}, {BOUNCES.get(b, b)}" for a, b in columns)]] + [
        [*titles, *(leak(shape=shape, light=light, bounces=b) for light, b in columns)]
        for shape, titles in known.SEALED.items()]


@table
def leaks_open():
    columns = [column for column in known.LEAKS["columns"] if column[1] != "direct"]
    lines = [["room", *(f"{a}, {BOUNCES.get(b, b)}" for a, b in columns)]]
    for shape, title in known.OPEN_ROOMS.items():
        rows = [found(load("leaks")["leaks"], shape=shape, light=light, bounces=b)
                for light, b in columns]
        lines.append([title, *(f"{short(row['leak'])} ({short(row['truth'])})" for row in rows)])
    return lines


@table
def readme():
    """Frame times beside errors, of the same frames."""
    return shown({
        "": "{name}", "propagation": "{stage_ms[propagate]:#} ms", "frame": "{frame_ms:#} ms",
        "error": "{nrmse:%0} %"
    }, [{**found(load("quality")["variants"], options=options), "name": name}
        for name, options in (("the defaults", known.BEST), ("`--preset fast`", known.FAST),
                              ("published scheme, sh2", PAPER))])


@table
def readme_peers():
    """Mean errors of clpv and other methods with the same time, over the views of the first device
    that has them."""
    path = sorted((ROOT / "lab/results/quality").glob("*.json"))[0]
    cells = json.loads(path.read_text(encoding="utf-8"))["small"]
    lines = [["method", "error", "in Sponza, `columns`", "time of light"]]
    for method, title in PEERS.items():
        rows = [cell for cell in cells if cell["method"] == method]
        light = sum(ms_of(row["times"], "frame") - sum(ms_of(row["times"], stage)
                                                       for stage in SHARED) for row in rows)
        columns = found(rows, scene="sponza", camera="columns")
        lines.append([title, f"{100 * sum(row['nrmse'] for row in rows) / len(rows):.1f} %",
                      f"{100 * columns['nrmse']:.0f} %", f"{number(light / len(rows))} ms"])
    return lines
