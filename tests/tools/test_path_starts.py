"""Builders of stored data still make what is stored."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from synthesis.kinds.path.exact.continuation_starts import load_five_point_start
from synthesis.kinds.path.exact.five_point_system import SOLUTION_COUNT, compute_residuals
from tools import path_starts
from tools.path_starts import five_point_problem


def test_a_drawn_linkage_solves_its_own_problem():
    y, p = five_point_problem(np.random.default_rng(3))
    assert compute_residuals(y, p) < 1e-10


@pytest.mark.slow
def test_the_program_makes_another_start_of_as_many_solutions(tmp_path, monkeypatch, capsys):
    file = tmp_path / "start.npz"
    monkeypatch.setattr(sys, "argv", ["path_starts", "five", "--seed", "77", "--output", str(file)])
    path_starts.main()
    assert f"{SOLUTION_COUNT} solutions" in capsys.readouterr().out
    with np.load(file) as made:
        assert made["y"].shape == (SOLUTION_COUNT, 8)
        assert compute_residuals(made["y"], made["p"]).max() < 1e-8
        assert not np.allclose(made["p"], load_five_point_start().p)
