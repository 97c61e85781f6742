#!/usr/bin/env python3
"""Draws charts of a report of `clpv bench`.

    plot.py REPORT.json FOLDER

Writes what the report's rows allow, each as .svg and .png: layouts, roofline, scaling, bases, frame.
"""
import json
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

# By file name alone, not by time of day: the same report gives the same bytes.
matplotlib.rcParams.update({"svg.hashsalt": "clpv", "axes.spines.top": False, "axes.spines.right": False,
                            "font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.axisbelow": True})
# Told apart by colour-blind eyes as well (Okabe and Ito).
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9", "#CC79A7", "#F0E442", "#000000"]
DEVICE_CHARS = 70
CLOSEST_LABELS = 0.7  # of the bandwidth before: nearer ones would overlap


def save(figure, folder, name, context):
    device = f"{context['device']} ({context['platform']} {context['driver']})"[:DEVICE_CHARS]
    figure.text(0.995, 0.004, f"clpv {context['git_describe']} on {device}", ha="right", va="bottom", size=6,
                color="#666666")
    figure.tight_layout(rect=(0, 0.015, 1, 1))
    for suffix in ("svg", "png"):
        metadata = {"Date": None} if suffix == "svg" else {}
        figure.savefig(folder / f"{name}.{suffix}", dpi=150, metadata=metadata)
    plt.close(figure)


def error_bars(rows):
    """Distances from the median down to the fastest and up to the 95th percentile."""
    return [[r["median"] - r["min"] for r in rows], [max(0.0, r["p95"] - r["median"]) for r in rows]]


def title_of(row):
    return f"{row['stage']} {row['basis']}" + (", occlusion" if row["occlusion"] else "")


def draw_layouts(rows, folder, context):
    rows = [r for r in rows if r["suite"] == "layouts" and r["status"] == "ok"]
    groups = list(dict.fromkeys(title_of(r) for r in rows))
    if not groups:
        return
    columns = 2
    lines = math.ceil(len(groups) / columns)
    figure, axes = plt.subplots(lines, columns, figsize=(9, 2.4 * lines), squeeze=False)
    for axis, group in zip(axes.flat, groups):
        members = sorted((r for r in rows if title_of(r) == group), key=lambda r: r["median"])
        names = [f"{r['layout']}/{r['storage']}" + (" texels" if r["name"].endswith("/texels") else "")
                 for r in members]
        colours = [COLOURS[0] if r["layout"] != "image" else COLOURS[1] for r in members]
        axis.barh(names, [r["median"] for r in members], xerr=error_bars(members), color=colours,
                  error_kw={"lw": 0.8})
        axis.set_xscale("log")
        axis.set_title(group)
        axis.set_xlabel("ms (bars: median; whiskers: fastest to 95 %)")
        axis.invert_yaxis()
        for i, r in enumerate(members):
            axis.annotate(f"{r['median']:.2f}", (r["median"], i), textcoords="offset points", xytext=(4, 5), size=7)
    for axis in list(axes.flat)[len(groups):]:
        axis.axis("off")
    save(figure, folder, "layouts", context)


def draw_roofline(rows, folder, context):
    ceilings = context.get("ceilings", {})
    points = [r for r in rows if r["flops"] > 0 and r["bytes"] > 0 and r["median"] > 0 and r["status"] == "ok"]
    if not points or not ceilings.get("gflops"):
        return
    figure, axis = plt.subplots(figsize=(7.5, 5))
    lowest = min(0.1, min(r["flops"] / r["bytes"] for r in points) / 2)
    highest = max(50.0, max(r["flops"] / r["bytes"] for r in points) * 2)
    labelled = math.inf
    for bandwidth in sorted(ceilings["bandwidths"], key=lambda b: -b["gbps"]):
        knee = ceilings["gflops"] / bandwidth["gbps"]
        size = bandwidth["working_set"] / 2**20
        label = f"{bandwidth['gbps']:.0f} GB/s at {size:.3g} MiB"
        axis.plot([lowest, knee], [lowest * bandwidth["gbps"], ceilings["gflops"]], color="#999999", lw=0.8)
        if bandwidth["gbps"] > CLOSEST_LABELS * labelled:
            continue
        labelled = bandwidth["gbps"]
        axis.annotate(label, (lowest, lowest * bandwidth["gbps"]), size=6, color="#666666", rotation=30,
                      rotation_mode="anchor", textcoords="offset points", xytext=(2, 2))
    axis.axhline(ceilings["gflops"], color="#444444", lw=1)
    axis.annotate(f"{ceilings['gflops']:.0f} GFLOP/s fused multiply-adds", (highest, ceilings["gflops"]), size=7,
                  ha="right", va="bottom")
    kinds = list(dict.fromkeys((r["stage"], r["layout"]) for r in points))
    markers = "osD^vPX*"
    for i, kind in enumerate(kinds):
        members = [r for r in points if (r["stage"], r["layout"]) == kind]
        axis.scatter([r["flops"] / r["bytes"] for r in members], [r["gflops"] for r in members], s=18,
                     color=COLOURS[i % len(COLOURS)], marker=markers[i % len(markers)], label=" ".join(kind), zorder=3)
    axis.set(xscale="log", yscale="log", xlabel="operations a byte that must move", ylabel="GFLOP/s",
             xlim=(lowest, highest))
    axis.legend(fontsize=7, loc="lower right")
    axis.set_title("Roofline")
    save(figure, folder, "roofline", context)


