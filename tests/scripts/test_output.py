# SPDX-License-Identifier: MIT
"""What clpv.output promises of files, folders and tars."""
import errno
import io
import os
import pathlib
import resource
import shutil
import signal
import stat
import subprocess
import sys
import tarfile
import tempfile
import unittest
from unittest import mock

import bystanders
from clpv import output
from clpv.output import BadOutput, Folder, Output

NOBODY = 65534
IS_ROOT = unittest.skipUnless(os.geteuid() == 0, "needs root")


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.file = self.folder / "file"
        self.file.write_text("old")

    def rejected(self, function, *arguments, code=output.RUN_TIME, **named):
        before = bystanders.seen(self.folder)
        with self.assertRaises(BadOutput) as caught:
            function(*arguments, **named)
        self.assertEqual(caught.exception.code, code, caught.exception)
        self.assertEqual(bystanders.seen(self.folder), before)
        return str(caught.exception)


class Files(InFolder):
    def test_a_link_stays_a_link_and_its_target_is_replaced(self):
        for name, target in ("link", "file"), ("relative", "other/new"):
            (self.folder / "other").mkdir(exist_ok=True)
            (self.folder / name).symlink_to(target)
            output.write(self.folder / name, "new")
            self.assertEqual(os.readlink(self.folder / name), target)
            self.assertEqual((self.folder / target).read_text(), "new")

    def test_a_link_is_resolved_once(self):
        link, other = self.folder / "link", self.folder / "other"
        other.write_text("other")
        link.symlink_to(self.file)
        made = Output(link)
        link.unlink()
        link.symlink_to(other)
        made.write("new")
        self.assertEqual((self.file.read_text(), other.read_text()), ("new", "other"))

    def test_planted_links_are_not_followed(self):
        (self.folder / f".file.{os.getpid()}").symlink_to(self.folder / "victim")
        (self.folder / ".file.aa.part").symlink_to(self.folder / "victim")
        with mock.patch.object(output.secrets, "token_hex", side_effect=["bb", "aa", "cc"]):
            output.write(self.file, "new")
        self.assertFalse((self.folder / "victim").exists())
        self.assertEqual(self.file.read_text(), "new")
        self.assertTrue((self.folder / ".file.aa.part").is_symlink())

    def test_mode_stays_and_new_files_have_that_of_umask(self):
        self.file.chmod(0o640)
        mask = os.umask(0o027)
        self.addCleanup(os.umask, mask)
        for name in "file", "new":
            output.write(self.folder / name, b"new")
            self.assertEqual(stat.S_IMODE((self.folder / name).stat().st_mode), 0o640)

    @IS_ROOT
    def test_owner_and_group_stay(self):
        os.chown(self.file, NOBODY, 12345)
        output.write(self.file, "new")
        found = self.file.stat()
        self.assertEqual((found.st_uid, found.st_gid, self.file.read_text()),
                         (NOBODY, 12345, "new"))
        with mock.patch.object(output.os, "fchown", side_effect=PermissionError(1, "no")):
            self.assertIn(f"{NOBODY}:12345, cannot be kept", self.rejected(Output, self.file))

    @IS_ROOT
    def test_what_another_user_cannot_replace_is_found_before_the_work(self):
        self.folder.chmod(0o755)
        module = self.folder / "output.py"
        shutil.copy(bystanders.ROOT / "python/clpv/output.py", module)
        module.chmod(0o644)
        as_nobody = {"user": NOBODY, "group": NOBODY, "extra_groups": []}
        try:
            subprocess.run(["test", "-x", self.folder], check=True, **as_nobody)
        except (OSError, subprocess.CalledProcessError):
            self.skipTest(f"{self.folder} cannot be entered by other users")
        sticky, closed = self.folder / "sticky", self.folder / "closed"
        for place, mode in (sticky, 0o1777), (closed, 0o755):
            place.mkdir()
            (place / "theirs").write_text("old")
            (place / "theirs").chmod(0o666)
            place.chmod(mode)
        for path, words in ((sticky / "theirs", "its folder is sticky"),
                            (closed / "theirs", "Permission denied"),
                            (closed / "new", "Permission denied")):
            code = f"import output; output.Output({str(path)!r})"
            found = subprocess.run([sys.executable, "-B", "-c", code], cwd=self.folder,
                                   capture_output=True, text=True, check=False, **as_nobody)
            self.assertIn(words, found.stderr)
            self.assertEqual(sorted(each.name for each in path.parent.iterdir()), ["theirs"])

    def test_append_only_is_found_before_the_work(self):
        for name, words in ((self.folder, "folder is append-only"),
                            (self.file, "Operation not permitted")):
            if shutil.which("chattr") is None or subprocess.run(
                    ["chattr", "+a", name], capture_output=True, check=False).returncode:
                self.skipTest("chattr +a does not work here")
            try:
                self.assertIn(words, self.rejected(Output, self.file))
            finally:
                subprocess.run(["chattr", "-a", name], check=True)

    def test_a_full_disk_leaves_the_old_file(self):
        handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        try:
            resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limits[1]))
            words = self.rejected(output.write, self.file, bytes(5000))
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
            signal.signal(signal.SIGXFSZ, handler)
        self.assertIn(os.strerror(errno.EFBIG), words)
        self.assertEqual(self.file.read_text(), "old")

    def test_data_reaches_the_disk_before_the_name(self):
        calls = []
        with mock.patch.object(output.os, "fsync", side_effect=lambda f: calls.append("sync")), \
                mock.patch.object(output.os, "rename", wraps=os.rename,
                                  side_effect=lambda *a, **k: calls.append("rename")):
            output.write(self.file, "new")
        self.assertEqual(calls, ["sync", "rename", "sync"])

    def test_devices_and_folders_are_no_outputs(self):
        os.mkfifo(self.folder / "fifo")
        (self.folder / "loop").symlink_to("loop")
        (self.folder / "device").symlink_to("/dev/null")
        for name, words in (("fifo", "not a regular"), ("device", "not a regular"),
                            (".", "a folder"), ("loop", "Too many levels"),
                            ("none/file", "none: No such file"), ("file/x", "Not a directory"),
                            ("x" * 300, "too long")):
            self.assertIn(words, self.rejected(Output, self.folder / name))

    def test_names_may_have_their_whole_length(self):
        name = "ä" * 127
        output.write(self.folder / name, "new")
        self.assertEqual(sorted(os.listdir(self.folder)), ["file", name])

    def test_inputs_stay(self):
        os.link(self.file, self.folder / "hard")
        (self.folder / "soft").symlink_to("file")
        for name in "file", "hard", "soft", "../" + self.folder.name + "/file":
            self.assertIn("allowed: another file", self.rejected(
                Output, self.folder / name, [self.folder / "none", self.file], code=output.USAGE))
        new = Output(self.folder / "new")
        self.rejected(Output, self.folder / "x/../new", [new], code=output.USAGE)


