# SPDX-License-Identifier: MIT
"""Writes the tables of measured numbers in the docs, between <!-- table: NAME --> and <!-- end -->, from results/docs.

    scripts/tables            rewrites them in README.md and docs/, and claims.json and expected.json in results/paper
    scripts/tables --check    changes nothing; fails if one of them differs from results/docs
    scripts/tables --list     names of all tables
    scripts/tables --stages FILE.json...   prints stage times of files of `clpv render --stats`, side by side

scripts/measure writes results/docs. Only the standard library.
"""
import functools
import json
import math
import pathlib
import re
import sys

from . import ROOT, RESULTS, expected, rows as known, verdicts
from .rows import PAPER, SHARED

BLOCK = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
TABLES = {}  # by name: function that returns lines of cells, the head first
MEASURED = {}  # by name: documents in place of files of results/docs
LOADED = set()  # files that tables of the current page use


def table(function):
    TABLES[function.__name__.replace("_", "-")] = function
    return function


@functools.cache
def read(name):
    if name in MEASURED:
        return MEASURED[name]
    return json.loads((RESULTS / f"docs/{name}.json").read_text(encoding="utf-8"))


def result(name):
    """A file of results/ by its name, "docs/claims"; tables that use one of results/docs say where it was measured."""
    folder, _, file = name.rpartition("/")
    if folder == "docs":
        return load(file)
    return json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))


def load(name):
    LOADED.add(name)
    return read(name)


def found(rows, **fields):
    """The one row with these fields; None where there is none."""
    matches = [row for row in rows if all(row.get(key) == value for key, value in fields.items())]
    if len(matches) > 1:
        sys.exit(f"scripts/tables: {len(matches)} rows have {fields}")
    return matches[0] if matches else None


# Cells: "-" for what was not measured.


def number(value):
    """Three digits: 0.48, 5.27, 20.4, 1801."""
    if value is None:
        return "-"
    return f"{value:.0f}" if value >= 99.95 else f"{value:.1f}" if value >= 9.995 else f"{value:.2f}"


def time(row):
    """Median and minimum [ms] of a row of `clpv bench`."""
    return f"{number(row['median'])} ({number(row['min'])})" if row else "-"


def ratio(a, b):
    return f"{number(a / b)}x" if a and b else "-"


def percent(value, digits=0):
    return "-" if value is None else f"{100 * value:.{digits}f}"


def summed(values):
    return None if None in values else round(sum(values), 3)


# Benchmarks.


def bench(suite):
    return load(suite)["benchmarks"]


TABLE1_BASES = "sh2", "srbf4", "srbf8v2"


def table1(shadows):
    """The paper's Table 1: of each basis the published time and the one measured here."""
    lines = [["[ms]"] + [f"{basis}, {column}" for basis in TABLE1_BASES for column in ("paper", "here")]
             + ["srbf8v2 / sh2, paper", "here"]]

    def add(title, published, here, spreads):
        times = [cell for a, b, s in zip(published, here, spreads)
                 for cell in ("-" if a is None else f"{a:g}", "-" if b is None else f"{number(b)} +- {number(s)}")]
        lines.append([title, *times, ratio(published[-1], published[0]), ratio(here[-1], here[0])])

    def at(stage, cascade, layout):
        rows = [found(bench("table1"), stage=stage, cascade=cascade, layout=layout, basis=basis, occlusion=shadows)
                for basis in TABLE1_BASES]
        return [[row and row[key] for row in rows] for key in ("published_ms", "median", "mad")]

    for layout in ("image", "soa"):
        terms = []
        for stage, name in (("inject-light", "injection"), ("inject-geometry", "geometry volume"),
                            ("propagate", "propagation"), ("gather", "light buffer")):
            if stage == "inject-geometry" and not shadows:
                continue
            for cascade, size in enumerate(("small", "medium", "big")) if stage != "gather" else ((None, None),):
                cells = at(stage, cascade, layout)
                if layout == "image":
                    add(f"{name}, {size}" if size else name, *cells)
                elif not shadows and stage == "propagate":
                    add(f"in buffers and constants: {name}, {size}", *cells)
                if stage != "inject-geometry":
                    terms.append(cells)
        published, here, spreads = zip(*terms)
        add("sum, without geometry volume" if layout == "image" else "in buffers and constants: the same sum",
            *([summed(column) for column in zip(*times)] for times in (published, here)), [math.hypot(*column) for column in zip(*spreads)])
    return lines


