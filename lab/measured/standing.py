# SPDX-License-Identifier: MIT
"""Measures the standing benchmark of quality: clpv and other methods at equal time against path
tracing.

    lab/scripts/standing --model PATH/Sponza.gltf [DEVICE]    13 minutes on two cores, as much again
                                                              for truths
    lab/scripts/standing --picture --model PATH/Sponza.gltf   two minutes
    lab/scripts/standing --own --model PATH/Sponza.gltf       three minutes, and ten for truths

Writes a file of lab/results/quality, named after device and commit, and the pictures of
lab/docs/other_methods.md; --picture only the one of images; --own renews the errors of clpv and of
the published scheme at 240x135 in each file there. lab/scripts/tables then writes the tables of
lab/docs/results.md. Commit and build first (scripts/build), and keep the machine free of other
work."""
import json
import pathlib
import re
import tempfile

import numpy

from . import LAB, ROOT, charts, parser_of, use_device
from .cells import found
from .charts import clpv
from .measure import FRAME_COUNT, measured_with, run, scenes_of, write
from .rows import DATA, SHARED, VIEWS
from .sheets import sheet

FOLDER = ROOT / "lab/results/quality"
STANDING_COUNT = 5
# Scenes and their cameras by run, then what each run measures.
STANDING = [["sponza_suns", "cornell", "atrium", "--camera=curtains", "--camera=atrium",
             "--camera=columns", "--camera=front", "--camera=nave", "--camera=gallery"],
            ["atrium_living", "--time=4"]]
STANDING_LARGE = [["sponza_suns", "cornell", "atrium", "--camera=curtains", "--camera=front",
                   "--camera=nave"]]
STANDING_FRAMES = [["--preset=best", "--vary=near=traced,off"], ["--preset=paper", "--basis=sh2"]]
METHODS = list(DATA["METHODS"])[3:]  # other methods
BASELINES = ["--preset=best", f"--baseline={','.join(METHODS)}"]
OF_A_TIME = ["--preset=best", f"--baseline={','.join(METHODS[:-1])}"]  # the last takes its own time
SIZES = {"small": ["--noise=0.03"], "large": ["--width=960", "--height=540", "--noise=0.06"]}
ERRORS = "nrmse", "nrmse_best_gain", "best_gain", "energy_ratio", "flip"
# Error against time, for the chart: clpv by grid, other methods by their time [ms].
FRONT = [*VIEWS, "--noise=0.03"]
GRIDS = "--vary=grid=16,24,32,48,64"
FRONT_GRIDS = {"clpv": [GRIDS], "clpv, near off": ["--near=off", GRIDS]}
FRONT_TIMES = 5, 20, 80
# The picture: views that clpv wins and loses, and methods beside clpv.
SHOWN_VIEWS = "curtains", "columns"
SHOWN = {"ddgi-converged": "DDGI, converged", "vpl-interleaved": "virtual point lights",
         "paths-filtered": "path tracing, filtered"}


def method_of(cell, options):
    """Name of what a cell measures; None for the frame beside baselines, which another run
    measures."""
    if options[0] == "--preset=paper":
        return "published scheme"
    named = {"traced": "clpv", "off": "clpv, near off"}
    return named.get(cell["options"].get("near"), cell["options"].get("baseline"))


def quality(scenes, model, *options):
    return run("quality", *scenes_of(scenes, model), *options, "--output", program=LAB)


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
    measured = measured_with(stats["device"])
    document = {"measured": measured, "frames": STANDING_COUNT, "time_of_large_ms": time,
                "ground_truths": []}
    for name, (scenes, size, runs) in groups.items():
        document[name] = []
        for arguments in scenes:
            for options in runs:
                report = quality(arguments, model, *SIZES[size], *options, "--fresh",
                                 f"--frames={STANDING_COUNT}")
                for cell in report["cells"]:
                    cell["method"] = method_of(cell, options)
                    cell["scene"] = cell["scene"].removesuffix("_suns")
                document[name] += [cell for cell in report["cells"] if cell["method"]]
            if name != "small_with_time_of_large":
                document["ground_truths"] += [
                    {**truth, "file": pathlib.Path(truth["file"]).name, "size": size}
                    for truth in report["ground_truths"]]
    document["variants"] = measure_front(model)
    slug = re.sub("[^a-z0-9.]+", "-",
                  f"{measured['device']} {measured['driver']} {measured['commit']}".lower())
    write(folder, slug, document)
    series = {}
    for row in document["variants"]:
        if row["series"] != "paths":  # above the chart
            series.setdefault(row["series"], []).append(row)
    charts.draw_errors(series, ROOT / "docs/images/baselines.png")


