# SPDX-License-Identifier: MIT
"""Images, cameras, lights, volumes: equal to what the program writes; bad input."""
import gc
import threading

import numpy as np
import pytest

import clpv
from conftest import CORNELL, FRONT, SMALL, program


def flags():
    return [
        word for name, value in SMALL.items() for word in (f"--{name.replace('_', '-')}", value)
    ]


def ms(renderer, stage):
    return clpv.ms_of(renderer.stats["times"], stage)


def test_images_are_the_programs_byte_for_byte(tmp_path, renderer):
    program("render", CORNELL, "--camera", "front", *flags(), "-o", tmp_path / "program.exr")
    image = renderer.render("full", camera="front")
    written = clpv.read_image(tmp_path / "program.exr")
    assert written.array.tobytes() == image.array.tobytes()
    image.save(tmp_path / "module.exr")
    assert clpv.read_image(tmp_path / "module.exr").array.tobytes() == image.array.tobytes()
    assert image.metadata["basis"] == "sh2" and image.channels == ("R", "G", "B", "A")
    assert image.array.shape == (27, 48, 4) and image.array.dtype == np.float32


def test_pathtrace_is_the_programs_byte_for_byte(tmp_path, scene):
    program("pathtrace", CORNELL, "--width", 16, "--height", 9, "--spp", 4, "--view", "indirect",
            "-o", tmp_path / "t.exr")
    traced = clpv.pathtrace(scene, "indirect", width=16, height=9, samples=4)
    assert clpv.read_image(tmp_path / "t.exr").array.tobytes() == traced.array.tobytes()


def test_arrays_do_not_copy_and_outlive_their_owners(scene):
    image = clpv.Renderer(scene, **SMALL).render()  # the renderer is gone
    array, same = image.array, np.asarray(image)
    assert np.shares_memory(array, same)
    before = array.copy()
    volume = clpv.Renderer(scene, **SMALL)
    volume.render()
    coefficients = volume.volumes()[0].coefficients
    total = coefficients.sum()
    del image, volume
    gc.collect()
    assert np.array_equal(array, before) and coefficients.sum() == total


def test_a_camera_by_value(renderer):
    named = renderer.render("full", camera="front").array
    assert np.allclose(renderer.render("full", camera=FRONT).array, named, atol=1e-4 * named.max())
    assert not np.allclose(
        renderer.render("full", camera=FRONT.replace(fov=40)).array, named, atol=0.01)
    assert FRONT == clpv.Camera((0.278, 0.273, -0.18), np.array([0.278, 0.273, 0.28]), fov=75)
    assert "fov=75" in repr(FRONT) and FRONT.replace(near=1).near == 1
    with pytest.raises(AttributeError):
        FRONT.fov = 3


def test_stats(scene):
    renderer = clpv.Renderer(scene, **SMALL)
    assert ms(renderer, "propagate") == 0
    renderer.render()
    stats = renderer.stats
    assert ms(renderer, "frame") > ms(renderer, "propagate") > 0 and stats["device_bytes"] > 0
    light = [time for time in stats["times"] if time["stage"] == "inject-light"]
    assert [(time["cascade"], time["light"], time["n"]) for time in light] == [(None, None, 1)]
    assert all(time["min"] == time["median"] == time["max"] > time["mad"] == 0 for time in light)


def test_threads_share_a_renderer(renderer):
    renderer.render()
    points = np.random.default_rng(1).uniform(0.1, 0.4, (3000, 3))

    def ask():
        return renderer.radiance(points, points)

    expected, found = ask(), []
    threads = [threading.Thread(target=lambda: found.append(ask())) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4 and all(np.array_equal(each, expected) for each in found)


def test_a_comparison_has_gain_and_identity(renderer):
    errors = clpv.compare(renderer.render().array * 2, renderer.render())
    assert errors.best_gain == pytest.approx(0.5) and not errors.identical


def test_sizes_and_release(scene):
    with clpv.Renderer(scene, **SMALL) as renderer:
        assert renderer.render(size=(30, 20)).array.shape == (20, 30, 4)
    assert renderer.stats["device_bytes"] < 1e6
    both = clpv.pathtrace(scene, ["indirect", "albedo"], width=4, height=3, samples=1)
    assert both.channels[:2] == ("indirect.R", "indirect.G") and both.array.shape == (3, 4, 8)