@table
def table1_shadows():
    return table1(shadows=True)


@table
def table1_no_shadows():
    return table1(shadows=False)


@table
def layouts():
    formats = ["image/half", "image/float", "aos/float", "soa/float", "soa/half", "tiled/float", "tiled/half"]
    lines = [["stage [ms]", *formats, "best over image/half"]]
    works = dict.fromkeys((row["stage"], row["basis"], row["occlusion"]) for row in bench("layouts"))
    for stage, basis, occlusion in works:
        rows = [found(bench("layouts"), stage=stage, basis=basis, occlusion=occlusion, filtered=True,
                      **dict(zip(("layout", "storage"), name.split("/")))) for name in formats]
        best = min(row["median"] for row in rows if row["layout"] != "image")
        lines.append([f"{stage} {basis}{', blockers' if occlusion else ''}", *map(time, rows),
                      ratio(rows[0]["median"], best)])
    return lines


@table
def bases():
    lines = [["basis", "N", "without blockers", "with blockers"]]
    rows = [row for row in bench("bases") if row["stage"] == "propagate" and row["lobe"] == "exact"]
    for basis, size in dict.fromkeys((row["basis"], row["n"]) for row in rows):
        lines.append([basis, str(size)] + [time(found(rows, basis=basis, occlusion=occlusion))
                                           for occlusion in (False, True)])
    return lines


def scaling(axis, stages, title):
    rows = [row for row in bench("scaling") if row["axis"] == axis]
    values = sorted({row["value"] for row in rows})
    lines = [[title, *(f"{value:.0f}" for value in values)]]
    for stage in stages:
        lines.append([f"{stage} [ms]"] + [number((found(rows, stage=stage, value=value) or {}).get("median"))
                                          for value in values])
    return lines


@table
def scaling_grid():
    lines = scaling("grid", ["propagate"], "cells along each axis")
    rows = [found(bench("scaling"), axis="grid", stage="propagate", value=int(value)) for value in lines[0][1:]]
    return lines + [["per cell and step [ns]"] + [number(row["median"] * 1e6 / (row["value"] ** 3 * row["iterations"]))
                                                  for row in rows]]


@table
def scaling_steps():
    return scaling("iterations", ["propagate"], "steps")


@table
def scaling_rsm():
    return scaling("rsm", ["rasterize-rsm", "inject"], "RSM, texels along each side")


@table
def scaling_triangles():
    return scaling("triangles", ["rasterize-rsm", "rasterize-camera"], "triangles")


@table
def ceilings():
    measured = load("layouts")["context"]["ceilings"]
    lines = [["multiply-adds [GFLOP/s]"], [number(measured["gflops"])]]
    for bandwidth in measured["bandwidths"]:
        lines[0].append(f"{bandwidth['working_set'] / 2**20:.3g} MiB [GB/s]")
        lines[1].append(number(bandwidth["gbps"]))
    return [[*lines[0], "a launch [us]"], [*lines[1], number(1e3 * measured["launch_ms"])]]


STAGES = ("rasterize-camera", "rasterize-shadow", "rasterize-rsm", "inject-light", "inject-geometry", "propagate", "gather",
          "near-trace", "near", "medium", "shade")


def stage_ms(frame, stage):
    times = [entry["ms"] for entry in frame["stages"] if entry["stage"] == stage] if frame else []
    return sum(times) if times else None


@table
def frames():
    return [["[ms]", "frame", *STAGES]] + [
        [name, number(frame and frame["frame_ms"]), *(number(stage_ms(frame, stage)) for stage in STAGES)]
        for name, frame in ((name, found(load("frames")["frames"], given=given)) for name, given in known.FRAMES.items())]


@table
def frames_recomputed():
    lines = [["recomputed", "frame [ms]", "blockers and visibility [ms]"]]
    for recompute, name in (("everything", "everything"), ("light", "light, as if lights had changed"),
                       ("nothing", "nothing: only the camera moves")):
        rows = [row for row in bench("frame") if row["recompute"] == recompute]
        parts = [row["median"] for row in rows if row["stage"] in ("blockers", "visibility")]
        lines.append([name, time(found(rows, stage="frame")), number(sum(parts)) if sum(parts) else "-"])
    return lines


