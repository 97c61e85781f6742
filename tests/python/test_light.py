# SPDX-License-Identifier: MIT
"""Light on the pixels of arrays: a frame's own G-buffer, a panorama, bad input."""
import numpy as np
import pytest

import clpv
from conftest import FRONT, SMALL


@pytest.fixture(scope="module")
def seen(renderer):
    light = renderer.render("irradiance", FRONT).array[..., :3]
    return light, renderer.show("normal").array[..., :3], renderer.show("depth").array[..., 0]


def test_bad_arrays_are_named(renderer, seen):
    _, normals, depths = seen
    with pytest.raises(ValueError, match=r"depths: found shape \(48, 27\), allowed: \(27, 48\)"):
        renderer.light(normals, depths=depths.T, camera=FRONT)
    with pytest.raises(ValueError, match="normals: found shape"):
        renderer.light(normals[0], depths=depths[0], camera=FRONT)
    with pytest.raises(ValueError, match="positions: found shape"):
        renderer.light(normals, positions=normals[:, :9], eye=FRONT.eye)
    with pytest.raises(ValueError, match="found neither, allowed: one of them"):
        renderer.light(normals, camera=FRONT)
    with pytest.raises(ValueError, match="found eye and camera"):
        renderer.light(normals, positions=normals, camera=FRONT, eye=FRONT.eye)
    with pytest.raises(clpv.UsageError, match="found depths and an eye"):
        renderer.light(normals, depths=depths, eye=FRONT.eye)


def test_sizes_and_release(scene):
    with clpv.Renderer(scene, **SMALL) as renderer:
        assert renderer.render(size=(30, 20)).array.shape == (20, 30, 4)
    assert renderer.stats["device_bytes"] < 1e6
    both = clpv.pathtrace(scene, ["indirect", "albedo"], width=4, height=3, samples=1, bounces="all")
    assert both.channels[:2] == ("indirect.R", "indirect.G") and both.array.shape == (3, 4, 8)
