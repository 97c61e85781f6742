# SPDX-License-Identifier: MIT
"""Names the likeliest mistake in an image: the correction that lowers its error most."""
import itertools

import numpy

from clpv_lab.score import flip

GAIN_LIMIT = 1.8  # factor of another exposure
EXPLAINED = 0.6  # each correction must leave at most this share of the error
LAYERS = "direct", "albedo"  # layers of a truth that show mistakes in indirect light
MIRRORS = {
    "left to right": numpy.s_[:, ::-1], "upside down": numpy.s_[::-1],
    "rotated by half a turn": numpy.s_[::-1, ::-1]
}


def difference(a, b):
    """Mean absolute difference over the mean of b. Unlike a root mean square, it is not that of a
    few edges that two renderers draw differently."""
    of = abs(b).sum()
    return abs(a - b).sum() / of if of > 0 else numpy.inf


def blurred(image, valid):
    """Mean of the valid pixels among the nearest 3x3."""
    def total(values):
        wide = numpy.pad(values, ((1, 1), (1, 1), (0, 0)))
        height, width = values.shape[:2]
        return sum(wide[y:y + height, x:x + width] for y in range(3) for x in range(3))

    weights = valid[..., None].astype(float)
    return total(image * weights) / numpy.maximum(total(weights), 1)


def corrected(image, truth, valid, layers):
    """Yields (words, image, truth, valid) with a mistake corrected, or made in the truth, too.
    `layers`: other layers of the truth by name."""
    for name, turned in MIRRORS.items():
        yield f"mirrored, {name}", image[turned], truth, valid & valid[turned]
    for x, y in itertools.product((-1, 0, 1), repeat=2):
        if x or y:
            back = {"shift": (-y, -x), "axis": (0, 1)}
            inside = numpy.zeros_like(valid)
            inside[1:-1, 1:-1] = True
            yield (f"shifted by ({x}, {y}) pixels", numpy.roll(image, **back), truth,
                   inside & valid & numpy.roll(valid, **back))
    yield "like one with R and B swapped", image[..., ::-1], truth, valid
    if 0 <= image[valid].min() and image[valid].max() <= 1:
        yield "sRGB-encoded", flip.decoded(image), truth, valid
    yield "decoded from sRGB once too often", flip.encoded(image), truth, valid
    yield ("blurred or antialiased, as the truth blurred by 3x3 pixels", image,
           blurred(truth, valid), valid)
    yield "mapped from -1..1 to 0..1", 2 * image - 1, truth, valid
    if "direct" in layers:
        yield "like one with direct light", image - layers["direct"], truth, valid
    if "albedo" in layers:
        yield ("like irradiance instead of radiance", image * layers["albedo"] / numpy.pi, truth,
               valid)


def suspicions(image, truth, valid, layers, noise):
    """Sentences about an image that is not what it should be. An error of the size of the truth's
    noise is none; None: unknown."""
    image, truth = image.astype(float), truth.astype(float)
    if not (image[valid] != 0).any():
        return ["is black"] if (truth[valid] != 0).any() else []
    if not (truth[valid] != 0).any():
        return ["is lit where the truth is black"]
    as_it_is = difference(image[valid], truth[valid])
    if noise is None or as_it_is <= 2 * noise:
        return []
    tried = [(1, [])]  # share of the error that remains, for each correction over EXPLAINED
    for words, a, b, where in [("", image, truth, valid), *corrected(image, truth, valid, layers)]:
        a, b, before = a[where], b[where], difference(image[where], truth[where])
        gain = b.sum() / a.sum() if a.sum() * b.sum() > 0 else 1
        for factor in {1, 1 if 1 / GAIN_LIMIT < gain < GAIN_LIMIT else gain}:
            looks = [words] if words else []
            if factor != 1:
                looks.append(f"{1 / gain:.2g}x too bright" if gain < 1 else f"{gain:.2g}x too dark")
            if looks and 0 < before < numpy.inf:
                after = difference(factor * a, b)
                tried.append((after / before / EXPLAINED**len(looks), [
                    f"looks {' and '.join(looks)}: corrected, its mean error falls from "
                    f"{100 * as_it_is:.0f} to {100 * after:.0f} %"
                ]))
    return min(tried)[1]
