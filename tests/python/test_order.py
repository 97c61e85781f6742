# SPDX-License-Identifier: MIT
"""The order of calls that change different things of a scene does not matter."""
import random

import numpy
import pytest

import clpv
from conftest import SMALL

WALL = numpy.array([[0.1, 0.1, 0.1], [0.4, 0.1, 0.1], [0.4, 0.4, 0.2]])
TRIANGLE = [[0, 1, 2]]


def moved(x):
    made = numpy.eye(4)
    made[0, 3] = x
    return made


def lights(step):
    return [clpv.Light("point", position=(0.2 + 0.01 * step, 0.4, 0.2), name="a"),
            clpv.Light("spot", position=(0.3, 0.5, 0.3), intensity=step, name="b")][:1 + step % 2]


CHANGES = {
    "lights": lambda scene, step: setattr(scene, "lights", lights(step)),
    "cameras": lambda scene, step: setattr(scene, "cameras", [
        clpv.Camera((0.28, 0.27, -0.2), (0.28, 0.27, 0.3), fov=60 + step, light="ab"[step % 2])]),
    "medium": lambda scene, step: setattr(scene, "medium", [
        None, clpv.Medium(0.1 * step), clpv.Medium(0.2, box=((0, 0, 0), (1, step, 1)))][step % 3]),
    "vertices": lambda scene, step: scene.set_positions(0, WALL + 0.02 * step),
    "place": lambda scene, step: scene.set_transform(1, moved(0.03 * step)),
    "outside": lambda scene, step: scene.set_transform(2, moved(step)),
}  # yapf: disable


def state(scene):
    return (scene.cameras, scene.lights, scene.medium, scene.bounds, scene.notes,
            clpv.Renderer(scene, **SMALL).render().array.tobytes())


@pytest.mark.parametrize("seeds", [1, pytest.param(8, marks=pytest.mark.long)])
def test_random_orders_give_the_same_state(seeds):
    options = SMALL | {"cascade_size": 1}
    for seed in range(seeds):
        found = set()
        for order in range(2):
            shuffle = random.Random(10 * seed + order)
            changed = clpv.Scene()
            for _ in range(3):
                changed.add_mesh(WALL, TRIANGLE, moves=order == 0)
            renderer = clpv.Renderer(changed, **options)
            # Each change has the same last value; others come before, and frames between.
            steps = [(name, step) for name in CHANGES for step in shuffle.sample(range(1, 9), 2)]
            shuffle.shuffle(steps)
            last = [(name, 4 * seed + number) for number, name in enumerate(CHANGES)]
            shuffle.shuffle(last)
            for name, step in steps + last:
                CHANGES[name](changed, step)
                if shuffle.random() < 0.1:
                    renderer.render()
            found.add((*state(changed), renderer.render().array.tobytes()))
        assert len(found) == 1, f"seed {seed}"
