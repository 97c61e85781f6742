# SPDX-License-Identifier: MIT
"""Files and folders that scripts and modules write, arguments of scripts, and gates of the tree."""
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
from clpv import output  # noqa: E402

STRUCT = re.compile(r"typedef struct[^{;]*\{([^}]*)\}\s*(\w+);")
MEMBER = re.compile(r"(\w+)\s*(?:\[\w+\])*\s*[,;]")


def run(script, *arguments, **environment):
    return subprocess.run([ROOT / "scripts" / script, *arguments], capture_output=True, text=True,
                          check=False, env={**os.environ, **environment})


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name).resolve()
        self.file = self.folder / "file"
        self.file.write_text("old")
        self.file.chmod(0o640)


class Outputs(InFolder):
    def test_links_and_modes_stay(self):
        (self.folder / "link").symlink_to("file")
        output.write(self.folder / "link", "text")
        self.assertEqual(os.readlink(self.folder / "link"), "file")
        self.assertEqual(self.file.read_text(), "text")
        self.assertEqual(self.file.stat().st_mode & 0o777, 0o640)

    def test_what_cannot_be_written_is_named_and_changes_nothing(self):
        os.link(self.file, self.folder / "hard")
        made = output.Folder(self.folder / "new/folder", "scripts/a")
        made.write("b/c", "1")
        before = sorted(self.folder.rglob("*"))
        for words, call in (
                ("a regular file", lambda: output.target_of(self.folder)),
                ("a folder that exists", lambda: output.write(self.folder / "none/file", "")),
                ("a folder that exists", lambda: output.write(self.file / "x", "")),
                ("allowed: another", lambda: output.target_of(self.folder / "hard", self.file)),
                ("scripts/b wrote", lambda: output.Folder(made.path, "scripts/b")),
                ("scripts/b wrote", lambda: output.Folder(self.folder, "scripts/b"))):
            with self.assertRaisesRegex(output.Failure, words):
                call()
        with mock.patch.object(output.os, "rename", side_effect=OSError(28, "No space left")):
            self.assertRaisesRegex(output.Failure, "No space left", output.write, self.file, "new")
        self.assertEqual(sorted(self.folder.rglob("*")), before)
        self.assertEqual(self.file.read_text(), "old")
        self.assertEqual(output.Folder(made.path, "scripts/a").written, [])

    def test_folders_of_bash_scripts_are_checked_as_well(self):
        found = run("demo", CLPV_OUT=str(self.folder))
        self.assertEqual(found.returncode, output.USAGE, found.stderr)
        self.assertIn("one that scripts/demo wrote", found.stderr)
        self.assertEqual(os.listdir(self.folder), ["file"])


class Tree(InFolder):
    """The tree's own gates."""

    def test_the_key_of_ground_truths_has_the_tracers_sources(self):
        subprocess.run(["cmake", f"-DROOT={ROOT}", f"-DOUTPUT={self.file}", "-P",
                        ROOT / "cmake/ground_truth_sources.cmake"], check=True)
        for name, has in (("host/pathtracer/path_sampler.cpp", True), ("kernels/shared/light.h", True),
                          ("host/reference/lighting.cpp", True), ("host/scene/load.cpp", False),
                          ("host/pipeline/gather/gather.cpp", False)):
            digest = hashlib.sha256((ROOT / name).read_bytes()).hexdigest()
            self.assertEqual(f"// {name} {digest}\n" in self.file.read_text(), has, name)

    def test_each_member_of_a_shared_struct_is_compared(self):
        found, listed = set(), set()
        for header in (ROOT / "kernels/shared").glob("*.h"):
            text = re.sub(r"//[^\n]*", "", header.read_text(encoding="utf-8"))
            listed |= set(re.findall(r"FIELD\((\w+), (\w+)\)", text))
            found |= {(name, member) for body, name in STRUCT.findall(text)
                      for member in MEMBER.findall(body) if member != "unused"}
        self.assertGreater(len(found), 90)
        self.assertEqual(found, listed)
