# SPDX-License-Identifier: MIT
"""Spherical plots: functions f on the sphere as shaded surfaces |f(w)| w with axes; z is up.

Input: values on a grid. Rows go from +z to -z (theta from 0 to pi), columns around z from +x
towards +y (phi from 0 to 2 pi), all ends included.
"""
import numpy
from matplotlib.colors import LightSource

POSITIVE, NEGATIVE = (0.29, 0.56, 0.85), (0.95, 0.45, 0.18)  # a blue, a vermilion
AZIMUTH, ELEVATION = -55, 24  # of the eye [degrees]; parallel projection
AXIS, LABEL = 0.86, 0.94  # ends of axes and places of labels, over the extent
# Of a plot without room for ticks, so that the extent reaches its edge.
ZOOM, EDGE = 1.746, 0.0925
LAMP = LightSource(azdeg=30, altdeg=-45)  # opposite to the light: normals of the grid point inwards


def unit(v):
    return numpy.asarray(v) / numpy.linalg.norm(v)


def directions(shape):
    theta = numpy.linspace(1e-3, numpy.pi - 1e-3, shape[0])[:, None]  # facets at poles have areas
    phi = numpy.linspace(0, 2 * numpy.pi, shape[1])
    return numpy.stack([numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi),
                        numpy.cos(theta) + 0 * phi], axis=-1)


def joint(functions, colours):
    """The maximum of several functions, and the colour of the largest at each point."""
    return functions.max(axis=0), numpy.asarray(colours)[functions.argmax(axis=0)]


def plot(axis, values, colours=None, extent=1.2, outline=None):
    """Draws into an `axis` of three dimensions; |f| = extent reaches its edge. `colours`: one per
    grid point; None: by sign. `outline`: (centre, radius) of a sphere whose silhouette is drawn on
    top."""
    axis.set_proj_type("ortho")
    axis.view_init(ELEVATION, AZIMUTH)
    axis.computed_zorder = False
    a, e = numpy.radians((AZIMUTH, ELEVATION))
    towards = numpy.array([numpy.cos(e) * numpy.cos(a), numpy.cos(e) * numpy.sin(a), numpy.sin(e)])
    grid = directions(values.shape)
    if colours is None:
        colours = numpy.where(values[..., None] < 0, NEGATIVE, POSITIVE)
    axis.plot_surface(*numpy.moveaxis(abs(values)[..., None] * grid, -1, 0), facecolors=colours,
                      rstride=1, cstride=1, lightsource=LAMP, linewidth=0, antialiased=False)
    for k, name in enumerate("xyz"):
        for sign, ink in ((-1, "0.7"), (1, "0.18")):
            end = sign * numpy.eye(3)[k]
            begin = abs(values)[tuple(numpy.unravel_index((grid @ end).argmax(), values.shape))]
            # The part outside of the surface, behind it or before it.
            line = numpy.linspace(min(begin, AXIS * extent), AXIS * extent, 2)[:, None] * end
            axis.plot(*line.T, color=ink, lw=0.8, zorder=0 if end @ towards < 0 else 2)
        axis.text(*(LABEL * extent * numpy.eye(3)[k]), name, ha="center", va="center", fontsize=9,
                  color="0.4")
    if outline:
        centre, radius = outline
        turn = numpy.linspace(0, 2 * numpy.pi, 99)[:, None]
        right = unit(numpy.cross((0, 0, 1), towards))
        ring = numpy.cos(turn) * right + numpy.sin(turn) * numpy.cross(towards, right)
        axis.plot(*(centre + radius * ring).T, color="0.1", ls=(0, (4, 3)), lw=1, zorder=3)
    limits = -extent, extent
    axis.set(xlim=limits, ylim=limits, zlim=limits)
    axis.set_box_aspect((1, 1, 1), zoom=ZOOM)
    axis.viewLim.intervalx = axis.viewLim.intervaly = -EDGE, EDGE
