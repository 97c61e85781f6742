# SPDX-License-Identifier: MIT
"""Bases, against closed forms."""
import json

import numpy as np
import pytest

import clpv
from conftest import program


def test_lobes_of_the_paper_are_those_of_the_program():
    for name, size in (("srbf4", 256), ("srbf14", 257), ("sh2", 256)):
        basis = clpv.Basis(name)
        words = "--lobe", "rotate", "--table-size", size, "--axis=-2,1,-3", "--format=json"
        expected = json.loads(program("basis", name, *words))["bases"][0]
        c = basis.clamped_cosine((-2, 1, -3), size)
        assert np.allclose(c, expected["coefficients"], rtol=1e-12, atol=1e-12)
        assert basis.lobe((-2, 1, -3), c)["minimum"] == pytest.approx(expected["minimum"])
        for steps in (8, 24):
            assert basis.energy(steps, table_size=size) == pytest.approx(
                expected[f"energy_sampled_{steps}"])
            assert basis.energy(steps, "exact",
                                size) == pytest.approx(expected[f"energy_exact_{steps}"])
    exact = json.loads(program("basis", "srbf4", "--format=json"))["bases"][0]
    assert clpv.Basis("srbf4").mean_error == pytest.approx(exact["mean_relative_l2"])
    assert clpv.Basis("srbf4").energy(0) == pytest.approx(1)


def test_a_function_of_the_basis_is_its_own_projection():
    basis = clpv.Basis("sh3")
    values = basis.evaluate(basis.directions())
    assert np.allclose([basis.project(column) for column in values.T], np.eye(9), atol=1e-9)


def test_own_centres():
    centres = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -2, 0]]
    basis = clpv.Basis("mine", bandwidth=np.float32(0.3), centres=centres)
    assert len(basis) == 4 and basis.name == "mine"
    assert np.allclose(basis.centres[3], [0, -1, 0]) and np.allclose(basis.bandwidths, 0.3)
