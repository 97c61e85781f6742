# SPDX-License-Identifier: MIT
"""Output files and folders of clpv's modules and scripts, with the promises of the program
(docs/security.md). Only the standard library.

A file is written under a temporary name in the folder of its target and renamed into place: readers
see the old file or the new one. The temporary name is unpredictable and never an existing file or
link. A link given as the output is resolved once and stays a link.
"""
import contextlib
import errno
import fcntl
import io
import os
import pathlib
import secrets
import stat
import struct
import sys
import tarfile

RUN_TIME, USAGE, BAD_INPUT = 1, 2, 3  # exit codes
MARKER = ".clpv-output"  # of a script's output folder: the script, then its files, a line each
LONGEST_NAME = 255  # bytes
GET_FLAGS, APPEND_ONLY = 0x80086601, 0x20  # FS_IOC_GETFLAGS of Linux
NO_SYNC = errno.EINVAL, errno.ENOTSUP  # file systems without fsync


class Failure(Exception):
    """What ends a command. `code`: its exit code."""

    def __init__(self, words, code=RUN_TIME):
        super().__init__(words)
        self.code = code


class BadOutput(Failure):
    """What cannot be written, and why."""


def printable(text):
    """Foreign text for a terminal: control characters become `?`."""
    return "".join(c if c.isprintable() or c == " " else "?" for c in str(text))


def is_append_only(folder):
    """Whether an open folder keeps what is created in it (`chattr +a`)."""
    try:
        flags = fcntl.ioctl(folder, GET_FLAGS, bytes(struct.calcsize("l")))
    except OSError:
        return False  # the file system has no such flags
    return bool(struct.unpack("l", flags)[0] & APPEND_ONLY)


def sync(file):
    try:
        os.fsync(file)
    except OSError as error:
        if error.errno not in NO_SYNC:
            raise


class Output:
    """An output file, checked before long work: its folder takes new files, and only a regular
    file is replaced that this user may write and replace, and that is no input."""

    def __init__(self, path, inputs=(), option="output"):
        """`inputs`: files that must stay, and other Outputs. Raises BadOutput."""
        self.path, self.target = path, os.path.realpath(path)
        for other in inputs:
            if self._is(other):
                name = other.path if isinstance(other, Output) else other
                raise BadOutput(
                    f"{option} {path}: found the file of {name}; allowed: another file", USAGE)
        with self._temporary():
            pass

    def write(self, data):
        """Writes bytes or text. Raises BadOutput; the old file then is as it was."""
        rest = memoryview(data.encode("utf-8") if isinstance(data, str) else data)
        with self._temporary() as (folder, name, file):
            while rest:
                rest = rest[os.write(file, rest):]
            sync(file)
            os.rename(name, os.path.basename(self.target), src_dir_fd=folder, dst_dir_fd=folder)
            sync(folder)

    def _is(self, other):
        if isinstance(other, Output):
            return self.target == other.target or self._is(other.target)
        try:
            return os.path.samestat(os.stat(self.target), os.stat(other))
        except OSError:
            return False  # one of them does not exist

    def _reject(self, why):
        raise BadOutput(f"{self.path}: cannot be written: {why}")

    @contextlib.contextmanager
    def _temporary(self):
        """Descriptor of the folder, name and descriptor of a temporary file, which disappears."""
        try:
            folder = os.open(os.path.dirname(self.target), os.O_RDONLY | os.O_DIRECTORY)
        except OSError as error:
            self._reject(f"{os.path.dirname(self.target)}: {error.strerror}")
        try:
            replaced = self._replaced(folder)
            name, file = self._created(folder, 0o666 if replaced is None else 0o600)
            try:
                if replaced is not None:
                    self._keep_owner(file, replaced)
                yield folder, name, file
            finally:
                os.close(file)
                with contextlib.suppress(FileNotFoundError):
                    os.unlink(name, dir_fd=folder)
        except OSError as error:
            self._reject(error.strerror)
        finally:
            os.close(folder)

    def _replaced(self, folder):
        """Status of the file to replace, or None. Rejects what cannot be replaced."""
        name = os.path.basename(self.target)
        if is_append_only(folder):
            self._reject("its folder is append-only")
        try:
            status = os.stat(name, dir_fd=folder, follow_symlinks=False)
        except FileNotFoundError:
            return None
        if stat.S_ISLNK(status.st_mode):
            self._reject(os.strerror(errno.ELOOP))
        if stat.S_ISDIR(status.st_mode):
            self._reject("it is a folder")
        if not stat.S_ISREG(status.st_mode):
            self._reject("it is not a regular file")
        above = os.fstat(folder)
        if above.st_mode & stat.S_ISVTX and os.geteuid() not in (0, status.st_uid, above.st_uid):
            self._reject("it belongs to another user, and its folder is sticky")
        # Fails for a file that is read-only, append-only or immutable.
        os.close(os.open(name, os.O_WRONLY | os.O_NOFOLLOW | os.O_NONBLOCK, dir_fd=folder))
        return status

    def _created(self, folder, mode):
        """A new hidden file of an unpredictable name: (name, descriptor)."""
        while True:
            end = f".{secrets.token_hex(8)}.part".encode()
            name = b"." + os.fsencode(os.path.basename(self.target))
            name = name[:LONGEST_NAME - len(end)] + end
            with contextlib.suppress(FileExistsError):
                return name, os.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW,
                                     mode, dir_fd=folder)

    def _keep_owner(self, file, replaced):
        made, kept = os.fstat(file), (replaced.st_uid, replaced.st_gid)
        if (made.st_uid, made.st_gid) != kept:
            try:
                os.fchown(file, *kept)
            except OSError:
                self._reject(f"its owner and group, {kept[0]}:{kept[1]}, cannot be kept")
        os.fchmod(file, stat.S_IMODE(replaced.st_mode) & 0o777)


