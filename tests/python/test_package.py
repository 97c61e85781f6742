# SPDX-License-Identifier: MIT
"""The package as users meet it: the program of the documentation, stubs, interrupts, import without
the native module."""
import ast
import inspect
import json
import os
import pathlib
import re
import subprocess
import time

import pytest

import clpv
from clpv import _pocl
from conftest import BUILD, CORNELL, ROOT, run_python


def test_the_example_runs_as_written():
    script = (ROOT / "examples/bases.py").read_text(encoding="utf-8")
    small = script.replace("width=240, height=135",
                           "width=32, height=18").replace("noise=0.02", "noise=0.2")
    small = small.replace("clpv.bases()", "clpv.bases()[:1]")  # others take long to compile
    assert small != script
    ended = run_python(small)
    assert ended.returncode == 0, ended.stderr
    lines = ended.stdout.splitlines()
    assert [line.split()[0] for line in lines] == clpv.bases()[:1]
    assert all(0 < float(line.split()[1]) < 2 and float(line.split()[2]) > 0 for line in lines)


def test_every_name_has_a_docstring():
    for name in clpv.__all__:
        member = getattr(clpv, name)
        assert member.__doc__, name
        for inner, value in vars(member).items() if inspect.isclass(member) else []:
            if not inner.startswith("_") and callable(value):
                assert value.__doc__, f"{name}.{inner}"


def test_the_stubs_have_no_names_of_their_own():
    stub = ast.parse(pathlib.Path(clpv.__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    stored = {node.id for node in ast.walk(stub) if isinstance(node, ast.Name)
              and isinstance(node.ctx, ast.Store) and not node.id.startswith("_")}
    assert stored <= set(dir(clpv))


def test_draw_imports_without_the_native_module():
    ended = run_python("import sys; sys.modules['clpv._native'] = None\n"
                "from clpv import draw; import clpv.draw.style; print(draw.__name__)\n"
                "import clpv\ntry:\n  clpv.Scene\nexcept ImportError:\n  print('no native module')")
    assert ended.stdout.split("\n")[:2] == ["clpv.draw", "no native module"], ended.stderr


@pytest.mark.parametrize("drivers, supported, variable, used",
                         [(0, [], "", True), (1, [], "", True), (1, [False], "", True),
                          (1, [False, True], "", False), (1, [], "/elsewhere", False)])
def test_pocl_of_pip_serves_systems_without_a_device(drivers, supported, variable, used, tmp_path,
                                                     monkeypatch):
    for name in ["pocl_binary_distribution/__init__.py", "pyopencl/.libs/libpocl-1.so",
                 *["vendors/system.icd"] * drivers]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    program = tmp_path / "clpv"
    listed = json.dumps({"devices": [{"supported": each} for each in supported]})
    program.write_text(f"#!/bin/sh\necho '{listed}'\nexit 4\n", encoding="utf-8")
    program.chmod(0o700)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(_pocl, "VENDORS", tmp_path / "vendors")
    monkeypatch.setattr(_pocl, "PROGRAM", program)
    monkeypatch.setenv("OCL_ICD_VENDORS", variable)
    _pocl.system_has_device.cache_clear()
    driver = str(tmp_path / "pyopencl/.libs/libpocl-1.so") if used else None
    assert _pocl.use() == driver
    assert os.environ["OCL_ICD_VENDORS"] == (driver or variable)


def test_the_gil_is_released():
    """A thread counts while the main thread traces."""
    import threading
    scene, counted, done = clpv.Scene(CORNELL), [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    clpv.pathtrace(scene, width=96, height=54, samples=64)
    done.set()
    thread.join()
    assert counted[0] > 10


def test_version_is_the_programs():
    said = subprocess.run([BUILD / "clpv", "--version"], capture_output=True, text=True,
                          check=True).stdout
    assert re.search(re.escape(clpv.__version__), said)
    assert os.path.realpath(clpv.__file__).startswith(
        str(ROOT)), "the module under test is the tree's"


def test_path_tracing_tells_its_progress():
    scene, told = clpv.Scene(CORNELL), []
    clpv.pathtrace(scene, width=96, height=54, samples=64, progress=told.append)
    assert told and told == sorted(told) and told[-1] == 1


def test_objects_print_what_they_are():
    scene = clpv.Scene(CORNELL)
    image = clpv.Image([[[0.5, 0.25, 1.0]]])
    assert repr(image) == "Image(1 x 1, R G B, linear)"
    assert repr(scene).startswith(f"Scene('{CORNELL}', ") and "4 cameras" in repr(scene)
    assert repr(clpv.Scene()) == "Scene('(in memory)', 0 triangles, 1 cameras, 1 lights)"


def test_notebooks_show_images(tmp_path):
    image = clpv.Image([[[0.5, 0.25, 1.0]]])
    (tmp_path / "shown.png").write_bytes(image._repr_png_())
    image.save(tmp_path / "saved.png")
    assert (clpv.read_image(tmp_path / "shown.png").array == clpv.read_image(
        tmp_path / "saved.png").array).all()
    assert clpv.Image([[[1.0]]])._repr_png_() is None
