# SPDX-License-Identifier: MIT
"""Wrong values are named; numbers may come in any container. What fits no function is pybind11's
TypeError."""
import math
import os
import subprocess
import sys

import numpy
import pytest

import clpv
from conftest import CORNELL, FRONT

NUMBERS = numpy.zeros((1, 1, 3))
MASKED = numpy.ma.masked_array(NUMBERS, NUMBERS == 0)
THING = object()
SQUARE, TRIANGLE = [[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1, 2]]
TEXTURE = [[[0.0, 1, 0, 1], [0, 1.5, 0, 1]]]
ENDLESS = numpy.broadcast_to(numpy.zeros(3), (10**13, 3))
NO_TEXTURES = "x", NUMBERS, numpy.zeros((1, 1, 4), int), numpy.ma.zeros((1, 1, 4))
PIXELS = numpy.ones((2, 1, 3))
BASIS = clpv.Basis("sh2")


def camera(**changes):
    return clpv.Camera(**{"eye": (0, 0, 0), "target": (0, 0, 1), **changes})


def traced(scene, **changes):
    return clpv.pathtrace(scene, **{"width": 1, "height": 1, "samples": 1, **changes})


# Values of a kind that fields of cameras, lights and media do not have.
@pytest.mark.parametrize("name, make, values", [
    ("Camera: fov", lambda v: camera(fov=v), ["1", None, (1, 2), THING]),
    ("Camera: name", lambda v: camera(name=v), [3, None, THING]),
    ("Camera: eye", lambda v: camera(eye=v), ["123", None, 3, (1, 2), (1, 2, "x"), THING]),
    ("Light: intensity", lambda v: clpv.Light(intensity=v), ["x", None, (1, 2), THING]),
    ("Medium: box", lambda v: clpv.Medium(box=v), ["x", (1, 2, 3), THING]),
    ("Material: base_colour", lambda v: clpv.Material(base_colour=v), ["x", (1, 2), range(5)]),
    ("Material: texture", lambda v: clpv.Material(texture=v), NO_TEXTURES),
])  # yapf: disable
def test_fields_of_another_kind_are_named(name, make, values):
    for wrong in values:
        with pytest.raises(clpv.UsageError, match=f"(?s)^{name}: found .*, allowed: "):
            make(wrong)


@pytest.mark.parametrize("wrong", ["x", [["x"]], THING, [[1j]], MASKED, *(
    numpy.full((1, 3), item, object) for item in ("1", None, THING))])
def test_arrays_have_real_numbers(wrong):
    with pytest.raises(TypeError, match=r"directions: ArrayLike\) -> "):
        BASIS.evaluate(wrong)
    with pytest.raises(TypeError, match="triangles: ArrayLike"):
        clpv.Scene.from_arrays(SQUARE, [[0.0, 1, 2]])


class Column(list):
    """As a column of pandas, whose subscripts are labels."""

    def __getitem__(self, label):
        return super().__getitem__(-1 - label)

    def tolist(self):
        return list(iter(self))


def containers(numbers):
    """Numbers as each type that people have vectors in, whose items may be made on access."""
    for array in [numpy.array(numbers, number) for number in (int, numpy.float32, ">f8")]:
        yield from (array, tuple(array), numpy.repeat(array, 2)[::2], array[::-1].copy()[::-1])
    yield Column(numbers)


def test_vectors_of_any_type(renderer):  # under PYTHONMALLOC=debug: items were once freed
    places = set()
    for one in containers((1, 0, 3)):
        assert camera(eye=one).eye == clpv.Light(intensity=one).intensity == (1, 0, 3), repr(one)
        assert clpv.Medium(box=(one, [2, 2, 4])).box == ((1, 0, 3), (2, 2, 4)), repr(one)
        renderer.update(one)
        places.add(renderer.volumes()[0].origin)
    assert len(places) == 1
    assert clpv.Medium(box=numpy.array([[0, 0, 0], [1, 2, 3]])).box == ((0, 0, 0), (1, 2, 3))


def test_arrays_of_any_type():
    rows = numpy.array([[0, 0, 1], [1, 0, 3], [2, 1, 0]])
    for one in rows.astype(object), numpy.asfortranarray(rows), rows.astype(">f4"):
        assert (BASIS.evaluate(one) == BASIS.evaluate(rows)).all()


def test_errors_are_those_of_python_too():
    assert issubclass(clpv.UsageError, ValueError) and issubclass(clpv.UsageError, TypeError)
    for kind in clpv.UsageError, clpv.InputError, clpv.DeviceError, clpv.ResourceError:
        assert issubclass(kind, clpv.Error)