class Folders(InFolder):
    def test_must_be_new_empty_or_marked(self):
        full = bystanders.fill(self.folder / "full")
        for other in full, full / "read-only", full / "sticky":
            words = self.rejected(Folder, other, "scripts/a", code=output.USAGE)
            self.assertIn("allowed: a new or empty folder, or one that scripts/a wrote", words)
        new = Folder(self.folder / "new/folder", "scripts/a")
        new.write("sub/file", "1")
        again = Folder(new.path, "scripts/a")
        again.write("sub/file", "2")
        self.assertEqual((new.path / "sub/file").read_text(), "2")
        self.rejected(Folder, new.path, "scripts/b", code=output.USAGE)
        self.rejected(Folder, self.folder / "file", "scripts/a")
        self.rejected(Folder, self.folder / "none", "scripts/a", make=False, code=output.BAD_INPUT)

    def test_foreign_markers_do_not_count(self):
        full = bystanders.fill(self.folder / "full")
        (self.folder / "marker").write_text("scripts/a\n")
        (full / output.MARKER).symlink_to(self.folder / "marker")
        self.rejected(Folder, full, "scripts/a", code=output.USAGE)
        if os.geteuid() == 0:
            (full / output.MARKER).unlink()
            (full / output.MARKER).write_text("scripts/a\nREADME.md\n")
            os.chown(full / output.MARKER, NOBODY, NOBODY)
            with mock.patch.object(output.os, "geteuid", return_value=1):
                self.rejected(Folder, full, "scripts/a", code=output.USAGE)

    def test_bystanders_in_a_marked_folder_stay(self):
        made = Folder(self.folder / "made", "scripts/a")
        made.write("ours", "1")
        (made.path / "README.md").write_text("theirs")
        (made.path / "link").symlink_to(self.file)
        (made.path / "linked").symlink_to(self.folder)
        again = Folder(made.path, "scripts/a")
        for name in "README.md", "link", "linked/file", "linked/new", "ours/x":
            self.rejected(again.write, name, "2",
                          code=output.USAGE)
        for name in "../file", "/tmp/x", "a//b", "", "a\nb", output.MARKER:
            self.rejected(again.file, name, code=output.USAGE)
        (made.path / "ours").unlink()
        (made.path / "ours").symlink_to(self.file)
        self.rejected(again.write, "ours", "2", code=output.USAGE)
        self.rejected(again.contents, ["ours"], code=output.BAD_INPUT)

    def test_a_tar_has_the_listed_files_alone(self):
        made = Folder(self.folder / "made", "scripts/a")
        made.write("b/c", "1")
        (made.path / "private.txt").write_text("theirs")
        packed = output.tar_of("root", made.contents(made.names))
        self.assertEqual(packed, output.tar_of("root", {"b/c": b"1"}))
        with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
            self.assertEqual(archive.getnames(), ["root/b/c"])

    def test_a_marker_leads_nowhere_else(self):
        made = Folder(self.folder / "made", "scripts/a")
        (made.path / output.MARKER).write_text("scripts/a\n../file\n/etc/hostname\nours\n")
        self.assertEqual(Folder(made.path, "scripts/a").names, ["ours"])


class Text(unittest.TestCase):
    def test_control_characters_are_printed_as_question_marks(self):
        self.assertEqual(output.printable("a\x1b[2Jb\r\n\x9bc d ä"), "a?[2Jb???c d ä")


if __name__ == "__main__":
    unittest.main()
