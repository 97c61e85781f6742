# SPDX-License-Identifier: MIT
"""The library prints nothing; Python's logging has its messages."""
import os
import pathlib
import subprocess
import sys

from conftest import ROOT, STEPS

RENDER = f"""
import clpv
scene = clpv.Scene("scenes/cornell.json")
clpv.Renderer(scene, **{STEPS!r}).render()
clpv.pathtrace(scene, width=8, height=8, samples=1)
"""


def run(code, folder):
    """Runs code where clpv cannot keep programs, of which it warns; PoCL keeps its cache."""
    (folder / "clpv").write_text("a file in the place of a folder")
    caches = pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache"))
    variables = {"XDG_CACHE_HOME": str(folder), "CLPV_PROGRAM_CACHE": "on",
                 "POCL_CACHE_DIR": str(caches / "clpv/pocl")}  # yapf: disable
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                          cwd=ROOT, env=os.environ | variables)


def test_logging_has_the_messages(tmp_path):
    ended = run("import logging\nlogging.basicConfig(level=logging.DEBUG)" + RENDER, tmp_path)
    assert ended.stdout == "" and "DEBUG:clpv:kernels/" in ended.stderr
    assert "WARNING:clpv:compiled programs are not cached: " in ended.stderr


def test_a_handler_that_raises_ends_the_call(tmp_path):
    ended = run("""
import logging
class Stop(logging.Handler):
    def emit(self, record):
        raise KeyError("stopped")
logging.getLogger("clpv").addHandler(Stop())
logging.getLogger("clpv").setLevel(logging.DEBUG)
try:
""" + "    ".join(RENDER.splitlines(keepends=True)) + """
except KeyError as error:
    print(error)""",
                tmp_path)
    assert ended.stdout == "'stopped'\n", ended.stderr
