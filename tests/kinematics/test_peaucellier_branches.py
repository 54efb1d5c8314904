"""Branches of Peaucellier's cell against a closed form.

B and C stand on the two intersections of circles about O4 and A, so the cell exists where the reach r = |O4 A| is
between arm − side and arm + side, and all of it is folded onto one line at either end. P is opposite to A in the
rhombus, or upon A; the two meet where the rhombus is flat, r² = arm² − side². By the law of cosines in O2 O4 A each of
the three reaches belongs to an angle of the crank and its mirror image at the ground link.
"""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.errors import DimensionError
from kinematics.linkage.planar.catalogue import make_peaucellier
from kinematics.linkage.planar.limits import find_branches
from kinematics.linkage.planar.mechanism import Mechanism
from tests.kinematics.mechanism_sampling import EVERY, take
from tests.support.kinematics.peaucellier_branches import TURN, pieces, same_cell


def general_cell(rng: np.random.Generator) -> Mechanism:
    """A crank of any length, so that P is on a circle; some of these turn through."""
    while True:
        ground, crank, side = rng.uniform(0.2, 3.0, 3)
        arm = side + rng.uniform(0.2, 3.0)
        o2 = complex(*rng.normal(size=2))
        o4 = o2 + ground * np.exp(1j * rng.uniform(-np.pi, np.pi))
        try:
            return make_peaucellier(o2, complex(o4), crank, arm, side, rng.uniform(-np.pi, np.pi))
        except DimensionError:
            continue


def test_branches_of_cells_that_draw_a_line() -> None:
    cells = EVERY["Peaucellier"](np.random.default_rng(61), 40)
    assert sum(same_cell(take(cells, k)) for k in range(40)) > 200


def test_branches_of_cells_that_draw_a_circle() -> None:
    rng = np.random.default_rng(62)
    cells = [general_cell(rng) for _ in range(60)]
    runs = [pieces(cell) for cell in cells]
    assert sum(run[0][0][1] - run[0][0][0] == TURN for run in runs) >= 3, "some turn through without a flat rhombus"
    assert sum(len(run) for run in runs) > 60, "some have more than one circuit"
    assert sum(same_cell(cell) for cell in cells) > 200


def test_a_branch_less_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    cell = take(EVERY["Peaucellier"](np.random.default_rng(63), 1), 0)
    found = find_branches(cell)
    monkeypatch.setattr("tests.support.kinematics.peaucellier_branches.find_branches", lambda _: found[1:])
    with pytest.raises(AssertionError):
        same_cell(cell)