def write(path, data):
    """Writes bytes or text to a file. Raises BadOutput."""
    Output(path).write(data)


def exit_code(main, *arguments):
    """That of a script's main function. Prints its Failure."""
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


def read_regular(path):
    """Bytes of a regular file; raises OSError for a link or anything else."""
    with open(os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError(errno.EINVAL, "it is not a regular file")
        return file.read()


class Folder:
    """Output folder of a script: new, empty, or one that this script wrote before. Its marker lists
    the files of the script; others are neither replaced nor packed."""

    def __init__(self, path, script, make=True):
        """`make`: False for a folder that must exist and have a marker. Raises BadOutput."""
        self.path, self.script, self.written = pathlib.Path(path), script, []
        self.names = self._marked()
        if self.names is not None:
            return
        try:
            if not make:
                raise BadOutput(f"{path}: found no {MARKER} of {script}; allowed: a folder that "
                                f"{script} wrote", BAD_INPUT)
            os.makedirs(path, exist_ok=True)
            if os.listdir(path):
                raise BadOutput(f"{path}: found files, and no {MARKER} of {script}; allowed: a new "
                                f"or empty folder, or one that {script} wrote", USAGE)
            self.names = []
            self._mark(script, os.O_CREAT | os.O_EXCL)
        except OSError as error:
            raise BadOutput(f"{path}: cannot be written: {error.strerror}") from None

    def _marked(self):
        """Files of the marker; None without a marker of this script, which this user or root
        wrote."""
        try:
            text = read_regular(self.path / MARKER).decode("utf-8")
            owner = os.lstat(self.path / MARKER).st_uid
        except (OSError, UnicodeDecodeError):
            return None
        script, *names = text.split("\n")[:-1] or [""]
        ours = script == self.script and owner in (0, os.geteuid())
        return [name for name in names if self._is_inside(name)] if ours else None

    def _mark(self, line, flags=0):
        flags |= os.O_WRONLY | os.O_APPEND | os.O_NOFOLLOW
        with open(os.open(self.path / MARKER, flags, 0o666), "w", encoding="utf-8") as file:
            file.write(f"{line}\n")

    @staticmethod
    def _is_inside(name):
        parts = name.split("/")
        return name.isprintable() and not {"", ".", ".."} & set(parts) and name != MARKER

    def file(self, name):
        """Path for a file of that name, which may have folders. Raises BadOutput if something has
        the name that this script did not write, or where a folder is a link."""
        place = self.path / name
        if not self._is_inside(name):
            raise BadOutput(f"{place}: allowed: a name inside {self.path}", USAGE)
        folders = [self.path.joinpath(*name.split("/")[:i]) for i in range(1, name.count("/") + 1)]
        try:
            for folder in folders:
                if not os.path.lexists(folder):
                    os.mkdir(folder)
            foreign = os.path.lexists(place) and (name not in self.names or place.is_symlink())
            if foreign or not all(stat.S_ISDIR(os.lstat(folder).st_mode) for folder in folders):
                raise BadOutput(f"{place}: found a file or link that {self.script} did not write; "
                                "allowed: none of this name", USAGE)
            if name not in self.names:
                self._mark(name)
                self.names.append(name)
        except OSError as error:
            raise BadOutput(f"{place}: cannot be written: {error.strerror}") from None
        self.written.append(name)
        return place

    def write(self, name, data):
        write(self.file(name), data)

    def contents(self, names):
        """{name: bytes} of files of this script."""
        found = {}
        for name in dict.fromkeys(names):
            try:
                found[name] = read_regular(self.path / name)
            except OSError as error:
                raise BadOutput(f"{self.path / name}: {error.strerror}; allowed: a file that "
                                f"{self.script} wrote", BAD_INPUT) from None
        return found


def tar_of(root, contents):
    """Bytes of a tar of {name: bytes} below the folder `root`, without owners and times."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for name, data in contents.items():
            entry = tarfile.TarInfo(f"{root}/{name}")
            entry.size, entry.mode = len(data), 0o644
            archive.addfile(entry, io.BytesIO(data))
    return packed.getvalue()
