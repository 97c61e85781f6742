# SPDX-License-Identifier: MIT
"""One kind of error: a call with an argument of the wrong kind raises clpv.Error, which names function,
argument, value found and value allowed. Arguments are checked by their types, so each kind has one call."""
import math
import os
import subprocess
import sys

import numpy
import pytest

try:
    import pandas
except ImportError:  # no package of scripts/setup
    pandas = None

import clpv
from conftest import CORNELL, FRONT

NUMBERS = numpy.zeros((1, 1, 3))
MASKED = numpy.ma.masked_array(NUMBERS, NUMBERS == 0)
THING = object()
SQUARE, TRIANGLE = [[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 1, 2]]


def camera(**changes):
    return clpv.Camera(**{"eye": (0, 0, 0), "target": (0, 0, 1), **changes})


def traced(given, **changes):
    return clpv.pathtrace(**{"scene": given["Scene"], "width": 1, "height": 1, "samples": 1, **changes})


# An argument of each kind, a call with it, and values of the wrong kind.
KINDS = [
    ("fov", lambda _, v: camera(fov=v), ["x", None, (1, 2), THING]),
    ("steps", lambda o, v: o["Basis"].energy(v), ["x", None, 1.5, 2**70, THING]),
    ("table_size", lambda o, v: o["Basis"].clamped_cosine((0, 0, 1), v), ["x", 1.5, THING]),
    ("name", lambda _, v: camera(name=v), [3, None, THING]),
    ("smooth", lambda _, v: clpv.Scene.from_arrays(SQUARE, TRIANGLE, smooth=v),
     ["x", THING]),
    ("eye", lambda _, v: camera(eye=v), ["x", None, 3, (1, 2), (1, 2, "x"), THING]),
    ("eye", lambda o, v: o["Renderer"].light(NUMBERS, positions=NUMBERS, eye=v), ["x", 3, THING]),
    ("intensity", lambda _, v: clpv.Light(intensity=v), ["x", None, (1, 2), THING]),
    ("box", lambda _, v: clpv.Medium(box=v), ["x", (1, 2, 3), THING]),
    ("directions", lambda o, v: o["Basis"].evaluate(v),
     ["x", [["x"]], THING, [[1j]], MASKED,
      *(numpy.full((1, 3), wrong, object) for wrong in ("1", None, THING))]),
    ("camera", lambda o, v: o["Renderer"].render(camera=v), [3, (0, 0, 0), THING]),
    ("material", lambda _, v: clpv.Scene.from_arrays(SQUARE, TRIANGLE, material=v), [3, "x", THING]),
    ("path", lambda _, v: clpv.read_image(v), [3, THING]),
    ("image", lambda _, v: clpv.compare(v, NUMBERS), ["x", THING, [3]]),
    ("scene", lambda o, v: traced(o, scene=v), [None, 3, "x", THING]),
    ("given", lambda _, v: clpv.Scene.from_trimesh(v), [None, 3, "x", THING]),
    ("normals", lambda o, v: o["Renderer"].enqueue_light(1, 1, normals=v, irradiance=None),
     ["x", 1.5, True, 3, -8, 2**40 + 1, 2**70, THING]),
    ("size", lambda o, v: o["Renderer"].render(size=v), [3, (1, ), (1.5, 2), "ab", (0, 5)]),
    ("channels", lambda _, v: clpv.Image(NUMBERS, v), [3, ["x", 4], THING]),
    ("progress", lambda o, v: traced(o, progress=v), [3, "x"]),
    ("view", lambda o, v: o["Renderer"].show(v), [3, None, "nothing", THING]),
    ("view", lambda o, v: traced(o, view=v),
     [3, None, "nothing", [3], [], ["full", "full"], THING]),
    ("bounces", lambda o, v: traced(o, bounces=v), ["x", None, 1.5, -1, THING]),
    ("bandwidth", lambda _, v: clpv.Basis("mine", v, [[1, 0, 0]]), ["x", THING]),
]  # yapf: disable


@pytest.fixture(scope="module")
def objects(renderer):
    return {"Scene": clpv.Scene(CORNELL), "Image": clpv.Image(NUMBERS), "Renderer": renderer,
            "Basis": clpv.Basis("sh2"), "Camera": FRONT, "Light": clpv.Light(),
            "Medium": clpv.Medium(), "Material": clpv.Material()}


@pytest.mark.parametrize("argument, call, values", KINDS)
@pytest.mark.filterwarnings("ignore")
def test_wrong_kinds_are_named(argument, call, values, objects):
    for wrong in values:
        with pytest.raises(clpv.Error) as raised:
            call(objects, wrong)
        words = str(raised.value)
        assert argument in words and "found " in words and "allowed: " in words, f"{wrong!r}: {words}"
        assert "incompatible" not in words and "pybind" not in words and "_native" not in words


def test_wrong_calls_are_named(objects):
    for given in (), (1, 2, 3, 4):
        with pytest.raises(clpv.UsageError, match=r"energy: found .*allowed: \(self: clpv.Basis, steps: int"):
            objects["Basis"].energy(*given)
    with pytest.raises(clpv.UsageError, match="Camera: found .*fo=3.*allowed: .*fov: float"):
        FRONT.replace(fo=3)


