# SPDX-License-Identifier: MIT
"""Spherical plots: functions f on the sphere as shaded surfaces |f(w)| w with axes; z is up.

Input: values on a grid. Rows go from +z to -z (theta from 0 to pi, both poles included), columns
around z from +x towards +y (phi from 0 to below 2 pi).
"""
import numpy
from matplotlib.collections import TriMesh
from matplotlib.patches import Circle
from matplotlib.tri import Triangulation

POSITIVE, NEGATIVE = (0.07, 0.26, 0.62), (0.85, 0.16, 0.03)  # linear: a blue, a vermilion
AXIS, LABEL = 0.86, 0.94  # ends of axes and places of labels, over the extent
SAMPLES = 100  # along half an axis, and along a ray of the occlusion test


def unit(v):
    return v / numpy.maximum(numpy.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


# The eye: azimuth -55 degrees, elevation 24. Parallel projection: rows are right, up and towards
# the eye.
TOWARDS = numpy.array(
    [numpy.cos(0.42) * numpy.cos(-0.96),
     numpy.cos(0.42) * numpy.sin(-0.96),
     numpy.sin(0.42)])
RIGHT = unit(numpy.cross((0, 0, 1), TOWARDS))
VIEW = numpy.stack([RIGHT, numpy.cross(TOWARDS, RIGHT), TOWARDS])
LAMP = unit(numpy.array([-0.45, 0.6, 0.7]) @ VIEW)


def directions(shape):
    theta = numpy.linspace(0, numpy.pi, shape[0])[:, None]
    phi = numpy.arange(shape[1])[None, :] * (2 * numpy.pi / shape[1])
    return numpy.stack([numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi),
                        numpy.cos(theta) + 0 * phi], axis=-1)


def signed(values):
    """Returns linear colours by sign."""
    return numpy.where(values[..., None] < 0, NEGATIVE, POSITIVE)


def joint(functions, colours):
    """Returns the maximum of several functions as one surface, and the colour of the largest at
    each point."""
    return functions.max(axis=0), numpy.asarray(colours)[functions.argmax(axis=0)]


def normals_of(points):
    down = numpy.gradient(points, axis=0)
    around = numpy.roll(points, -1, axis=1) - numpy.roll(points, 1, axis=1)
    normals = unit(numpy.cross(down, around))
    for pole, beside in ((0, 1), (-1, -2)):  # the gradient around z is 0 at the poles
        normals[pole] = unit(normals[beside].mean(axis=0))
    return normals


def lit(colours, normals):
    """Shades linear colours and encodes them as sRGB."""
    diffuse = numpy.maximum(0, normals @ LAMP)[..., None]
    gloss = 0.18 * numpy.maximum(0, normals @ unit(LAMP + TOWARDS))[..., None] ** 40
    linear = numpy.clip(colours * (0.22 + 0.95 * diffuse) + gloss, 0, 1)
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def front_facets(screen):
    """Returns triangles of a projected grid that face the eye, farthest first (painter's
    algorithm)."""
    rows, columns = screen.shape[:2]
    a = (numpy.arange(rows - 1)[:, None] * columns + numpy.arange(columns)[None, :]).ravel()
    b = (numpy.arange(rows - 1)[:, None] * columns +
         (numpy.arange(columns) + 1)[None, :] % columns).ravel()
    triangles = numpy.concatenate([numpy.stack([a, a + columns, b], axis=1),
                                   numpy.stack([b, a + columns, b + columns], axis=1)])
    corners = screen.reshape(-1, 3)[triangles]
    u, v = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    facing = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > 0
    return triangles[facing][corners[facing, :, 2].mean(axis=1).argsort()]


def radius_at(values, points):
    """Returns |f| in the directions of points, at the nearest grid point."""
    w = unit(points)
    row = numpy.rint(numpy.arccos(numpy.clip(w[..., 2], -1, 1)) / numpy.pi *
                     (values.shape[0] - 1)).astype(int)
    column = numpy.rint(numpy.arctan2(w[..., 1], w[..., 0]) / (2 * numpy.pi) *
                        values.shape[1]).astype(int)
    return abs(values[row, column % values.shape[1]])


def hidden(values, points, extent):
    """Returns which points the surface |f| hides from the eye."""
    along = numpy.linspace(0, 2 * extent, SAMPLES)[:, None, None] * TOWARDS
    rays = points + along
    return (numpy.linalg.norm(rays, axis=-1) < radius_at(values, rays)).any(axis=0)


def draw_axes(axis, values, extent):
    for k, name in enumerate("xyz"):
        end = VIEW[:2, k] * extent
        for sign, ink in ((-1, "0.7"), (1, "0.18")):
            points = numpy.linspace(0, sign * AXIS * extent, SAMPLES)[:, None] * numpy.eye(3)[k]
            line = points @ VIEW[:2].T
            if values is not None:
                line[hidden(values, points, extent)] = numpy.nan
            axis.plot(*line.T, color=ink, lw=0.8, solid_capstyle="butt")
        axis.text(*(end * LABEL), name, ha="center", va="center", fontsize=9, color="0.4")


def plot(axis, values, colours=None, extent=1.2, outline=None):
    """Draws into `axis`; |f| = extent reaches its edge. `colours`: linear, one per grid point;
    None: by sign. `outline`: (centre, radius) of a sphere whose silhouette is drawn on top.
    `values` None: axes only."""
    if values is not None:
        points = abs(values)[..., None] * directions(values.shape)
        screen = points @ VIEW.T
        triangles = front_facets(screen)
        flat = screen.reshape(-1, 3)
        mesh = TriMesh(Triangulation(flat[:, 0], flat[:, 1], triangles))
        mesh.set_facecolor(
            lit(signed(values) if colours is None else colours, normals_of(points)).reshape(-1, 3))
        axis.add_collection(mesh, autolim=False)
    draw_axes(axis, values, extent)
    if outline:
        centre, radius = outline
        axis.add_patch(
            Circle(VIEW[:2] @ centre, radius, fill=False, ls=(0, (4, 3)), lw=1, ec="0.1", zorder=5))
    axis.set(xlim=(-extent, extent), ylim=(-extent, extent), aspect="equal")
