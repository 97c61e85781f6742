# SPDX-License-Identifier: MIT
"""The picture of scripts/demo: the atrium under sun and sky by direct light, with all bounces, and
path traced.

    PYTHONPATH=scripts python3 -m measured.demo DIR [--width N] [--height N] [RENDER_OPTION...]

DIR: output folder. Other options go to `clpv render`, those OF_BOTH to `clpv pathtrace` too.
"""
import argparse
import json
import pathlib
import subprocess
import sys

import numpy
import PIL.Image

from . import CLPV, ROOT, output
from clpv import ms_of
from clpv.draw import style

SCENE = ROOT / "scenes/atrium.json"
EXPOSURE = -0.7  # [EV]
SKY = {"radiance": [1.2, 1.6, 2.4], "ground": [0, 0, 0]}  # [W/m^2/sr]
WIDTH, HEIGHT = 384, 216  # three of this width fit a screen
NOISE = 0.1  # of the path-traced light; adds little to the error
DPI = 100
OWN = "-o", "--output", "--view", "--bounces", "--stats"
OF_BOTH = ("--camera", "--eye", "--target", "--up", "--fov", "--near-plane", "--sun",
           "--light-scale", "--medium", "--time", "--model")


def displayed(light):
    """sRGB values of linear ones: exposure and curve `photographic`, as a PNG of clpv has them."""
    x = light.clip(0) * 2**EXPOSURE
    x = (x * (1 + x / 36) / (1 + x)).clip(0, 1)
    return numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * x**(1 / 2.4) - 0.055)


def of_both(options):
    return [word for i, option in enumerate(options) if option.split("=")[0] in OF_BOTH
            for word in options[i:i + 1 + ("=" not in option)]]


class Demo:
    """Images in linear EXR, in a folder of scripts/demo."""

    def __init__(self, folder, size, options):
        self.folder, self.options, self.size = folder, options, size
        self.stats = folder.file("frame.json")

    def run(self, *arguments):
        """Returns what clpv prints. Its own message and exit code end the demo."""
        try:
            return subprocess.run([CLPV, *map(str, arguments)], check=True, text=True,
                                  stdout=subprocess.PIPE).stdout
        except subprocess.CalledProcessError as error:
            sys.exit(error.returncode if error.returncode > 0 else 1)

    def image(self, command, scene, name, views, *options):
        file = self.folder.file(name)
        self.run(command, scene, "-o", file, "--view", *views, f"--width={self.size[0]}",
                 f"--height={self.size[1]}", "--bounces=all", *options)
        return file

    def shown(self, file, layer):
        planes = self.folder.file(f"{file.stem}-{layer}.tif")
        each = [word for colour in "RGB" for word in (file, "--ch", f"{layer}.{colour}")]
        subprocess.run(["oiiotool", *each, "--mosaic", "1x3", "-d", "float", "-o", planes],
                       check=True)
        rows = numpy.asarray(PIL.Image.open(planes))
        return displayed(numpy.moveaxis(rows.reshape(3, -1, rows.shape[1]), 0, -1))

    def make(self):
        """Returns [(caption, sRGB image)], and the error of a frame with all bounces."""
        scene = json.loads(SCENE.read_text())
        scene.update(model=str(SCENE.parent / scene["model"]), sky=SKY)
        self.folder.write("day.json", json.dumps(scene, indent=2).encode())
        day = self.folder.path / "day.json"
        ours = self.image("render", day, "clpv.exr", ("full", "direct", "indirect"), "--stats",
                          self.stats, *self.options)
        truth = self.image("pathtrace", day, "truth.exr", ("full", "indirect"),
                           f"--noise={NOISE}", *of_both(self.options))
        errors = json.loads(self.run("compare", f"{ours}:indirect", f"{truth}:indirect"))
        return [("Direct light", self.shown(ours, "direct")),
                ("Global illumination by clpv", self.shown(ours, "full")),
                ("Path traced", self.shown(truth, "full"))
               ], errors["nrmse_valid"]


def picture(tiles):
    """Bytes of a PNG: the tiles side by side at their sizes, with captions below."""
    gap, line = 4, 22  # [pixels]
    width = sum(image.shape[1] + gap for _, image in tiles) + gap
    height = max(image.shape[0] for _, image in tiles) + line + 2 * gap
    figure = style.pyplot.figure(figsize=(width / DPI, height / DPI), facecolor="white", dpi=DPI)
    left = gap
    for caption, image in tiles:
        figure.figimage(image, left, line + gap, resize=False)
        figure.text((left + image.shape[1] / 2) / width, line / height, caption, ha="center",
                    va="top", fontsize=9)
        left += image.shape[1] + gap
    return style.rendered(figure, "png", dpi=DPI)


def print_stages(stats):
    """Of `clpv render --stats`; sums over cascades and lights."""
    rows = [[stage, ms_of(stats["times"], stage)]
            for stage in dict.fromkeys(time["stage"] for time in stats["times"])]
    rows.sort(key=lambda row: row[0] in ("frame", "host"))
    started = [[key.removesuffix("_ms").replace("_", " "), stats[key]]
               for key in ("first_launch_ms", "build_ms", "startup_ms")]
    width = max(len(name) for name, _ in rows + started)
    rule = "-" * width + "  " + "-" * 8
    print(f"{'stage [ms]':{width}}  {stats['options']['basis']:>8}", rule, sep="\n")
    for name, milliseconds in rows + [[rule, None]] + started:
        print(name if milliseconds is None else f"{name:{width}}  {milliseconds:8.2f}")
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
    demo = Demo(folder, (arguments.width, arguments.height), options)
    tiles, error = demo.make()
    folder.write("demo.png", picture(tiles))
    stats = json.loads(demo.stats.read_text())
    print_stages(stats)
    milliseconds = ms_of(stats["times"], "frame")
    print(f"All bounces: {milliseconds:.0f} ms per frame of {arguments.width}x{arguments.height}; "
          f"error of indirect light {100 * error:.0f} % (NRMSE against path tracing at "
          f"{arguments.width}x{arguments.height})")
    print(f"Picture: {folder.path}/demo.png")
    return 0


if __name__ == "__main__":
    sys.exit(output.exit_code(main))
