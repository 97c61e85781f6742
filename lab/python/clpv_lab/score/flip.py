# SPDX-License-Identifier: MIT
"""FLIP (Andersson et al. 2020) of linear images after tone curve ACES, with the numbers of
host/image/compare.cpp."""
import numpy

PIXELS_PER_DEGREE = 67.0206  # 3840 pixels over 0.7 m, seen from 0.7 m
EDGE_WIDTH = 0.082  # width of a feature [degrees]
SENSITIVITIES = [(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04),
                                               (13.5, 0.025)]  # height, width by channel
WIDEST = 0.04
TO_XYZ = numpy.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                      [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                      [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = TO_XYZ.sum(axis=1)


def encoded(linear):
    return numpy.where(linear <= 0.0031308, 12.92 * linear,
                       1.055 * numpy.maximum(linear, 0)**(1 / 2.4) - 0.055)


def decoded(srgb):
    return numpy.where(srgb <= 0.04045, srgb / 12.92,
                       ((numpy.maximum(srgb, 0) + 0.055) / 1.055)**2.4)


def displayed(linear, exposure):
    """sRGB-encoded values of linear radiance at an exposure [EV]."""
    x = numpy.clip(2.0 ** exposure * linear, 0, 1e6)
    return encoded(numpy.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0, 1))


def filtered(plane, along_x, along_y):
    """Filters rows and columns; pixels beyond the image equal the nearest one in it."""
    radius, (height, width) = len(along_x) // 2, plane.shape
    wide = numpy.pad(plane, ((0, 0), (radius, radius)), "edge")
    rows = sum(tap * wide[:, i:i + width] for i, tap in enumerate(along_x))
    high = numpy.pad(rows, ((radius, radius), (0, 0)), "edge")
    return sum(tap * high[i:i + height] for i, tap in enumerate(along_y))


def seen(plane, sensitivity):
    """A channel without the detail that is too fine for an observer."""
    radius = int(numpy.ceil(3 * numpy.sqrt(WIDEST / (2 * numpy.pi ** 2)) * PIXELS_PER_DEGREE))
    i = numpy.arange(-radius, radius + 1)
    result, total = 0, 0
    for height, width in sensitivity:
        row = numpy.exp(-numpy.pi ** 2 * i ** 2 / (PIXELS_PER_DEGREE ** 2 * width))
        scale = height * numpy.sqrt(numpy.pi / width)
        result, total = result + scale * filtered(plane, row, row), total + scale * row.sum() ** 2
    return result / total


def features(lightness):
    """Strengths of edges (first derivative) and of points (second derivative)."""
    deviation = 0.5 * EDGE_WIDTH * PIXELS_PER_DEGREE
    radius = int(numpy.ceil(3 * deviation))
    i = numpy.arange(-radius, radius + 1)
    smooth = numpy.exp(-i ** 2 / (2 * deviation ** 2))
    strengths = []
    for row in -i * smooth, (i ** 2 / deviation ** 2 - 1) * smooth:
        row = row / (numpy.where(row > 0, row[row > 0].sum(), -row[row <= 0].sum()) * smooth.sum())
        strengths.append(
            numpy.hypot(filtered(lightness, row, smooth), filtered(lightness, smooth, row)))
    return strengths


def lab_curve(t):
    delta = 6 / 29
    return numpy.where(t > delta ** 3, numpy.cbrt(t), t / (3 * delta ** 2) + 4 / 29)


def hunt_lab(linear):
    """CIELAB with Hunt's adjustment: chroma counts less in the dark."""
    f = lab_curve(linear @ TO_XYZ.T / WHITE)
    lightness = 116 * f[..., 1] - 16
    return numpy.stack([
        lightness, 5 * lightness * (f[..., 0] - f[..., 1]), 2 * lightness * (f[..., 1] - f[..., 2])
    ], axis=-1)


def hyab(a, b):
    return abs(a[..., 0] - b[..., 0]) + numpy.hypot(a[..., 1] - b[..., 1], a[..., 2] - b[..., 2])


def observed(srgb):
    """An image as an observer sees it: colours and features."""
    t = decoded(srgb) @ TO_XYZ.T / WHITE
    opponent = [116 * t[..., 1] - 16, 500 * (t[..., 0] - t[..., 1]), 200 * (t[..., 1] - t[..., 2])]
    lightness = (opponent[0] + 16) / 116
    y, cx, cz = (seen(plane, sensitivity) for plane, sensitivity in zip(opponent, SENSITIVITIES))
    y = (y + 16) / 116
    linear = numpy.stack([y + cx / 500, y, y - cz / 200],
                         axis=-1) * WHITE @ numpy.linalg.inv(TO_XYZ).T
    return hunt_lab(numpy.clip(linear, 0, 1)), features(lightness)


def flip(a, b):
    """FLIP of each pixel, 0 to 1, of sRGB-encoded images."""
    (colours_a, features_a), (colours_b, features_b) = observed(a), observed(b)
    largest = hyab(hunt_lab(numpy.array([0.0, 1, 0])), hunt_lab(numpy.array([0.0, 0, 1]))) ** 0.7
    difference = hyab(colours_a, colours_b) ** 0.7
    split = 0.4 * largest
    colour = numpy.where(difference < split, difference * 0.95 / split,
                         0.95 + (difference - split) / (largest - split) * 0.05)
    feature = numpy.max([abs(x - y) for x, y in zip(features_a, features_b)], axis=0)
    return colour ** (1 - (feature / numpy.sqrt(2)) ** 0.5)
