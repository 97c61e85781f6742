# SPDX-License-Identifier: MIT
"""The paper's Figures 1 to 6 by clpv, for scripts/reproduce: contact sheets with captions, and
numbers.

figure1, figure4   Sponza, camera `curtains`, by `--preset paper` and by the defaults with the
                   paper's two bases
figure2, 3, 6      by `clpv basis --figures`, with both kinds of lobes
figure5            the arcade and the wall behind it, sun along the nave, as figure1
answer             indirect light of both bases by either preset, beside path tracing
srbf14             srbf14 with rotated lobes and sampled transport, and with exact ones; camera
                   `atrium`

These are clpv's renderings of the paper's captions, not the paper's images; docs/paper/figures.md
describes them. """
import functools
import itertools
import pathlib
import subprocess
import tempfile

import numpy as np

from . import CLPV, ROOT, native
from . import claims
from .rows import options_of

clpv = native()
from clpv.draw import style  # noqa: E402

LUMINANCE = (0.2126, 0.7152, 0.0722)
PRESETS = ("paper", "best")
BASES = ("sh2", "srbf8v2")
NOISE = 0.1  # noise of the path-traced picture
LOBES = ("rotate", "exact")
SIZES = (12.5, 50)  # m, edge of the smallest cascade
STEPS = (8, 24)
# Three settings for srbf14. The first's errors are those of the table too.
EXACT = {name.replace("-", "_"): value for name, value in options_of("EXACT_LOBES").items()
         if name != "preset"}
SETTINGS = {
    "rotated lobes": {},
    "exact lobes": EXACT,
    "both exact": {**EXACT, "transport": "exact"},
}
AMPLIFY = 15  # factor of difference images, as in the paper
EXPOSURE = 4  # exposure of all images [EV]
WIDTH, DPI = 12.7, 85  # sheets: inches, pixels per inch
# A pixel counts as darker if it lost more than this share of the view's mean; smaller changes are
# rounding.
DARKER = 0.02


class Frames:
    """Frames of one view, each rendered once, as display images and as arrays."""

    def __init__(self, scene, arguments, camera):
        self.scene, self.camera = scene, camera
        self.size = {"width": arguments.width, "height": arguments.height}
        self.view = f"Sponza, camera {camera}, exposure {EXPOSURE:+g} EV"
        self.always = {}  # options of all frames of a preset with steps

    @functools.cache
    def rendered(self, **options):
        always = self.always if options.get("preset") == "paper" else {}
        renderer = clpv.Renderer(self.scene, **self.size, **{**always, **options})
        return {"full": renderer.render("full", self.camera), "indirect": renderer.show("indirect")}

    def frame(self, view, **options):
        """The frame as an Image."""
        return self.rendered(**options)[view]

    def image(self, view="full", **options):
        """Pixels for a display, transparent without a surface."""
        return self.frame(view, **options).display(EXPOSURE)

    def indirect(self, **options):
        """Luminance of the indirect light."""
        return self.frame("indirect", **options).array[..., :3] @ np.array(LUMINANCE)


def difference(a, b):
    return np.clip(AMPLIFY * np.abs(a.astype(int) - b)[..., :3], 0, 255).astype(np.uint8)


def sheet(path, title, columns, tiles):
    """Tiles (pixels, caption), row by row, under a title."""
    height, width = tiles[0][0].shape[:2]
    tile = (WIDTH / columns, WIDTH / columns * height / width)
    made = style.Sheet([title], columns, len(tiles), tile, above=True)
    for i, (pixels, caption) in enumerate(tiles):
        made.tile(i, caption).imshow(pixels, interpolation="lanczos", aspect="auto")
    made.save(path, DPI)


def pair(frames, view="full", **options):
    """Returns captioned tiles of both bases and of their difference."""
    images = [frames.image(view, basis=basis, **options) for basis in BASES]
    return [*zip(images, BASES), (difference(*images), f"difference x{AMPLIFY}")]


def with_caption(tiles, text):
    return [(pixels, f"{caption}, {text}") for pixels, caption in tiles]


def figure1(frames, out):
    tiles = [
        tile for preset in PRESETS
        for tile in with_caption(pair(frames, preset=preset), f"--preset {preset}")
    ]
    sheet(out.file("figure1.jpg"), f"Figure 1: two bases by either preset ({frames.view})", 3,
          tiles)


