# SPDX-License-Identifier: MIT
"""A folder full of files that are none of clpv's, with names that an output might have, and what
has become of them."""
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
NAMES = (
    "LICENSE", "README.md", "index.html", "report.json", "suite.json", "score.md", "check.json",
    "private.txt", "frame-rsm.jpg", "atrium-sh2.png", "root/etc/passwd", "truths/cornell.exr",
    "models/cornell.glb", "parts/lobes.json", "vendors/intel.icd", "ready", ".hidden",
    ".index.html.part", "name with spaces"
)


def fill(folder):
    """Puts bystanders into a folder: files, hidden ones, other modes, links to outside, read-only
    and sticky folders. Returns the folder."""
    outside = folder.with_name(folder.name + "-outside")
    for place in folder, outside:
        place.mkdir(parents=True)
    for name in NAMES:
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"precious {name}\n")
    (outside / "victim").write_text("precious victim\n")
    (folder / "private.txt").chmod(0o600)
    (folder / "figure1.jpg").symlink_to(outside / "victim")
    (folder / "cameras").symlink_to(outside)
    (folder / "clpv").symlink_to(outside / "nothing")
    for name, mode in ("read-only", 0o555), ("sticky", 0o1777):
        (folder / name).mkdir()
        (folder / name / "file").write_text("precious\n")
        (folder / name).chmod(mode)
    return folder


def seen(*folders):
    """{path: all that must stay} of everything in the folders; times of folders are left out."""
    found = {}
    for folder in folders:
        for path in [folder, *sorted(folder.rglob("*"))]:
            status = path.lstat()
            found[str(path)] = (
                oct(status.st_mode), status.st_uid, status.st_gid,
                None if path.is_dir() else (status.st_ino, status.st_mtime_ns),
                os.readlink(path) if path.is_symlink() else
                path.read_bytes() if path.is_file() else None)
    return found
