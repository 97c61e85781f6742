#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A room built from NumPy arrays. Its red wall moves; the indirect light on the floor is printed,
and plotted with matplotlib."""
import numpy as np

import clpv


def rectangle(corner, along, up):
    """Positions and triangles of a rectangle, seen from where `along` to `up` turns
    counter-clockwise."""
    corner, along, up = map(np.array, (corner, along, up))
    corners = np.array([corner, corner + along, corner + along + up, corner + up])
    return corners, [[0, 1, 2], [0, 2, 3]]


scene = clpv.Scene()
for wall in [((0, 0, 4), (4, 0, 0), (0, 0, -4)),   # floor
             ((0, 0, 0), (4, 0, 0), (0, 3, 0)),    # back
             ((0, 0, 4), (0, 0, -4), (0, 3, 0))]:  # left
    scene.add_mesh(*rectangle(*wall), material=clpv.Material(base_colour=0.7))
red = scene.add_mesh(*rectangle((4, 0, 0), (0, 0, 4), (0, 3, 0)),
                     material=clpv.Material(base_colour=(0.8, 0.1, 0.1)))
scene.lights = [clpv.Light(direction=(0.6, -1, -0.2), intensity=20)]
scene.cameras = [clpv.Camera(eye=(2, 1.6, 6), target=(2, 1.2, 0))]

renderer = clpv.Renderer(scene, width=480, height=270, cascade_size=5, grid=32)
x, z = np.meshgrid(np.linspace(0.1, 1.9, 24), np.linspace(0.2, 3.8, 24))
points, up = np.stack([x, 0 * x, z], axis=-1), np.broadcast_to((0.0, 1, 0), (*x.shape, 3))
maps = []
for shift in np.linspace(0, -1.6, 5):
    transform = np.eye(4)
    transform[0, 3] = shift
    scene.set_transform(red, transform)
    renderer.render()
    maps.append(renderer.irradiance(points, up))
    print(f"wall at {4 + shift:.1f} m: red light on the floor {maps[-1][..., 0].mean():.4f} W/m^2")

try:
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError:
    raise SystemExit(0)
figure, axes = plt.subplots(1, len(maps), figsize=(12, 2.8))
for axis, values, shift in zip(axes, maps, np.linspace(0, -1.6, 5)):
    shown = axis.imshow(values[..., 0], vmin=0, vmax=max(v[..., 0].max() for v in maps),
                        extent=(0.1, 1.9, 3.8, 0.2))
    axis.set_title(f"wall at {4 + shift:.1f} m")
figure.colorbar(shown, ax=axes, label="red irradiance [W/m²]")
figure.savefig("arrays.png", dpi=120)
