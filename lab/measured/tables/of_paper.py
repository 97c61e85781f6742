# SPDX-License-Identifier: MIT
"""Tables of docs/bases.md, docs/paper/, docs/benchmark_results.md and docs/gpu.md: errors of
clamped cosines, claims, brightness over steps, and times by `clpv bench` and `clpv render
--stats`. tables.json has their columns."""
import functools
import json
import math

from clpv import ms_of

from .. import ROOT, rows as known, verdicts
from ..cells import (TABLES, crossed, found, load, number, ratio, result, rows, summed,
                     table, time)
from .of_light import mean

TABLE1_BASES = "sh2", "srbf4", "srbf8v2"
STAGES = ("frame", "rasterize-camera", "rasterize-shadow", "rasterize-rsm", "inject-light",
          "inject-geometry", "propagate", "gather", "near-trace", "near", "medium", "shade")
SHOWN = 6  # points of a claim whose numbers its line shows


@rows
def sets(named):
    """Errors of the named sets, or of other guesses."""
    return [row for row in load("claims")["lobes"]["sets"] if (":" not in row["basis"]) == named]


@table
def basis_tables():
    """Rotated lobes by the number of table entries."""
    lines = load("claims")["tables"]

    def cell(name, size):
        row = found(lines, basis=name, entries=size)
        return f"{row['up']:.3f}; {row['energy_sampled_8']:.3f}"

    sizes = dict.fromkeys(row["entries"] for row in lines)
    return crossed("error along +z; energy after 8 steps",
                   {f"{size} entries" if size else "H computed": size for size in sizes},
                   {row["basis"]: row["basis"] for row in lines}, cell)


@rows
def searches():
    lines = json.loads((ROOT / "lab/results/centres/searched.json").read_text())["sets"]
    for n in dict.fromkeys(row["n"] for row in lines):
        yield {"n": n, "fixed": found(lines, n=n, over="all", lambdas="none"),
               "best": found(lines, n=n, over="all", lambdas="one"),
               "axes": found(lines, n=n, over="axes", lambdas="one")}


@rows
def of_centres():
    """Errors of images by searched centres."""
    for name, options in known.CENTRES.items():
        yield {"name": name,
               "published": mean("quality-centres", {**known.EXACT_LOBES, **options}),
               "fast": mean("quality-centres" if "centres" in options else "quality",
                            {**known.FAST, **options})}


@rows
def of_light():
    lines = load("claims")["light"]
    for row in lines:
        if row["rsm_size"] == 256:
            large = found(lines, cascade_size=row["cascade_size"], iterations=row["iterations"],
                          rsm_size=1024)
            yield {**row, "large": large or {"difference": None}}


@table
def claims_views():
    """Errors of both bases by the published scheme, paired in twelve views."""
    views = load("claims")["views"]

    def cell(camera, setting):
        sh, srbf = (found(views["rows"], camera=camera, basis=basis,
                          iterations=str(setting["iterations"]),
                          **{"cascade-size": f"{setting['cascade_size']:g}"})["nrmse"]
                    for basis in ("sh2", "srbf8v2"))
        return f"{sh:.3f}, {srbf:.3f} ({sh - srbf:+.3f})"

    settings = {f"{each['cascade_size']:g} m, {each['iterations']} steps": each
                for each in views["summary"]}
    cameras = {row["camera"].replace("-", ", "): row["camera"] for row in views["rows"]}
    ends = {"mean difference, standard error": "{mean:+.3f}, {standard_error:.3f}",
            "8v2 better": "{srbf8v2_better} of {views}"}
    return [*crossed("E of sh2, srbf8v2 (difference)", settings, cameras, cell),
            *crossed("", settings, ends, lambda form, each: form.format(**each))[1:]]


@rows
def contrasts(names):
    return [{**row, "title": names[row["image"]]} for row in load("claims")["shadows"]["rows"]]


def verdict_lines(section):
    """A line for each claim of a section."""
    lines = [["statement", "holds if", "verdict", "numbers", "command"]]
    for claim in verdicts.judged(result, section):
        points = [f"{point['at']}: {point['numbers']}" for point in claim["points"]]
        more = [f"{len(points) - SHOWN} more"] if len(points) > SHOWN + 1 else []
        command = f"`{claim['command']}`" if claim["command"].split()[0] in (
            "clpv", "python3", "scripts/reproduce") else claim["command"]
        verdict = f"**{claim['verdict']}**" if len(claim["verdict"]) < 20 else claim["verdict"]
        numbers = "; ".join(points[:SHOWN if more else None] + more)
        lines.append([claim["statement"], claim["rule"], verdict, numbers, command])
    return lines


