# SPDX-License-Identifier: MIT
"""One kind of error: a call with an argument of the wrong kind raises clpv.Error, which names function,
argument, value found and value allowed."""
import inspect
import math
import os
import pathlib
import subprocess
import sys

import numpy
import pytest

try:
    import pandas
except ImportError:  # no package of scripts/setup
    pandas = None

import clpv
from conftest import CORNELL, FRONT, SMALL

NUMBERS = numpy.zeros((1, 1, 3))
MASKED = numpy.ma.masked_array(NUMBERS, NUMBERS == 0)
THING = object()
# Values of the wrong kind for each kind of argument.
WRONG = {
    "number": ["x", None, (1, 2), THING],
    "integer": ["x", None, 1.5, 2**70, True, THING],
    "text": [3, None, b"full", THING, "\ud800"],
    "bool": ["x", (1, ), math.nan, 1j, THING],
    "vector": ["x", None, 3, (1, 2), (1, 2, "x"), numpy.zeros(3, complex), MASKED[0, 0], THING],
    "colour": ["x", None, (1, 2), THING],
    "array": ["x", [["x"]], THING, [[1j]], MASKED,
              *(numpy.full((1, 3), wrong, object) for wrong in ("1", None, THING))],
    "camera": [3, (0, 0, 0), THING],
    "path": [3, THING, "\ud800"],
    "image": ["x", THING, [3]],
    "object": [None, 3, "x", THING],
    "buffer": ["x", 1.5, True, 3, -8, 2**40 + 1, 2**70, THING],
    "size": [3, (1, ), (1.5, 2), "ab", (0, 5)],
    "names": [3, ["x", 4], THING],
    "function": [3, "x"],
    "view": [3, None, "nothing", THING],
    "views": [3, None, "nothing", [3], [], ["full", "full"], THING],
    "bounces": ["x", None, 1.5, -1, THING],
    "numbers": ["x", THING],
}
MESH = {"positions": "array", "triangles": "array", "normals": "array", "uvs": "array",
        "colours": "array", "smooth": "bool", "material": "camera", "transform": "array",
        "moves": "bool"}
GIVEN_MESH = {"positions": numpy.eye(3), "triangles": [[0, 1, 2]]}
PIXELS = {"width": "integer", "height": "integer", "normals": "buffer", "positions": "buffer",
          "depths": "buffer", "irradiance": "buffer", "eye": "vector?", "camera": "camera",
          "time": "number"}
