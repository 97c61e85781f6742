#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Bakes probes of a scene, looks them up on a slice, and shows the truth beside them.

    PYTHONPATH=build/python examples/probes.py scenes/cornell.json slice.png [--height 0.5]
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

import clpv
import numpy as np
from matplotlib import pyplot as plt

A = np.pi * np.array([1] + [2 / 3] * 3 + [1 / 4] * 5)  # integrals of the clamped cosine, by harmonic
BAKES = {
    "swept, sh3": ("--format", "sh3"),
    "traced, sh3": ("--format", "sh3", "--from", "pathtrace"),
    "traced, ambient cube": ("--format", "ambient-cube", "--from", "pathtrace")
}


def harmonics(n):
    """The nine harmonics at unit vectors (..., 3)."""
    x, y, z = np.moveaxis(np.asarray(n, float), -1, 0)
    return np.stack([0.282095 + 0 * x, 0.488603 * y, 0.488603 * z, 0.488603 * x, 1.092548 * x * y,
                     1.092548 * y * z, 0.315392 * (3 * z * z - 1), 1.092548 * x * z,
                     0.546274 * (x * x - y * y)], axis=-1)


def cube(n):
    """Weights of the six faces +x, -x, +y, ... at unit vectors (..., 3)."""
    n = np.asarray(n, float)
    return np.stack([np.where(sign * n[..., axis] > 0, n[..., axis]**2, 0)
                     for axis in range(3) for sign in (1, -1)], axis=-1)


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


def irradiance(probes, points, normals):
    weights = A * harmonics(normals) if probes["format"] == "sh3" else np.pi * cube(normals)
    return np.einsum("...i,...ic->...c", weights, look_up(probes, points))


def bake(program, scene, options):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "probes.npz"
        done = subprocess.run([program, "bake", scene, "-o", file, *options], check=False)
        if done.returncode != 0:
            sys.exit(done.returncode)  # it has said why
        return dict(np.load(file))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("output")
    parser.add_argument("--height", type=float, default=0.5, help="of the slice, as a share of the box")
    parser.add_argument("--clpv", default="build/clpv")
    options = parser.parse_args()
    baked = {title: bake(options.clpv, options.scene, given) for title, given in BAKES.items()}
    lower, upper = next(iter(baked.values()))["bounds"]
    t, s = np.mgrid[0.02:0.98:48j, 0.02:0.98:48j]
    points = lower + np.stack([s, np.full_like(s, options.height), t], axis=-1) * (upper - lower)
    up = np.broadcast_to([0.0, 1.0, 0.0], points.shape)
    truth = clpv.Scene(options.scene).pathtrace_points(points, up, noise=0.05)["indirect"]
    shown = {"truth": truth, **{title: irradiance(probes, points, up)
                                for title, probes in baked.items()}}
    _, axes = plt.subplots(1, len(shown), figsize=(2.4 * len(shown), 2.6))
    for axis, (title, light) in zip(axes, shown.items()):
        axis.imshow(np.clip(light / np.percentile(truth, 99), 0, 1) ** (1 / 2.2), origin="lower")
        axis.set_title(title, fontsize=9)
        axis.set_axis_off()
    plt.savefig(options.output, bbox_inches="tight", dpi=90)


if __name__ == "__main__":
    main()
