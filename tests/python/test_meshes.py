# SPDX-License-Identifier: MIT
"""Scenes from arrays: a file's bytes, moving meshes, rejected arrays; trimesh where it is
installed."""
import gc
import re
import threading

import numpy
import pytest

import clpv
import clpv._trimesh
from conftest import ROOT, SMALL, run_python

NO_TRIMESH = "trimesh is not installed (pip install trimesh)"
SQUARE = numpy.array([[0, 1, 2], [0, 2, 3]])
WALL = numpy.array([[-2, 0, -2], [2, 0, -2], [2, 3, -2], [-2, 3, -2]], dtype=float)


def test_arrays_are_those_of_their_file(tmp_path):
    uvs = numpy.array([[0, 0], [2, 0], [2, 1], [0, 1]], dtype=float)
    texture = numpy.random.default_rng(1).integers(0, 256, (4, 8, 4), numpy.uint8)
    look = clpv.Material(base_colour=(0.5, 1, 1), texture=texture, emission=0.25, double_sided=True)
    scene = clpv.Scene.from_arrays(WALL, SQUARE, normals=WALL * 0 + (0, 0.6, 0.8), uvs=uvs,
                                   material=look, transform=numpy.diag([1.0, 2, 1, 1]))
    scene.add_instance(0, numpy.diag([0.5, 1.0, 2, 1]))
    scene.save(tmp_path / "wall.glb")
    of_file = clpv.Scene(tmp_path / "wall.glb")
    assert scene.bounds == of_file.bounds == ((-2, 0, -4), (2, 6, -2))
    of_file.cameras, of_file.lights = scene.cameras, scene.lights
    for view in "albedo", "normal", "full":
        numpy.testing.assert_allclose(*(clpv.Renderer(each, cascade_size=4, **SMALL).render(view)
                                        .array for each in (of_file, scene)), atol=1e-4)


@pytest.mark.parametrize("change, error, words", [
    ({"positions": WALL[:, :2]}, clpv.InputError, "positions: found shape (4, 2); allowed: (n, 3)"),
    ({"positions": WALL.astype(complex)}, TypeError, "positions: ArrayLike"),
    ({"triangles": SQUARE.astype(float)}, TypeError, "triangles: ArrayLike"),
    ({"triangles": SQUARE - 1}, clpv.InputError, "triangles[0]: found index -1"),
    ({"triangles": SQUARE + 2**32}, clpv.InputError, "triangles[0]: found index 4294967296"),
    ({"colours": WALL[:, :2]}, clpv.InputError, "found shape (4, 2); allowed: (n, 4) or (n, 3)"),
    ({"transform": numpy.eye(3)}, TypeError, "transform: "),
])
def test_bad_arrays_are_rejected_by_name(change, error, words):
    with pytest.raises(error, match=re.escape(words)):
        clpv.Scene.from_arrays(**({"positions": WALL, "triangles": SQUARE} | change))


def test_colours_without_alpha_are_opaque():
    scene = clpv.Scene.from_arrays(WALL, SQUARE, colours=numpy.ones((4, 3)),
                                   material=clpv.Material(alpha_cutoff=0.5))
    assert clpv.pathtrace(scene, "albedo", width=2, height=2, samples=1).array.max() == 1


def test_float_textures_are_encoded():
    texture = numpy.ones((1, 1, 4)) * (0.5, 0, 1, 0.5)
    assert clpv.Material(texture=texture).texture.tolist() == [[[188, 0, 255, 128]]]


def test_meshes_change_while_frames_render():
    scene = clpv.Scene.from_arrays(WALL, SQUARE, moves=True)
    renderer = clpv.Renderer(scene, cascade_size=4, **SMALL)
    positions = WALL.copy()

    def change():
        for step in range(20):
            positions[:] = WALL + (0, 0, 0.01 * step)
            scene.set_positions(0, positions)
            positions[:] = numpy.nan  # the scene has its own copy
            if step % 5 == 0:
                scene.remove_mesh(scene.add_mesh(WALL, SQUARE))

    thread = threading.Thread(target=change)
    thread.start()
    while thread.is_alive():
        assert numpy.isfinite(renderer.render().array).all()
    gc.collect()
    anew = clpv.Scene.from_arrays(WALL + (0, 0, 0.19), SQUARE)
    anew.cameras = scene.cameras
    numpy.testing.assert_array_equal(renderer.render().array,
                                     clpv.Renderer(anew, cascade_size=4, **SMALL).render().array)


