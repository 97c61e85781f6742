# SPDX-License-Identifier: MIT
"""Output files and folders of clpv's modules and scripts. Only the standard library."""
import os
import pathlib
import shutil
import sys

RUN_TIME, USAGE, BAD_INPUT = 1, 2, 3  # exit codes
MARKER = ".clpv-output"  # marks an output folder: the script that wrote it


class Failure(Exception):
    """Ends a command with the exit code `code`."""

    def __init__(self, words, code=RUN_TIME):
        super().__init__(words)
        self.code = code


def target_of(path, *inputs):
    """The file that a link leads to. Raises Failure, before long work, if it cannot be written, or
    is an input."""
    target = pathlib.Path(os.path.realpath(path))
    for name in inputs:
        both = target.exists() and os.path.exists(name)
        if target.samefile(name) if both else str(target) == os.path.realpath(name):
            raise Failure(f"{path}: found the file of {name}; allowed: another file", USAGE)
    if not target.parent.is_dir() or (target.exists() and not target.is_file()):
        raise Failure(f"{path}: cannot be written; allowed: a regular file in a folder that exists")
    return target


def write(path, data):
    """Writes bytes or text to a file beside, then renames it. Raises Failure; the old file then is
    as it was."""
    target = target_of(path)
    made = target.with_name(f".{os.getpid()}.part")
    try:
        with open(made, "xb") as file:  # follows no link
            file.write(data.encode("utf-8") if isinstance(data, str) else data)
        if target.exists():
            shutil.copymode(target, made)
        os.rename(made, target)
    except OSError as error:
        if not isinstance(error, FileExistsError):
            made.unlink(missing_ok=True)
        raise Failure(f"{path}: cannot be written: {error.strerror}") from None


def exit_code(main, *arguments):
    """Exit code of a script's main function. Prints its Failure, or what the system reports."""
    try:
        return main(*arguments)
    except (Failure, OSError) as error:
        print(f"{sys.argv[0]}: {error}", file=sys.stderr)
        return getattr(error, "code", RUN_TIME)


class Folder:
    """Output folder of a script: new, empty, or one that this script wrote before. `written`: its
    files of this run. Raises Failure."""

    def __init__(self, path, script):
        self.path, self.written = pathlib.Path(path), []
        self.path.mkdir(parents=True, exist_ok=True)
        marker = self.path / MARKER
        if not any(self.path.iterdir()):
            write(marker, f"{script}\n")
        if not marker.is_file() or marker.read_text("utf-8").splitlines()[:1] != [script]:
            raise Failure(f"{path}: found files, and no {MARKER} of {script}; allowed: a new or "
                          f"empty folder, or one that {script} wrote", USAGE)

    def file(self, name):
        """Path for a file of that name, which may have folders."""
        place = self.path / name
        place.parent.mkdir(parents=True, exist_ok=True)
        self.written.append(name)
        return place

    def write(self, name, data):
        write(self.file(name), data)
