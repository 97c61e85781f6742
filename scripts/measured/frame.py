# SPDX-License-Identifier: MIT
"""Renders the pictures of docs/frame.md: one frame of the atrium, stage by stage.

    scripts/frame [--out DIR]

Output: frame-NAME.jpg in docs/images, or in DIR, a new or empty folder, or one of an earlier run.
First builds. Needs the packages of scripts/setup.
"""
import argparse
import io
import pathlib
import subprocess

from matplotlib import pyplot

from . import ROOT, native, output

clpv = native()  # main() builds the native module

CAMERA = "nave"
SIZE = {"width": 640, "height": 360}
# Pictures: view, exposure over the scene's [EV], options of `clpv render`. Steps without iterations
# leave injected light as it is.
PICTURES = {
    "direct": ("direct", 0, {}),
    "injected": ("cells", -0.5, {"transport": "sampled", "iterations": 0}),
    "swept": ("cells", -1.5, {}),
    "irradiance": ("irradiance", -1.5, {"near": "off"}),
    "near": ("irradiance", -1.5, {"near": "traced"}),
    "full": ("full", 0, {"near": "traced"}),
}
CASCADE = 25  # edge of the finest cascade [m], in scenes/atrium.json


def rsm(scene, camera):
    """Content of the sun's RSM of the finest cascade: the light that each texel reflects."""
    from .claims import from_the_sun  # needs the native module
    above = from_the_sun(camera, scene.lights[0].direction, CASCADE)
    return clpv.Renderer(scene, width=SIZE["height"], height=SIZE["height"]).render("direct", above)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, help="output folder (default: docs/images)")
    out = parser.parse_args().out
    folder = out and output.Folder(out, "scripts/frame")
    subprocess.run([str(ROOT / "scripts/build"), "clpv", "clpv_python"], check=True)
    scene = clpv.Scene(ROOT / "scenes/atrium.json")
    camera = next(each for each in scene.cameras if each.name == CAMERA)

    def save(name, image, exposure):
        file = f"frame-{name}.jpg"
        file, made = folder.file(file) if folder else ROOT / "docs/images" / file, io.BytesIO()
        pixels = image.display(scene.exposure + exposure)[..., :3]
        pyplot.imsave(made, pixels, format="jpg", pil_kwargs={"quality": 80, "optimize": True})
        output.write(file, made.getvalue())
        print(file)

    save("rsm", rsm(scene, camera), 0)
    for name, (view, exposure, options) in PICTURES.items():
        save(name, clpv.Renderer(scene, **SIZE, **options).render(view, camera), exposure)
