# SPDX-License-Identifier: MIT
"""Charts of `clpv bench`: layouts and a roofline.

Each function turns rows into a figure, or returns None if no row belongs to its chart. It reads
fields of rows, not names. """
import itertools
import math
import pathlib

from matplotlib import pyplot
from matplotlib.lines import Line2D

from clpv import output
from clpv.draw import documents, style
from clpv.draw.documents import NUMBER, TEXT_OR_NULL

ROW = {"suite": str, "stage": str, "status": str, "basis": TEXT_OR_NULL, "layout": TEXT_OR_NULL,
       "storage": TEXT_OR_NULL, "occlusion": bool, "median": NUMBER, "min": NUMBER, "p95": NUMBER}
DEVICE_CHARS = 70
# Maximum ratio to the previous labelled bandwidth; closer labels would overlap.
CLOSEST_LABELS = 0.7


def of_suite(rows, suite):
    return [row for row in rows if row["suite"] == suite and row["status"] == "ok"]


def distinct(values):
    return list(dict.fromkeys(values))


def error_bars(rows):
    """Returns distances from the median down to the minimum and up to the 95th percentile."""
    return [[max(0.0, r["median"] - r["min"]) for r in rows],
            [max(0.0, r["p95"] - r["median"]) for r in rows]]


def work_of(row):
    return f"{row['stage']} {row['basis']}" + (", occlusion" if row["occlusion"] else "")


def layouts(rows):
    rows = of_suite(rows, "layouts")
    groups = distinct(map(work_of, rows))
    if not groups:
        return None
    figure, axes = style.panels(len(groups), 2, (4.5, 2.4))
    for axis, group in zip(axes, groups):
        members = sorted((r for r in rows if work_of(r) == group), key=lambda r: r["median"])
        names = [
            f"{r['layout']}/{r['storage']}" + ("" if r.get("filtered", True) else " texels")
            for r in members
        ]
        colours = [style.colour(1 if r["layout"] == "image" else 0) for r in members]
        axis.barh(names, [r["median"] for r in members], xerr=error_bars(members), color=colours,
                  error_kw={"lw": 0.8, "ecolor": style.INK})
        style.logarithmic(axis.xaxis)
        axis.set(title=group, xlabel="ms (median; whiskers: minimum to 95 %)")
        axis.invert_yaxis()
        for i, r in enumerate(members):
            axis.annotate(f"{r['median']:.2f}", (r["median"], i), textcoords="offset points",
                          xytext=(4, 5), size=7)
    return figure


def roofline(rows, ceilings):
    points = [
        r for r in rows
        if r["status"] == "ok" and r["flops"] > 0 and r["bytes"] > 0 and r["median"] > 0
    ]
    if not points or not ceilings.get("gflops"):
        return None
    figure, axis = pyplot.subplots(figsize=(7.5, 5))
    lowest = min(0.1, min(r["flops"] / r["bytes"] for r in points) / 2)
    highest = max(50.0, max(r["flops"] / r["bytes"] for r in points) * 2)
    labelled = math.inf
    for bandwidth in sorted(ceilings["bandwidths"], key=lambda b: -b["gbps"]):
        knee = ceilings["gflops"] / bandwidth["gbps"]
        axis.plot([lowest, knee], [lowest * bandwidth["gbps"], ceilings["gflops"]],
                  color=style.SOFT, lw=0.8)
        if bandwidth["gbps"] > CLOSEST_LABELS * labelled:
            continue
        labelled = bandwidth["gbps"]
        axis.annotate(f"{bandwidth['gbps']:.0f} GB/s at {bandwidth['working_set'] / 2**20:.3g} MiB",
                      (lowest, lowest * bandwidth["gbps"]), size=6, color=style.SOFT, rotation=30,
                      rotation_mode="anchor", textcoords="offset points", xytext=(2, 2))
    axis.axhline(ceilings["gflops"], color=style.INK, lw=1)
    axis.annotate(f"{ceilings['gflops']:.0f} GFLOP/s fused multiply-adds",
                  (highest, ceilings["gflops"]), size=7, ha="right", va="bottom")
    stages, kinds = distinct(r["stage"] for r in points), distinct(r["layout"] for r in points)
    markers = dict(zip(stages, itertools.cycle("osD^vPX*")))
    colours = {layout: style.colour(i) for i, layout in enumerate(kinds)}
    for stage, layout in distinct((r["stage"], r["layout"]) for r in points):
        members = [r for r in points if (r["stage"], r["layout"]) == (stage, layout)]
        axis.scatter([r["flops"] / r["bytes"] for r in members], [r["gflops"] for r in members],
                     s=18, color=colours[layout], marker=markers[stage], zorder=3)
    key = [
        Line2D([], [], ls="", marker=markers[stage], color=style.SOFT, label=stage)
        for stage in stages
    ]
    key += [
        Line2D([], [], ls="", marker="s", ms=8, color=colours[layout], label=layout)
        for layout in kinds if layout
    ]
    axis.set(xlabel="operations per byte", ylabel="GFLOP/s", xlim=(lowest, highest),
             title="Roofline")
    style.logarithmic(axis.xaxis)
    style.logarithmic(axis.yaxis)
    axis.legend(handles=key, fontsize=7, loc="upper left", bbox_to_anchor=(1.01, 1),
                borderaxespad=0)
    return figure


def save(figure, folder, name, context):
    """Writes the chart with a footer below it, which the margins include."""
    device = f"{context['device']} ({context['platform']} {context['driver']})"[:DEVICE_CHARS]
    version = context["git_describe"]
    if version == "unknown":  # a build from a source archive
        version = context["clpv_version"]
    figure.tight_layout()
    figure.text(1, 0, f"clpv {version} on {device}", ha="right", va="top", size=6, color=style.SOFT)
    for suffix in ("svg", "png"):
        output.write(folder / f"{name}.{suffix}",
                     style.rendered(figure, suffix, dpi=150, bbox_inches="tight"))


def draw(source: pathlib.Path, folder: pathlib.Path) -> None:
    document = documents.read(source / "bench.json")
    rows, context = documents.checked(document, "bench.json", "benchmarks",
                                      ROW), document["context"]
    charts = {"layouts": layouts(rows), "roofline": roofline(rows, context["ceilings"])}
    for name, figure in charts.items():
        if figure:
            save(figure, folder, name, context)