# Arguments of each function by kind, with '?' if None is allowed; and a call that has the required
# ones.
CALLS = {
    "Camera": ({"eye": "vector", "target": "vector", "up": "vector", "fov": "number",
                "near": "number", "name": "text", "light": "text"},
               {"eye": (0, 0, 0), "target": (0, 0, 1)}),
    "Light": ({"kind": "text", "position": "vector", "direction": "vector", "intensity": "colour",
               "range": "number", "inner_cone": "number", "outer_cone": "number", "name": "text"},
              {}),
    "Medium": ({"scattering": "colour", "absorption": "colour", "anisotropy": "number",
                "box": "vector?"}, {}),
    "Material": ({"base_colour": "colour", "emission": "colour", "texture": "array",
                  "alpha_cutoff": "number?", "double_sided": "bool"}, {}),
    "Scene": ({"path": "path", "model": "path"}, {}),
    "Scene.add_mesh": (MESH, GIVEN_MESH),
    "Scene.from_arrays": (MESH, GIVEN_MESH),
    "Scene.from_trimesh": ({"given": "object"}, {}),
    "Scene.add_instance": ({"mesh": "integer", "transform": "array"},
                           {"mesh": 0, "transform": numpy.eye(4)}),
    "Scene.pathtrace_points": ({"positions": "array", "normals": "array", "bounces": "bounces",
                                "samples": "integer", "noise": "number", "seed": "integer",
                                "threads": "integer", "time": "number"},
                               {"positions": NUMBERS, "normals": (0, 1, 0)}),
    "Scene.save": ({"path": "path"}, {"path": "x.glb"}),
    "Scene.remove_mesh": ({"mesh": "integer"}, {}),
    "Scene.set_positions": ({"mesh": "integer", "positions": "array", "normals": "array"},
                            {"mesh": 0, "positions": numpy.eye(3)}),
    "Scene.set_transform": ({"mesh": "integer", "transform": "array"},
                            {"mesh": 0, "transform": numpy.eye(4)}),
    "Image": ({"array": "array", "channels": "names", "encoding": "text"}, {"array": NUMBERS}),
    "Image.save": ({"path": "path", "exposure": "number?"}, {"path": "x.png"}),
    "Image.display": ({"exposure": "number?"}, {}),
    "Renderer": ({"scene": "object", "device": "text", "context": "buffer", "queue": "buffer"},
                 {"scene": None}),
    "Renderer.render": ({"view": "view", "camera": "camera", "time": "number", "size": "size"}, {}),
    "Renderer.show": ({"view": "view"}, {}),
    "Renderer.update": ({"eye": "vector", "time": "number"}, {"eye": (0, 0, 0)}),
    "Renderer.light": ({"normals": "array", "positions": "array", "depths": "array",
                        "eye": "vector?", "camera": "camera", "time": "number"},
                       {"normals": NUMBERS, "positions": NUMBERS}),
    "Renderer.irradiance": ({"points": "array", "normals": "array"},
                            {"points": NUMBERS, "normals": NUMBERS}),
    "Renderer.radiance": ({"points": "array", "directions": "array"},
                          {"points": NUMBERS, "directions": NUMBERS}),
    "Renderer.enqueue": ({"view": "view", "camera": "camera", "time": "number", "size": "size"},
                         {}),
    "Renderer.enqueue_light": (PIXELS, {"width": 1, "height": 1, "normals": None,
                                        "irradiance": None}),
    "Basis": ({"name": "text", "bandwidth": "numbers", "centres": "array"}, {}),
    "Basis.evaluate": ({"directions": "array"}, {}),
    "Basis.clamped_cosine": ({"axes": "array", "table_size": "integer?"}, {"axes": (0, 0, 1)}),
    "Basis.energy": ({"steps": "integer", "transport": "text", "table_size": "integer?"},
                     {"steps": 1}),
    "Basis.project": ({"values": "array"}, {}),
    "Basis.lobe": ({"axis": "array", "coefficients": "array"}, {"axis": (0, 0, 1)}),
    "compare": ({"image": "image", "reference": "image", "exposure": "number"},
                {"image": NUMBERS, "reference": NUMBERS}),
    "pathtrace": ({"scene": "object", "view": "views", "camera": "camera", "width": "integer",
                   "height": "integer", "bounces": "bounces", "samples": "integer",
                   "noise": "number", "seed": "integer", "threads": "integer", "time": "number",
                   "progress": "function"}, {"scene": None, "width": 1, "height": 1, "samples": 1}),
    "read_image": ({"path": "path"}, {}),
}  # yapf: disable
WITHOUT = {"ms_of", "Basis.directions", "Renderer.volumes", "Renderer.device_volumes", "Renderer.release",
           "Renderer.lookup_source", "DeviceFrame.wait", "DeviceEvent.wait",
           "DeviceVolumes.arguments", "bases", "devices", "options", "Camera.replace",
           "Light.replace", "Medium.replace", "Material.replace", "Image.automatic_exposure"}
# Functions whose only argument is required.
ONE = {"Scene.from_trimesh", "Scene.remove_mesh", "Renderer.show", "Basis.evaluate",
       "Basis.project", "read_image"}
HIDDEN = {"DeviceEvent", "DeviceFrame", "DeviceVolumes", "Volume", "Comparison"}


def public_functions():
    for name in clpv.__all__:
        member = getattr(clpv, name)
        if inspect.isclass(member) and issubclass(member, Exception):
            continue
        if name not in HIDDEN:
            yield name
        if inspect.isclass(member):
            for inner, value in vars(member).items():
                if not inner.startswith("_") and callable(getattr(member, inner)) and not isinstance(
                        value, property):
                    yield f"{name}.{inner}"


@pytest.fixture(scope="module")
def objects(scene, renderer):
    return {"Scene": clpv.Scene(CORNELL), "Image": clpv.Image(NUMBERS), "Renderer": renderer,
            "Basis": clpv.Basis("sh2"), "scene": scene}


def call_of(name, objects):
    owner, _, method = name.partition(".")
    kind = getattr(clpv, owner)
    return getattr(objects[owner], method) if method and owner in objects else getattr(
        kind, method) if method else kind


def test_the_table_has_every_function():
    assert set(public_functions()) == set(CALLS) | WITHOUT


