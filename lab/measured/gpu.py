# SPDX-License-Identifier: MIT
"""Measures a GPU that is there for a few minutes, in one command (docs/gpu.md).

Devices; frames of the defaults, 1920x1080, `fine`, `paper`, one bounce and a camera that only
moves, also of an older program; hashes of the images of two runs; `clpv check`,
thorough, stages of --first first. A step that the time left does not hold is cut off or left out,
and the file says so. Prints a table of the frames. Scene: Sponza's `curtains` with --model, else
the atrium.
"""
import collections
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile
import time

from . import CLPV, ROOT, cells, described, json_lines, output, parser_of, tables, use_device

FRAMES = {"defaults": [], "1080p": [], "fine": ["--preset", "fine"], "paper": ["--preset", "paper"],
          "one bounce": ["--bounces", "1"]}
SIZES = {"1080p": (1920, 1080)}  # of frames that are not 960x540
QUICK = 48, 27
COUNTS = "launches", "fills", "waits", "arguments"
KEYS = *COUNTS, "written_bytes", "host_ms", "device", "times", "kernels"
LEAST = 5  # [s] for a step


class Clock:
    """The time that is left, and the program that is measured."""

    def __init__(self, minutes, program):
        self.end, self.program = time.monotonic() + 60 * minutes, program

    def run(self, arguments, program=None):
        """Runs clpv: its stdout, and None or why it has none."""
        left = self.end - time.monotonic()
        if left < LEAST:
            return "", "left out: no time left"
        try:
            done = subprocess.run([program or self.program, *arguments], capture_output=True,
                                  text=True, timeout=left, check=False, cwd=ROOT)
        except subprocess.TimeoutExpired as error:
            return (error.stdout or b"").decode(), f"cut off after {left:.0f} s"
        if done.returncode == 0:
            return done.stdout, None
        return done.stdout, f"exit code {done.returncode}: {done.stderr.strip()[-500:]}"


def frame(clock, program, scene, options, folder):
    """Times, counts and the image's hash of a frame, measured twice; `hash` is that of both."""
    row, hashes = {}, set()
    for _ in range(2):
        stats, image = folder / "stats.json", folder / "image.exr"
        _, why = clock.run([*scene, *options, "-o", image, "--stats", stats], program)
        if why:
            return {**dict.fromkeys(COUNTS), "times": [], "hash": "", "failed": why}
        hashes.add(hashlib.sha256(image.read_bytes()).hexdigest())
        found = json.loads(stats.read_text())
        if row and found["times"][0]["median"] > row["times"][0]["median"]:
            continue
        row = {key: found.get(key) for key in KEYS}
    return {**row, "hash": hashes.pop() if len(hashes) == 1 else "two runs differ"}


def bench(clock, suite, *options):
    """Rows of a suite of `clpv bench`: name, status, median, counts."""
    text, why = clock.run(["bench", suite, "--format", "json", *options])
    if why:
        return [{"failed": why}]
    keys = "name", "status", "median", *COUNTS
    return [{key: row.get(key) for key in keys} for row in json.loads(text)["benchmarks"]]


def check(clock, options, stages):
    """Results of `clpv check` by status, of these stages or of all."""
    chosen = ["--stage", *stages] if stages else []
    text, why = clock.run(["check", "--format", "json", *options, *chosen])
    if not text or (why and "exit code" not in why):
        return {"failed": why}
    results = json.loads(text)["checks"]
    return {"results": collections.Counter(result["status"] for result in results),
            "bad": [result for result in results if result["status"] in ("wrong", "failed")]}


# Markdown: a row a frame, before and after; "-" for what failed.
COLUMNS = {"frame": "{frame}", "program": "{program}", "frame [ms]": "{ms:.2f}",
           "host [ms]": "{host:.2f}", **{name: f"{{{name}:.0f}}" for name in COUNTS}}
MS = {"ms": "ms_of(times, 'frame') or None", "host": "ms_of(times, 'host') or None"}


def measure(options, folder):
    programs = {"this": options.clpv.resolve()}
    if options.before:
        programs["before"] = options.before.resolve()
    clock = Clock(options.minutes, programs["this"])
    scene = ["render", "--frames", "2" if options.quick else "15"]
    if options.model:
        scene += ["scenes/sponza.json", "--model", options.model, "--camera", "curtains"]
    else:
        scene.append("scenes/atrium.json")
    # Frames first: they are what a GPU is lent for. Each of both programs in turn.
    frames = []
    for name, chosen in FRAMES.items():
        width, height = QUICK if options.quick else SIZES.get(name, (960, 540))
        size = ["--width", str(width), "--height", str(height)]
        for program, path in programs.items():
            frames.append({"frame": name, "program": program,
                           **frame(clock, path, scene, size + chosen, folder)})
    few = ["--repetitions", "2"] if options.quick else []
    text, why = clock.run(["devices", "--format", "json"])
    report = {
        "context": {"commit": described(), "scene": "Sponza" if options.model else "atrium",
                    "quick": options.quick, "before": str(options.before or "")},
        "devices": why or json.loads(text),
        "frames": frames,
        "moving": bench(clock, "frame", "--filter", "^frame/sh2.*/best/recompute:nothing", *few),
    }
    thorough = [] if options.quick else ["--thorough"]
    stages = [stage for stage in options.first.split(",") if stage]
    report["check first"] = check(clock, thorough, stages) if stages else {}
    report["check"] = {} if options.quick and stages else check(clock, thorough, [])
    return report


def main():
    parser = parser_of(__doc__)
    parser.add_argument("-o", "--output", metavar="FILE.json", required=True, type=pathlib.Path)
    parser.add_argument("--device", type=use_device, help="as of clpv --device")
    parser.add_argument("--clpv", type=pathlib.Path, default=CLPV)
    parser.add_argument("--before", type=pathlib.Path, help="an older program")
    parser.add_argument("--first", default="", metavar="STAGE,...", help="to check first")
    parser.add_argument("--minutes", type=float, default=9)
    parser.add_argument("--quick", action="store_true",
                        help="small frames and the short check, for tests")
    options = parser.parse_args()
    output.target_of(options.output)  # found before the work
    with tempfile.TemporaryDirectory() as folder:
        report = measure(options, pathlib.Path(folder))
    output.write(options.output, json_lines(report))
    rows = {"each": report["frames"], "let": MS}
    print(tables.drawn(cells.table({"columns": COLUMNS, "rows": rows})), end="")
    bad = [row for row in report["frames"] if "failed" in row or "differ" in row["hash"]]
    bad += report["check"].get("bad", []) + report["check first"].get("bad", [])
    for row in bad:
        print(f"scripts/gpu: {json.dumps(row)}", file=sys.stderr)
    return 1 if bad else 0