@table
def rasterize():
    names = {"rasterize-camera": "camera, 960x540", "rasterize-shadow": "shadow map, 1024^2",
             "rasterize-rsm": "three RSMs, 256^2"}
    lines = [["", "clpv [ms]", "per triangle [ns]", "per pixel [ns]", "OpenGL [ms]", "OpenGL / clpv"]]
    for stage, name in names.items():
        ours, theirs = (found(bench("rasterize"), name=stage + peer) for peer in ("", "/opengl"))
        wall = ours["wall_ms"]
        lines.append([name, number(wall), number(1e6 * wall / ours["triangles"]), number(1e6 * wall / ours["pixels"]),
                      number(theirs["wall_ms"]), ratio(theirs["wall_ms"], wall)])
    return lines


@table
def baseline():
    lines = [["sh2", "OpenCL, minimum [ms]", "GFLOP/s", "of the ceiling", "C++, minimum [ms]", "GFLOP/s", "of the ceiling",
              "OpenCL / C++"]]
    for occlusion, name in ((False, "without blockers"), (True, "with blockers")):
        rows = [found(bench("native"), stage=stage, occlusion=occlusion)
                for stage in ("propagate", "native")]
        cells = [cell for row in rows for cell in (number(row["min"]), f"{row['gflops'] * row['median'] / row['min']:.0f}",
                                                   f"{100 * row['ceiling_share'] * row['median'] / row['min']:.0f} %")]
        lines.append([name, *cells, ratio(rows[0]["min"], rows[1]["min"])])
    return lines


# Quality: NRMSE of indirect light in %, and energy over the ground truth's.

VIEWS = {"curtains": "curtains", "atrium": "atrium", "columns": "columns", "front": "Cornell, front"}


def nrmse(name, options, **view):
    row = found(load(name)["cells"], options=options, **view)
    return percent(row and row["nrmse"])


def mean(name, options, digits=1):
    row = found(load(name)["variants"], options=options)
    return percent(row and row["nrmse"], digits)


def energy(row):
    return f"{row['energy_ratio']:.2f}" if row and row.get("energy_ratio") else "-"


def energies(name, options):
    return " ".join(energy(found(load(name)["cells"], options=options, camera=camera)) for camera in VIEWS)


def quality_lines(variants):
    lines = [["variant", *VIEWS.values(), "mean", "energy", "other suns, mean"]]
    for name, options in variants.items():
        lines.append([name] + [nrmse("quality", options, camera=camera) for camera in VIEWS]
                     + [mean("quality", options), energies("quality", options), mean("quality-suns", options)])
    return lines


@table
def quality():
    return quality_lines(known.QUALITY)


@table
def quality_parts():
    return quality_lines(known.QUALITY_PARTS)


@table
def quality_grid():
    lines = [["cells along each axis", "mean", "worst", "energy", "frame [ms]", "propagate [ms]", "gather [ms]"]]
    for grid in known.GRIDS:
        row = found(load("quality-grid")["variants"], options={**known.FAST, "grid": str(grid)})
        lines.append([str(grid), percent(row["nrmse"], 1), percent(row["worst_nrmse"], 1), f"{row['energy_ratio']:.2f}",
                      *map(number, (row["frame_ms"], row["stage_ms"]["propagate"], row["stage_ms"]["gather"]))])
    return lines


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
            rows = [row for row in load("quality-scenes")["cells"] if (row["scene"], row["options"]) == (scene, options)]
            if rows and all(row["nrmse"] is not None for row in rows):  # steps reject skies
                lines.append([name, label, ", ".join(f"{row['camera']} {percent(row['nrmse'])}" for row in rows),
                              percent(sum(row["nrmse"] for row in rows) / len(rows)), " ".join(map(energy, rows))])
    return lines


@table
def quality_media():
    lines = [["scene, camera", "sigma_s, sigma_a [1/m]", "bounces", "`medium`", "`indirect`"]]
    rows = {}  # cells by view
    for cell in load("quality-media")["cells"]:
        rows.setdefault((cell["scene"], cell["camera"], cell["medium"], cell["bounces"]), {})[cell["view"]] = cell
    for (scene, camera, medium, bounces), views in rows.items():
        lines.append([f"{scene}, {camera}", medium, bounces,
                      *(f"{percent(views[view]['nrmse'])} %, {energy(views[view])}" if view in views else "-"
                        for view in ("medium", "indirect"))])
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
    for truth, file, options, name in (
            ("one bounce", "quality-lamp", known.FAST, "`--preset fast`"),
            *(("all bounces", "quality-lamp-bounces", {**known.FAST, "bounces": n}, f"`--preset fast --bounces {n}`") for n in ("1", "2", "all"))):
        lines.append([truth, name] + [nrmse(file, options, camera=camera) for camera in ("front", "published")])
    return lines


