# SPDX-License-Identifier: MIT
"""Spherical plots against surfaces whose outlines are known."""
import math
import unittest

from support import ROOT  # noqa: F401  (puts the package into the path)
from clpv.draw import sphere
import numpy
from matplotlib import pyplot

SIZE = 200  # pixels
GRID = sphere.directions((91, 180))


def image_of(values, **options):
    figure = pyplot.figure(figsize=(2, 2), dpi=SIZE / 2)
    axis = figure.add_axes((0, 0, 1, 1))
    axis.axis("off")
    sphere.plot(axis, values, **options)
    figure.canvas.draw()
    pixels = numpy.asarray(figure.canvas.buffer_rgba())[..., :3] / 255.0
    pyplot.close(figure)
    return pixels


def blue(image):
    return image[..., 2] > image[..., 0] + 0.1


def red(image):
    return image[..., 0] > image[..., 2] + 0.1


def box(mask):
    """left, right, top, bottom"""
    rows, columns = numpy.nonzero(mask)
    return columns.min(), columns.max(), rows.min(), rows.max()


class SphericalPlot(unittest.TestCase):
    def test_a_constant_is_a_disc_of_its_radius(self):
        image = image_of(numpy.full(GRID.shape[:2], 0.8), extent=1)
        left, right, top, bottom = box(blue(image))
        self.assertAlmostEqual(blue(image).sum(), math.pi * 80**2, delta=0.03 * math.pi * 80**2)
        self.assertAlmostEqual(right - left, 160, delta=2)
        self.assertAlmostEqual(bottom - top, 160, delta=2)
        self.assertEqual(red(image).sum(), 0)

    def test_the_clamped_cosine_is_a_sphere_through_the_origin(self):
        left, right, _, bottom = box(blue(image_of(numpy.maximum(0, GRID[..., 2]), extent=1)))
        self.assertAlmostEqual(right - left, 100, delta=2)
        self.assertAlmostEqual((left + right) / 2, 100, delta=1)
        self.assertLess(bottom, 106, "all of it is above the origin, seen from 24 degrees above")

    def test_what_is_nearer_hides(self):
        near, far = (numpy.maximum(0, sign * GRID[..., 1]) for sign in (-1, 1))  # the eye is at -y
        alone = red(image_of(far, colours=numpy.broadcast_to(sphere.NEGATIVE, GRID.shape))).sum()
        values, colours = sphere.joint(numpy.stack([near, far]), [sphere.POSITIVE, sphere.NEGATIVE])
        both = red(image_of(values, colours=colours)).sum()
        self.assertGreater(both, 100)
        self.assertLess(both, alone - 100)

    def test_an_axis_is_hidden_inside_and_behind(self):
        ball = numpy.full(GRID.shape[:2], 0.5)
        points = numpy.array([[0, 0, 0.3], [0, 0, 0.9], -0.9 * sphere.TOWARDS,
                              0.9 * sphere.TOWARDS])
        self.assertEqual(sphere.hidden(ball, points, 1.2).tolist(), [True, False, True, False])

if __name__ == "__main__":
    unittest.main()