@pytest.mark.parametrize("name", CALLS)
@pytest.mark.filterwarnings("ignore")
def test_wrong_kinds_are_named(name, objects):
    function = call_of(name, objects)
    kinds, given = CALLS[name]
    given = given | {key: objects["scene"] for key in ("scene", ) if key in given}
    for argument, kind in kinds.items():
        for wrong in WRONG[kind.rstrip("?")]:
            if wrong is None and kind.endswith("?"):
                continue
            with pytest.raises(clpv.Error) as raised:
                function(**(given | {argument: wrong}))
            words = str(raised.value)
            assert f"{argument}: found" in words and "allowed: " in words, \
                f"{name}({argument}={wrong!r}): {words}"
            assert "incompatible" not in words and "pybind" not in words


@pytest.mark.parametrize("name", [name for name in CALLS if name != "Renderer"])
def test_wrong_calls_are_named(name, objects):
    function, given = call_of(name, objects), CALLS[name][1]
    given = given | {key: objects["scene"] for key in ("scene", ) if key in given}
    title = name.rpartition(".")[2]
    only = {"array": (0, 0, 1), "view": "full", "path": "x", "integer": 0, "object": 3}
    if name in ONE:
        given = {key: only[kind] for key, kind in CALLS[name][0].items()}
    with pytest.raises(clpv.UsageError, match=f"{title}: found argument 'nothing', allowed: "):
        function(**given, nothing=1)
    with pytest.raises(clpv.UsageError, match=rf"{title}: found argument '.ud800', allowed: "):
        function(**given, **{"\ud800": 1})
    with pytest.raises(clpv.UsageError, match=f"{title}: found 20 arguments by position, allowed: "):
        function(*range(20))
    for key in set(given) - ({"width", "height", "samples"} if name == "pathtrace" else set()):
        if (name, key) == ("Renderer.light", "positions"):
            continue
        with pytest.raises(clpv.UsageError, match=f"{title}: {key}: found none, allowed: "):
            function(**{other: value for other, value in given.items() if other != key})


def containers(numbers):
    """Numbers as each type that people have vectors in, whose items may be made on access."""
    for array in [numpy.array(numbers, number) for number in (int, numpy.float32, ">f8")]:
        yield from (array, tuple(array), numpy.repeat(array, 2)[::2], array[::-1].copy()[::-1])
    if pandas is not None:
        yield pandas.Series(numbers, index=[2, 1, 0])  # subscripts are labels
        yield pandas.DataFrame([numbers], columns=list("xyz")).iloc[0]


@pytest.mark.parametrize("name", CALLS)
def test_vectors_of_any_type(name, objects):  # under PYTHONMALLOC=debug: items were once freed
    kinds, given = CALLS[name]
    given = given | {key: objects["scene"] for key in ("scene", ) if key in given}
    for argument in [key for key, kind in kinds.items() if kind.rstrip("?") in ("vector", "colour")]:
        for one in containers((1, 0, 3)):
            value = (one, [2, 2, 4]) if argument == "box" else one
            try:
                made = call_of(name, objects)(**(given | {argument: value}))
            except clpv.Error as error:  # by the scene or the device
                assert f"{argument}: found" not in str(error)
                continue
            found = getattr(made, argument, [1, 0, 3])
            assert tuple(found[0] if argument == "box" else found)[:3] == (1, 0, 3), repr(one)
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


def test_lone_surrogates_are_no_options(objects):
    for options, words in (({"\ud800": 1}, "found argument"), ({"basis": "\ud800"}, "basis: found"),
                           ({"centres": pathlib.Path("\ud800")}, "centres: found")):
        with pytest.raises(clpv.UsageError, match=f"Renderer: {words} .*ud800.*allowed: "):
            clpv.Renderer(objects["scene"], **options)


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
    with pytest.raises(clpv.UsageError, match="Camera: found argument 'fo', allowed: eye, target"):
        FRONT.replace(fo=3)


def test_errors_are_those_of_python_too():
    assert issubclass(clpv.UsageError, ValueError) and issubclass(clpv.UsageError, TypeError)
    for kind in clpv.UsageError, clpv.InputError, clpv.DeviceError, clpv.ResourceError:
        assert issubclass(kind, clpv.Error)