@table
def quality_steps():
    lines = [["NRMSE [%], energy", *(f"{s['cascade-size']} m, {s['iterations']} steps" for s in known.SETTINGS)]]
    for name, options in known.STEPS.items():
        cells = [found(load("quality-steps")["cells"], options={**options, **setting}) for setting in known.SETTINGS]
        lines.append([name] + [f"{percent(row['nrmse'])}, {energy(row)}" if row else "-" for row in cells])
    return lines


@table
def readme():
    """Frame times beside errors."""
    lines = [["", "propagate", "gather", "frame", "error"]]
    for name, quality in {"the defaults": known.BEST, "`--preset fast`": known.FAST,
                          "published scheme, sh2, in buffers": PAPER,
                          "published scheme, sh2, in images of halves": PAPER}.items():
        frame = found(load("frames")["frames"], given=known.FRAMES[name])
        times = stage_ms(frame, "propagate"), stage_ms(frame, "gather"), frame and frame["frame_ms"]
        error = mean("quality", quality, 0)
        lines.append([name, *(f"{number(time)} ms" if time else "-" for time in times), "-" if error == "-" else f"{error} %"])
    return lines


# Bases: errors of clamped cosines, by scripts/claims.


@table
def basis_lobes():
    lines = [["basis", "N", "condition of A", "+z", "(-2,1,-3)", "(-2,1,-3), rotated", "mean", "minimum, +z",
              "energy after 8 / 24 steps"]]
    for row in load("claims")["lobes"]["sets"]:
        if ":" not in row["basis"]:
            lines.append([row["basis"], str(row["n"]), number(row["condition"])]
                         + [f"{row[key]:.3f}" for key in ("up", "oblique", "oblique_rotated", "mean", "minimum")] + [
                          f"{row['energy_sampled_8']:.3f} / {row['energy_sampled_24']:.3f}"])
    return lines


@table
def basis_tables():
    """Rotated lobes by the number of table entries."""
    rows = load("claims")["tables"]
    sizes = list(dict.fromkeys(row["entries"] for row in rows))
    lines = [["error along +z; energy after 8 steps", *(f"{size} entries" if size else "H computed" for size in sizes)]]
    for name in dict.fromkeys(row["basis"] for row in rows):
        cells = (found(rows, basis=name, entries=size) for size in sizes)
        lines.append([name, *(f"{row['up']:.3f}; {row['energy_sampled_8']:.3f}" for row in cells)])
    return lines


@table
def basis_guesses():
    """Other sets that fit the paper's description."""
    return [["set", "+z", "(-2,1,-3)", "mean"]] + [
        [row["basis"], *(f"{row[key]:.3f}" for key in ("up", "oblique", "mean"))]
        for row in load("claims")["lobes"]["sets"] if ":" in row["basis"]]


