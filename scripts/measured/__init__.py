# SPDX-License-Identifier: MIT
"""Measured numbers: scripts/measure, scripts/claims and scripts/reproduce measure them, scripts/tables and scripts/charts show them.

rows.py has what is measured, once for both.
"""
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
