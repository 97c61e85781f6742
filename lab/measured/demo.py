# SPDX-License-Identifier: MIT
"""The picture of scripts/demo: the atrium under sun and sky by direct light, with all bounces, and
path traced. Only the standard library.

    PYTHONPATH=lab python3 -m measured.demo DIR [--width N] [--height N] [RENDER_OPTION...]

DIR: output folder. Other options go to `clpv render`, those OF_BOTH to `clpv pathtrace` too.
"""
import argparse
import array
import json
import pathlib
import struct
import sys
import zlib

from . import ROOT, output, run_clpv
from clpv import ms_of

sys.path.insert(0, str(ROOT / "lab/python"))
from clpv_lab.score import exr  # noqa: E402  pylint: disable=wrong-import-position

SCENE = ROOT / "scenes/atrium.json"
EXPOSURE = -0.7  # [EV]
SKY = {"radiance": [1.2, 1.6, 2.4], "ground": [0, 0, 0]}  # [W/m^2/sr]
WIDTH, HEIGHT = 384, 216  # three of this width fit a screen
NOISE = 0.1  # noise of the path-traced light; adds little to the error
GAP = 4  # between the pictures [pixels]
OWN = "-o", "--output", "--view", "--bounces", "--stats"
OF_BOTH = ("--camera", "--eye", "--target", "--up", "--fov", "--near-plane", "--sun",
           "--light-scale", "--medium", "--time", "--model")


def displayed(x):
    """Byte of a linear value: exposure, curve `photographic` and sRGB, as a PNG of clpv has it."""
    x = max(x, 0) * 2**EXPOSURE
    x = min(1, x * (1 + x / 36) / (1 + x))
    return round(255 * (12.92 * x if x <= 0.0031308 else 1.055 * x**(1 / 2.4) - 0.055))


def of_both(options):
    return [word for i, option in enumerate(options) if option.split("=")[0] in OF_BOTH
            for word in options[i:i + 1 + ("=" not in option)]]


def shown(file, layer):
    """Rows of sRGB bytes."""
    width, height, planes = exr.raw(file)
    colours = [map(displayed, array.array("f", planes[f"{layer}.{c}"][1])) for c in "RGB"]
    pixels = b"".join(map(bytes, zip(*colours)))
    return [pixels[3 * width * y:3 * width * (y + 1)] for y in range(height)]


def rendered(folder, size, options):
    """Renders and path-traces into an output.Folder. Returns the pictures from left to right, and
    the error of a frame with all bounces."""
    scene = json.loads(SCENE.read_text())
    scene.update(model=str(SCENE.parent / scene["model"]), sky=SKY)
    folder.write("day.json", json.dumps(scene, indent=2))
    day, ours, truth = (folder.path / name for name in ("day.json", "clpv.exr", "truth.exr"))
    common = [f"--width={size[0]}", f"--height={size[1]}", "--bounces=all"]
    run_clpv("render", day, "-o", ours, "--view", "full", "direct", "indirect", *common,
             "--stats", folder.path / "frame.json", *options, cwd=None)
    run_clpv("pathtrace", day, "-o", truth, "--view", "full", "indirect", *common,
             f"--noise={NOISE}", *of_both(options), cwd=None)
    errors = json.loads(run_clpv("compare", f"{ours}:indirect", f"{truth}:indirect"))
    return [shown(ours, "direct"), shown(ours, "full"), shown(truth, "full")], errors["nrmse_valid"]


def picture(pictures):
    """Bytes of a PNG with the pictures side by side."""
    rows = [(b"\xff" * 3 * GAP).join(row) for row in zip(*pictures)]

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">2I5B", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)
    above = [bytes(len(rows[0])), *rows]  # filter 2: differences from the row above
    pixels = zlib.compress(b"".join(b"\2" + bytes(a - b & 255 for a, b in zip(*both))
                                    for both in zip(rows, above)), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) + chunk(b"IEND", b"")


def print_stages(stats):
    """Stage times of `clpv render --stats`, summed over cascades and lights."""
    rows = [[stage, f"{ms_of(stats['times'], stage):.2f}"]
            for stage in dict.fromkeys(time["stage"] for time in stats["times"])]
    rows.sort(key=lambda row: row[0] in ("frame", "host"))
    started = [[key.removesuffix("_ms").replace("_", " "), f"{stats[key]:.2f}"]
               for key in ("first_launch_ms", "build_ms", "startup_ms")]
    width = max(len(name) for name, _ in rows + started)
    head, rule = ["stage [ms]", stats["options"]["basis"]], ["-" * width, "-" * 8]
    for name, value in [head, rule, *rows, rule, *started]:
        print(f"{name:{width}}  {value:>8}")
    device = stats["device"]
    print(f"on {device['name']} ({device['platform']}, driver {device['driver']})")


def main():
    parser = argparse.ArgumentParser(prog="scripts/demo", usage="scripts/demo [RENDER_OPTION...]",
                                     add_help=False, allow_abbrev=False)
    parser.add_argument("folder", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--width", type=int, default=WIDTH)
    parser.add_argument("--height", type=int, default=HEIGHT)
    arguments, options = parser.parse_known_args()
    if own := [option for option in options if option.split("=")[0] in OWN]:
        parser.error(f"found {own[0]}; allowed: options other than {', '.join(OWN)}")
    folder = output.Folder(arguments.folder, "scripts/demo")
    pictures, error = rendered(folder, (arguments.width, arguments.height), options)
    folder.write("demo.png", picture(pictures))
    stats = json.loads((folder.path / "frame.json").read_text())
    print_stages(stats)
    milliseconds = ms_of(stats["times"], "frame")
    print(f"All bounces: {milliseconds:.0f} ms per frame of {arguments.width}x{arguments.height}; "
          f"error of indirect light {100 * error:.0f} % (NRMSE against path tracing at "
          f"{arguments.width}x{arguments.height})")
    print(f"Picture: {folder.path}/demo.png: direct light, global illumination by clpv, path traced")
    return 0


if __name__ == "__main__":
    sys.exit(output.exit_code(main))