def answer(frames, out):
    tiles, truth = [], clpv.pathtrace(frames.scene, "indirect", frames.camera, **frames.size,
                                      noise=NOISE)
    for preset, basis in itertools.product(PRESETS, BASES):
        image = frames.frame("indirect", basis=basis, preset=preset, bounces=1)
        error = f"NRMSE {100 * clpv.compare(image, truth).nrmse:.0f} %"
        tiles.append((image.display(EXPOSURE + 1), f"{basis}, --preset {preset}: {error}"))
    tiles.insert(len(BASES), (truth.display(EXPOSURE + 1), "path traced"))
    sheet(out.file("answer.jpg"), f"Indirect light of one bounce: Sponza, {frames.camera}", 3,
          tiles)


def figure4(frames, out, preset):
    tiles = []
    for size, steps in itertools.product(SIZES, STEPS if preset == "paper" else
                                         ("no", )):  # a sweep takes none
        given = {} if steps == "no" else {"iterations": steps}
        tiles += with_caption(pair(frames, preset=preset, cascade_size=size, **given),
                              f"{size:g} m, {steps} iterations")
    sheet(
        out.file(f"figure4-{preset}.jpg"),
        f"Figure 4 by --preset {preset}: edge of the smallest cascade, propagation steps "
        f"({frames.view})", 3, tiles)


def figure5(frames, out, preset):
    tiles = []
    for view, light in (("full", "direct light on"), ("indirect", "direct light off")):
        open_air = frames.image(view, basis="srbf8v2", preset=preset, blockers="none")
        tiles += with_caption(pair(frames, view, preset=preset), light)
        tiles.append((open_air, f"srbf8v2, {light}, no indirect shadows"))
    sheet(out.file(f"figure5-{preset}.jpg"),
          f"Figure 5 by --preset {preset}: indirect shadows ({frames.view})", 4, tiles)


def srbf14(frames, out):
    tiles = []
    for (setting, options), steps in itertools.product(SETTINGS.items(), STEPS):
        for size, view in itertools.product(SIZES, ("full", "indirect")):
            pixels = frames.image(view, preset="paper", basis="srbf14", **options,
                                  cascade_size=size, iterations=steps)
            tiles.append((pixels, f"{setting}, {steps} steps, {size:g} m, {view}"))
    sheet(out.file("srbf14.jpg"),
          f"srbf14 by --preset paper, with other lobes and transport ({frames.view})", 4, tiles)


def variants():
    """Yields the variants whose brightness is compared at both numbers of steps."""
    for basis in BASES:
        yield {"preset": "paper", "basis": basis}
    for setting in SETTINGS.values():
        yield {"preset": "paper", "basis": "srbf14", **setting}


def brightness(frames):
    """Rows: mean luminance of the indirect light at both numbers of steps, and the share of pixels
    that the later steps darken."""
    rows = []
    for variant, size in itertools.product(variants(), SIZES):
        few, many = (frames.indirect(**variant, cascade_size=size, iterations=steps)
                     for steps in STEPS)
        darker = float((many < few - DARKER * few.mean()).mean())
        rows.append({
            **variant, "cascade_size": size, "mean_8": float(few.mean()),
            "mean_24": float(many.mean()), "darker": darker
        })
    return rows


def basis_figures(out):
    """Names of Figures 2, 3 and 6 in the folder."""
    names = []
    for lobe in LOBES:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([str(CLPV), "basis", "--lobe", lobe, "--figures", folder], check=True,
                           stdout=subprocess.DEVNULL)
            for file in sorted(pathlib.Path(folder).glob("*.png")):
                names.append(f"lobes-{lobe}/{file.name}")
                out.write(names[-1], file.read_bytes())
    return names


def paper(arguments):
    """Files of Figures 1, 4 and 5, and of 2, 3 and 6, and brightness. Without a model Figures 2, 3
    and 6 only."""
    out = arguments.out
    lobe_files = basis_figures(out)
    if not arguments.model:
        return {"sheets": [], "lobes": lobe_files, "rows": []}
    scene = clpv.Scene(ROOT / "scenes/sponza_suns.json", arguments.model)
    frames, along = (Frames(scene, arguments, camera) for camera in ("curtains", "atrium"))
    nave = clpv.Scene(ROOT / "scenes/sponza_suns.json", arguments.model)
    nave.lights, nave.cameras = [claims.ALONG_THE_NAVE], [claims.OF_ARCADE]
    shadowed = Frames(nave, arguments, "arcade")
    if arguments.quick:  # the light of run-time lobes within 2e-4, five times as fast
        frames.always = shadowed.always = {"lobe_time": "host"}
    figure1(frames, out)
    answer(frames, out)
    for preset in PRESETS:
        figure4(frames, out, preset)
    for preset in PRESETS:
        figure5(shadowed, out, preset)
    if not arguments.quick:
        srbf14(along, out)
    sheets = [name for name in out.written if "/" not in name]
    return {"sheets": sheets, "lobes": lobe_files,
            "rows": [] if arguments.quick else brightness(along)}
