#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Bakes probes of a scene, looks them up on a slice, and shows the truth beside them.

    PYTHONPATH=build/python examples/probes.py scenes/cornell.json slice.png [--height 0.5]
"""
import argparse
import pathlib
import subprocess
import tempfile

import clpv
import numpy as np
from matplotlib import pyplot as plt

A = np.pi * np.array([1] + [2 / 3] * 3 + [1 / 4] * 5)  # of the clamped cosine, by harmonic


def harmonics(n):
    """The nine harmonics at unit vectors (..., 3)."""
    x, y, z = np.moveaxis(np.asarray(n, float), -1, 0)
    return np.stack([0.282095 + 0 * x, 0.488603 * y, 0.488603 * z, 0.488603 * x, 1.092548 * x * y,
                     1.092548 * y * z, 0.315392 * (3 * z * z - 1), 1.092548 * x * z,
                     0.546274 * (x * x - y * y)], axis=-1)


def look_up(probes, points):
    """Trilinear interpolation of the coefficients (n, 3) at points (..., 3)."""
    c, (lower, upper) = probes["coefficients"], probes["bounds"]
    count = np.array(c.shape[2::-1])
    at = np.clip((points - lower) / probes["spacing"], 0, count - 1)
    low = np.minimum(at.astype(int), count - 2)
    part = at - low
    total = 0
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, part, 1 - part), axis=-1)
        x, y, z = np.moveaxis(low + corner, -1, 0)
        total = total + weight[..., None, None] * c[z, y, x]
    return total


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("output")
    parser.add_argument("--height", type=float, default=0.5, help="of the slice, as a share of the box")
    parser.add_argument("--clpv", default="build/clpv")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "probes.npz"
        subprocess.run([options.clpv, "bake", options.scene, "-o", file, "--format", "sh3"], check=True)
        probes = dict(np.load(file))
    lower, upper = probes["bounds"]
    t, s = np.mgrid[0.02:0.98:48j, 0.02:0.98:48j]
    points = lower + np.stack([s, np.full_like(s, options.height), t], axis=-1) * (upper - lower)
    up = np.broadcast_to([0.0, 1.0, 0.0], points.shape)
    baked = np.einsum("...i,...ic->...c", A * harmonics(up), look_up(probes, points))
    truth = clpv.Scene(options.scene).pathtrace_points(points, up, noise=0.05)["indirect"]
    _, axes = plt.subplots(1, 2, figsize=(9, 4.5))
    for axis, light, title in zip(axes, (baked, truth), ("probes, sh3", "truth")):
        axis.imshow(np.clip(light / np.percentile(truth, 99), 0, 1) ** (1 / 2.2), origin="lower")
        axis.set_title(f"irradiance of indirect light, upwards: {title}")
        axis.set_axis_off()
    plt.savefig(options.output, bbox_inches="tight")


if __name__ == "__main__":
    main()
