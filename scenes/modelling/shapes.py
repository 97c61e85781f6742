# SPDX-License-Identifier: MIT
"""Parts of a building: turned columns, vases and balusters, arches, mouldings, curtains."""
import math

from modelling.mesh import Mesh


def lathe(mesh, material, profile, segments, uv_scale=1.0, close=True):
    """Turns profile [(radius, y)], listed from the bottom up, round the y axis; normals break at
    corners > 35 degrees."""
    rows = list(profile)
    if close:
        rows = [(0.0, rows[0][1])] + rows + [(0.0, rows[-1][1])]
    heading = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in zip(rows, rows[1:])]
    sharp = []
    for i in range(1, len(rows) - 1):
        turn = abs((heading[i] - heading[i - 1] + math.pi) % (2 * math.pi) - math.pi)
        if turn > math.radians(35):
            sharp.append(i)
    length = [0.0]
    for a, b in zip(rows, rows[1:]):
        length.append(length[-1] + math.hypot(b[0] - a[0], b[1] - a[1]))
    points = []
    for radius, y in rows:
        angles = [2 * math.pi * (c % segments) / segments for c in range(segments + 1)]
        points.append([(radius * math.cos(a), y, radius * math.sin(a)) for a in angles])
    girth = max(r for r, _ in rows) * 2 * math.pi
    mesh.grid(material, points, lambda r, c:
              (uv_scale * girth * c / segments, -uv_scale * length[r]), True, sharp)


def arc(centre, radius, start, end, steps):
    """Points of a profile on a circle, angles in degrees."""
    angles = [math.radians(start + (end - start) * i / steps) for i in range(steps + 1)]
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def column(height, radius, segments, material, plinth_material):
    """Plinth, base, a shaft that narrows, capital and abacus; stands on y = 0, ends at y =
    height."""
    mesh = Mesh()
    r, plinth, abacus = radius, 0.5 * radius, 0.35 * radius
    mesh.box(plinth_material, (-1.42 * r, 0, -1.42 * r), (1.42 * r, plinth, 1.42 * r), "-y")
    mesh.box(plinth_material, (-1.45 * r, height - abacus, -1.45 * r), (1.45 * r, height, 1.45 * r))
    y = plinth
    profile = [(1.2 * r, y)] + arc((1.2 * r, y + 0.17 * r), 0.17 * r, -90, 90, 6)[1:]
    y += 0.34 * r
    profile += [(1.13 * r, y), (1.13 * r, y + 0.08 * r)] + arc(
        (1.25 * r, y + 0.2 * r), 0.15 * r, -150, -210, 3)
    y += 0.34 * r
    profile += [(1.1 * r, y)] + arc(
        (1.08 * r, y + 0.1 * r), 0.1 * r, -90, 90, 5)[1:] + [(1.0 * r, y + 0.24 * r)]
    top = height - abacus - 0.95 * r
    for i in range(1, 8):  # a shaft that swells a little
        t = i / 8
        profile.append((r * (1 - 0.14 * t * t), y + 0.24 * r + (top - y - 0.24 * r) * t))
    profile += [(0.86 * r, top)] + arc((0.9 * r, top + 0.07 * r), 0.07 * r, -90, 90, 4)
    profile += [(0.86 * r, top + 0.16 * r), (0.88 * r, top + 0.4 * r)]
    profile += arc((0.88 * r, top + 0.95 * r), 0.5 * r, -75, -5, 6)
    profile += [(1.38 * r, height - abacus)]
    lathe(mesh, material, profile, segments, 0.5)
    return mesh


def turned(profile, segments, material, uv_scale=1.0):
    """A Mesh of one lathed part."""
    mesh = Mesh()
    lathe(mesh, material, profile, segments, uv_scale)
    return mesh