def renew_own(model):
    """Errors of the frames that are clpv's own, beside times and other methods as they are."""
    report = [(options, quality(arguments, model, *SIZES["small"], *options, "--frames=1"))
              for arguments in STANDING for options in STANDING_FRAMES]
    measured = measured_with(report[0][1]["device"])
    for path in FOLDER.glob("*.json"):
        document = json.loads(path.read_text(encoding="utf-8"))
        for options, each in report:
            for cell in each["cells"]:
                row = found(document["small"], scene=cell["scene"].removesuffix("_suns"),
                            camera=cell["camera"], method=method_of(cell, options))
                row.update({name: cell[name] for name in ERRORS})
        document["measured"]["except"] = ("errors of clpv and the published scheme at 240x135, of "
                                          f"{measured['commit']} on {measured['device']}")
        write(FOLDER, path.stem, document)


def measure_front(model):
    """Variants of clpv by grid, and of other methods by time, with the series that each belongs
    to."""
    given = FRONT, model, "--fresh", "--frames=3"
    variants = [{**row, "series": series} for series, options in FRONT_GRIDS.items()
                for row in quality(*given, "--preset=best", *options)["variants"]]
    for time in FRONT_TIMES:
        report = quality(*given, *OF_A_TIME, f"--baseline-time={time}")
        variants += [{**row, "series": row["options"]["baseline"]} for row in report["variants"]
                     if "baseline" in row["options"]]
    return variants


def indirect_of(file):
    """That layer of a ground truth."""
    image = clpv.read_image(file)
    return clpv.Image(image.array[..., [image.channels.index(f"indirect.{c}") for c in "RGBA"]],
                      tuple("RGBA"))


def draw_methods(model):
    """Light of clpv, of other methods with its time, and path tracing; below, the differences from
    path tracing over its root mean square."""
    with tempfile.TemporaryDirectory() as folder:
        report = quality(["sponza_suns"], model, "--preset=best", "--noise=0.06",
                         *(f"--camera={view}" for view in SHOWN_VIEWS), "--fresh",
                         f"--baseline={','.join(SHOWN)}", f"--frames={STANDING_COUNT}",
                         f"--images={folder}")
        images = {(name, view): clpv.read_image(f"{folder}/{name}/sponza_suns-{view}.exr")
                  for name in SHOWN for view in SHOWN_VIEWS}
    truths = {truth["camera"]: indirect_of(truth["file"]) for truth in report["ground_truths"]}
    exposure = truths[SHOWN_VIEWS[0]].automatic_exposure()
    scene = clpv.Scene(ROOT / "scenes/sponza_suns.json", model)
    height, width = next(iter(images.values())).array.shape[:2]
    tiles = []
    for view in SHOWN_VIEWS:
        truth = truths[view]
        with clpv.Renderer(scene, width=width, height=height, bounces=1) as renderer:
            line = {"clpv": renderer.render("indirect", view),
                    **{title: images[name, view] for name, title in SHOWN.items()},
                    "path traced": truth}
        level = float(numpy.sqrt((truth.array[..., :3]**2).mean()))
        errors = []
        for title, image in line.items():
            error = 100 * clpv.compare(image, truth).nrmse_valid
            caption = f"{title}: NRMSE {error:.0f} %" if image is not truth else f"{view}: {title}"
            tiles.append((image.display(exposure), caption))
            away = abs(image.array - truth.array)[..., :3].mean(axis=2) / level
            errors.append((away if image is not truth else None, ""))
        tiles += errors
    sheet(ROOT / "docs/images/equal-time.jpg",
          "Indirect light of one bounce in equal time, and 0 to 100 % error below", len(SHOWN) + 2,
          (width / 100, height / 100), tiles, cmap="inferno", vmin=0, vmax=1)


def main():
    parser = parser_of(__doc__, required=True)
    parser.add_argument("device", metavar="DEVICE", nargs="?", type=use_device,
                        help="as --device of clpv takes it (default: the first)")
    parser.add_argument("--picture", action="store_true", help="the picture of images alone")
    parser.add_argument("--own", action="store_true", help="errors of clpv's own frames alone")
    arguments = parser.parse_args()
    if arguments.picture or arguments.own:
        (draw_methods if arguments.picture else renew_own)(arguments.model)
        return 0
    measure_standing(FOLDER, arguments.model)
    print("lab/results/quality is written; lab/scripts/tables writes lab/docs/results.md")
    return 0