def axis_and_value(row):
    last = row["name"].rsplit("/", 1)[-1]
    axis, colon, value = last.partition(":")
    return (axis, float(value)) if colon else (None, 0.0)


def draw_scaling(rows, folder, context):
    rows = [r for r in rows if r["suite"] == "scaling" and r["status"] == "ok"]
    axes_names = list(dict.fromkeys(axis_and_value(r)[0] for r in rows))
    if not axes_names:
        return
    columns = min(3, len(axes_names))
    lines = math.ceil(len(axes_names) / columns)
    figure, axes = plt.subplots(lines, columns, figsize=(3.4 * columns, 3 * lines), squeeze=False)
    for axis, name in zip(axes.flat, axes_names):
        members = [r for r in rows if axis_and_value(r)[0] == name]
        for i, stage in enumerate(dict.fromkeys(r["stage"] for r in members)):
            series = sorted(((axis_and_value(r)[1], r) for r in members if r["stage"] == stage), key=lambda p: p[0])
            x = [p[0] for p in series]
            axis.errorbar(x, [p[1]["median"] for p in series], yerr=error_bars([p[1] for p in series]), marker="o",
                          ms=3, lw=1, color=COLOURS[i % len(COLOURS)], label=stage)
            axis.set_xticks(x, [f"{v:g}" for v in x], rotation=45 if max(x) >= 1000 else 0)
        axis.set(xscale="log", yscale="log", xlabel=name, ylabel="ms")
        axis.set_xticks(sorted({axis_and_value(r)[1] for r in members}),
                        [f"{v:g}" for v in sorted({axis_and_value(r)[1] for r in members})])
        axis.minorticks_off()
        axis.legend(fontsize=7)
    for axis in list(axes.flat)[len(axes_names):]:
        axis.axis("off")
    save(figure, folder, "scaling", context)


def draw_bases(rows, folder, context):
    rows = [r for r in rows if r["suite"] == "bases" and r["stage"] == "propagate" and r["status"] == "ok"
            and r["lobe"] == "exact"]
    names = list(dict.fromkeys(r["basis"] for r in sorted(rows, key=lambda r: r["n"])))
    if not names:
        return
    kinds = [("coefficients", False), ("fluxes", False), ("coefficients", True), ("fluxes", True)]
    figure, axis = plt.subplots(figsize=(9, 3.6))
    width = 0.8 / len(kinds)
    for k, (state, occlusion) in enumerate(kinds):
        found = {r["basis"]: r for r in rows if r["state"] == state and r["occlusion"] == occlusion}
        at = [i + (k - 1.5) * width for i, name in enumerate(names) if name in found]
        members = [found[name] for name in names if name in found]
        axis.bar(at, [r["median"] for r in members], width, yerr=error_bars(members), color=COLOURS[k],
                 error_kw={"lw": 0.7}, label=state + (", occlusion" if occlusion else ""))
    axis.set_xticks(range(len(names)), [f"{n}\nN={next(r['n'] for r in rows if r['basis'] == n)}" for n in names])
    axis.set(yscale="log", ylabel="ms", title="Propagation by basis and state")
    axis.legend(fontsize=7, ncol=2)
    save(figure, folder, "bases", context)


def draw_frame(rows, folder, context):
    rows = [r for r in rows if r["suite"] == "frame" and r["status"] == "ok"]
    frames = [r for r in rows if r["stage"] == "frame"]
    if not frames:
        return
    stages = list(dict.fromkeys(r["stage"] for r in rows if r["stage"] != "frame"))
    figure, axis = plt.subplots(figsize=(8, 1.2 + 0.5 * len(frames)))
    names = [f"{r['basis']} {r['name'].rsplit('/', 1)[-1]}" for r in frames]
    left = [0.0] * len(frames)
    for i, stage in enumerate(stages):
        times = {r["name"].split("/", 1)[1]: r["median"] for r in rows if r["stage"] == stage}
        widths = [times.get(f["name"].split("/", 1)[1], 0.0) for f in frames]
        axis.barh(names, widths, left=left, color=COLOURS[i % len(COLOURS)], label=stage)
        left = [a + b for a, b in zip(left, widths)]
    axis.plot([f["median"] for f in frames], names, "k|", ms=14, label="frame (wall)")
    axis.set(xlabel="ms, medians", title="Frames by stage")
    axis.legend(fontsize=7, ncol=4, loc="upper center", bbox_to_anchor=(0.5, -0.25))
    save(figure, folder, "frame", context)


def main(report, folder):
    document = json.loads(pathlib.Path(report).read_text(encoding="utf-8"))
    rows, context = document["benchmarks"], document["context"]
    folder = pathlib.Path(folder)
    for draw in (draw_layouts, draw_roofline, draw_scaling, draw_bases, draw_frame):
        draw(rows, folder, context)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    main(sys.argv[1], sys.argv[2])
