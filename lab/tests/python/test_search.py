# SPDX-License-Identifier: MIT
"""The search for centres: its objective and gradients, its minima, its bounds, and its files."""
import json
import math
import os
import subprocess
import sys

import numpy as np
import pytest

import clpv

pytest.importorskip("scipy", reason="all of it: SciPy is not installed (Debian: apt install python3-scipy)")
from clpv_lab import search  # noqa: E402

SLANTED = np.array([[1, 2, -3], [0, math.sqrt(14), 0]]) / math.sqrt(14), np.array([0.75, 0.25])
LAMBDAS = np.array([0.2, 0.3, 0.25, 0.4, 0.33, 0.21])


def program(*arguments):
    words = [os.path.join(os.environ["CLPV_BUILD"], "clpv"), *map(str, arguments)]
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def even_directions(count):
    z, turn = 1 - (2 * np.arange(count) + 1) / count, math.pi * (3 -
                                                                 math.sqrt(5)) * np.arange(count)
    return np.stack([np.sqrt(1 - z * z) * np.cos(turn),
                     np.sqrt(1 - z * z) * np.sin(turn), z], axis=-1)


def error_over(basis, directions, weights):
    return math.sqrt(sum(w * basis.lobe(d)["relative_l2"]**2 for d, w in zip(directions, weights)))


@pytest.mark.parametrize("over, directions", [
    ((None, None), (even_directions(300), np.full(300, 1 / 300))), (SLANTED, SLANTED)])
def test_the_objective_is_the_error_of_the_basis(over, directions):
    centres = even_directions(6)
    basis = clpv.Basis("set", LAMBDAS, centres)
    objective = search.Objective(*over)
    assert math.sqrt(objective.square_error(centres, LAMBDAS)[0]) == pytest.approx(
        error_over(basis, *directions), abs=1e-3)
    bound = math.exp(objective.log_condition(centres, LAMBDAS)[0])
    assert basis.condition < bound < 6 * basis.condition


@pytest.mark.parametrize("over", [(None, None), SLANTED])
@pytest.mark.parametrize("lambdas, count", [("none", 18), ("one", 19), ("each", 24)])
def test_gradients_are_those_of_differences(over, lambdas, count):
    objective, unknowns = search.Objective(*over), search.Unknowns(6, lambdas, 0.3)
    v = unknowns.random(np.random.default_rng(3))
    v[18:] += LAMBDAS[:len(v) - 18] - 0.25
    assert len(v) == count
    for function in map(unknowns.of, (objective.square_error, objective.log_condition)):
        step = 1e-6 * np.eye(count)
        differences = [(function(v + each)[0] - function(v - each)[0]) / 2e-6 for each in step]
        assert np.allclose(function(v)[1], differences, atol=1e-6)


# Errors as an independent optimiser found them (docs/bases.md).
@pytest.mark.parametrize("count, over, lambdas, error", [(4, "all", "none", 0.40967),
                                                         (6, "axes", "one", 0.08978),
                                                         (8, "all", "one", 0.18096),
                                                         (9, "all", "none", 0.13660)])
def test_minima(count, over, lambdas, error):
    found = search.search(count, over, lambdas, starts=4)
    assert found.error == pytest.approx(error, abs=2e-5) and found.valid == 4
    basis = clpv.Basis("found", found.lambdas, found.centres)
    assert basis.condition == pytest.approx(found.condition,
                                            rel=1e-6) and found.condition < 2e4 * (1 + 1e-5)
    assert over == "axes" or found.error > search.minimum_error(count)


def test_minimum_errors_are_those_of_the_harmonics():
    for count, name in ((4, "sh2"), (9, "sh3")):
        assert search.minimum_error(count) == pytest.approx(
            clpv.Basis(name).lobe((1, 2, 3))["relative_l2"], abs=1e-9)
    assert search.minimum_error(8) == pytest.approx(math.sqrt(1 / 8 - 12 / 128), abs=1e-12)


def test_the_same_seed_gives_the_same_set():
    one, again, other = (search.search(5, lambdas="each", starts=2, seed=seed)
                         for seed in (1, 1, 2))
    assert np.array_equal(one.centres, again.centres) and np.array_equal(one.lambdas, again.lambdas)
    assert not np.array_equal(one.centres, other.centres)


@pytest.mark.parametrize(
    "given, text",
    [({"count": 0}, "count: found 0, allowed: 1 to 64"), ({"count": 65}, "65"),
     ({"start_lambda": math.nan}, "lambda: found nan"), ({"max_condition": 1e8}, "1e+07"),
     ({"starts": 0}, "starts"),
     ({"count": 20, "lambdas": "none", "start_lambda": 0.05, "starts": 2}, "none of 2 starts")])
def test_bad_values(given, text):
    with pytest.raises(ValueError) as raised:
        search.search(**{"count": 4, **given})
    assert text in str(raised.value)


@pytest.mark.parametrize("text, place", [("{", "Expecting"), ("[]", "/weights"),
                                         ('{"weights": []}', "1 to 10000"),
                                         ('{"weights": 7}', "/weights"),
                                         ('{"weights": [[0, 0, 0, 1]]}', "/weights/0"),
                                         ('{"weights": [[0, 0, 1, -1]]}', "/weights/0"),
                                         ('{"weights": [[0, 0, 1, 1e999]]}', "/weights/0"),
                                         ("[" * 100000, "recursion"), (None, "No such file")])
def test_bad_weights(tmp_path, text, place):
    path = tmp_path / "weights.json"
    if text is not None:
        path.write_text(text)
    with pytest.raises(search.documents.BadDocument) as raised:
        search.weights(path)
    assert str(path) in str(raised.value) and place in str(raised.value)


def run(*arguments):
    return subprocess.run([sys.executable, "-m", "clpv_lab.search", *map(str, arguments)],
                          capture_output=True, text=True, check=False, timeout=300, env=os.environ)


def test_from_weighted_normals_to_a_set(tmp_path):
    normals, file = tmp_path / "normals.json", tmp_path / "mine.json"
    normals.write_text(json.dumps({"weights": [[0, 1, 0, 3], [1, 0, 0, 1], [0, 0, 2, 1]]}))
    assert search.weights(normals)[1].tolist() == pytest.approx([0.6, 0.2, 0.2])
    found = run(4, "--starts", 2, "--lambdas", "each", "--weights", normals, "-o", file)
    assert found.returncode == 0 and "of 2 starts" in found.stdout, found.stderr
    made = json.loads(file.read_text())
    basis = json.loads(program("basis", "--format=json", "--centres", file))["bases"][0]
    assert basis["name"] == "mine" and basis["lambdas"] == made["lambda"] and len(
        made["centres"]) == 4
