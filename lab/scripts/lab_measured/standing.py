# SPDX-License-Identifier: MIT
"""Measures the standing benchmark of quality: clpv and other methods at equal time against path
tracing.

    lab/scripts/standing --model PATH/Sponza.gltf [DEVICE]    13 minutes on two cores, as much again
                                                              for truths

Writes a file of lab/results/quality, named after device and commit, and the chart of
lab/docs/other_methods.md; lab/scripts/tables then writes the tables of lab/docs/results.md. DEVICE:
as --device of clpv takes it; default: the first. Commit and build first (scripts/build), and keep
the machine free of other work. """
import argparse
import os
import pathlib
import re

from measured import LAB, ROOT, charts
from measured.measure import FRAME_COUNT, measured_with, run, scenes_of, write
from measured.rows import VIEWS

FOLDER = ROOT / "lab/results/quality"
STANDING_COUNT = 5
# Scenes and their cameras by run, then what each run measures.
STANDING = [[
    "sponza_suns", "cornell", "atrium", "--camera=curtains", "--camera=atrium", "--camera=columns",
    "--camera=front", "--camera=nave", "--camera=gallery"
], ["atrium_living", "--time=4"]]
STANDING_LARGE = [[
    "sponza_suns", "cornell", "atrium", "--camera=curtains", "--camera=front", "--camera=nave"
]]
STANDING_FRAMES = [["--preset=best", "--vary=near=traced,off"], ["--preset=paper", "--basis=sh2"]]
METHODS = ("paths", "paths-filtered", "vpl", "vpl-interleaved", "ddgi-first", "ddgi-converged",
           "radiance-cascades", "radiance-cascades-fine")
BASELINES = ["--preset=best", f"--baseline={','.join(METHODS)}"]
OF_A_TIME = ["--preset=best", f"--baseline={','.join(METHODS[:-1])}"]  # the last takes its own time
SIZES = {"small": ["--noise=0.03"], "large": ["--width=960", "--height=540", "--noise=0.06"]}
SHARED = "rasterize-camera", "rasterize-shadow", "shade"  # stages whose time baselines do not get
# Error against time, for the chart: clpv by grid, other methods by their time [ms].
FRONT = [*VIEWS, "--noise=0.03"]
FRONT_GRIDS = {
    "clpv": ["--vary=grid=16,24,32,48,64"],
    "clpv, near off": ["--near=off", "--vary=grid=16,24,32,48,64"]
}
FRONT_TIMES = 5, 20, 80


def method_of(cell, options):
    """Name of what a cell measures; None for the frame beside baselines, which another run
    measures."""
    if options[0] == "--preset=paper":
        return "published scheme"
    near = cell["options"].get("near")
    return {"traced": "clpv", "off": "clpv, near off"
            }[near] if near else cell["options"].get("baseline")


def measure_standing(folder, model):
    """Three groups of cells: 240x135 and 960x540, each with its frame's time, and 240x135 with the
    time of 960x540."""
    stats = run("render", "scenes/sponza_suns.json", f"--model={model}", "--camera=curtains",
                f"--frames={FRAME_COUNT}", "--output=FOLDER/frame.png", "--stats")
    time = sum(stage["median"] for stage in stats["times"]
               if stage["stage"] not in ("frame", "host", *SHARED))
    groups = {
        "small": (STANDING, "small", STANDING_FRAMES + [BASELINES]),
        "small_with_time_of_large": (STANDING, "small",
                                     [OF_A_TIME + [f"--baseline-time={time:.1f}"]]),
        "large": (STANDING_LARGE, "large", STANDING_FRAMES + [BASELINES])
    }
    document = {
        "measured": measured_with(stats["device"]), "frames": STANDING_COUNT,
        "time_of_large_ms": time, "ground_truths": []
    }
    for name, (scenes, size, runs) in groups.items():
        document[name] = []
        for arguments in scenes:
            for options in runs:
                report = run("quality", *scenes_of(arguments, model), *SIZES[size], *options,
                             "--fresh", f"--frames={STANDING_COUNT}", "--output", program=LAB)
                for cell in report["cells"]:
                    cell["method"] = method_of(cell, options)
                document[name] += [cell for cell in report["cells"] if cell["method"]]
            document["ground_truths"] += [
                {**truth, "file": pathlib.Path(truth["file"]).name, "size": size}
                for truth in report["ground_truths"] if name != "small_with_time_of_large"
            ]
    document["variants"] = measure_front(model)
    measured = document["measured"]
    slug = re.sub("[^a-z0-9.]+", "-",
                  f"{measured['device']} {measured['driver']} {measured['commit']}".lower())
    write(folder, slug, document)
    series = {}
    for row in document["variants"]:
        if row["series"] != "paths":  # above the chart
            series.setdefault(row["series"], []).append(row)
    charts.draw_errors(series, ROOT / "docs/images/baselines.png")


def measure_front(model):
    """Variants of clpv by grid, and of other methods by time, with the series that each belongs
    to."""
    given = [*scenes_of(FRONT, model), "--fresh", "--frames=3"]
    variants = []
    for series, options in FRONT_GRIDS.items():
        variants += [
            {**row, "series": series}
            for row in run("quality", *given, "--preset=best", *options, "--output",
                           program=LAB)["variants"]
        ]
    for time in FRONT_TIMES:
        report = run("quality", *given, *OF_A_TIME, f"--baseline-time={time}", "--output",
                     program=LAB)
        variants += [{**row, "series": row["options"]["baseline"]} for row in report["variants"]
                     if "baseline" in row["options"]]
    return variants


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("device", metavar="DEVICE", nargs="?")
    parser.add_argument("--model", type=pathlib.Path, required=True,
                        help="Sponza's glTF, of the Khronos sample models")
    arguments = parser.parse_args()
    if arguments.device:
        os.environ["CLPV_DEVICE"] = arguments.device
    measure_standing(FOLDER, arguments.model.resolve())
    print("lab/results/quality is written; lab/scripts/tables writes lab/docs/results.md")
    return 0
