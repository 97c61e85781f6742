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
    scripts/charts spheres -o FILE.jpg                          moving spheres that baked probes
                                                                light, and the same by path tracing.
                                                                Needs a build
    scripts/charts stability [LABEL=]DIR ... -o FILE.png        of `clpv sequence --stability`

Needs Debian's Python and the packages of scripts/setup."""
import argparse
import json
import math
import pathlib
import sys

import numpy

from . import CLPV, ROOT, bake, native, output

clpv = native()
from clpv.draw import style  # noqa: E402

sys.path.insert(0, str(ROOT / "examples"))
import probes  # noqa: E402  pylint: disable=wrong-import-position

MINIMUM = 1e-5  # smaller changes show as this on the logarithmic axis
BASES = ("srbf4", "srbf6", "srbf8v1", "srbf8v2", "srbf8v3", "srbf14")
FORMATS = ("sh2", "zh3", "sh3", "srbf8v2", "ambient-cube", "ambient-cube-mean")
LAMBDAS = [round(0.05 * i, 2) for i in range(1, 15)]

# Moving objects of draw_spheres: centres and radius [m], reflectance; probes; size of a picture.
SPHERES = [(x, y, z) for x in (-6.5, -4, -1.5, 1.5) for z, y in ((-2.9, 1.2), (-0.3, 2.6), (1.9, 1.2))]
RADIUS, WHITE, SPACING, SHOWN = 0.45, 0.8, 1, (400, 225)
PATHS = 256


def save(figure, target, dpi):
    figure.tight_layout()
    output.write(target, style.rendered(figure, "png", dpi=dpi))
    print(target)


def draw_errors(series, target):
    """Error over the time of a frame. `series`: variants of `clpv quality` by label."""
    figure, (axis,) = style.panels(1, 1, (8, 4.5))
    for i, (label, rows) in enumerate(series.items()):
        points = sorted((row["frame_ms"], 100 * row["nrmse"], row["options"].get("grid", ""))
                        for row in rows if row["rejected"] == 0)
        axis.plot(*list(zip(*points))[:2], marker="os^Dv"[i % 5], color=style.colour(i), label=label)
        for j, (*place, grid) in enumerate(points):
            axis.annotate(grid, place, textcoords="offset points", ha="center",
                          xytext=(0, -13 if j % 2 else 6))
    axis.set(ylim=(0, 110), xlabel="frame [ms]", ylabel="mean NRMSE [%]")
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


def draw_lambda(_, target):
    curves = {name: [point for point in (described(name, value) for value in LAMBDAS) if point]
              for name in BASES}
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
    return {stage: [sum(e["ms"] for e in frame["stages"] if e["stage"] == stage) for frame in frames]
            for stage in stages}


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
    frames = {line["frame"]: line for line in lines
              if line.get("settings") == summaries[-1]["settings"]}
    return [frames[number] for number in sorted(frames) if not frames[number]["first"]]


def draw_times(files, target):
    (_, file), = files
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


def draw_probes(files, target):
    """Errors of light probes by format, from coarse to fine spacing, over bytes of the volume."""
    rows = json.loads(files[0][1].read_text(encoding="utf-8"))["rows"]
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


def seen_spheres(camera, depth):
    """Pixels (height, width) that show a sphere before `depth`, then its points and normals there."""
    eye, target, up = map(numpy.array, (camera.eye, camera.target, camera.up))
    z = (target - eye) / numpy.linalg.norm(target - eye)
    x = numpy.cross(z, up)
    x /= numpy.linalg.norm(x)
    half = math.tan(math.radians(camera.fov / 2))
    height, width = depth.shape
    v, u = (numpy.mgrid[:height, :width] + 0.5) * 2 - numpy.array([height, width])[:, None, None]
    rays = z + half / height * (u[..., None] * x - v[..., None] * numpy.cross(x, z))
    points, normals, nearest = numpy.zeros_like(rays), numpy.zeros_like(rays), depth.copy()
    for centre in SPHERES:
        a, b = (rays**2).sum(axis=-1), (rays * (eye - centre)).sum(axis=-1)
        root = b * b - a * (((eye - centre)**2).sum() - RADIUS**2)
        t = numpy.where(root > 0, (-b - numpy.sqrt(abs(root))) / a, 0)
        hit = (t > 0) & ((t < nearest) | (nearest == 0))
        nearest[hit], points[hit] = t[hit], eye + t[hit, None] * rays[hit]
        normals[hit] = (points[hit] - centre) / RADIUS
    shown = (normals != 0).any(axis=-1)
    return shown, points[shown], normals[shown]


