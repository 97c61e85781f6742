# SPDX-License-Identifier: MIT
"""Measured numbers: scripts/measure and scripts/reproduce measure them, scripts/tables and
scripts/charts show them.

rows.py has what is measured, once for both.
"""
import json
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("CLPV_BUILD_DIR", ROOT / "build"))
CLPV = BUILD / "clpv"
RESULTS = ROOT / "results"
sys.path.insert(0, str(ROOT / "python"))


def native():
    """The package clpv with the native module of the build."""
    import clpv
    clpv.__path__.append(str(BUILD / "python/clpv"))
    return clpv


def json_lines(document):
    """JSON with a line for each row of its lists and for each member of its objects."""
    members = []
    for key, value in document.items():
        if isinstance(value, dict) and value:
            lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(each)}"
                               for name, each in value.items())
            members.append(f"{json.dumps(key)}: {{\n{lines}\n}}")
        else:
            lines = isinstance(value, list) and ",\n".join(map(json.dumps, value))
            members.append(f"{json.dumps(key)}: " +
                           (f"[\n{lines}\n]" if lines else json.dumps(value)))
    return "{" + ",\n".join(members) + "}\n"
