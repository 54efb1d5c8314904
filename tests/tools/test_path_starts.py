"""Builders of stored data still make what is stored."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from synthesis.kinds.path.five_point_system import SOLUTIONS, residuals
from synthesis.kinds.path.starts import five_point_start
from tools import path_starts
from tools.path_starts import five_point_problem


def test_a_drawn_linkage_solves_its_own_problem():
    y, p = five_point_problem(np.random.default_rng(3))
    assert residuals(y, p) < 1e-10


@pytest.mark.slow
def test_the_program_makes_another_start_of_as_many_solutions(tmp_path, monkeypatch, capsys):
    file = tmp_path / "start.npz"
    monkeypatch.setattr(sys, "argv", ["path_starts", "five", "--seed", "77", "--output", str(file)])
    path_starts.main()
    assert f"{SOLUTIONS} solutions" in capsys.readouterr().out
    with np.load(file) as made:
        assert made["y"].shape == (SOLUTIONS, 8)
        assert residuals(made["y"], made["p"]).max() < 1e-8
        assert not np.allclose(made["p"], five_point_start().p)
