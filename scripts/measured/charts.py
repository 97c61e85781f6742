# SPDX-License-Identifier: MIT
"""Charts of what clpv wrote.

    scripts/charts lambda -o FILE.png                           condition, error and energy of SRBF
                                                                bases over the bandwidth; lambdas
                                                                that clpv rejects are missing. Needs
                                                                a build
    scripts/charts times DIR -o FILE.png                        times.jsonl of `clpv sequence`:
                                                                median, 95th percentile and maximum
                                                                of each stage; time of every frame
    scripts/charts probes FILE.json -o FILE.png                 results/docs/bake.json: error of light
                                                                probes over bytes
    scripts/charts stability [LABEL=]DIR ... -o FILE.png        stability.json of `clpv sequence
                                                                --stability`

Needs Debian's Python and the packages of scripts/setup."""
import argparse
import json
import pathlib
import sys

import numpy

from . import bake, native, output

clpv = native()
from clpv.draw import style  # noqa: E402

HIGHEST = 120  # [%] errors above are worse than a black image
MINIMUM = 1e-5  # smaller changes show as this on the logarithmic axis
BASES = ("srbf4", "srbf6", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14")
FORMATS = ("sh2", "zh3", "sh3", "srbf8v2", "ambient-cube", "ambient-cube-mean")
LAMBDAS = [round(0.05 * i, 2) for i in range(1, 15)]


def save(figure, target, dpi):
    figure.tight_layout()
    output.write(target, style.rendered(figure, "png", dpi=dpi))
    print(target)


def draw_errors(files, target):
    """Error over the time of a frame, for scripts/measure and lab/scripts/standing: a point for
    each variant, a line for each series, or else for each file. `files`: (label, path)."""
    lines = {}
    for label, path in files:
        for row in json.loads(pathlib.Path(path).read_text(encoding="utf-8"))["variants"]:
            options = row["options"]
            name = options.get("grid", "") if "series" in row else " ".join(options.values())
            if not row["rejected"]:
                lines.setdefault(row.get("series", label), []).append(
                    (row["frame_ms"], 100 * row["nrmse"], name))
    figure, (axis,) = style.panels(1, 1, (8, 4.5))
    for i, (label, places) in enumerate(lines.items()):
        times, errors, names = zip(*sorted(places))
        axis.plot(times, errors, "o-", color=style.colour(i), label=label)
        for x, y, name in zip(times, errors, names):
            axis.annotate(name, (x, y), textcoords="offset points", xytext=(5, 5), fontsize="small")
    highest = max(error for places in lines.values() for _, error, _ in places)
    axis.set(ylim=(0, min(HIGHEST, 1.08 * highest)), xlabel="frame [ms]", ylabel="mean NRMSE [%]")
    style.logarithmic(axis.xaxis)
    axis.legend()
    save(figure, target, 110)


def described(name, bandwidth):
    """Returns the numbers of a basis; None if clpv rejects this lambda."""
    try:
        basis = clpv.Basis(name, bandwidth)
    except clpv.UsageError:
        return None
    return {"lambda": bandwidth, "condition": basis.condition, "mean_relative_l2": basis.mean_error,
            "energy_sampled_8": basis.energy(8), "energy_sampled_24": basis.energy(24)}


def draw_lambda(target):
    curves = {
        name: [point for point in (described(name, value) for value in LAMBDAS) if point]
        for name in BASES
    }
    figure, panels = style.panels(3, 3, (4.27, 4.2))
    titles = {"condition": "condition number of A",
              "mean_relative_l2": "clamped cosine: relative L2 error, mean over all axes",
              "energy_sampled_24": "energy after 24 steps, sampled transport"}
    for panel, (key, title) in zip(panels, titles.items()):
        for i, (name, points) in enumerate(curves.items()):
            panel.plot([p["lambda"] for p in points], [p[key] for p in points], marker="o",
                       markersize=3, label=name, color=style.colour(i))
        panel.set_title(title, fontsize=10)
        panel.set_xlabel("lambda")
        panel.axvline(0.25, color=style.LINE, lw=2, zorder=0)
    style.logarithmic(panels[0].yaxis)
    panels[0].axhline(1e7, color=style.INK, linestyle="--")
    panels[1].axhline(0.354, color=style.INK, linestyle=":", label="sh2")
    panels[1].axhline(0.088, color=style.INK, linestyle="--", label="sh3")
    panels[1].set_ylim(0, 0.7)
    panels[2].axhline(1, color=style.INK, linestyle="--")
    panels[2].set_ylim(0, 2)
    panels[1].legend(fontsize=8)
    save(figure, target, 80)


def stage_samples(frames):
    """Returns {stage: ms of each frame}; 0 for a frame that skipped the stage."""
    stages = list(dict.fromkeys(entry["stage"] for frame in frames for entry in frame["stages"]))
    return {
        stage: [sum(e["ms"] for e in frame["stages"] if e["stage"] == stage) for frame in frames]
        for stage in stages
    }


def read(folder, name):
    return json.loads((pathlib.Path(folder) / name).read_text(encoding="utf-8"))


def steady_frames(file):
    """Lines of times.jsonl: the last of each frame with the settings of the last summary, without
    first frames of a process."""
    lines = []
    for line in file.read_text(encoding="utf-8").splitlines():
        try:
            lines.append(json.loads(line))
        except ValueError:
            pass  # torn by a crash
    summaries = [line["summary"] for line in lines if "summary" in line]
    if not summaries:
        sys.exit(f"{file}: no summary: the run did not end")
    frames = {
        line["frame"]: line
        for line in lines if line.get("settings") == summaries[-1]["settings"]
    }
    return [frames[number] for number in sorted(frames) if not frames[number]["first"]]


def draw_times(folder, target):
    file = pathlib.Path(folder) / "times.jsonl"
    frames = steady_frames(file)
    if not frames:
        sys.exit(f"{file}: only first frames of runs")
    samples = stage_samples(frames)
    samples["frame (wall)"] = [frame["frame_ms"] for frame in frames]
    figure, (left, right) = style.panels(2, 2, (4.6, 3.4))
    names = list(samples)[::-1]
    left.barh(names, [numpy.quantile(samples[n], 0.5) for n in names], color=style.colour(0),
              label="median")
    for marker, share, label in (("|", 0.95, "95th percentile"), ("x", 1.0, "maximum")):
        left.plot([numpy.quantile(samples[n], share) for n in names], names, marker,
                  color=style.INK, ls="", label=label)
    left.set(xlabel="ms", title=f"Stages of {len(frames)} frames")
    left.legend(fontsize=7)
    right.plot([frame["time"] for frame in frames], samples["frame (wall)"], lw=1,
               color=style.colour(0))
    right.set(xlabel="s", ylabel="ms", title="Every frame (wall)", ylim=(0, None))
    save(figure, target, 100)


def draw_probes(file, target):
    """Errors of light probes by format, from coarse to fine spacing, over bytes of the volume."""
    rows = json.loads(pathlib.Path(file).read_text(encoding="utf-8"))["rows"]
    figure, panels = style.panels(4, 2, (5.2, 3.6))
    places = [(source, place) for source in bake.SOURCES for place in ("surface", "air")]
    for panel, (source, place) in zip(panels, places):
        for i, name in enumerate(FORMATS):
            line = bake.over_bytes(rows, name, source, place)
            panel.plot(*zip(*line), lw=1.5, marker="osv^Dp"[i], ms=5, color=style.colour(i), label=name)
        where = {"surface": "on surfaces", "air": "in the air"}[place]
        panel.set(title=f"{'path-traced' if source == 'pathtrace' else 'swept'} probes, {where}",
                  xlabel="bytes in a cube of the coarse spacing", ylabel="mean NRMSE [%]")
        style.logarithmic(panel.xaxis)
    panels[0].legend()
    save(figure, target, 90)


def draw_stability(folders, target):
    figure, (axis,) = style.panels(1, 1, (8.6, 3.4))
    documents_of = {label: read(folder, "stability.json") for label, folder in folders}
    for i, (label, document) in enumerate(documents_of.items()):
        frames = [f for f in document["frames"] if f["change"] is not None]
        axis.plot([f["time"] for f in frames], [100 * max(f["change"], MINIMUM) for f in frames],
                  lw=1, marker=".", ms=3, color=style.colour(i), label=label)
        traced = [(f["time"], 100 * f["traced"]) for f in frames if f["traced"] is not None]
        if traced:
            axis.plot(*zip(*traced), lw=1, ls="--", color=style.colour(len(folders) + i),
                      label=f"path tracing, {document['traced_spp']} paths per pixel: noise")
    axis.set(xlabel="s", ylabel="change of irradiance [% of its mean]",
             title="Change between frames, on surfaces that do not move (lowest line: none)")
    style.logarithmic(axis.yaxis)
    axis.legend(fontsize=7, ncol=3, loc="upper center", bbox_to_anchor=(0.5, -0.18))
    save(figure, target, 100)


DRAWN = {"lambda": draw_lambda, "times": draw_times, "probes": draw_probes,
         "stability": draw_stability}
FILES = {"lambda": (0, 0), "times": (1, 1), "probes": (1, 1), "stability": (1, 999)}
READ = {"times": "/times.jsonl", "stability": "/stability.json"}  # of a folder


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("chart", choices=DRAWN)
    parser.add_argument("files", nargs="*", metavar="[LABEL=]FILE")
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path, metavar="FILE.png")
    arguments = parser.parse_args()
    chart, files = arguments.chart, [given.rpartition("=")[::2] for given in arguments.files]
    least, most = FILES[chart]
    if not least <= len(files) <= most:
        parser.error(f"{chart}: found {len(files)} files; allowed: {least} to {most}")
    output.target_of(arguments.output, *(path + READ.get(chart, "") for _, path in files))
    if chart == "stability":
        draw_stability([(label or pathlib.Path(path).name, path) for label, path in files],
                       arguments.output)
    else:
        DRAWN[chart](*(path for _, path in files), arguments.output)
    return 0
