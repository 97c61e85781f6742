# SPDX-License-Identifier: MIT
"""Output files and folders of clpv's modules and scripts, written beside and then renamed: readers
see the old file or the new one. Only the standard library."""
import io
import os
import pathlib
import shutil
import sys
import tarfile

RUN_TIME, USAGE, BAD_INPUT = 1, 2, 3  # exit codes
MARKER = ".clpv-output"  # marks an output folder: the script that wrote it


class Failure(Exception):
    """Ends a command with the exit code `code`."""

    def __init__(self, words, code=RUN_TIME):
        super().__init__(words)
        self.code = code


def printable(text):
    """Foreign text for a terminal: control characters become `?`."""
    return "".join(c if c.isprintable() or c == " " else "?" for c in str(text))


def target_of(path, *inputs):
    """The file that a link leads to. Raises Failure, before long work: the folder is missing, or
    there is what is no regular file, or an input."""
    target = pathlib.Path(os.path.realpath(path))
    for name in inputs:
        both = target.exists() and os.path.exists(name)
        if target.samefile(name) if both else str(target) == os.path.realpath(name):
            raise Failure(f"{path}: found the file of {name}; allowed: another file", USAGE)
    if not target.parent.is_dir():
        raise Failure(f"{path}: cannot be written: there is no folder {target.parent}")
    if target.exists() and not target.is_file():
        raise Failure(f"{path}: cannot be written: it is not a regular file")
    return target


def write(path, data):
    """Writes bytes or text to a file. Raises Failure; the old file then is as it was."""
    target = target_of(path)
    made = target.with_name(f".{os.getpid()}.part")
    try:
        with open(made, "xb") as file:
            file.write(data.encode("utf-8") if isinstance(data, str) else data)
        if target.exists():
            shutil.copymode(target, made)
        os.rename(made, target)
    except OSError as error:
        made.unlink(missing_ok=True)
        raise Failure(f"{path}: cannot be written: {error.strerror}") from None


def exit_code(main, *arguments):
    """Exit code of a script's main function. Prints its Failure."""
    try:
        return main(*arguments)
    except Failure as error:
        print(f"{sys.argv[0]}: {error}", file=sys.stderr)
        return error.code


def name_missing_modules():
    """For programs: a module that cannot be imported ends them with a line and exit code 1."""
    usual = sys.excepthook

    def hook(kind, error, trace):
        if not issubclass(kind, ImportError):
            return usual(kind, error, trace)
        hint = f" (Debian: python3-{error.name})" if kind is ModuleNotFoundError else ""
        print(f"{sys.argv[0]}: {error}{hint}", file=sys.stderr)

    sys.excepthook = hook


class Folder:
    """Output folder of a script: new, empty, or one that this script wrote before. `written`: its
    files of this run."""

    def __init__(self, path, script):
        """Raises Failure."""
        self.path, self.written = pathlib.Path(path), []
        marker = self.path / MARKER
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            if not any(self.path.iterdir()):
                marker.write_text(f"{script}\n", encoding="utf-8")
            found = marker.is_file() and not marker.is_symlink()
            lines = marker.read_text("utf-8").splitlines() if found else []
        except OSError as error:
            raise Failure(f"{path}: cannot be written: {error.strerror}") from None
        if lines[:1] != [script]:
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


def tar_of(root, contents):
    """Bytes of a tar of {name: bytes} below the folder `root`, without owners and times."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for name, data in contents.items():
            entry = tarfile.TarInfo(f"{root}/{name}")
            entry.size, entry.mode = len(data), 0o644
            archive.addfile(entry, io.BytesIO(data))
    return packed.getvalue()
