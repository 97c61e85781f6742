# SPDX-License-Identifier: MIT
"""The module of the build tree, small frames, and the program. CLPV_BUILD: the build folder."""
import os
import pathlib
import signal
import subprocess
import sys

import pytest

import clpv

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["CLPV_BUILD"])
CORNELL = ROOT / "scenes/cornell.json"
SMALL = {
    "basis": "sh2", "width": 48, "height": 27, "grid": 16, "directions": 24,
    "coarser_directions": 24, "rsm_size": 64
}  # the programs of all tests
STEPS = {
    "basis": "sh2", "width": 48, "height": 27, "rsm_size": 64, "grid": 5, "cascades": 1,
    "transport": "sampled", "gather": "all", "blockers": "seen"
}  # the fewest programs, for processes of their own
FRONT = clpv.Camera(eye=(0.278, 0.273, -0.18), target=(0.278, 0.273, 0.28), fov=75)


def pytest_configure(config):
    # A shell ignores SIGINT for tests that it starts in the background.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    config.addinivalue_line("markers", "long: by `scripts/test --long`")


def program(*arguments):
    words = [str(BUILD / "clpv"), *map(str, arguments)]
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def run_python(code, **more):
    """A process of its own in the root, or elsewhere."""
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False,
                          **{"cwd": ROOT, "timeout": 300, **more})


@pytest.fixture(scope="session")
def scene():
    return clpv.Scene(CORNELL)


@pytest.fixture(scope="session")
def renderer(scene):
    made = clpv.Renderer(scene, **SMALL)
    made.render()
    return made
