# SPDX-License-Identifier: MIT
"""All scripts and modules of the lab: --help, and a machine without NumPy."""
import subprocess
import sys

import in_tree
from in_tree import ROOT, test_scripts

SCRIPTS = sorted(file.name for file in (ROOT / "lab/scripts").iterdir() if file.is_file())


class OfTheLab(in_tree.InTree):
    def test_help_names_the_script(self):
        for name in SCRIPTS:
            found = self.made(f"../lab/scripts/{name}", "--help")
            self.assertIn(f"  lab/scripts/{name}", found.stdout)

    def test_a_missing_module_is_named(self):
        (self.folder / "numpy.py").write_text(test_scripts.WITHOUT_NUMPY)
        environment = {"PYTHONPATH": f"{self.folder}:{ROOT}/python:{ROOT}/lab/python"}
        for name in "corpus", "suite":
            self.refused(1, test_scripts.MISSING, f"../lab/scripts/{name}", **environment)
        for name in "search", "score":
            found = subprocess.run([sys.executable, "-B", "-m", f"clpv_lab.{name}"], text=True,
                                   capture_output=True, check=False, env=environment)
            self.assertEqual((found.returncode, found.stderr.count("\n")), (1, 1), found.stderr)
            self.assertIn(test_scripts.MISSING, found.stderr)