for each in dict.fromkeys(claim["section"] for claim in verdicts.CLAIMS):
    TABLES[f"verdicts-{each}"] = functools.partial(verdict_lines, each)


@rows
def brightness(variants):
    """Mean luminance over steps, by scripts/reproduce."""
    for name, basis, exact in variants:
        lobes = {key.replace("-", "_"): value for key, value in known.EXACT_LOBES.items()
                 if key != "preset" and exact}
        fields = {"lobe": None, **lobes, "transport": "exact" if exact == "transport" else None}
        yield {"name": name, "sizes": [found(load("figures")["rows"], basis=basis, **fields,
                                             cascade_size=size) for size in (12.5, 50)]}


# Times.


def bench(suite):
    return load(suite)["benchmarks"]


def table1(shadows):
    """The paper's Table 1: of each basis the published time and the one measured here."""
    lines = [["[ms]"] +
             [f"{basis}, {column}" for basis in TABLE1_BASES
              for column in ("paper", "here")] + ["srbf8v2 / sh2, paper", "here"]]

    def add(title, published, here, spreads):
        times = [
            cell for a, b, s in zip(published, here, spreads)
            for cell in ("-" if a is None else f"{a:g}",
                         "-" if b is None else f"{number(b)} +- {number(s)}")
        ]
        lines.append([title, *times, ratio(published[-1], published[0]), ratio(here[-1], here[0])])

    def at(stage, cascade, layout):
        cells = [found(bench("table1"), stage=stage, cascade=cascade, layout=layout, basis=basis,
                       occlusion=shadows) for basis in TABLE1_BASES]
        return [[row and row[key] for row in cells] for key in ("published_ms", "median", "mad")]

    stages = [("inject-light", "injection"), ("propagate", "propagation"),
              ("gather", "light buffer")]
    if shadows:
        stages.insert(1, ("inject-geometry", "geometry volume"))
    for layout in ("image", "soa"):
        terms = []
        for stage, name in stages:
            for cascade, size in (enumerate((", small", ", medium", ", big")) if stage != "gather"
                                  else [(None, "")]):
                cells = at(stage, cascade, layout)
                if layout == "image":
                    add(name + size, *cells)
                elif not shadows and stage == "propagate":
                    add(f"in buffers and constants: {name}{size}", *cells)
                if stage != "inject-geometry":
                    terms.append(cells)
        published, here, spreads = zip(*terms)
        add("sum, without geometry volume"
            if layout == "image" else "in buffers and constants: the same sum",
            *([summed(column) for column in zip(*times)] for times in (published, here)),
            [math.hypot(*column) for column in zip(*spreads)])
    return lines


TABLES["table1-shadows"] = functools.partial(table1, shadows=True)
TABLES["table1-no-shadows"] = functools.partial(table1, shadows=False)


@rows
def layouts(formats):
    for stage, basis, occlusion in dict.fromkeys(
            (row["stage"], row["basis"], row["occlusion"]) for row in bench("layouts")):
        cells = [found(bench("layouts"), stage=stage, basis=basis, occlusion=occlusion,
                       filtered=True, **dict(zip(("layout", "storage"), name.split("/"))))
                 for name in formats]
        best = min(row["median"] for row in cells if row["layout"] != "image")
        yield {"title": f"{stage} {basis}{', blockers' if occlusion else ''}",
               "times": [time(row) for row in cells], "best": ratio(cells[0]["median"], best)}


@rows
def bases():
    lines = [row for row in bench("bases") if row["stage"] == "propagate" and row["lobe"] == "exact"]
    for basis, size in dict.fromkeys((row["basis"], row["coefficients"]) for row in lines):
        yield {"basis": basis, "n": size, "times": [time(found(lines, basis=basis, occlusion=with_blockers))
                                                    for with_blockers in (False, True)]}


@table
def frames():
    def cell(given, stage):
        frame = found(load("frames")["frames"], given=given)
        return number(frame and ms_of(frame["times"], stage) or None)

    return crossed("[ms]", {stage: stage for stage in STAGES}, known.FRAMES, cell)


@rows
def recomputed(names):
    for recompute, name in names.items():
        lines = [row for row in bench("frame") if row["recompute"] == recompute]
        parts = [row["median"] for row in lines if row["stage"] in ("blockers", "visibility")]
        yield {"name": name, "frame": time(found(lines, stage="frame")),
               "parts": sum(parts) or None}