def test_meshes_report_what_was_found():
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    with pytest.raises(clpv.InputError, match=f"triangles.0.: found index {2**64 - 1}"):
        clpv.Scene.from_arrays(square, numpy.array([[0, 1, 2**64 - 1]], numpy.uint64))
    with pytest.raises(clpv.InputError, match="uvs: found none beside a texture"):
        clpv.Scene.from_arrays(square, [[0, 1, 2]],
                               material=clpv.Material(texture=numpy.ones((1, 1, 4))))
    with pytest.raises(clpv.InputError, match=r"texture: \[0, 1\]: found 1.5; allowed: 0 to 1"):
        clpv.Material(texture=[[[0.0, 1, 0, 1], [0, 1.5, 0, 1]]])
    with pytest.raises(clpv.InputError, match="triangles"):  # not 'an array of float64'
        clpv.Scene.from_arrays(square, [])


def test_messages_name_function_and_argument(renderer, scene):
    for match, call in [
        ("^irradiance: points: found shape", lambda: renderer.irradiance([[1, 2]], (0, 1, 0))),
        ("^light: normals: found shape", lambda: renderer.light([[0, 1, 0]], positions=[[0, 0, 0]])),
        ("^evaluate: directions: found shape", lambda: clpv.Basis("sh2").evaluate([1, 2])),
        ("^render: time: found nan", lambda: renderer.render(time=math.nan)),
        ("^render: camera: target: found .*the eye itself",
         lambda: renderer.render(camera=FRONT.replace(target=FRONT.eye))),
        ("^render: camera: fov: found 0", lambda: renderer.render(camera=FRONT.replace(fov=0))),
        ("^Renderer: centres: found .* allowed: a text",
         lambda: clpv.Renderer(scene, centres=numpy.eye(3))),
        ("^pathtrace: camera: eye: found",
         lambda: clpv.pathtrace(scene, camera=FRONT.replace(eye=(0, math.nan, 0)))),
        ("^pathtrace: threads: found -1", lambda: clpv.pathtrace(scene, threads=-1)),
        ("^pathtrace: noise: found nan", lambda: clpv.pathtrace(scene, samples=2, noise=math.nan)),
        ("^project: values: found nan at 0",
         lambda: clpv.Basis("sh2").project(numpy.full(len(clpv.Basis("sh2").directions()), math.nan))),
        ("^clamped_cosine: table_size: found -1",
         lambda: clpv.Basis("sh2").clamped_cosine((0, 0, 1), -1)),
        ("^compare: exposure: found nan", lambda: clpv.compare(NUMBERS, NUMBERS, math.nan)),
        ("^options: found 1 arguments by position", lambda: clpv.options(1)),
        ("^devices: found 1 arguments by position", lambda: clpv.devices(1)),
        ("^clpv.Volume: found a call", lambda: clpv.Volume()),
    ]:  # yapf: disable
        with pytest.raises(clpv.UsageError, match=match):
            call()
    with pytest.raises(clpv.InputError, match="allowed: none without vertices"):
        scene.add_mesh([], [[0, 1, 2]])


def test_images_say_what_they_cannot_show(tmp_path):
    for image in clpv.Image(numpy.zeros((1, 1, 2))), clpv.Image(NUMBERS, encoding="srgb"):
        with pytest.raises(clpv.InputError, match="image: found .*, allowed: "):
            image.display()
        with pytest.raises(clpv.InputError, match="image: found .*, allowed: "):
            image.save(tmp_path / "x.png")
    with pytest.raises(clpv.InputError, match="sRGB-encoded"):
        clpv.Image(NUMBERS, encoding="srgb").save(tmp_path / "x.exr")
    clpv.Image(NUMBERS).save(tmp_path / "X.EXR")
    for names in ["R", "R", "R"], ["R", "a\0b", "B"], ["R", "G", ""]:
        with pytest.raises(clpv.InputError, match="allowed: unique names"):
            clpv.Image(NUMBERS, names)


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


def test_interrupts_of_arguments_are_not_swallowed():
    class Interrupts:
        def __float__(self):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        clpv.Camera((Interrupts(), 0, 0), (0, 0, 1))


def test_lost_settings_are_named_when_a_scene_is_saved(tmp_path, caplog):
    scene = clpv.Scene(CORNELL)
    scene.lights = []
    scene.save(tmp_path / "dark.GLB")
    assert "cascades: not written" in caplog.text and "no lights" in caplog.text