def arch_bay(width, springing, radius, top, thickness, steps, wall, trim):
    """A bay of an arcade's wall, from its springing to its top, centred on x = 0, across z = 0;
    opening `radius`.

    The columns' capitals carry it. Archivolts (`trim`) stand out on both faces. Its sides join the
    next bays. """
    mesh = Mesh()
    half, z = width / 2, thickness / 2
    angles = [math.pi * i / steps for i in range(steps + 1)]
    curve = [(radius * math.cos(a), springing + radius * math.sin(a))
             for a in angles]  # right to left

    def outline(x, y, angle):
        """Where the ray from the arch's centre leaves the bay's rectangle."""
        dx, dy = math.cos(angle), math.sin(angle)
        reach = min(half / abs(dx) if abs(dx) > 1e-9 else 1e9,
                    (top - springing) / dy if dy > 1e-9 else 1e9)
        return (reach * dx, springing + reach * dy)

    corner = math.atan2(top - springing, half)
    cuts = sorted(set(angles + [corner, math.pi - corner]))
    for a, b in zip(cuts, cuts[1:]):
        inner = [(radius * math.cos(t), springing + radius * math.sin(t)) for t in (a, b)]
        outer = [outline(*p, t) for p, t in zip(inner, (a, b))]
        front = [(*inner[0], z), (*outer[0], z), (*outer[1], z), (*inner[1], z)]
        mesh.quad(wall, front)
        mesh.quad(wall, [(x, y, -z) for x, y, _ in reversed(front)])
    for side in (-1, 1):  # the undersides beside the opening
        x = sorted((side * radius, side * half))
        mesh.quad(wall, [(x[0], springing, -z), (x[1], springing, -z), (x[1], springing, z),
                         (x[0], springing, z)])
    soffit = [[(x, y, z), (x, y, -z)] for x, y in curve]
    mesh.grid(trim, soffit, lambda r, c: (2 * c * z, radius * math.pi * r / steps))
    for side in (-1, 1):
        archivolt(mesh, trim, springing, radius, side, z, steps)
    return mesh


def archivolt(mesh, material, springing, radius, side, z, steps):
    """A stepped band round the opening, on the face at side * z."""
    band = [(0.0, 0.0), (0.0, 0.05), (0.12, 0.05), (0.14, 0.03), (0.24, 0.03),
            (0.24, 0.0)]  # (outwards, forwards) [m]
    rows = []
    for i in range(steps + 1):
        angle = math.pi * i / steps
        rows.append([((radius + o) * math.cos(angle), springing + (radius + o) * math.sin(angle),
                      side * (z + f)) for o, f in band])
    for k in range(len(band) - 1):  # one strip an edge: the corners stay sharp
        strip = [[row[k], row[k + 1]] for row in rows]
        if side > 0:
            strip.reverse()
        mesh.grid(material, strip, lambda r, c, k=k: (radius * math.pi * r / steps, 0.1 * (k + c)))
    for row, outward in ((rows[0], 1), (rows[-1], -1)):  # the two feet
        foot = row[:4] if side * outward > 0 else row[3::-1]
        mesh.quad(material, list(reversed(foot)))
        foot = [row[0], row[3], row[4], row[5]]
        mesh.quad(material, list(reversed(foot)) if side * outward > 0 else foot)


def moulding(mesh, material, profile, start, end, outward):
    """Sweeps profile [(out, y)], bottom to top, along the level line from start to end; `outward`:
    unit, across it.

    The ends are closed.
    """
    def at(base, o, y):
        return (base[0] + outward[0] * o, base[1] + y, base[2] + outward[2] * o)

    along = (end[0] - start[0], 0, end[2] - start[2])
    outward_is_front = along[0] * outward[2] - along[2] * outward[
        0] > 0  # along x up points to `outward`
    for (o0, y0), (o1, y1) in zip(profile, profile[1:]):
        corners = [at(start, o0, y0), at(end, o0, y0), at(end, o1, y1), at(start, o1, y1)]
        mesh.quad(material, corners if outward_is_front else list(reversed(corners)))
    for base, flip in ((start, not outward_is_front), (end, outward_is_front)):
        inner = min(o for o, _ in profile)
        for (o0, y0), (o1, y1) in zip(profile, profile[1:]):
            if y1 <= y0:
                continue
            corners = [at(base, inner, y0), at(base, o0, y0), at(base, o1, y1), at(base, inner, y1)]
            mesh.quad(material, list(reversed(corners)) if flip else corners)


