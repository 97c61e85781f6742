# SPDX-License-Identifier: MIT
"""Each script with outputs, in folders full of files that are none of its own: it leaves them as
they are, whether it refuses the folder or wrote there before. Stubs stand for clpv and for tools
that take minutes."""
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

import bystanders
import numpy
import PIL.Image
from bystanders import ROOT
from clpv import output

sys.path.append(str(ROOT / "scripts"))

BAD_INPUT, USAGE = 3, 2
CLPV = """#!/usr/bin/python3
import os, pathlib, sys
arguments = sys.argv[1:]
dump = os.environ.get("CLPV_PROGRAM_DUMP")
if dump:
    pathlib.Path(dump, "a.cl").write_text("kernel")
for option in "-o", "--stats":
    if option in arguments:
        pathlib.Path(arguments[arguments.index(option) + 1]).write_text(" ".join(arguments))
"""
DEMO_CLPV = """#!/bin/bash
echo "$*" >>"$STUB_LOG"
while [[ $# -gt 0 ]]; do
  case $1 in
    compare) echo '{{"nrmse_valid": 0.123}}' ;;
    -o) cp {} "$2" ;;
    --stats) echo '{{"times": [{{"stage": "frame", "median": 40.4}}], "first_launch_ms": 1, "build_ms": 1, "startup_ms": 1,
               "options": {{"basis": "sh2"}},
               "device": {{"name": "a", "platform": "b", "driver": "c"}}}}' >"$2" ;;
  esac
  shift
done
"""
WITHOUT_NUMPY = "raise ModuleNotFoundError(\"No module named 'numpy'\", name='numpy')\n"
MISSING = "No module named 'numpy' (Debian: python3-numpy)"
OIIOTOOL = '#!/bin/bash\ncp "$1" "${@: -1}"\n'