@table
def basis_lambdas():
    """Lobes along +z and light at `curtains`, by lambda."""
    names = ("sh2", "srbf4", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14")
    return [["lambda", *names, "4, 8v1, 8v3 worse than SH", "8v2 very similar to SH", "light: 8v2 and SH differ by", "*E* of 8v2"]] + [
        [f"{row['lambda']}", *(f"{row[name]:.3f}" if row[name] else "-" for name in names), *("yes" if row[rule] else "no" for rule in ("worse", "similar")),
         *(f"{row[key]:.3f}" for key in ("difference", "error"))] for row in load("claims")["lambdas"]]


@table
def basis_search():
    lines = [["N", "lambda 0.25", "best lambda", "bound", "over axes, best lambda"]]
    rows = load("claims")["lobes"]["searched"]
    for n in dict.fromkeys(row["n"] for row in rows):
        fixed, best = (found(rows, n=n, over="all", lambdas=lambdas) for lambdas in ("none", "one"))
        axes = found(rows, n=n, over="axes", lambdas="one")
        lines.append([str(n), f"{fixed['error']:.3f}", f"{best['error']:.3f} ({best['lambda']:.2f})", f"{fixed['bound']:.3f}",
                      f"{axes['error']:.3f}"])
    return lines


@table
def basis_images():
    """Errors of images by searched centres."""
    lines = [["NRMSE of indirect light, mean of four views [%]", "published scheme, exact lobes", "`--preset fast`"]]
    for name, options in known.CENTRES.items():
        lines.append([name, mean("quality-centres", {**known.EXACT_LOBES, **options}),
                      mean("quality-centres" if "centres" in options else "quality",
                           known.FAST if name == "sh3" else {**known.FAST, **options})])
    return lines


# Claims about light, by scripts/claims.


@table
def claims_light():
    lines = [["smallest cascade, steps", "sh2", "srbf8v2", "difference of both", "the same, RSM 1024^2"]]
    rows = load("claims")["light"]
    for row in (row for row in rows if row["rsm_size"] == 256):
        size, steps = row["cascade_size"], row["iterations"]
        large = found(rows, cascade_size=size, iterations=steps, rsm_size=1024)
        lines.append([f"{size:g} m, {steps} steps", *(f"{row[key]:.3f}" for key in ("sh2", "srbf8v2", "difference")),
                      f"{large['difference']:.3f}" if large else "-"])
    return lines


@table
def claims_views():
    """Errors of both bases by the published scheme, paired in twelve views."""
    views = load("claims")["views"]
    lines = [["E of sh2, srbf8v2 (difference)", *(f"{s['cascade_size']:g} m, {s['iterations']} steps" for s in views["summary"])]]
    for camera in dict.fromkeys(row["camera"] for row in views["rows"]):
        line = [camera.replace("-", ", ")]
        for setting in views["summary"]:
            sh, srbf = (next(row["nrmse"] for row in views["rows"] if row["camera"] == camera and row["basis"] == basis
                             and float(row["cascade-size"]) == setting["cascade_size"]
                             and int(row["iterations"]) == setting["iterations"]) for basis in ("sh2", "srbf8v2"))
            line.append(f"{sh:.3f}, {srbf:.3f} ({sh - srbf:+.3f})")
        lines.append(line)
    lines.append(["mean difference, standard error", *(f"{s['mean']:+.3f}, {s['standard_error']:.3f}" for s in views["summary"])])
    lines.append(["8v2 better", *(f"{s['srbf8v2_better']} of {s['views']}" for s in views["summary"])])
    return lines


@table
def claims_shadows():
    names = {"path traced": "path traced", "paper sh2": "published scheme, sh2",
             "paper srbf8v2": "published scheme, srbf8v2", "best": "the defaults",
             "paper sh2 64 16": "published scheme, sh2, 64^3 cells, 16 steps"}
    return [["contrast on the floor", "with indirect shadows", "without"]] + [
        [names[row["image"]], *("-" if row[key] is None else f"{row[key]:.2f}" for key in ("on", "off"))]
        for row in load("claims")["shadows"]["rows"]]


SHOWN = 6  # points of a claim whose numbers its line shows


def verdict_lines(section):
    """A line for each claim of a section."""
    lines = [["statement", "holds if", "verdict", "numbers", "command"]]
    for claim in verdicts.judged(result):
        if claim["section"] == section:
            points = [f"{point['at']}: {point['numbers']}" for point in claim["points"]]
            more = [f"{len(points) - SHOWN} more"] if len(points) > SHOWN + 1 else []
            command = f"`{claim['command']}`" if claim["command"].split()[0] in ("clpv", "python3", "scripts/claims") else claim["command"]
            lines.append([claim["statement"], claim["rule"], f"**{claim['verdict']}**" if len(claim["verdict"]) < 20 else claim["verdict"],
                          "; ".join(points[:SHOWN if more else None] + more), command])
    return lines


for each in ("theory", "lobes", "light", "shadows", "cost", "conclusions"):
    TABLES[f"verdicts-{each}"] = functools.partial(verdict_lines, each)


# One option at a time, by `clpv bench factors`.


@table
def factors():
    """A line for each row: times of both bases, their ratio and difference from the preset."""
    lines = [["changed from `--preset paper`", "sh2 [ms]", "srbf8v2 [ms]", "srbf8v2 / sh2", "propagation: srbf8v2 / sh2",
              "srbf8v2 over the preset's", "a light volume of srbf8v2 [MiB]", "difference: sh2", "srbf8v2"]]
    rows = [row for row in bench("factors") if row["stage"] == "sum"]
    preset = found(rows, basis="srbf8v2", changed="")

    def shown(row):
        return f"{number(row['median'])} +- {number(row['mad'])}"

    for changed in dict.fromkeys(row["changed"] for row in rows):
        sh, srbf = (found(rows, basis=basis, changed=changed) for basis in ("sh2", "srbf8v2"))
        steps = [found(bench("factors"), stage="propagate", basis=basis, changed=changed)["median"] for basis in ("srbf8v2", "sh2")]
        *before, last = changed.split(" ")
        title = f"and {last}" if before else f"only {last}" if last else "nothing: as published"
        lines.append([title, shown(sh), shown(srbf), ratio(srbf["median"], sh["median"]),
                      ratio(*steps), f"{preset['median'] / srbf['median']:.3g}x faster" if changed else "-",
                      number(srbf["volume_bytes"] / 2**20), f"{sh['difference']:.4f}", f"{srbf['difference']:.4f}"])
    return lines


# Figures: brightness over steps, by scripts/figures.


@table
def figures_brightness():
    rows = load("figures")["rows"]
    lines = [["mean luminance", *(f"{size} m, {steps} steps" for size in ("12.5", "50") for steps in (8, 24))]]
    exact = {name.replace("-", "_"): value for name, value in known.EXACT_LOBES.items() if name != "preset"}
    for name, variant in (("published scheme, sh2", {"basis": "sh2"}), ("published scheme, srbf8v2", {"basis": "srbf8v2"}),
                          ("published scheme, srbf14", {"basis": "srbf14"}),
                          ("srbf14, exact lobes", {"basis": "srbf14", **exact}),
                          ("srbf14, exact lobes and transport", {"basis": "srbf14", **exact, "transport": "exact"})):
        cells = []
        for size in (12.5, 50):
            fields = {"lobe": None, "transport": None, **variant, "cascade_size": size}
            row = found(rows, **fields)
            cells += [f"{row['mean_8']:.4f}", f"{row['mean_24']:.4f}"]
        lines.append([name, *cells])
    return lines


# The standing benchmark: docs/results.md.

METHODS = {"clpv": "**clpv, the defaults**", "clpv, near off": "clpv, `--preset fast`", "published scheme": "published scheme, sh2",
           **{name: f"`{name}`" for name in known.METHODS}}


def standing():
    """(name, document) of each device and commit."""
    return [(f"{i + 1}", json.loads(path.read_text(encoding="utf-8")))
            for i, path in enumerate(sorted((RESULTS / "quality").glob("*.json")))]


def standing_lines(group):
    """A line for each run and method: the error of each view, then means."""
    views = list(dict.fromkeys((cell["scene"], cell["camera"]) for _, document in standing() for cell in document[group]))
    lines = [["run", "NRMSE [%]", *(f"{scene}, {camera}" for scene, camera in views), "mean", "energy", "FLIP", "light [ms]"]]
    for run, document in standing():
        for method, title in METHODS.items():
            cells = [found(document[group], method=method, scene=scene, camera=camera) for scene, camera in views]
            there = [cell for cell in cells if cell and not cell["rejected"]]
            if there:
                def mean_of(get):
                    return sum(map(get, there)) / len(there)
                lines.append([run, title, *(percent(cell and cell["nrmse"]) for cell in cells),
                              percent(mean_of(lambda cell: cell["nrmse"]), 1), f"{mean_of(lambda cell: cell['energy_ratio']):.2f}",
                              f"{mean_of(lambda cell: cell['flip']):.3f}", number(mean_of(light_ms))])
    return lines


def light_ms(cell):
    """Time that baselines get: the frame without G-buffer, shadow maps and shading."""
    return cell["frame_ms"] - sum(cell["stage_ms"].get(stage, 0) for stage in SHARED)


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
    return [["run", "clpv", "device", "driver", "threads", "date", "time of 960x540 [ms]"]] + [
        [run, document["measured"]["commit"], document["measured"]["device"], document["measured"]["driver"],
         str(document["small"][0]["compute_units"]), document["measured"]["date"], number(document["time_of_large_ms"])]
        for run, document in standing()]


# The docs.


def drawn(lines):
    text = ["| " + " | ".join(line) + " |" for line in lines]
    return "\n".join([text[0], "|" + "---|" * len(lines[0]), *text[1:]]) + "\n"


def measured_on():
    """Commit, device and date of the page's tables: one line if one run of scripts/measure measured them all."""
    runs = {}
    for name in sorted(LOADED):
        measured = read(name)["measured"]
        key = f"clpv {measured['commit']}, {measured['device']}, {measured['driver']}, {measured['date']}"
        if "except" in measured:
            key += f"; except {measured['except']}"
        runs.setdefault(key, []).append(name)
    if len(runs) == 1:
        return f"Measured with {next(iter(runs))} (`results/docs`).\n"
    return "".join(f"- {', '.join(files)} (`results/docs`): {run}.\n" for run, files in runs.items())


def block(match):
    name = match[2]
    if name == "measured-on":
        return match[0]
    if name not in TABLES:
        sys.exit(f"scripts/tables: no table '{name}'; allowed: measured-on, {', '.join(TABLES)}")
    return match[1] + drawn(TABLES[name]()) + match[3]


def written(text):
    """The page with its tables, and where they were measured."""
    LOADED.clear()
    text = BLOCK.sub(block, text)
    return BLOCK.sub(lambda match: match[1] + measured_on() + match[3] if match[2] == "measured-on" else match[0], text)


# Stage times of `clpv render --stats`.


def stage_sums(stats):
    """Returns {stage: (ms, whether the host's clock measured it)}, in the order of the frame."""
    sums = {}
    for entry in stats["stages"]:
        ms, wall = sums.get(entry["stage"], (0.0, False))
        sums[entry["stage"]] = (ms + entry["ms"], wall or entry["timer"] == "wall")
    return sums


def milliseconds(value, wall=False):
    return f"{value:.2f}{' wall' if wall else ''}"


def print_stages(paths):
    """One column per file; sums over cascades and lights. `wall`: times of the host's clock, where event times are implausible."""
    stats = [json.loads(pathlib.Path(path).read_text(encoding="utf-8")) for path in paths]
    columns = [stage_sums(one) for one in stats]
    stages = list(dict.fromkeys(stage for column in columns for stage in column))
    rows = [["stage [ms]"] + [one["options"]["basis"] for one in stats]]
    for stage in stages:
        rows.append([stage] + [milliseconds(*column[stage]) if stage in column else "-" for column in columns])
    for key in ("frame_ms", "first_launch_ms", "build_ms", "startup_ms"):
        rows.append([key.removesuffix("_ms").replace("_", " ")] + [milliseconds(one[key]) for one in stats])
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for number, row in enumerate(rows):
        print("  ".join([row[0].ljust(widths[0])] + [text.rjust(width) for text, width in zip(row[1:], widths[1:])]))
        if number in (0, len(stages)):
            print("  ".join("-" * width for width in widths))
    device = stats[0]["device"]
    print(f"on {device['name']} ({device['platform']}, driver {device['driver']})")



def json_lines(document):
    """JSON with a line for each row of its lists and for each member of its objects."""
    members = []
    for key, value in document.items():
        if isinstance(value, dict) and value:
            lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(each)}" for name, each in value.items())
            members.append(f"{json.dumps(key)}: {{\n{lines}\n}}")
        else:
            lines = isinstance(value, list) and ",\n".join(map(json.dumps, value))
            members.append(f"{json.dumps(key)}: " + (f"[\n{lines}\n]" if lines else json.dumps(value)))
    return "{" + ",\n".join(members) + "}\n"


def main():
    arguments = sys.argv[1:]
    if arguments == ["--list"]:
        print("\n".join(["measured-on", *TABLES]))
        return 0
    if arguments[:1] == ["--stages"] and len(arguments) > 1:
        return print_stages(arguments[1:])
    if arguments not in ([], ["--check"]):
        sys.exit(__doc__.strip())
    differing = []
    for name, document in (("claims", {"claims": verdicts.judged(result)}), ("expected", expected.expected(result))):
        file = RESULTS / f"paper/{name}.json"
        text = json_lines(document)
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            differing.append(str(file.relative_to(ROOT)))
            if not arguments:
                file.parent.mkdir(exist_ok=True)
                file.write_text(text, encoding="utf-8")
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md"))]:
        text = page.read_text(encoding="utf-8")
        if written(text) != text:
            differing.append(str(page.relative_to(ROOT)))
            if not arguments:
                page.write_text(written(text), encoding="utf-8")
    if arguments and differing:
        print(f"{', '.join(differing)}: tables differ from results/docs; run scripts/tables", file=sys.stderr)
        return 1
    return 0

