# SPDX-License-Identifier: MIT
"""The searched sets of lab/results/centres have the errors and condition numbers that docs/bases.md shows."""
import json
import pathlib

import numpy as np
import pytest

import clpv

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "results/centres"
SEARCHED = json.loads((FOLDER / "searched.json").read_text())["sets"]
AXES = np.concatenate([np.eye(3), -np.eye(3)])
MAX_CONDITION = 2e4


def even_directions(count):
    z = 1 - (2 * np.arange(count) + 1) / count
    turn = np.pi * (3 - np.sqrt(5)) * np.arange(count)
    radius = np.sqrt(1 - z * z)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=-1)


def error_over(basis, directions):
    return np.sqrt(np.mean([basis.lobe(d)["relative_l2"]**2 for d in directions]))


@pytest.mark.parametrize("row", SEARCHED, ids=lambda row: f"{row['n']}-{row['over']}-{row['lambdas']}")
def test_a_set_has_its_error(row):
    basis = clpv.Basis("set", row["lambda"], row["centres"])
    directions = AXES if row["over"] == "axes" else even_directions(300)
    assert error_over(basis, directions) == pytest.approx(row["error"], abs=1e-3)
    assert basis.condition == pytest.approx(row["condition"], rel=1e-4)
    assert len(basis) == row["n"] and row["condition"] < MAX_CONDITION * (1 + 1e-5)
    assert row["bound"] is None or row["error"] > row["bound"]


def test_the_measured_set_of_eight_is_the_searched_one():
    measured = json.loads((FOLDER / "eight.json").read_text())
    best, = (row for row in SEARCHED if (row["n"], row["over"], row["lambdas"]) == (8, "all", "one"))
    assert (measured["lambda"], measured["centres"]) == (best["lambda"], best["centres"])