class InTree(unittest.TestCase):
    """A tree with the scripts, a stub of clpv, and a folder full of bystanders."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name).resolve()
        self.tree, self.full = self.folder / "tree", self.folder / "full"
        shutil.copytree(ROOT / "scripts", self.tree / "scripts",
                        ignore=shutil.ignore_patterns("__pycache__"))
        for name in ("python", "scenes", "docs", "lab", "results", "LICENSE", "CMakeLists.txt",
                     "README.md", "REPRODUCING.md", "CITATION.cff", "CHANGELOG.md"):
            (self.tree / name).symlink_to(ROOT / name)
        for name, text in (("tree/build/clpv", CLPV), ("bin/oiiotool", OIIOTOOL),
                           ("tree/scripts/build", "#!/bin/sh\n"),
                           ("tree/scripts/setup", "#!/bin/sh\n")):
            file = self.folder / name
            file.parent.mkdir(exist_ok=True)
            file.write_text(text)
            file.chmod(0o755)

    def run_script(self, name, *arguments, cwd=None, **environment):
        words = [str(self.tree / "scripts" / name), *map(str, arguments)]
        path = f"{self.folder}/bin:/usr/bin:/bin:/usr/sbin:/sbin"
        env = {
            "PATH": path, "PYTHONDONTWRITEBYTECODE": "1",
            "MPLCONFIGDIR": os.environ.get("MPLCONFIGDIR", str(self.folder / "fonts")), **environment
        }
        return subprocess.run(words, capture_output=True, text=True, check=False, env=env,
                              cwd=cwd or self.folder)

    def made(self, *arguments, **named):
        found = self.run_script(*arguments, **named)
        self.assertEqual(found.returncode, 0, found.stderr)
        return found

    def refused(self, code, words, *arguments, **named):
        before = bystanders.seen(self.folder)
        found = self.run_script(*arguments, **named)
        self.assertEqual(found.returncode, code, found.stderr)
        self.assertIn(words, found.stderr)
        self.assertEqual(bystanders.seen(self.folder), before)

    def add_bystanders(self, folder):
        """Puts bystanders among what a script wrote. Returns what must stay."""
        made = bystanders.fill(self.folder / "others")
        for path in made.iterdir():
            if not os.path.lexists(folder / path.name):
                path.rename(folder / path.name)
        ours = {str(folder / name) for name in self.listed(folder)}
        return {
            path: found for path, found in bystanders.seen(folder).items()
            if path not in ours and found[3] is not None and not path.endswith(output.MARKER)
        }

    def listed(self, folder):
        return (folder / output.MARKER).read_text().splitlines()[1:]


class FullFolders(InTree):
    """A folder that the script did not write stays as it is."""

    def test_as_outputs(self):
        bystanders.fill(self.full)
        for script, *arguments in (
            ("reproduce", "--no-build", "--part=lobes", f"--out={self.full}"),
            ("frame", "--out", self.full)):
            with self.subTest(script):
                self.refused(USAGE, f"one that scripts/{script} wrote", script, *arguments)
        self.refused(USAGE, "one that scripts/demo wrote", "demo", CLPV_OUT=str(self.full))
        self.refused(BAD_INPUT, "one that scripts/reproduce wrote".replace("one", "a folder"),
                     "archive", "--from", self.full)

    def test_as_folders_of_tests(self):
        bystanders.fill(self.full / "runs")
        (self.folder / "bin/chromium").symlink_to("/bin/true")
        (self.tree / "tests").symlink_to(ROOT / "tests")
        for script, *arguments in (("docs/run_tutorial", "clpv", self.full),
                                   ("report/screenshot", "clpv", "cornell.json", self.full),
                                   ("oclgrind/run", self.full, "runs", "true")):
            with self.subTest(script):
                self.refused(USAGE, f"one that tests/{script} wrote", f"../tests/{script}",
                             *arguments)

    def test_what_a_test_wrote_is_removed_the_next_time(self):
        (self.folder / "bin/oclgrind").write_text("#!/bin/sh\necho Instructions executed for kernel\n")
        (self.folder / "bin/oclgrind").chmod(0o755)
        (self.tree / "tests").symlink_to(ROOT / "tests")
        for left in "programs/a.cl", "old":
            self.made("../tests/oclgrind/run", self.full, "runs", "true")
            (self.full / "runs" / left).write_text("old")
        self.made("../tests/oclgrind/run", f"{self.full}/", "runs", "true")
        self.assertEqual(sorted(path.name for path in (self.full / "runs").rglob("*")),
                         [".clpv-output", "output.txt", "programs", "reports.log"])

    def test_in_the_place_of_a_scripts_own(self):
        bystanders.fill(self.tree / "build-intel")
        self.refused(USAGE, "one that scripts/check_intel wrote", "check_intel")
        (self.tree / "results").unlink()
        bystanders.fill(self.tree / "results/mine")
        self.refused(USAGE, "one that scripts/measure wrote", "measure", "mine")
        if os.geteuid() == 0:
            bystanders.fill(self.tree / "build-suites/sid-pocl")
            self.refused(USAGE, "one that scripts/check_pocl wrote", "check_pocl", "sid")
            if shutil.which("debootstrap"):
                bystanders.fill(self.full)
                self.refused(USAGE, "one that scripts/bare wrote", "bare", self.full)

    def test_outside_of_a_scripts_folder(self):
        bystanders.fill(self.full)
        for name in "../../full", "..", "-x":
            self.refused(USAGE, "allowed: a name such as trixie", "check_pocl", name)
            if name != "-x":
                self.refused(USAGE, "allowed: letters", "measure", name)


class OwnFolders(InTree):
    """Bystanders in a folder that the script wrote stay as they are, and out of tars."""

    def test_archive(self):
        made = output.Folder(self.folder / "made", "scripts/reproduce")
        made.write("index.html", "page")
        made.write("parts/lobes.json", "{}")
        (made.path / "hostname").symlink_to("/etc/hostname")
        stays = self.add_bystanders(made.path)
        tar = made.path / "paper.tar"
        for _ in range(2):  # the second time the tar of the first lies in the folder
            self.made("archive", "--from=made", f"--output={tar}")
            with tarfile.open(tar) as archive:
                names = [name.split("/", 2)[1:] for name in archive.getnames()]
            self.assertEqual([rest[0] for folder, *rest in names if folder == "paper"],
                             ["index.html", "parts/lobes.json"])
        self.assertEqual({path: bystanders.seen(made.path)[path] for path in stays}, stays)
        self.refused(USAGE, "allowed: another file", "archive", "--from=made",
                     "--output=made/index.html")
        (made.path / "parts/lobes.json").unlink()
        self.refused(BAD_INPUT, "parts/lobes.json: No such file", "archive", "--from=made",
                     f"--output={tar}")

    def test_demo(self):
        planes = self.folder / "planes.tif"  # of a layer, as oiiotool writes them
        PIL.Image.fromarray(numpy.ones((9, 4), numpy.float32)).save(planes)
        (self.tree / "build/clpv").write_text(DEMO_CLPV.format(planes))
        (self.folder / "caller").mkdir()
        for _ in range(2):
            found = self.made("demo", "--centres", "mine.json", "--eye", "-1,2,3", "--width=40",
                              cwd=self.folder / "caller", CLPV_OUT="made", STUB_LOG="log")
            made = self.folder / "caller/made"
            log = (self.folder / "caller/log").read_text()
            self.assertEqual(log.count("--centres mine.json"), 3, "each render has the options")
            self.assertEqual(log.count("--eye -1,2,3"), 4, "and the path tracer the camera")
            self.assertEqual(log.count("--width=40 "), 2)
            self.assertEqual(log.count("--width=20 "), 2)
            self.assertIn("40 ms per frame of 40x216; error of indirect light 12 %", found.stdout)
            self.assertEqual((made / "demo.png").read_bytes()[:4], b"\x89PNG")
            (self.folder / "caller/log").unlink()
            if not (made / "README.md").exists():
                stays = self.add_bystanders(made)
        found = bystanders.seen(made)
        self.assertEqual({path: found[path] for path in stays}, stays)
        self.assertFalse((self.tree / "made").exists())
        self.refused(USAGE, "found --bounces=2", "demo", "--bounces=2", CLPV_OUT=str(made))

    def test_tables(self):
        for name in "docs", "lab", "README.md":
            (self.tree / name).unlink()
        shutil.copy(ROOT / "README.md", self.tree)
        bystanders.fill(self.tree / "docs")
        shutil.copy(ROOT / "docs/frame.md", self.tree / "docs/a.md")
        page = "<!-- table: {} -->\n<!-- end -->\n"
        stale = self.tree / "docs/stale.md"
        stale.write_text(page.format("table1-shadows"))
        stale.chmod(0o640)
        (self.folder / "outside.md").write_text(page.format("table1-shadows"))
        (self.tree / "docs/link.md").symlink_to(self.folder / "outside.md")
        before = bystanders.seen(self.folder)
        self.made("tables")
        after = bystanders.seen(self.folder)
        self.assertEqual([path for path in before if after[path] != before[path]], [str(stale)])
        self.assertEqual(sorted(after), sorted(before))
        self.assertEqual(after[str(stale)][:3], before[str(stale)][:3])

    def test_charts_spare_their_inputs(self):
        for chart, given, file in (("errors", "q.json", "q.json"), ("probes", "p.json", "p.json"),
                                   ("times", "s", "s/times.jsonl"),
                                   ("stability", "a=s", "s/stability.json")):
            (self.folder / file).parent.mkdir(exist_ok=True)
            (self.folder / file).write_text("{}")
            self.refused(USAGE, "allowed: another file", "charts", chart, given, "-o", file)


class Gates(InTree):
    """A gate without anything to judge fails."""

    def test_lines(self):
        self.refused(1, "host: found nothing to count", "lines", "--check")
        (self.tree / "host").mkdir()
        lab = "clpv" + "_lab"  # apart, as this file is of the core
        (self.tree / "host/a.py").write_text(f"import {lab}.score\n")
        self.refused(1, f"host/a.py: {lab}, which belongs to the lab", "lines", "--check")

    def test_links_of_the_docs(self):
        (self.tree / "tests").symlink_to(ROOT / "tests")
        self.full.mkdir()
        self.refused(1, "found no page", "../tests/docs/check_links", self.full)

class Home(InTree):
    def test_stays_empty(self):
        home = self.folder / "home"
        home.mkdir()
        self.made("charts", "--help", HOME=str(home), MPLCONFIGDIR="")
        self.assertEqual(list(home.iterdir()), [])
        self.assertTrue((self.tree / "build/matplotlib").is_dir())


class Arguments(InTree):
    def test_help_is_the_comment_and_changes_nothing(self):
        for name in sorted(file.name for file in (ROOT / "scripts").iterdir()):
            if not os.access(ROOT / "scripts" / name, os.X_OK) or name in ("measured", "stubs"):
                continue  # scripts/stubs needs the native module
            found = subprocess.run([ROOT / "scripts" / name, "--help"], capture_output=True,
                                   text=True, check=False, cwd=self.folder)
            self.assertEqual(found.returncode, 0, name)
            self.assertIn(f"  scripts/{name}", found.stdout)

    def test_checks_of_the_docs_without_arguments_say_how(self):
        (self.tree / "tests").symlink_to(ROOT / "tests")
        for name in "run_tutorial", "check_links", "check_kernels":
            self.refused(1, f"tests/docs/{name} ", f"../tests/docs/{name}")

    def test_a_missing_module_is_named(self):
        (self.folder / "numpy.py").write_text(WITHOUT_NUMPY)
        environment = {"PYTHONPATH": f"{self.folder}:{ROOT}/python:{ROOT}/scripts"}
        for name in "charts", "frame", "leaks":
            self.refused(1, MISSING, name, **environment)
        for name in "clpv.view", "measured.demo":
            found = subprocess.run([sys.executable, "-B", "-m", name], capture_output=True,
                                   text=True, check=False, env=environment)
            self.assertEqual((found.returncode, found.stderr.count("\n")), (1, 1), found.stderr)
            self.assertIn(MISSING, found.stderr)

    def test_unknown_arguments(self):
        for name, *arguments in (("build", "--fast"), ("test", "gather"), ("test", "--lng"),
                               ("test", "-R", "a", "--long"), ("fuzz", "none"),
                               ("sanitize", "--fast"), ("check_intel", "x"), ("setup", "x"),
                               ("format", "x"), ("tables", "x"), ("archive", "x"), ("bare", "-x")):
            found = subprocess.run([ROOT / "scripts" / name, *arguments], capture_output=True,
                                   text=True, check=False)
            self.assertEqual(found.returncode, USAGE, (name, found.stderr))


class Modes(unittest.TestCase):
    def test_files_with_an_interpreter_are_executable_and_no_others(self):
        for folder in "examples", "lab", "scripts", "tests":
            for file in sorted((ROOT / folder).rglob("*")):
                if file.is_file() and "__pycache__" not in file.parts:
                    self.assertEqual(os.access(file, os.X_OK), file.read_bytes()[:2] == b"#!", file)


class Leaks(unittest.TestCase):
    def test_finds_an_output_that_cannot_be_written_before_the_work(self):
        done = subprocess.run([ROOT / "scripts/leaks", "-o", "/none/leaks.json"], timeout=10,
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, output.RUN_TIME, done.stderr)
        self.assertIn("/none: No such file", done.stderr)


if __name__ == "__main__":
    unittest.main()
