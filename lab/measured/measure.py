# SPDX-License-Identifier: MIT
"""Measures a device for results/, or all numbers that the tables in the docs show.

    scripts/measure NAME [DEVICE]                              into results/NAME: 15 minutes on two
                                                               cores
    scripts/measure docs --model PATH/Sponza.gltf [DEVICE]     into results/docs: up to two hours on
                                                               two cores

NAME: driver and processor or GPU, such as pocl-3.1-epyc-2-cores. The first form runs `clpv check`
and four suites of `clpv bench`. The second runs more suites, frames with --stats, and `clpv
quality` against path tracing, and redraws the charts in docs/images; scripts/tables then writes the
tables. The paper's numbers are those of scripts/reproduce --record. Commit and build first (scripts/build),
and keep the machine free of other work. results/NAME of the first form is new, empty, or of an
earlier run. Files hold no samples and no host name. `clpv quality` caches ground truths, and for
the docs finished cells, so a second run of it is short. The second form needs Debian's Python and
its packages.
"""
import datetime
import functools
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

from . import (CLPV, RESULTS, ROOT, bake, charts, described, json_lines, leaks, output, parser_of,
               rooms, rows, run_clpv, use_device)

FRAME_COUNT = 9
IMAGES = ROOT / "docs/images"


def run(*arguments, program=CLPV, right=False):
    """Returns the JSON of `clpv ARGUMENTS FILE.json`, without samples and host name, with FOLDER a
    temporary folder. Where that fails and leaves a file, as `clpv bench` does, goes on, but if it has
    to be `right`."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "result.json"
        command = [str(program), *(argument.replace("FOLDER", folder) for argument in arguments),
                   str(file)]
        print(f"{sys.argv[0]}: clpv", *arguments, file=sys.stderr)
        code = subprocess.run(command, stdout=subprocess.DEVNULL, check=False, cwd=ROOT).returncode
        if code != 0:
            print(f"{sys.argv[0]}: exit code {code}", file=sys.stderr)
        if code != 0 and right or not file.exists():
            sys.exit(code)
        document = json.loads(file.read_text(encoding="utf-8"))
    document.get("context", {}).pop("host_name", None)
    for row in document.get("benchmarks", []):
        row.pop("samples_ms", None)
    return document


def write(folder, name, document):
    output.write(folder / f"{name}.json", json_lines(document))


def measure_device(folder):
    output.Folder(folder, "scripts/measure")
    write(folder, "check", json.loads(run_clpv("check", "--format=json", check=False)))
    for suite, options in rows.DEVICE_SUITES.items():
        write(folder, suite, run("bench", suite, *options.split(), "--output"))


def scenes_of(arguments, model):
    """Arguments of `clpv quality`: paths of the scenes, options, and Sponza's model."""
    scenes = [argument for argument in arguments if not argument.startswith("--")]
    return ([f"scenes/{scene}.json" for scene in scenes] + arguments[len(scenes):]
            + [f"--model={scene}={model}" for scene in scenes if scene.startswith("sponza")])


def measured_with(device):
    return {"commit": described(), "date": str(datetime.date.today()),
            "device": device["name"], "driver": f"{device['platform']} {device['driver']}"}


def measure_quality(name, model):
    arguments, runs = rows.QUALITY_FILES[name]
    cells, variants = [], []
    given = scenes_of(arguments, model)
    if not any(argument.startswith("--preset") for argument in given):
        given.append("--preset=best")  # bases and transports that a run does not name keep defaults
    for options in runs:
        vary = [f"--vary={option}={value}" for option, value in options.items()]
        document = run("quality", *given, *vary, "--output")
        cells += document["cells"]
        variants += document["variants"]
    return {"given": arguments, "cells": cells, "variants": variants}


