# SPDX-License-Identifier: MIT
"""lab/scripts/suite, with stubs in place of clpv and oiiotool: it leaves files that are none of its
own, and its scorer runs where clpv is not built."""
import subprocess
import sys
import tarfile
import unittest

import in_tree
from in_tree import bystanders, test_scripts

CLPV = """#!/usr/bin/python3
import json, pathlib, sys
given = dict(each[2:].split("=", 1) for each in sys.argv[1:] if "=" in each)
truth = pathlib.Path(sys.argv[0]).with_name("cornell-front-0123.exr")
truth.write_text("truth")
pathlib.Path(given["output"]).write_text(json.dumps({"ground_truths": [
    {"file": str(truth), "camera": "front", "noise": 0.03, "spp": 1}]}))
"""
SCRIPT = "../lab/scripts/suite"


class OfCornell(in_tree.InTree):
    def setUp(self):
        super().setUp()
        (self.tree / "build/clpv").write_text(CLPV)

    def test_bystanders_stay_and_are_not_packed(self):
        made = self.folder / "made"
        call = SCRIPT, "--scene=cornell", "--output=made"
        self.made(*call)
        stays = self.add_bystanders(made)
        self.made(*call)
        self.assertEqual({path: bystanders.seen(made)[path] for path in stays}, stays)
        with tarfile.open(self.folder / "made.tar") as tar:
            names = tar.getnames()
        self.assertEqual(sorted(names), sorted(f"made/{name}" for name in self.listed(made)))
        for name in ("suite.json", "LICENSE", "score.md", "truths/cornell-front-0123.exr",
                     "models/cornell.glb", "cameras/cornell.gltf", "clpv/output.py",
                     "clpv/draw/viewer.html", "clpv_lab/score/__main__.py"):
            self.assertIn(f"made/{name}", names)

    def test_the_scorer_runs(self):
        self.made(SCRIPT, "--scene=cornell", "--output=made")
        found = subprocess.run([sys.executable, "-B", "-m", "clpv_lab.score", "--help"],
                               cwd=self.folder / "made", env={}, capture_output=True, check=False)
        self.assertEqual(found.returncode, 0, found.stderr)

    def test_a_folder_of_others_and_a_tar_beside_a_new_one_stay(self):
        bystanders.fill(self.full)
        self.refused(test_scripts.USAGE, f"one that {SCRIPT[3:]} wrote", SCRIPT, "--scene=cornell",
                     f"--output={self.full}")
        (self.folder / "photos.tar").write_text("precious")
        self.refused(test_scripts.USAGE, "photos.tar; allowed: none", SCRIPT, "--scene=cornell",
                     "--output=photos")


if __name__ == "__main__":
    unittest.main()
