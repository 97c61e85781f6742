# SPDX-License-Identifier: MIT
"""The module where Python ends, forks, interrupts, pickles, or makes objects without their
__init__: refused by name, never an abort or a hang."""
import copy
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import clpv
from conftest import CORNELL, FRONT, ROOT, STEPS, run_python

START = f"""
import os, sys, threading, time, clpv
scene = clpv.Scene({str(CORNELL)!r})
renderer = clpv.Renderer(scene, **{STEPS!r})
renderer.render()
"""


# Each once aborted with 'terminate called'.
@pytest.mark.parametrize("work", [
    "renderer.render()", "clpv.pathtrace(scene, samples=1 << 20)", "renderer.render().save(path)",
    "scene.lights = scene.lights", "scene.cameras", "renderer.stats",
    "basis = clpv.Basis('sh4'); basis.project(basis.directions()[:, 0])"
])
def test_exit_while_a_daemon_thread_works(tmp_path, work):
    ended = run_python(START + f"path = {str(tmp_path / 'a.exr')!r}\n"
                       f"def work():\n  while True: {work}\n"
                       "for _ in range(2): threading.Thread(target=work, daemon=True).start()\n"
                       "time.sleep(0.2)\nprint('leaving', flush=True)")
    assert ended.returncode == 0 and ended.stdout == "leaving\n", ended.stderr
    assert "terminate" not in ended.stderr and "Traceback" not in ended.stderr, ended.stderr


def test_first_arrays_of_two_threads():  # each once waited for the other without end
    code = ("import sys, threading\nsys.setswitchinterval(1e-6)\nimport clpv\n"
            "work = lambda: clpv.Basis('sh2').directions()\n"
            "threads = [threading.Thread(target=work) for _ in range(8)]\n"
            "[t.start() for t in threads]; [t.join() for t in threads]")
    assert run_python(code, timeout=60).returncode == 0


def test_calls_during_exit_are_refused():
    ended = run_python(
        "import atexit\n"
        "def late():\n  try: clpv.Scene('a.json')\n  except clpv.Error as e: print(e)\n"
        "atexit.register(late)\n" + START)
    assert ended.stdout == "clpv: Python is exiting\n" and ended.returncode == 0, ended.stderr


FORK = """
child = os.fork()
if child == 0:
  {}
_, status = os.waitpid(child, 0)
print("child", os.waitstatus_to_exitcode(status), flush=True)
"""
IN_A_CHILD = ("renderer.render()", "clpv.Renderer(scene)", "renderer.stats", "scene.lights = []",
              "clpv.pathtrace(scene, samples=1)", "clpv.devices()", "renderer.volumes()")


def test_a_forked_child_is_refused_by_name():  # a render there once hung
    ended = run_python(START + "".join(
        FORK.format(f"try: {work}\n  except clpv.Error as e: print(e, flush=True)\n  os._exit(0)")
        for work in IN_A_CHILD) + "renderer.render()\n")
    lines = ended.stdout.splitlines()
    assert ended.returncode == 0 and len(lines) == 2 * len(IN_A_CHILD), ended.stderr
    for work, words, code in zip(IN_A_CHILD, lines[::2], lines[1::2]):
        assert "forked" in words and "'spawn'" in words and code == "child 0", work


def test_a_fork_before_any_render_works():
    code = FORK.format(
        f"print(clpv.Renderer(scene, **{STEPS!r}).render().width, flush=True)\n  os._exit(0)"
    )  # as multiprocessing ends
    ended = run_python(START.split("renderer =")[0] + code)
    assert ended.stdout == "48\nchild 0\n", ended.stderr


def test_values_are_copied_pickled_and_hashed():
    texture = np.arange(8, dtype=np.uint8).reshape(1, 2, 4)
    values = [FRONT, FRONT.replace(name="other"), clpv.Light("spot", name="s"),
              clpv.Medium(0.5, box=((0, 0, 0), (1, 1, 1))), clpv.Material(base_colour=0.5),
              clpv.Material(texture=texture, alpha_cutoff=0.5)]
    for each in values:
        copies = [copy.copy(each), copy.deepcopy(each), each.replace()]
        copies += [pickle.loads(pickle.dumps(each, p)) for p in range(pickle.HIGHEST_PROTOCOL + 1)]
        assert all(made == each and hash(made) == hash(each) for made in copies)
    assert len(set(values + [copy.copy(each) for each in values])) == len(values)


def test_an_exception_ends_its_own_call_only():  # all calls of the process once ended with it
    def stop(_):
        raise RuntimeError("enough")

    traced = []
    options = {"width": 48, "height": 27, "threads": 1}
    other = threading.Thread(target=lambda: traced.append(
        clpv.pathtrace(clpv.Scene(CORNELL), samples=256, **options)))
    other.start()
    stopped = 0
    while other.is_alive():
        with pytest.raises(RuntimeError, match="enough"):
            clpv.pathtrace(clpv.Scene(CORNELL), samples=1 << 14, progress=stop, **options)
        stopped += 1
    assert stopped > 0 and len(traced) == 1


def test_a_storm_of_interrupts(tmp_path):
    code = START + f"""
import signal
expected = renderer.render().array.tobytes()
hits, end = 0, time.monotonic() + 1.5
print('started', flush=True)
while time.monotonic() < end:
  try:
    renderer.render()
    clpv.pathtrace(scene, width=16, height=9, samples=16)
  except KeyboardInterrupt:
    hits += 1
signal.signal(signal.SIGINT, signal.SIG_IGN)
assert hits > 10, hits
assert renderer.render().array.tobytes() == expected
renderer.render().save({str(tmp_path / 'a.exr')!r})
print('done')
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, cwd=ROOT) as child:
        assert child.stdout.readline() == "started\n"
        while child.poll() is None:
            child.send_signal(signal.SIGINT)
            time.sleep(0.01)
        out, errors = child.communicate(timeout=300)
    # A signal may also come between two lines of the loop, which then ends as Python does.
    assert (child.returncode == 0 and out == "done\n") or "KeyboardInterrupt" in errors, errors
    assert child.returncode not in (-signal.SIGABRT, -signal.SIGSEGV), errors
    assert os.listdir(tmp_path) in ([], ["a.exr"])
