# SPDX-License-Identifier: MIT
"""scripts/reduce on a capsule whose replay is a stub: it is wrong, where WRONG is set, as long as the
program has two of its statements."""
import array
import pathlib
import subprocess
import tempfile
import unittest

from bystanders import ROOT

REPLAY = r"""#!/bin/sh
cd "$1" || exit 1
[ -z "$REPLAY_OUTPUTS" ] || printf '\0\0\200?\0\0\0@' >expected.bin.output
[ "$(tr -cd '{' <0-a.cl | wc -c)" = "$(tr -cd '}' <0-a.cl | wc -c)" ] || { echo "failed: braces"; exit 1; }
if [ -n "$WRONG" ] && grep -q '^launch.* m0 ' capsule.txt && grep -q 'fault *(' 0-a.cl && grep -q 'a *\[' 0-a.cl; then echo "wrong: memory 0"; exit 1; fi
echo ok
"""
PROGRAM = """
static inline int unused(int x) {
  return x + 1;
}
__kernel void k(__global float* a, float b) {
  for (int i = 0; i < 3; ++i) {
    b += 1.0f;
    if (b > 2.0f) { b = fault(b); b *= 3.0f; }
  }
  a[0] = b;
  a[1] = 2.0f;
}
"""
COMMANDS = """# comment
buffer 0 8
buffer 1 8
write 0 -
write 1 -
program 0 0-a.cl -w
launch 0 k 1 64 8 m0 v00000000
launch 0 k 1 64 8 m1 v00000000
expect 0 float expected.bin
"""


class Reduce(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.capsule = self.folder / "capsule"
        self.capsule.mkdir()
        files = {"0-a.cl": PROGRAM, "capsule.txt": COMMANDS, "README.md": "# A capsule\n", "replay.c": "",
                 "Makefile": "replay:\n\tcp stub replay && chmod +x replay\n", "stub": REPLAY}
        for name, text in files.items():
            (self.capsule / name).write_text(text)
        (self.capsule / "expected.bin").write_bytes(array.array("f", [1, 1, 2, 2]).tobytes())

    def reduce(self, wrong="env WRONG=1", right="", output="small"):
        return subprocess.run([ROOT / "scripts/reduce", self.capsule, self.folder / output, "--wrong", wrong, "--right", right],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)

    def test_keeps_what_the_fault_needs(self):
        done = self.reduce()
        self.assertEqual(done.returncode, 0, done.stdout)
        small = self.folder / "small"
        text = (small / "0-a.cl").read_text()
        self.assertIn("fault", text)
        self.assertNotIn("unused", text)
        self.assertLess(len("".join(text.split())), 40, text)
        commands = [line for line in (small / "capsule.txt").read_text().splitlines() if not line.startswith("#")]
        self.assertEqual([c.split()[0] for c in commands], ["buffer", "write", "program", "launch", "expect"])
        self.assertIn("launch 0 k 1 8 8 m0 v00000000", commands)
        self.assertIn("Reduced by scripts/reduce", (small / "README.md").read_text())
        ranges = array.array("f", (small / "expected.bin").read_bytes())
        self.assertAlmostEqual(ranges[2], 2 - 2e-3, places=5)
        self.assertEqual({file.name for file in small.iterdir()},
                         {"0-a.cl", "capsule.txt", "README.md", "replay.c", "Makefile", "expected.bin"})

    def test_leaves_what_exists_and_what_is_right(self):
        self.assertIn("allowed: wrong or failed", self.reduce(wrong="").stdout)
        self.assertFalse((self.folder / "small").exists())
        (self.folder / "small").mkdir()
        done = self.reduce()
        self.assertEqual(done.returncode, 2)
        self.assertIn("which exists; allowed: a new folder", done.stdout)

    def test_names_what_cannot_be_used_before_the_work(self):
        for given, words in (({"output": "none/small"}, "OUTPUT: found .*/none; allowed: a folder that can be written"),
                             ({"wrong": "/none/device"}, "--wrong: found /none/device; allowed: a program that can be run"),
                             ({"right": "/none/device"}, "--right: found /none/device; allowed: a program that can be run"),
                             ({"right": "env 'A"}, "--right: found env 'A: No closing quotation")):
            done = self.reduce(**given)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertRegex(done.stdout, words)
            self.assertNotIn("at first", done.stdout)


if __name__ == "__main__":
    unittest.main()