def containers(numbers):
    """Numbers as each type that people have vectors in, whose items may be made on access."""
    for array in [numpy.array(numbers, number) for number in (int, numpy.float32, ">f8")]:
        yield from (array, tuple(array), numpy.repeat(array, 2)[::2], array[::-1].copy()[::-1])
    if pandas is not None:
        yield pandas.Series(numbers, index=[2, 1, 0])  # subscripts are labels
        yield pandas.DataFrame([numbers], columns=list("xyz")).iloc[0]


def test_vectors_of_any_type(objects):  # under PYTHONMALLOC=debug: items were once freed
    for one in containers((1, 0, 3)):
        assert camera(eye=one).eye == clpv.Light(intensity=one).intensity == (1, 0, 3), repr(one)
        assert clpv.Medium(box=(one, [2, 2, 4])).box == ((1, 0, 3), (2, 2, 4)), repr(one)
        objects["Renderer"].update(one)
    assert clpv.Medium(box=numpy.array([[0, 0, 0], [1, 2, 3]])).box == ((0, 0, 0), (1, 2, 3))


def test_arrays_of_any_type():
    basis, rows = clpv.Basis("sh2"), numpy.array([[0, 0, 1], [1, 0, 3], [2, 1, 0]])
    given = [rows.astype(object), numpy.asfortranarray(rows), rows.astype(">f4")]
    if pandas is not None:  # whose tables have a method `mask`
        table = pandas.DataFrame(rows, index=[2, 1, 0])
        given += [table, table.astype("Float64"), table.astype(object)]
        for wrong in table.astype(str), table.astype("Float64").replace(3, pandas.NA):
            with pytest.raises(clpv.UsageError, match="directions: found an array of"):
                basis.evaluate(wrong)
    for one in given:
        assert (basis.evaluate(one) == basis.evaluate(rows)).all()


def test_wrong_times_are_named():
    for times in (3, None, "x", [3], [{}], numpy.zeros(3), [{"stage": "frame", "median": "x"}],
                  [{"stage": "frame", "median": 10**400}]):
        with pytest.raises(clpv.UsageError, match="ms_of: times: found .*; allowed: "):
            clpv.ms_of(times, "frame")
    with pytest.raises(clpv.UsageError, match="ms_of: stage: found 3; allowed: "):
        clpv.ms_of([], 3)


def test_assigned_values_are_named(scene):
    for name, wrong in [("lights", [3]), ("lights", 3), ("cameras", FRONT), ("medium", "fog")]:
        with pytest.raises(clpv.UsageError, match=f"{name}: found .*, allowed: a? ?(sequence|clpv)"):
            setattr(scene, name, wrong)


def test_errors_are_those_of_python_too():
    assert issubclass(clpv.UsageError, ValueError) and issubclass(clpv.UsageError, TypeError)
    for kind in clpv.UsageError, clpv.InputError, clpv.DeviceError, clpv.ResourceError:
        assert issubclass(kind, clpv.Error)


def test_numbers_of_meshes_and_textures_are_named():
    with pytest.raises(clpv.InputError, match=f"triangles.0.: found index {2**64 - 1}"):
        clpv.Scene.from_arrays(SQUARE, numpy.array([[0, 1, 2**64 - 1]], numpy.uint64))
    with pytest.raises(clpv.InputError, match=r"texture: \[0, 1\]: found 1.5; allowed: 0 to 1"):
        clpv.Material(texture=[[[0.0, 1, 0, 1], [0, 1.5, 0, 1]]])
    with pytest.raises(clpv.InputError, match="triangles"):  # not 'an array of float64'
        clpv.Scene.from_arrays(SQUARE, [])


def test_messages_name_function_and_argument(renderer, scene):
    for match, call in [
        ("^irradiance: points: found shape", lambda: renderer.irradiance([[1, 2]], (0, 1, 0))),
        ("^light: normals: found shape", lambda: renderer.light([[0, 1, 0]], positions=[[0, 0, 0]])),
        ("^evaluate: directions: found shape", lambda: clpv.Basis("sh2").evaluate([1, 2])),
        ("^render: time: found nan", lambda: renderer.render(time=math.nan)),
        ("^render: camera: target: found .*the eye itself",
         lambda: renderer.render(camera=FRONT.replace(target=FRONT.eye))),
        ("^Renderer: centres: found .* allowed: a text",
         lambda: clpv.Renderer(scene, centres=numpy.eye(3))),
        ("^pathtrace: camera: eye: found",
         lambda: clpv.pathtrace(scene, camera=FRONT.replace(eye=(0, math.nan, 0)))),
        ("^project: values: found nan at 0",
         lambda: clpv.Basis("sh2").project(numpy.full(len(clpv.Basis("sh2").directions()), math.nan))),
        ("^clamped_cosine: table_size: found -1",
         lambda: clpv.Basis("sh2").clamped_cosine((0, 0, 1), -1)),
        ("^compare: exposure: found nan", lambda: clpv.compare(NUMBERS, NUMBERS, math.nan)),
        ("^options: found 1, allowed", lambda: clpv.options(1)),
    ]:  # yapf: disable
        with pytest.raises(clpv.UsageError, match=match):
            call()
    with pytest.raises(clpv.InputError, match="allowed: none without vertices"):
        scene.add_mesh([], [[0, 1, 2]])


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
