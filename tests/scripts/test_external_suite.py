# SPDX-License-Identifier: MIT
"""examples/pocl-testsuite with a stub of clpv: its tests are skipped without a device, and fail with clpv's other exit codes."""
import pathlib
import subprocess
import tempfile
import unittest

from bystanders import ROOT


class Tests(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.build = pathlib.Path(folder.name) / "build"
        subprocess.run(["cmake", "-S", ROOT / "examples/pocl-testsuite", "-B", self.build], check=True, stdout=subprocess.DEVNULL)
        (self.build / "clpv/build").mkdir(parents=True, exist_ok=True)

    def results(self, code):
        """Of each test, 'Passed', '***Skipped' or '***Failed', where clpv ends with `code`."""
        stub = self.build / "clpv/build/clpv"
        stub.write_text(f"#!/bin/sh\ntouch 1.exr 2.exr\nexit {code}\n")
        stub.chmod(0o755)
        done = subprocess.run(["ctest", "--test-dir", self.build, "-L", "clpv"], check=False, stdout=subprocess.PIPE, text=True)
        return {word for line in done.stdout.splitlines() if " Test #" in line for word in ("Passed", "***Skipped", "***Failed")
                if word in line}

    def test_exit_codes_of_clpv(self):
        for code, result in (0, "Passed"), (4, "***Skipped"), (5, "***Failed"):
            with self.subTest(code=code):
                self.assertEqual(self.results(code), {result})
