# SPDX-License-Identifier: MIT
"""A tree with the scripts of core and lab, as the core's tests of scripts have it."""
import pathlib
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.append(str(ROOT / "tests/scripts"))
import bystanders  # noqa: E402, F401
import test_scripts  # noqa: E402


class InTree(test_scripts.InTree):
    def setUp(self):
        super().setUp()
        lab = self.tree / "lab"
        lab.unlink()
        shutil.copytree(ROOT / "lab/scripts", lab / "scripts")
        for name in "docs", "python":
            (lab / name).symlink_to(ROOT / "lab" / name)
