# SPDX-License-Identifier: MIT
"""Two images and their difference side by side, at one pixel per pixel, with a scale.

compare.json: "a", "b": names; "nrmse": a number or null. a.npy, b.npy: display values; error.npy:
absolute differences, each (height, width, 3).
"""
import numpy

from clpv.draw import documents, style

DPI = 100
GAP, CAPTION, SCALE = 6, 24, 90  # [pixels]; SCALE: width of the scale with its numbers
SMALLEST = 160  # [pixels]: smaller images are enlarged by a whole factor
SHOWN = 99  # percentile of the differences at the end of the scale


def draw(folder, path):
    document = documents.read(folder / "compare.json")
    a, b, error = (numpy.load(folder / f"{name}.npy") for name in ("a", "b", "error"))
    error = error.mean(axis=2)
    factor = max(1, -(-SMALLEST // min(a.shape[:2])))
    height, width = (factor * length for length in a.shape[:2])
    whole = 3 * (width + GAP) + GAP + SCALE, height + CAPTION + 2 * GAP
    figure = style.pyplot.figure(figsize=(whole[0] / DPI, whole[1] / DPI), dpi=DPI,
                                 facecolor="white")
    largest = numpy.percentile(error, SHOWN) or error.max() or 1
    nrmse = document["nrmse"]
    captions = (f"A: {document['a']}", f"B: {document['b']}",
                "|A - B|" + (f", NRMSE {100 * nrmse:.1f} %" if nrmse is not None else ""))
    for i, (image, caption) in enumerate(zip((a, b, error), captions)):
        left = GAP + i * (width + GAP)
        axis = figure.add_axes((left / whole[0], GAP / whole[1], width / whole[0],
                                height / whole[1]))
        axis.axis("off")
        shown = axis.imshow(image if i == 2 else image.clip(0, 1), cmap="inferno", vmin=0,
                            vmax=largest, interpolation="nearest", aspect="auto")
        room = width // 6  # characters of a caption
        figure.text(left / whole[0], 1 - CAPTION / whole[1] / 1.4,
                    caption if len(caption) <= room else "..." + caption[3 - room:], fontsize=8)
    place = figure.add_axes((1 - (SCALE - GAP) / whole[0], GAP / whole[1], 14 / whole[0],
                             height / whole[1]))
    figure.colorbar(shown, cax=place, extend="max")
    style.output.write(path, style.rendered(figure, "png", dpi=DPI))
