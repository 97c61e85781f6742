# SPDX-License-Identifier: MIT
"""A renderer in pyopencl's context and queue; skipped without pyopencl (Debian:
python3-pyopencl)."""
import pathlib
import runpy

import numpy as np
import pytest

import clpv
from conftest import CORNELL, FRONT, ROOT, SMALL

MISSING = "pyopencl is not installed (Debian: apt install python3-pyopencl)"


def test_handles_of_another_kind_are_named(scene):
    allowed = "allowed: an object of pyopencl's class"
    with pytest.raises(TypeError, match=f"queue: found .*str.*, {allowed} CommandQueue, or its"):
        clpv.Renderer(scene, queue="queue", **SMALL)

    class Context:  # as pyopencl's, whose handle a driver would take for a queue and crash
        int_ptr = 4096

    for name, given in [("queue", Context()), ("context", type("CommandQueue", (Context,), {})())]:
        if name == "context":
            given.__class__ = type("Buffer", (), {"int_ptr": 4096})
        with pytest.raises(TypeError, match=f"{name}: found .*, {allowed}"):
            clpv.Renderer(scene, **{name: given}, **SMALL)
    with pytest.raises(ValueError, match="device: found one and a context or queue"):
        clpv.Renderer(scene, "0", queue=1, **SMALL)


def test_frames_and_light_in_pyopencls_queue(scene, renderer):
    cl = pytest.importorskip("pyopencl", reason=MISSING)
    context = cl.create_some_context(interactive=False)
    queue = cl.CommandQueue(context)
    made = clpv.Renderer(scene, context=context, queue=queue.int_ptr, **SMALL)
    frame = made.enqueue("irradiance", FRONT)
    frame.wait()
    assert cl.Event.from_int_ptr(frame.int_ptr, retain=True).command_execution_status == 0
    expected = renderer.render("irradiance", FRONT).array[..., :3]

    def read(number):
        values = np.empty((frame.height, frame.width, 4), np.float32)
        cl.enqueue_copy(queue, values, cl.MemoryObject.from_int_ptr(number, retain=True))
        return values[..., :3]

    assert np.array_equal(read(frame.irradiance), expected)
    light = cl.Buffer(context, cl.mem_flags.WRITE_ONLY, 16 * 48 * 27)
    made.enqueue_light(48, 27, normals=frame.normals, depths=frame.depth, irradiance=light,
                       camera=FRONT).wait()
    assert np.array_equal(read(light.int_ptr), expected)
    arrays = pytest.importorskip("pyopencl.array")
    into = arrays.zeros(queue, (27, 48, 4), np.float32)
    made.enqueue_light(48, 27, normals=frame.normals, depths=frame.depth, irradiance=into,
                       camera=FRONT).wait()
    assert np.array_equal(into.get()[..., :3], expected)
    with pytest.raises(clpv.UsageError, match="irradiance: found an array of float64 .*, allowed:"):
        made.enqueue_light(48, 27, normals=frame.normals, depths=frame.depth,
                           irradiance=into.astype(np.float64), camera=FRONT)
    with pytest.raises(clpv.UsageError,
                       match="light: normals: found 20736 bytes, allowed: at least"):
        made.enqueue_light(480, 27, normals=frame.normals, depths=frame.depth, irradiance=light,
                           camera=FRONT)


def test_the_example_runs():
    pytest.importorskip("pyopencl", reason=MISSING)
    example = runpy.run_path(str(pathlib.Path(ROOT) / "examples/lookup.py"))
    example["main"](CORNELL)
