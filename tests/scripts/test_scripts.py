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

    def rejected(self, words, code, function, *arguments):
        before = sorted(self.folder.rglob("*"))
        with self.assertRaisesRegex(output.BadOutput, words) as caught:
            function(*arguments)
        self.assertEqual(caught.exception.code, code)
        self.assertEqual(sorted(self.folder.rglob("*")), before)
        self.assertEqual(self.file.read_text(), "old")


class Files(InFolder):
    def test_links_and_modes_stay(self):
        self.addCleanup(os.umask, os.umask(0o027))
        for name, target in ("link", "file"), ("new", "missing"):
            (self.folder / name).symlink_to(target)
            output.write(self.folder / name, "text")
            self.assertEqual(os.readlink(self.folder / name), target)
            self.assertEqual((self.folder / target).read_text(), "text")
            self.assertEqual((self.folder / target).stat().st_mode & 0o777, 0o640)

    def test_what_cannot_be_written_is_named_before_the_work(self):
        os.mkfifo(self.folder / "fifo")
        for name, words in (("fifo", "not a regular"), (".", "not a regular"),
                            ("none/file", "none: No such file"), ("file/x", "Not a directory")):
            self.rejected(words, output.RUN_TIME, output.Output, self.folder / name)

    def test_a_failure_leaves_the_old_file(self):
        with mock.patch.object(output.os, "fsync", side_effect=OSError(28, "No space left")):
            self.rejected("No space left", output.RUN_TIME, output.write, self.file, "new")

    def test_inputs_stay(self):
        os.link(self.file, self.folder / "hard")
        (self.folder / "soft").symlink_to("file")
        inputs = self.folder / "none", self.file, output.Output(self.folder / "new")
        for name in "file", "hard", "soft", "x/../new":
            self.rejected("allowed: another file", output.USAGE, output.Output, self.folder / name,
                          inputs)


class Folders(InFolder):
    def test_are_new_empty_or_marked(self):
        made = output.Folder(self.folder / "new/folder", "scripts/a")
        made.write("b/c", "1")
        self.assertEqual((made.path / "b/c").read_text(), "1")
        self.assertEqual(output.Folder(made.path, "scripts/a").written, [])
        for other in made.path, self.folder:
            self.rejected("one that scripts/b wrote", output.USAGE, output.Folder, other,
                          "scripts/b")

    def test_of_bash_scripts_are_checked_as_well(self):
        found = run("demo", CLPV_OUT=str(self.folder))
        self.assertEqual(found.returncode, output.USAGE, found.stderr)
        self.assertIn("one that scripts/demo wrote", found.stderr)
        self.assertEqual(os.listdir(self.folder), ["file"])


class Tree(InFolder):
    """The tree's own gates."""

    def test_a_home_stays_empty(self):
        home = self.folder / "home"
        home.mkdir()
        self.assertEqual(run("charts", "--help", HOME=str(home), MPLCONFIGDIR="").returncode, 0)
        self.assertEqual(list(home.iterdir()), [])

    def test_help_is_the_comment_and_unknown_arguments_are_rejected(self):
        for name in sorted(file.name for file in (ROOT / "scripts").iterdir() if file.is_file()):
            if not os.access(ROOT / "scripts" / name, os.X_OK) or name == "stubs":  # needs the module
                continue
            self.assertIn(f"  scripts/{name}", run(name, "--help").stdout)
        for name, *arguments in (("build", "--fast"), ("test", "gather"), ("test", "--lng"),
                                 ("fuzz", "none"), ("sanitize", "--fast"), ("check_intel", "x"),
                                 ("gpu", "x"), ("setup", "x"), ("format", "x"), ("tables", "x"),
                                 ("bare", "-x")):
            self.assertEqual(run(name, *arguments).returncode, output.USAGE, name)

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

    def test_files_with_an_interpreter_are_executable_and_no_others(self):
        for folder in "examples", "lab", "scripts", "tests":
            for file in sorted((ROOT / folder).rglob("*")):
                if file.is_file() and "__pycache__" not in file.parts:
                    self.assertEqual(os.access(file, os.X_OK), file.read_bytes()[:2] == b"#!", file)


if __name__ == "__main__":
    unittest.main()
