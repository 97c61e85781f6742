# SPDX-License-Identifier: MIT
"""Output files and folders of clpv's modules and scripts, written beside and then renamed: readers
see the old file or the new one. Only the standard library."""
import io
import os
import pathlib
import sys
import tarfile
import tempfile

RUN_TIME, USAGE, BAD_INPUT = 1, 2, 3  # exit codes
MARKER = ".clpv-output"  # marks an output folder: the script that wrote it


class Failure(Exception):
    """Ends a command with the exit code `code`."""

    def __init__(self, words, code=RUN_TIME):
        super().__init__(words)
        self.code = code


class BadOutput(Failure):
    """Names an output that cannot be written, and why."""


def printable(text):
    """Foreign text for a terminal: control characters become `?`."""
    return "".join(c if c.isprintable() or c == " " else "?" for c in str(text))


class Output:
    """An output file, checked before long work: its folder is there, and it replaces nothing but a
    regular file that is no input. A link stays a link."""

    def __init__(self, path, inputs=(), option="output"):
        """`inputs`: files that must stay, and other Outputs. Raises BadOutput."""
        self.path, self.target = path, pathlib.Path(os.path.realpath(path))
        for other in inputs:
            name = other.path if isinstance(other, Output) else other
            same = self.target.exists() and os.path.exists(name) and self.target.samefile(name)
            if same or self.target == pathlib.Path(os.path.realpath(name)):
                raise BadOutput(
                    f"{option} {path}: found the file of {name}; allowed: another file", USAGE)
        try:
            os.scandir(self.target.parent).close()
            regular = self.target.is_file() or not os.path.lexists(self.target)
        except OSError as error:
            raise self._bad(f"{self.target.parent}: {error.strerror}") from None
        if not regular:
            raise self._bad("it is not a regular file")

    def write(self, data):
        """Writes bytes or text. Raises BadOutput; the old file then is as it was."""
        made = None
        try:
            with tempfile.NamedTemporaryFile(dir=self.target.parent, prefix=".", suffix=".part",
                                             delete=False) as file:
                made = file.name
                file.write(data.encode("utf-8") if isinstance(data, str) else data)
                file.flush()
                os.fsync(file)
            os.chmod(made, self._mode())
            os.rename(made, self.target)
        except OSError as error:
            if made:
                os.unlink(made)
            raise self._bad(error.strerror) from None

    def _mode(self):
        if self.target.exists():
            return self.target.stat().st_mode & 0o777
        mask = os.umask(0)
        os.umask(mask)
        return 0o666 & ~mask

    def _bad(self, why):
        return BadOutput(f"{self.path}: cannot be written: {why}")


def write(path, data):
    """Writes bytes or text to a file. Raises BadOutput."""
    Output(path).write(data)


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
        """Raises BadOutput."""
        self.path, self.written = pathlib.Path(path), []
        marker = self.path / MARKER
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            if not any(self.path.iterdir()):
                marker.write_text(f"{script}\n", encoding="utf-8")
            found = marker.is_file() and not marker.is_symlink()
            lines = marker.read_text("utf-8").splitlines() if found else []
        except OSError as error:
            raise BadOutput(f"{path}: cannot be written: {error.strerror}") from None
        if lines[:1] != [script]:
            raise BadOutput(f"{path}: found files, and no {MARKER} of {script}; allowed: a new or "
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