def sheet(mesh, material, surface, columns, rows, uv):
    """Cloth: surface(u, v) for u to the right, v downwards, both in [0, 1], faces +z."""
    points = [[surface(c / columns, 1 - r / rows) for c in range(columns + 1)]
              for r in range(rows + 1)]
    # Rows go up, columns to the right: up x right points to -z, so turn the columns round.
    points = [list(reversed(row)) for row in points]
    mesh.grid(material, points, lambda r, c: uv(1 - c / columns, 1 - r / rows))


def drawn_curtain(width, height, folds, depth, seed, material, columns=96, rows=20):
    """A closed curtain: folds that deepen and wander on their way down. Hangs from y = 0 at z =
    0."""
    mesh = Mesh()
    phase = 0.7 * seed

    def surface(u, v):
        wander = 0.25 * math.sin(2.1 * math.pi * v + phase) * v
        wave = math.sin(2 * math.pi * (folds * u + wander) + phase)
        wave += 0.35 * math.sin(2 * math.pi * (2.3 * folds * u - 0.4 * v) + 2 * phase)
        amplitude = depth * (0.45 + 0.55 * math.sqrt(v)) * (0.8 + 0.2 * math.sin(5.1 * u + phase))
        belly = 0.06 * math.sin(math.pi * u) * v
        hem = 0.03 * math.sin(2 * math.pi * folds * u + phase) * v
        return (width * (u - 0.5), -height * v + hem * 0.4, amplitude * wave + belly)

    sheet(mesh, material, surface, columns, rows, lambda u, v: (2.4 * width * u, 1.6 * height * v))
    return mesh


def tied_curtain(width, height, folds, depth, seed, material, columns=72, rows=28):
    """Half a curtain drawn to the left and tied: `width` wide at its top, from x = 0 to the
    right."""
    mesh = Mesh()
    phase = 1.3 * seed
    tie = 0.62  # share of the height where the cord is

    def gather(v):
        """Share of the width that the cloth still spans."""
        if v < tie:
            return 1 - 0.78 * math.sin(0.5 * math.pi * v / tie) ** 1.6
        return 0.22 + 0.24 * math.sin(0.5 * math.pi * (v - tie) / (1 - tie))

    def surface(u, v):
        span = gather(v)
        wave = math.sin(2 * math.pi * folds * u +
                        phase) + 0.3 * span * math.sin(2 * math.pi * 2.3 * folds * u)
        amplitude = depth * (0.5 + 0.7 * (1 - span)) * (1 - 0.45 * math.exp(-((v - tie) / 0.06)**2))
        sag = 0.22 * u * math.sin(math.pi * min(v / tie, 1.0)) if v < tie else 0.0
        return (width * span * u, -height * v - sag, amplitude * wave)

    sheet(mesh, material, surface, columns, rows, lambda u, v: (3.2 * width * u, 1.6 * height * v))
    return mesh


def draped_cloth(width, height, over, seed, material, columns=40, rows=24):
    """A cloth over a rail: from behind the rail's top edge (z = -over), forwards, and down on its
    front from z = 0."""
    mesh = Mesh()
    phase = 0.9 * seed
    flat = over / (over + height)  # share of the cloth's length that lies on the rail

    def surface(u, v):
        x = width * (u - 0.5)
        if v <= flat:
            return (x, 0.012, -over * (1 - v / flat))
        fall = (v - flat) / (1 - flat)
        wave = math.sin(2 * math.pi * (2.5 * u + 0.15 * fall) +
                        phase) + 0.4 * math.sin(2 * math.pi * 6.1 * u + phase)
        hem = 0.05 * math.cos(2 * math.pi * 2.5 * u + phase) * fall
        # The cloth leaves the rail a little forwards, then hangs in folds that deepen.
        out = 0.05 * min(1.0, 6 * fall) + 0.035 * wave * fall
        return (x * (1 - 0.06 * fall), 0.012 - height * fall + hem, out)

    sheet(mesh, material, surface, columns, rows, lambda u, v: (2.4 * width * u, 1.6 *
                                                                (over + height) * v))
    return mesh
