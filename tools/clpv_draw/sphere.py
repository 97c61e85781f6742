# SPDX-License-Identifier: MIT
"""Spherical plots: functions f on the sphere as the surfaces |f(w)| w, lit, with axes; z is up.

A function comes as its values on a grid: rows from +z to -z (theta from 0 to pi, both poles included), columns round
z from +x towards +y (phi from 0, the last before 2 pi).
"""
import numpy
from matplotlib.collections import TriMesh
from matplotlib.patches import Circle
from matplotlib.tri import Triangulation

POSITIVE, NEGATIVE = (0.07, 0.26, 0.62), (0.85, 0.16, 0.03)  # linear: a blue, a vermilion
AXIS, LABEL = 0.86, 0.94  # of the extent
SAMPLES = 100  # along half an axis, and along the ray that tells whether something hides it


def unit(v):
    return v / numpy.maximum(numpy.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


# The eye: azimuth -55 degrees, elevation 24. Parallel projection: rows are right, up and towards the eye.
TOWARDS = numpy.array([numpy.cos(0.42) * numpy.cos(-0.96), numpy.cos(0.42) * numpy.sin(-0.96), numpy.sin(0.42)])
RIGHT = unit(numpy.cross((0, 0, 1), TOWARDS))
VIEW = numpy.stack([RIGHT, numpy.cross(TOWARDS, RIGHT), TOWARDS])
LAMP = unit(numpy.array([-0.45, 0.6, 0.7]) @ VIEW)


def directions(shape):
    theta = numpy.linspace(0, numpy.pi, shape[0])[:, None]
    phi = numpy.arange(shape[1])[None, :] * (2 * numpy.pi / shape[1])
    return numpy.stack([numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi),
                        numpy.cos(theta) + 0 * phi], axis=-1)


def signed(values):
    """Linear colours of a function's two signs."""
    return numpy.where(values[..., None] < 0, NEGATIVE, POSITIVE)


def joint(functions, colours):
    """Several functions as one surface, that of the largest, and its colours: seen from outside all is the same."""
    return functions.max(axis=0), numpy.asarray(colours)[functions.argmax(axis=0)]


def normals_of(points):
    down = numpy.gradient(points, axis=0)
    around = numpy.roll(points, -1, axis=1) - numpy.roll(points, 1, axis=1)
    normals = unit(numpy.cross(down, around))
    for pole, beside in ((0, 1), (-1, -2)):  # there, nothing changes around
        normals[pole] = unit(normals[beside].mean(axis=0))
    return normals


def lit(colours, normals):
    """Linear colours under the lamp, encoded for a display."""
    diffuse = numpy.maximum(0, normals @ LAMP)[..., None]
    gloss = 0.18 * numpy.maximum(0, normals @ unit(LAMP + TOWARDS))[..., None] ** 40
    linear = numpy.clip(colours * (0.22 + 0.95 * diffuse) + gloss, 0, 1)
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def front_facets(screen):
    """Triangles of a projected grid that face the eye, the farthest first: painted in order they hide each other."""
    rows, columns = screen.shape[:2]
    a = (numpy.arange(rows - 1)[:, None] * columns + numpy.arange(columns)[None, :]).ravel()
    b = (numpy.arange(rows - 1)[:, None] * columns + (numpy.arange(columns) + 1)[None, :] % columns).ravel()
    triangles = numpy.concatenate([numpy.stack([a, a + columns, b], axis=1),
                                   numpy.stack([b, a + columns, b + columns], axis=1)])
    corners = screen.reshape(-1, 3)[triangles]
    u, v = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    facing = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > 0
    return triangles[facing][corners[facing, :, 2].mean(axis=1).argsort()]


def radius_at(values, points):
    """|f| in the directions of points, of the nearest on the grid."""
    w = unit(points)
    row = numpy.rint(numpy.arccos(numpy.clip(w[..., 2], -1, 1)) / numpy.pi * (values.shape[0] - 1)).astype(int)
    column = numpy.rint(numpy.arctan2(w[..., 1], w[..., 0]) / (2 * numpy.pi) * values.shape[1]).astype(int)
    return abs(values[row, column % values.shape[1]])


def hidden(values, points, extent):
    """Which points have something of the solid within |f| between them and the eye."""
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
    """Into `axis`: |f| = extent reaches an edge. `colours`: linear, a point of the grid each; None: by sign. `outline`:
    (centre, radius) of a sphere of which only the silhouette is drawn, over everything. `values` None: axes alone."""
    if values is not None:
        points = abs(values)[..., None] * directions(values.shape)
        screen = points @ VIEW.T
        triangles = front_facets(screen)
        flat = screen.reshape(-1, 3)
        mesh = TriMesh(Triangulation(flat[:, 0], flat[:, 1], triangles))
        mesh.set_facecolor(lit(signed(values) if colours is None else colours, normals_of(points)).reshape(-1, 3))
        axis.add_collection(mesh, autolim=False)
    draw_axes(axis, values, extent)
    if outline:
        centre, radius = outline
        axis.add_patch(Circle(VIEW[:2] @ centre, radius, fill=False, ls=(0, (4, 3)), lw=1, ec="0.1", zorder=5))
    axis.set(xlim=(-extent, extent), ylim=(-extent, extent), aspect="equal")
