# SPDX-License-Identifier: MIT
"""The library prints nothing; Python's logging has its messages."""
import os
import subprocess
import sys

from conftest import ROOT, SMALL

RENDER = ("import clpv\nclpv.Renderer(clpv.Scene('scenes/cornell.json'), "
          f"**{SMALL | {'width': 8, 'height': 8}!r}).render()\n"
          "clpv.pathtrace(clpv.Scene('scenes/cornell.json'), width=8, height=8, samples=1)\n")


def run(code, **variables):
    """Runs code where no cache can be written, of which the library warns."""
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                          cwd=ROOT, env=os.environ | variables)


def test_nothing_is_printed(tmp_path):
    (tmp_path / "clpv").write_text("a file in the place of a folder")
    variables = {"XDG_CACHE_HOME": str(tmp_path), "CLPV_PROGRAM_CACHE": "on"}
    ended = run(RENDER, **variables)
    assert (ended.stdout, ended.stderr) == ("", "")
    logged = run("import logging\nlogging.basicConfig(level=logging.DEBUG)\n" + RENDER, **variables)
    assert logged.stdout == "" and "WARNING:clpv:compiled programs are not cached: " in logged.stderr
    assert "DEBUG:clpv:kernels/" in logged.stderr


def test_a_handler_that_fails_ends_the_call():
    ended = run("import logging, clpv\nclass Stop(logging.Handler):\n"
                "  def emit(self, record): raise KeyError(record.getMessage()[:8])\n"
                "log = logging.getLogger('clpv')\nlog.addHandler(Stop()); log.setLevel(10)\n"
                "try:\n  " + RENDER.splitlines()[1] + "\nexcept KeyError as e: print(e)")
    assert "kernels/" in ended.stdout, ended.stderr
