# SPDX-License-Identifier: MIT
"""The package as the tests import it, and documents as clpv writes them."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))


def row(suite, stage, **fields):
    """A row of `clpv bench`; its name says nothing."""
    return {
        "name": "a name", "suite": suite, "stage": stage, "status": "ok", "reason": None,
        "basis": "sh2", "coefficients": 4, "layout": "soa", "storage": "float", "lobe": "exact",
        "occlusion": False, "cascade": None, "filtered": True,
        "median": 4.25, "min": 4.0, "p95": 5.0, **fields
    }


def variant(options, **fields):
    """A variant of `clpv quality`."""
    return {
        "options": options, "rejected": 0, "nrmse": 0.45, "worst_nrmse": 0.5, "energy_ratio": 1.0,
        "frame_ms": 170.0, **fields
    }
