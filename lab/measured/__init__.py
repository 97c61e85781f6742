# SPDX-License-Identifier: MIT
"""Measured numbers: scripts/measure and scripts/reproduce measure them and draw charts,
scripts/tables shows them.

rows.py has what is measured, once for both.
"""
import argparse
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / os.environ.get("CLPV_BUILD_DIR", "build")
CLPV = BUILD / "clpv"
LAB = BUILD / "clpv-lab"  # has other methods and peers too
RESULTS = ROOT / "results"
os.environ["MPLCONFIGDIR"] = os.environ.get("MPLCONFIGDIR") or str(BUILD / "matplotlib")  # not in HOME
sys.path.insert(0, str(ROOT / "python"))
from clpv import output  # noqa: E402


def native():
    """The package clpv with the native module of the build."""
    import clpv
    clpv.__path__.append(str(BUILD / "python/clpv"))
    return clpv


def run_clpv(*arguments, check=True, cwd=ROOT):
    """Returns what clpv prints. With `check` its own message and exit code end the script."""
    done = subprocess.run([str(CLPV), *map(str, arguments)], stdout=subprocess.PIPE, text=True,
                          check=False, cwd=cwd)
    if check and done.returncode:
        sys.exit(max(done.returncode, 1))
    return done.stdout


def parser_of(description, model=True, required=False):
    """A parser of a script's arguments, with the model that most of them take."""
    parser = argparse.ArgumentParser(sys.argv[0], description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    if model:
        parser.add_argument("--model", type=lambda given: pathlib.Path(given).resolve(),
                            required=required, help="Sponza's glTF, of the Khronos sample models")
    return parser


def use_device(name):
    """As --device of clpv takes it: for all programs that the script runs."""
    os.environ["CLPV_DEVICE"] = name
    return name


def described():
    """Commit of this tree, as cmake/git_describe.cmake finds it: `unknown` without git, and in a
    source archive, which may lie in another repository."""
    if not (ROOT / ".git").exists() or not shutil.which("git"):
        return "unknown"
    found = subprocess.run(["git", "describe", "--always", "--dirty", "--tags"],
                           capture_output=True, text=True, check=False, cwd=ROOT)
    return found.stdout.strip() or "unknown"


def hash_of(paths):
    """SHA-256 of files, and of all files in folders, with their names."""
    sums = hashlib.sha256()
    for path in paths:
        for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
            if file.is_file() and "__pycache__" not in file.parts:
                content = hashlib.sha256(file.read_bytes()).hexdigest()
                sums.update(f"{file.relative_to(path.parent)} {content}\n".encode())
    return sums.hexdigest()


def model_files(model):
    """The model and the files that it names."""
    if model.suffix == ".glb":
        return [model]
    document = json.loads(model.read_text())
    uris = [entry["uri"] for entry in [*document.get("buffers", []), *document.get("images", [])]
            if "uri" in entry]
    return [model, *(model.parent / urllib.parse.unquote(uri) for uri in uris
                     if not uri.startswith("data:"))]


def json_lines(document):
    """JSON with a line for each row of its lists and for each member of its objects."""
    members = []
    for key, value in document.items():
        text = json.dumps(value)
        if value and isinstance(value, dict):
            lines = [f"{json.dumps(name)}: {json.dumps(each)}" for name, each in value.items()]
        else:
            lines = list(map(json.dumps, value)) if isinstance(value, list) else []
        if lines:
            text = text[0] + "\n" + ",\n".join(lines) + "\n" + text[-1]
        members.append(f"{json.dumps(key)}: {text}")
    return "{" + ",\n".join(members) + "}\n"
