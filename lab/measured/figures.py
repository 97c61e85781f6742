# SPDX-License-Identifier: MIT
"""The paper's Figures 1 to 6 by clpv, for scripts/reproduce: contact sheets with captions, and
numbers. figures.json has the sheets of frames; basis_figures.py draws Figures 2, 3 and 6.

These are clpv's renderings of the paper's captions, not the paper's images; docs/paper/figures.md
describes them."""
import functools
import itertools
import json
import pathlib

import numpy as np

from . import basis_figures, cells, claims, native
from .rows import keywords_of
from .sheets import sheet

clpv = native()

DATA = json.loads(pathlib.Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))
LUMINANCE = (0.2126, 0.7152, 0.0722)
PRESETS = ("paper", "best")
BASES = ("sh2", "srbf8v2")
NOISE = 0.1  # noise of the path-traced picture
SIZES = (12.5, 50)  # m, edge of the smallest cascade
STEPS = (8, 24)
AMPLIFY = 15  # factor of difference images, as in the paper and in captions of figures.json
EXPOSURE = 4  # exposure of all images [EV]
WIDTH, DPI = 12.7, 85  # sheets: inches, pixels per inch
# A pixel counts as darker if it lost more than this share of the view's mean; smaller changes are
# rounding.
DARKER = 0.02


class Frames:
    """Frames of one view, each rendered once."""

    def __init__(self, views, arguments, camera):
        self.views, self.camera = views, camera
        self.size = {"width": arguments.width, "height": arguments.height}
        self.title = f"Sponza, camera {camera}, exposure {EXPOSURE:+g} EV"

    @functools.cache
    def rendered(self, options):
        renderer = self.views.renderer(**{**self.size, "bounces": "auto", **keywords_of(options)})
        return {"full": renderer.render("full", self.camera), "indirect": renderer.show("indirect")}

    def image(self, layer, options):
        """Pixels for a display, transparent without a surface."""
        return self.rendered(options)[layer].display(EXPOSURE)

    def luminance(self, options):
        """Luminance of the indirect light."""
        return self.rendered(options)["indirect"].array[..., :3] @ np.array(LUMINANCE)


def difference(a, b):
    return np.clip(AMPLIFY * np.abs(a.astype(int) - b)[..., :3], 0, 255).astype(np.uint8)


def write_sheet(path, title, columns, tiles):
    """Tiles (pixels, caption), row by row, under a title."""
    height, width = tiles[0][0].shape[:2]
    size = WIDTH / columns, WIDTH / columns * height / width
    sheet(path, title, columns, size, tiles, DPI, interpolation="lanczos", aspect="auto")


def tiles_of(frames, spec):
    """Tiles of a sheet of figures.json: a caption and options, or those of two images, whose
    difference it shows."""
    for row in cells.rows_of(spec["rows"]):
        for caption, *each in [*spec.get("tiles", DATA["tiles"]), *spec.get("more", [])]:
            images = [frames.image(row.get("layer", "full"),
                                   f"{cells.shown(spec['options'], row)} {options}")
                      for options in each]
            yield (difference(*images) if len(images) > 1 else images[0],
                   caption.format(caption=cells.shown(spec["caption"], row)))


def answer(frames, out):
    tiles, truth = [], clpv.pathtrace(frames.views.scene, "indirect", frames.camera, **frames.size,
                                      bounces=1, noise=NOISE)
    for preset, basis in itertools.product(PRESETS, BASES):
        image = frames.rendered(f"--basis={basis} --preset={preset} --bounces=1")["indirect"]
        error = f"NRMSE {100 * clpv.compare(image, truth).nrmse:.0f} %"
        tiles.append((image.display(EXPOSURE + 1), f"{basis}, --preset {preset}: {error}"))
    tiles.insert(len(BASES), (truth.display(EXPOSURE + 1), "path traced"))
    write_sheet(out.file("answer.jpg"), f"Indirect light of one bounce: Sponza, {frames.camera}", 3,
                tiles)


def brightness(frames):
    """Rows: mean luminance of the indirect light at both numbers of steps, and the share of pixels
    that the later steps darken."""
    for variant, size in itertools.product(DATA["brightness"], SIZES):
        few, many = (frames.luminance(f"{variant} --cascade-size={size} --iterations={steps}")
                     for steps in STEPS)
        yield {**keywords_of(variant), "cascade_size": size, "mean_8": float(few.mean()),
               "mean_24": float(many.mean()),
               "darker": float((many < few - DARKER * few.mean()).mean())}


def paper(arguments):
    """Files of Figures 1, 4 and 5, and of 2, 3 and 6, and brightness. Without a model Figures 2, 3
    and 6 only."""
    out = arguments.out
    lobe_files = [name for kind in ("rotate", "exact") for name in basis_figures.draw(out, kind)]
    if not arguments.model:
        return {"sheets": [], "lobes": lobe_files, "rows": []}
    nave = claims.Views(arguments)
    nave.scene.lights, nave.scene.cameras = [claims.ALONG_THE_NAVE], [claims.OF_ARCADE]
    frames = {camera: Frames(views, arguments, camera) for camera, views in (
        ("curtains", claims.Views(arguments)), ("atrium", claims.Views(arguments)),
        ("arcade", nave))}
    for name, spec in DATA["sheets"].items():
        if not (arguments.quick and spec.get("whole")):
            view = frames[spec["view"]]
            write_sheet(out.file(name), f"{spec['title']} ({view.title})", spec["columns"],
                        list(tiles_of(view, spec)))
    answer(frames["curtains"], out)
    sheets = [name for name in out.written if "/" not in name]
    return {"sheets": sheets, "lobes": lobe_files,
            "rows": [] if arguments.quick else list(brightness(frames["atrium"]))}