def draw_spheres(_, target):
    """The atrium with spheres that the scene does not have, by probes and by path tracing."""
    file = ROOT / "scenes/atrium.json"
    scene = clpv.Scene(file)
    camera = next(each for each in scene.cameras if each.name == "nave")
    with clpv.Renderer(scene) as renderer:
        picture = renderer.render("full", camera, size=SHOWN)
        depth = renderer.show("depth").array[..., 0].astype(float)
    shown, points, normals = seen_spheres(camera, depth)
    truth = scene.pathtrace_points(points, normals, samples=PATHS)
    light = {}
    for title, source in (("swept probes", "sweep"), ("path-traced probes", "pathtrace")):
        baked = probes.bake(CLPV, file, ("--format=ambient-cube-mean", f"--spacing={SPACING}",
                                         f"--from={source}", f"--bounds={bake.BOXES['atrium']}",
                                         *([bake.PATHS] if source == "pathtrace" else [])))
        light[title] = probes.irradiance(baked, points, normals)
    light["path traced"] = truth["indirect"]
    made = style.Sheet([f"Spheres in the atrium, lit by probes {SPACING} m apart"], len(light), len(light),
                       tuple(length / 100 for length in SHOWN), above=True)
    for i, (title, indirect) in enumerate(light.items()):
        array = picture.array.copy()
        array[shown, :3] = WHITE / math.pi * (truth["direct"] + indirect)
        array[shown, 3] = 1
        if title != "path traced":
            error = clpv.compare(indirect[None], truth["indirect"][None]).nrmse
            title += f": NRMSE {100 * error:.0f} %"
        made.tile(i, title).imshow(clpv.Image(array, ("R", "G", "B", "A")).display(scene.exposure))
    made.save(target, 100)


def draw_stability(files, target):
    figure, (axis,) = style.panels(1, 1, (8.6, 3.4))
    for i, (label, file) in enumerate(files):
        document = json.loads(file.read_text(encoding="utf-8"))
        frames = [f for f in document["frames"] if f["change"] is not None]
        axis.plot([f["time"] for f in frames], [100 * max(f["change"], MINIMUM) for f in frames],
                  lw=1, marker=".", ms=3, color=style.colour(i), label=label)
        traced = [(f["time"], 100 * f["traced"]) for f in frames if f["traced"] is not None]
        if traced:
            axis.plot(*zip(*traced), lw=1, ls="--", color=style.colour(len(files) + i),
                      label=f"path tracing, {document['traced_spp']} paths per pixel: noise")
    axis.set(xlabel="s", ylabel="change of irradiance [% of its mean]",
             title="Change between frames, on surfaces that do not move (lowest line: none)")
    style.logarithmic(axis.yaxis)
    axis.legend(fontsize=7, ncol=3, loc="upper center", bbox_to_anchor=(0.5, -0.18))
    save(figure, target, 100)


# How many files each chart reads, and the file of a folder.
CHARTS = {"lambda": (draw_lambda, range(1), ""), "times": (draw_times, range(1, 2), "times.jsonl"),
          "probes": (draw_probes, range(1, 2), ""), "spheres": (draw_spheres, range(1), ""),
          "stability": (draw_stability, range(1, 1000), "stability.json")}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("chart", choices=CHARTS)
    parser.add_argument("files", nargs="*", metavar="[LABEL=]FILE")
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path, metavar="FILE.png")
    arguments = parser.parse_args()
    files = [given.rpartition("=") for given in arguments.files]
    draw, allowed, name = CHARTS[arguments.chart]
    if len(files) not in allowed:
        parser.error(f"{arguments.chart}: found {len(files)} files; allowed: {allowed[0]} to {allowed[-1]}")
    files = [(label or pathlib.Path(path).name, pathlib.Path(path) / name) for label, _, path in files]
    output.target_of(arguments.output, *(path for _, path in files))
    draw(files, arguments.output)
    return 0
