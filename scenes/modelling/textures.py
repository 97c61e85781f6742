# SPDX-License-Identifier: MIT
"""Small tiling textures: floor tiles, stone courses, plaster, damask. Made of hashes, so the same
everywhere."""
import math

from modelling.gltf import png

SHADES = 32  # steps between a texture's darkest and lightest colour


def hash01(*key):
    """A number in [0, 1) that looks random and is the same for the same integers."""
    h = 2166136261
    for value in key:
        h = ((h ^ (value & 0xFFFFFFFF)) * 16777619) & 0xFFFFFFFF
        h ^= h >> 15
        h = (h * 0x2C1B3C6D) & 0xFFFFFFFF
        h ^= h >> 12
    return h / 4294967296.0


def noise(size, cells, seed):
    """Value noise on a lattice of `cells` x `cells` that repeats: `size` x `size` values in [0, 1),
    row by row."""
    lattice = [[hash01(x, y, seed) for x in range(cells)] for y in range(cells)]
    steps = []
    for i in range(size):
        cell, t = divmod(i * cells / size, 1.0)
        steps.append((int(cell), (int(cell) + 1) % cells, t * t * (3 - 2 * t)))
    values = []
    for above, below, ty in steps:
        row = [a + (b - a) * ty for a, b in zip(lattice[above], lattice[below])]
        values += [row[left] + (row[right] - row[left]) * tx for left, right, tx in steps]
    return values


def clouds(size, cells, octaves, seed):
    """A weighted mean of octaves of noise."""
    weights = [0.5 ** (i + 1) for i in range(octaves)]
    maps = [noise(size, cells << i, seed + i) for i in range(octaves)]
    total = sum(weights)
    return [sum(w * v for w, v in zip(weights, values)) / total for values in zip(*maps)]


def srgb(linear):
    """An sRGB byte of a linear value in [0, 1]."""
    encoded = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
    return max(0, min(255, round(encoded * 255)))


def ramp(dark, light):
    """SHADES colours from one linear colour to another, as sRGB bytes."""
    steps = [i / (SHADES - 1) for i in range(SHADES)]
    return [tuple(srgb(d + (l - d) * t) for d, l in zip(dark, light)) for t in steps]


def shade(value):
    return max(0, min(SHADES - 1, round(value * (SHADES - 1))))


def floor_tiles(size=512):
    """Two by two tiles, light and dark, with joints: repeats every two tiles."""
    pale, dark = ramp((0.32, 0.29, 0.24), (0.78, 0.73, 0.64)), ramp((0.18, 0.11, 0.08),
                                                                    (0.56, 0.38, 0.28))
    half, pixels = size // 2, []
    stain, grain = clouds(size, 8, 4, 11), noise(size, 128, 21)
    for i in range(size * size):
        x, y = i % size, i // size
        tile = (x // half, y // half)
        u, v = x % half, y % half
        joint = min(u, v, half - 1 - u, half - 1 - v)
        value = 0.55 + 0.35 * (stain[i] - 0.5) + 0.14 * (hash01(*tile, 3) -
                                                         0.5) + 0.10 * (grain[i] - 0.5)
        if joint < 2:
            value = 0.04
        elif joint < 4:
            value -= 0.10
        pixels.append(shade(value) + (SHADES if (tile[0] + tile[1]) % 2 else 0))
    return png(size, size, pale + dark, pixels)


def stone_courses(size=512, courses=4, blocks=2):
    """Courses of ashlar, half a block apart from one to the next."""
    height, width, pixels = size // courses, size // blocks, []
    stain, grain = clouds(size, 8, 4, 31), noise(size, 128, 41)
    for i in range(size * size):
        x, y = i % size, i // size
        course = y // height
        shifted = x + (width // 2) * (course % 2)
        block = shifted % size // width
        u, v = shifted % width, y % height
        joint = min(u, v, width - 1 - u, height - 1 - v)
        value = 0.62 + 0.30 * (stain[i] - 0.5) + 0.20 * (hash01(course, block, 5) -
                                                         0.5) + 0.12 * (grain[i] - 0.5)
        pixels.append(shade(value - 0.30 if joint < 2 else value))
    return png(size, size, ramp((0.30, 0.25, 0.19), (0.80, 0.73, 0.62)), pixels)


def plaster(size=256):
    """Lime plaster: large soft stains and a fine grain."""
    values = [
        0.6 + 0.5 * (s - 0.5) + 0.15 * (g - 0.5)
        for s, g in zip(clouds(size, 4, 4, 51), noise(size, 64, 61))
    ]
    return png(size, size, ramp((0.50, 0.44, 0.36), (0.80, 0.74, 0.64)), [shade(v) for v in values])


def damask(size=256):
    """A woven pattern of leaves in two shades, white on average near 1: multiplies a cloth's
    colour."""
    pixels = []
    for y in range(size):
        for x in range(size):
            u, v = x / size, y / size
            leaf = math.cos(2 * math.pi *
                            (u + 0.18 * math.sin(4 * math.pi * v))) * math.cos(2 * math.pi * v)
            vein = math.cos(
                6 * math.pi * u) * math.cos(6 * math.pi * v + math.pi * math.cos(2 * math.pi * u))
            woven = 1.0 if leaf + 0.45 * vein > 0.12 else 0.0
            value = 0.52 + 0.30 * woven + 0.12 * (hash01(x, y, 71) - 0.5)
            pixels.append(shade(value))
    return png(size, size, ramp((0.45, 0.45, 0.45), (1.0, 1.0, 1.0)), pixels)