def measure_media(model):
    cells = []
    for each in rows.MEDIA:
        for count, view in itertools.product(each["bounces"], each["views"]):
            report = run("quality", *scenes_of(each["given"].split(), model), "--preset=best",
                         "--spp=256", f"--bounces={count}", f"--view={view}", "--output")
            cells += [{**cell, "medium": each["medium"], "bounces": count, "view": view}
                      for cell in report["cells"]]
    return {"cells": cells}


def sponza_of(model):
    return [f"--model={model}", "--camera=curtains"]


def measure_frames(model):
    frames = []
    for varied in rows.table("FRAMES").values():
        stats = run("render", "scenes/sponza_suns.json", *sponza_of(model),
                    *(f"--{name}={value}" for name, value in ({"bounces": 1} | varied).items()),
                    f"--frames={FRAME_COUNT}", "--output=FOLDER/frame.png", "--stats")
        frames.append({"given": varied, "times": stats["times"]})
    return {"frames": frames}


def measure_suite(name, model, options, right=False):
    words = options.split()
    if words[:1] == ["sponza"]:
        words = ["--scene=scenes/sponza_suns.json", *sponza_of(model), *words[1:]]
    return run("bench", name, *words, "--output", right=right)


def draw_front():
    charts.draw_errors({
        label: json.loads((RESULTS / f"docs/{name}.json").read_text())["variants"]
        for label, name in (("clpv, --preset fast", "quality-grid"),
                            ("published scheme, sh2 in buffers", "quality-grid-published"))
    }, IMAGES / "front.png")


# Files of results/docs, each with a function of Sponza's model that measures it; and what is drawn
# after them.
PARTS = {
    "frames": measure_frames,
    **{name: functools.partial(measure_suite, name, options=options)
       for name, options in rows.DOCS_SUITES.items()},
    **{name: functools.partial(measure_quality, name) for name in rows.QUALITY_FILES},
    "quality-media": measure_media,
    "bake": lambda model: {"rows": bake.measure(model), "part": bake.measure_part()},
    "bake-leaks": lambda _: {"rows": bake.measure_leaks()},
    "leaks": lambda _: {"leaks": leaks.measure(**rows.LEAKS)},
    "rooms": lambda _: {"rows": rooms.measure()},
}
DRAWN = {
    "frames": [lambda: charts.draw_frame(IMAGES)],
    "bake": [lambda: charts.draw_probes(IMAGES / "probes.png"),
             lambda: charts.draw_spheres(IMAGES / "spheres.jpg")],
    "rooms": [lambda: rooms.draw(IMAGES / "rooms.jpg")],
    "quality-grid": [draw_front], "quality-grid-published": [draw_front]
}


def measure_docs(model, parts):
    """`parts`: names of files in results/docs."""
    tiny = run("render", "scenes/cornell.json", "--width=16", "--height=9",
               "--output=FOLDER/frame.png", "--stats")
    measured = measured_with(tiny["device"])
    for name in parts:
        write(RESULTS / "docs", name, {"measured": measured, **PARTS[name](model)})
        for draw in DRAWN.get(name, []):
            draw()


def main():
    parser = parser_of(__doc__)
    parser.add_argument("name", metavar="NAME",
                        help="folder in results/; docs: all that the docs' tables show")
    parser.add_argument("device", metavar="DEVICE", nargs="?", type=use_device,
                        help="as --device of clpv takes it (default: the first)")
    parser.add_argument("--part", metavar="NAME", action="append",
                        help="of docs: a file of results/docs, repeatable (default: all)")
    arguments = parser.parse_intermixed_args()
    for part in arguments.part or []:
        if arguments.name != "docs" or part not in PARTS:
            parser.error(f"--part {part}: allowed for docs: {', '.join(PARTS)}")
    if (arguments.name == "docs") != (arguments.model is not None):
        parser.error("--model: needed for docs, and for these alone")
    if arguments.name == "docs":
        measure_docs(arguments.model, arguments.part or PARTS)
        print("results/docs is written; scripts/tables and lab/scripts/tables write the tables")
    else:
        measure_device(RESULTS / arguments.name)
        print(f"results/{arguments.name} is written; results/README.md says how to send it")
