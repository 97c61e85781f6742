# SPDX-License-Identifier: MIT
"""`pip install .` into a folder. Needs scikit-build-core; links the library of this build to save
its compilation."""
import subprocess
import sys

import pytest

import clpv
from conftest import BUILD, ROOT

pytest.importorskip("scikit_build_core",
                    reason="all of it: scikit-build-core is not installed (pip install scikit-build-core)")
pytest.importorskip("pip",
                    reason="all of it: pip is not installed (Debian: apt install python3-pip)")


def test_pip_install(tmp_path):
    def run(*words):
        ended = subprocess.run([str(word) for word in words], capture_output=True, text=True,
                               check=False, cwd=tmp_path)
        assert ended.returncode == 0, ended.stdout + ended.stderr
        return ended.stdout

    # As in pip's isolated build, NumPy is in PYTHONPATH alone.
    run(sys.executable, "-m", "venv", "--without-pip", tmp_path / "bare")
    run("env", "PYTHONPATH=" + ":".join(filter(None, sys.path)), tmp_path / "bare/bin/python", "-m",
        "pip", "install", "-q", "--no-build-isolation", "--no-index", "--no-deps",
        "--target", tmp_path / "site",
        f"--config-settings=build-dir={tmp_path / 'build'}",
        "--config-settings=cmake.define.CLPV_BUILD_PROGRAM=OFF",
        "--config-settings=build.targets=clpv_python",
        f"--config-settings=cmake.define.CLPV_PREBUILT={BUILD / 'libclpv.a'}", ROOT)
    said = run("env", f"PYTHONPATH={tmp_path / 'site'}", sys.executable, "-c",
               "import clpv, clpv.draw; s = clpv.Scene('%s/scenes/cornell.json')\n"
               "print(clpv.__version__, len(s.cameras), clpv.__file__)" % ROOT)
    assert said.startswith(clpv.__version__) and str(tmp_path) in said
