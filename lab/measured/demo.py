# SPDX-License-Identifier: MIT
"""The picture of scripts/demo: the atrium under sun and sky by direct light, with all bounces, and
path traced. Only the standard library.

    PYTHONPATH=lab python3 -m measured.demo DIR [--width N] [--height N] [RENDER_OPTION...]

DIR: output folder. Other options go to `clpv render`, those OF_BOTH to `clpv pathtrace` too.
"""
import argparse
import array
import itertools
import json
import pathlib
import struct
import subprocess
import sys
import zlib

from . import CLPV, ROOT, output
from clpv import ms_of

SCENE = ROOT / "scenes/atrium.json"
EXPOSURE = -0.7  # [EV]
SKY = {"radiance": [1.2, 1.6, 2.4], "ground": [0, 0, 0]}  # [W/m^2/sr]
WIDTH, HEIGHT = 384, 216  # three of this width fit a screen
NOISE = 0.1  # noise of the path-traced light; adds little to the error
GAP = 4  # between the pictures [pixels]
OWN = "-o", "--output", "--view", "--bounces", "--stats"
OF_BOTH = ("--camera", "--eye", "--target", "--up", "--fov", "--near-plane", "--sun",
           "--light-scale", "--medium", "--time", "--model")


def unpacked(block):
    """Bytes of a compressed EXR block: deflate, differences of bytes, two halves interleaved."""
    block = bytearray(zlib.decompress(block))
    block[:] = itertools.accumulate(block, lambda value, step: value + step - 128 & 255)
    even = (len(block) + 1) // 2
    block[::2], block[1::2] = block[:even], block[even:]
    return block


def read_exr(file):
    """(width, height, {channel: floats}) of an EXR that clpv wrote."""
    data = file.read_bytes()
    at, header = 8, {}
    while data[at]:
        name, _, rest = data[at:].split(b"\0", 2)
        at = len(data) - len(rest) + 4
        size = int.from_bytes(rest[:4], "little")
        header[name], at = data[at:at + size], at + size
    left, top, right, bottom = struct.unpack("<4i", header[b"dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    planes, names = {}, header[b"channels"]
    while names[0]:
        name, rest = names.split(b"\0", 1)
        planes[name.decode()], names = array.array("f"), rest[16:]
    rows = 16 if header[b"compression"][0] else 1  # rows of a block
    for i in range(-(-height // rows)):
        start, = struct.unpack_from("<Q", data, at + 1 + 8 * i)
        first, size = struct.unpack_from("<2i", data, start)
        block = data[start + 8:start + 8 + size]
        count = min(rows, top + height - first)
        if size < 4 * width * count * len(planes):
            block = unpacked(block)
        for row, (name, plane) in itertools.product(range(count), enumerate(planes.values())):
            begin = 4 * width * (row * len(planes) + name)
            plane.frombytes(block[begin:begin + 4 * width])
    return width, height, planes


def displayed(x):
    """Byte of a linear value: exposure, curve `photographic` and sRGB, as a PNG of clpv has it."""
    x = max(x, 0) * 2**EXPOSURE
    x = min(1, x * (1 + x / 36) / (1 + x))
    return round(255 * (12.92 * x if x <= 0.0031308 else 1.055 * x**(1 / 2.4) - 0.055))


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
        """Rows of sRGB bytes."""
        width, height, planes = read_exr(file)
        pixels = b"".join(map(bytes, zip(*(map(displayed, planes[f"{layer}.{colour}"])
                                           for colour in "RGB"))))
        return [pixels[3 * width * y:3 * width * (y + 1)] for y in range(height)]

    def make(self):
        """Returns the pictures from left to right, and the error of a frame with all bounces."""
        scene = json.loads(SCENE.read_text())
        scene.update(model=str(SCENE.parent / scene["model"]), sky=SKY)
        self.folder.write("day.json", json.dumps(scene, indent=2).encode())
        day = self.folder.path / "day.json"
        ours = self.image("render", day, "clpv.exr", ("full", "direct", "indirect"), "--stats",
                          self.stats, *self.options)
        truth = self.image("pathtrace", day, "truth.exr", ("full", "indirect"),
                           f"--noise={NOISE}", *of_both(self.options))
        errors = json.loads(self.run("compare", f"{ours}:indirect", f"{truth}:indirect"))
        return [self.shown(ours, "direct"), self.shown(ours, "full"), self.shown(truth, "full")
               ], errors["nrmse_valid"]


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
    pictures, error = demo.make()
    folder.write("demo.png", picture(pictures))
    stats = json.loads(demo.stats.read_text())
    print_stages(stats)
    milliseconds = ms_of(stats["times"], "frame")
    print(f"All bounces: {milliseconds:.0f} ms per frame of {arguments.width}x{arguments.height}; "
          f"error of indirect light {100 * error:.0f} % (NRMSE against path tracing at "
          f"{arguments.width}x{arguments.height})")
    print(f"Picture: {folder.path}/demo.png: direct light, global illumination by clpv, path traced")
    return 0


if __name__ == "__main__":
    sys.exit(output.exit_code(main))