@pytest.mark.parametrize("error, match, call", [
    (clpv.UsageError, "points: found shape", lambda s, r: r.irradiance([[1, 2]], (0, 1, 0))),
    (clpv.UsageError, r"normals: found shape \(2, 3\)",
     lambda s, r: r.irradiance(SQUARE, SQUARE[:2])),
    (clpv.UsageError, r"depths: found shape \(1, 2\), allowed: \(2, 1\)",
     lambda s, r: r.light(PIXELS, depths=[[1, 1]])),
    (clpv.UsageError, "normals: found shape", lambda s, r: r.light(PIXELS[0], depths=[[1]])),
    (clpv.UsageError, "positions: found shape",
     lambda s, r: r.light(PIXELS, positions=PIXELS[:1], eye=FRONT.eye)),
    (clpv.UsageError, "found neither, allowed: one of them", lambda s, r: r.light(PIXELS)),
    (clpv.UsageError, "found eye and camera",
     lambda s, r: r.light(PIXELS, positions=PIXELS, camera=FRONT, eye=FRONT.eye)),
    (clpv.UsageError, "found depths and an eye",
     lambda s, r: r.light(PIXELS, depths=[[1], [1]], eye=FRONT.eye)),
    (clpv.UsageError, "time: found nan", lambda s, r: r.render(time=math.nan)),
    (clpv.UsageError, "view: found 'nothing', allowed: full", lambda s, r: r.show("nothing")),
    (clpv.UsageError, "centres: found .* allowed: a text",
     lambda s, r: clpv.Renderer(s, centres=numpy.eye(3))),
    (clpv.UsageError, "lambda: found '7'", lambda s, r: clpv.Renderer(s, lambda_=7)),
    (clpv.UsageError, "camera: eye: found",
     lambda s, r: traced(s, camera=FRONT.replace(eye=(0, math.nan, 0)))),
    (clpv.UsageError, "bounces: found 'x'", lambda s, r: traced(s, bounces="x")),
    (clpv.UsageError, "kind: found 'sun', allowed: directional",
     lambda s, r: setattr(s, "lights", [clpv.Light("sun")])),
    (clpv.UsageError, "channels: found 1 names", lambda s, r: clpv.Image(NUMBERS, ["R"])),
    (clpv.UsageError, "from_trimesh: given: found int", lambda s, r: clpv.Scene.from_trimesh(3)),
    (clpv.InputError, "nowhere", lambda s, r: clpv.Scene("/nowhere/scene.json")),
    (clpv.InputError, r"texture: \[0, 1\]: found 1.5; allowed: 0 to 1",
     lambda s, r: clpv.Material(texture=TEXTURE)),
    (clpv.InputError, "triangles", lambda s, r: clpv.Scene.from_arrays(SQUARE, [])),
    (clpv.InputError, "allowed: none without vertices", lambda s, r: s.add_mesh([], [[0, 1, 2]])),
    (clpv.DeviceError, "no such one", lambda s, r: clpv.Renderer(s, device="no such one")),
    (clpv.ResourceError, "none/a.exr", lambda s, r: r.render().save("/none/a.exr")),
    (MemoryError, "", lambda s, r: r.irradiance(ENDLESS, ENDLESS)),
    (TypeError, "cannot pickle", lambda s, r: __import__("copy").copy(s)),
    (TypeError, "cannot pickle", lambda s, r: __import__("pickle").dumps(s, 0)),
    *((TypeError, f"clpv.{kind.__name__}: found no call of __init__",
       lambda s, r, kind=kind: kind.__new__(kind))
      for kind in (clpv.Scene, clpv.Renderer, clpv.Image, clpv.Basis, clpv.Volume)),
    *((clpv.UsageError, f"normals: found .*, allowed: an object of pyopencl's class",
       lambda s, r, wrong=wrong: r.enqueue_light(1, 1, normals=wrong, irradiance=None))
      for wrong in ("x", 1.5, THING))
])  # yapf: disable
def test_errors_name_what_they_found(error, match, call, scene, renderer):
    with pytest.raises(error, match=match):
        call(scene, renderer)


@pytest.mark.parametrize("error, match, call", [
    (clpv.UsageError, "1.5", lambda: clpv.Basis("srbf4", bandwidth=1.5)),
    (clpv.UsageError, "direction: found", lambda: clpv.Basis("mine", centres=[[0, 0, 0]])),
    (clpv.UsageError, r"bandwidth: found shape \(2,\), allowed: \(3,\)",
     lambda: clpv.Basis("mine", bandwidth=[.2, .2], centres=numpy.eye(3))),
    (clpv.UsageError, "allowed: three numbers", lambda: clpv.Camera((10**400, 0, 0), (0, 0, 0))),
    (clpv.UsageError, "centres: found shape", lambda: clpv.Basis("mine", centres=[[1, 0]])),
    (clpv.UsageError, "bandwidth: found shape", lambda: clpv.Basis("srbf4", [0.1, 0.2])),
    (clpv.UsageError, "transport: found 'sweep'", lambda: BASIS.energy(8, "sweep")),
    (clpv.UsageError, "steps: found -1", lambda: BASIS.energy(-1)),
    (clpv.UsageError, "table_size: found", lambda: BASIS.clamped_cosine([0, 0, 1], 2**21)),
    (clpv.UsageError, "direction: found", lambda: BASIS.evaluate([0, 0, 0])),
    (clpv.UsageError, "coefficients: found shape", lambda: BASIS.lobe([0, 0, 1], [1, 2])),
    (clpv.UsageError, "values: found shape", lambda: BASIS.project([1, 2])),
    (clpv.UsageError, "values: found nan at 0",
     lambda: BASIS.project(numpy.full(len(BASIS.directions()), math.nan))),
])
def test_errors_of_bases(error, match, call):
    with pytest.raises(error, match=match):
        call()


def test_numpys_warnings_as_errors_are_raised():
    code = """
import clpv, numpy as np
large = np.full((2, 2, 4), 1e300)
for call in (lambda: clpv.Material(texture=large), lambda: clpv.Image(large),
             lambda: clpv.Scene.from_arrays(np.full((3, 3), 1e300), [[0, 1, 2]])):
    try:
        call()
        raise SystemExit("no error")
    except RuntimeWarning:
        pass
"""
    subprocess.run([sys.executable, "-W", "error::RuntimeWarning", "-c", code], check=True,
                   env=os.environ)


def test_lost_settings_are_named_when_a_scene_is_saved(tmp_path, caplog):
    scene = clpv.Scene(CORNELL)
    scene.lights = []
    scene.save(tmp_path / "dark.GLB")
    assert "cascades: not written" in caplog.text and "no lights" in caplog.text