@pytest.mark.parametrize("name", ["cornell", "atrium"])
def test_a_saved_scene_is_the_same(name, tmp_path):
    scene = clpv.Scene(ROOT / f"scenes/{name}.json")
    scene.save(tmp_path / "saved.glb")
    saved = clpv.Scene(tmp_path / "saved.glb")
    assert [camera.name for camera in saved.cameras] == [camera.name for camera in scene.cameras]
    assert [light.name for light in saved.lights] == [light.name for light in scene.lights]
    numpy.testing.assert_array_equal(saved.bounds, scene.bounds)
    options = {"width": 16, "height": 9, "samples": 4}
    for view in "albedo", "direct", "indirect":
        found = [clpv.pathtrace(each, view, each.cameras[0].replace(light=""), **options).array
                 for each in (scene, saved)]
        numpy.testing.assert_allclose(found[1], found[0], rtol=1e-3, atol=1e-4 * found[0].max())
    with pytest.raises(clpv.UsageError, match="found extension '.obj', allowed: .glb"):
        scene.save(tmp_path / "saved.obj")


def test_scene_of_trimesh():
    trimesh = pytest.importorskip("trimesh", reason=NO_TRIMESH)
    box = trimesh.creation.box((1, 1, 1))
    given = trimesh.Scene()
    given.add_geometry(box, geom_name="box")
    given.graph.update("second", matrix=trimesh.transformations.translation_matrix((3, 0, 0)),
                       geometry="box")
    scene = clpv.Scene.from_trimesh(given)
    assert scene.bounds == ((-0.5, -0.5, -0.5), (3.5, 0.5, 0.5))
    assert "24 triangles" in repr(scene)
    assert "12 triangles" in repr(clpv.Scene.from_trimesh(box))


def test_colours_of_trimesh():
    trimesh = pytest.importorskip("trimesh", reason=NO_TRIMESH)
    look = clpv._trimesh._arguments  # pylint: disable=protected-access
    box = trimesh.creation.box((1, 1, 1))
    box.visual.face_colors = [[10 * face, 255, 0, 255] for face in range(12)]
    given = look(box)
    assert given["positions"].shape == (36, 3) and given["colours"].shape == (36, 4)
    assert numpy.ptp(given["colours"][:3], axis=0).max() == 0 and given["colours"][33, 1] == 1
    assert given["colours"][33, 0] == pytest.approx(110 / 255)  # linear
    assert "12 triangles" in repr(clpv.Scene.from_trimesh(box))


@pytest.mark.parametrize("colour, material", [
    (None, {}), ((0.5, 0.25, 1), {}), ((0.5, 0.25, 1, 1), {"base_colour": (0.4, 0.6, 0.8, 1)}),
    (None, {"base_colour": (1, 1, 1, 0.3), "alpha_cutoff": 0.2}),
    (None, {"emission": (0.2, 0.4, 0.6), "double_sided": True})])
def test_a_scene_of_trimesh_is_its_file(colour, material, tmp_path):
    trimesh = pytest.importorskip("trimesh", reason=NO_TRIMESH)
    file = tmp_path / "a.glb"
    clpv.Scene.from_arrays(WALL, SQUARE, normals=WALL * 0 + (0.6, 0, 0.8),
                           colours=colour and numpy.array([colour] * len(WALL)),
                           material=clpv.Material(**material)).save(file)
    camera = clpv.Camera(eye=(0.2, 1, 3), target=(0, 1.5, -2))
    for view in "albedo", "normal", "direct":
        scenes = clpv.Scene.from_trimesh(trimesh.load(file)), clpv.Scene(file)
        found, expected = (clpv.pathtrace(each, view, camera, width=9, height=9, samples=1).array
                           for each in scenes)
        numpy.testing.assert_allclose(found, expected, atol=0.005)  # rounding of 8 bits


def test_the_example_of_arrays_runs(tmp_path):
    script = (ROOT / "examples/arrays.py").read_text(encoding="utf-8")
    small = script.replace("width=480, height=270",
                           "width=32, height=18").replace(
        "grid=32", "grid=16, directions=24, coarser_directions=24")
    assert small != script
    ended = run_python(small, cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    means = [float(line.split()[-2]) for line in ended.stdout.splitlines() if "W/m^2" in line]
    assert len(means) == 5 and len(set(means)) == 5, "the wall's place changes the light"
