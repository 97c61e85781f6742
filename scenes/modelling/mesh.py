# SPDX-License-Identifier: MIT
"""Triangle meshes in metres, y up, counter-clockwise seen from outside; and vectors as tuples.

A Mesh keeps one list of vertices per material. Positions, normals and texture coordinates are
rounded to a fixed step, so that the last bit of another machine's sine does not change the file.
"""
import math

POSITION_STEP = 2.0 ** -13  # [m], an eighth of a millimetre
NORMAL_STEP = 2.0 ** -9
UV_STEP = 2.0 ** -11
TEXTURE_METRES = 2.0  # covered by one repetition of a texture


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalised(a):
    length = math.sqrt(dot(a, a))
    return scale(a, 1.0 / length)


def rounded(values, step):
    return tuple(round(v / step) * step for v in values)


class Surface:
    """Vertices and triangles of one material."""

    def __init__(self):
        self.positions, self.normals, self.uvs, self.indices = [], [], [], []
        self._seen = {}

    def vertex(self, position, normal, uv):
        """The index of that vertex; one that is there already is shared."""
        key = (rounded(position, POSITION_STEP), rounded(normal, NORMAL_STEP), rounded(uv, UV_STEP))
        if key not in self._seen:
            self._seen[key] = len(self.positions)
            self.positions.append(key[0])
            self.normals.append(key[1])
            self.uvs.append(key[2])
        return self._seen[key]

    def triangle(self, a, b, c):
        """Adds a triangle of three vertex indices, unless two are the same."""
        if len({self.positions[a], self.positions[b], self.positions[c]}) == 3:
            self.indices += [a, b, c]


class Mesh:
    """Content of one glTF mesh: a Surface per material name."""

    def __init__(self):
        self.surfaces = {}

    def surface(self, material):
        return self.surfaces.setdefault(material, Surface())

    def triangles(self):
        return sum(len(s.indices) // 3 for s in self.surfaces.values())

    def quad(self, material, corners, uvs=None, normals=None):
        """A quadrilateral, corners counter-clockwise from outside. Without uvs, metric ones from
        the main axis."""
        normal = normalised(cross(sub(corners[2], corners[0]), sub(corners[3], corners[1])))
        normals = normals or [normal] * 4
        uvs = uvs or [metric_uv(c, normal) for c in corners]
        surface = self.surface(material)
        i = [surface.vertex(c, n, t) for c, n, t in zip(corners, normals, uvs)]
        surface.triangle(i[0], i[1], i[2])
        surface.triangle(i[0], i[2], i[3])

    def box(self, material, low, high, omit=""):
        """An axis-aligned box; `omit` lists faces that nobody sees, such as "-y +y"."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        faces = {
            "-x": [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)],
            "+x": [(x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)],
            "-y": [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
            "+y": [(x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)],
            "-z": [(x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)],
            "+z": [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
        }
        skipped = omit.split()
        for name, corners in faces.items():
            if name not in skipped:
                self.quad(material, corners)

    def grid(self, material, points, uv, closed=False, sharp_rows=()):
        """A smooth sheet through points[row][column]; uv(row, column) gives texture coordinates.

        Outside is where d(row) x d(column) points. `closed` joins the last column to the first
        (which is repeated in `points`). Across a row in `sharp_rows` the normal breaks. """
        surface = self.surface(material)
        rows, columns = len(points), len(points[0])
        breaks = [0] + sorted(sharp_rows) + [rows - 1]
        for low, high in zip(breaks, breaks[1:]):
            index = {}
            for r in range(low, high + 1):
                for c in range(columns):
                    normal = _grid_normal(points, r, c, low, high, closed)
                    index[r, c] = surface.vertex(points[r][c], normal, uv(r, c))
            for r in range(low, high):
                for c in range(columns - 1):
                    a, b, d, e = index[r, c], index[r + 1, c], index[r + 1, c + 1], index[r, c + 1]
                    surface.triangle(a, b, d)
                    surface.triangle(a, d, e)


def _grid_normal(points, r, c, low, high, closed):
    last = len(points[0]) - 1
    before, after = max(c - 1, 0), min(c + 1, last)
    if closed:
        before, after = (c - 1) % last, (c + 1) % last
    for step in (0, 1):  # where a row shrinks to a point, look across from the next one
        row = r if step == 0 else (r + 1 if r < high else r - 1)
        across = sub(points[row][after], points[row][before])
        if dot(across, across) > 1e-12:
            break
    along = sub(points[min(r + 1, high)][c], points[max(r - 1, low)][c])
    return normalised(cross(along, across))


def metric_uv(point, normal):
    """Texture coordinates on the plane that faces the normal's main axis: a texture covers
    TEXTURE_METRES."""
    axis = max(range(3), key=lambda i: abs(normal[i]))
    across, along = {0: (point[2], -point[1]), 1: (point[0], point[2]),
                     2: (point[0], -point[1])}[axis]
    return (across / TEXTURE_METRES, along / TEXTURE_METRES)
