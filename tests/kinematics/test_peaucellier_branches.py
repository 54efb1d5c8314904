"""Branches of Peaucellier's cell against a closed form.

B and C stand on the two intersections of circles about O4 and A, so the cell exists where the reach r = |O4 A| is
between arm − side and arm + side, and all of it is folded onto one line at either end. P is opposite to A in the
rhombus, or upon A; the two meet where the rhombus is flat, r² = arm² − side². By the law of cosines in O2 O4 A each of
the three reaches belongs to an angle of the crank and its mirror image at the ground link.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from kinematics.errors import DimensionError
from kinematics.linkage.planar.catalogue import peaucellier
from kinematics.linkage.planar.limits import branches
from kinematics.linkage.planar.mechanism import Mechanism
from tests.kinematics.mechanism_sampling import EVERY, take

TURN = 2.0 * np.pi

Piece = tuple[float, float]


def pieces(mechanism: Mechanism) -> list[list[Piece]]:
    """The ranges of the input in which no assembly begins or ends; those in one list meet at flat rhombi."""
    joint = {name: complex(z) for name, z in mechanism.joints.items()}
    ground, reference = joint["O4"] - joint["O2"], joint["A"] - joint["O2"]
    arm, side = abs(joint["B"] - joint["O4"]), abs(joint["B"] - joint["A"])
    start = float(mechanism.reference_input) - float(np.angle(reference / ground))

    def angles(squared_reach: float) -> list[float]:
        c, g = abs(reference), abs(ground)
        cosine = (c * c + g * g - squared_reach) / (2.0 * c * g)
        return [float(np.arccos(cosine)), TURN - float(np.arccos(cosine))] if abs(cosine) < 1.0 else []

    folded = angles((arm - side) ** 2) + angles((arm + side) ** 2)
    flat = angles(arm * arm - side * side)
    cuts = sorted(folded + flat)
    if not cuts:
        return [[(0.0, TURN)]]
    runs: list[list[Piece]] = []
    for low, high in pairwise([*cuts, cuts[0] + TURN]):
        reach = abs(reference) * np.exp(0.5j * (low + high)) - abs(ground)
        if not arm - side < abs(reach) < arm + side:
            continue
        piece = (start + low, start + high)
        if runs and low in flat:
            runs[-1].append(piece)
        else:
            runs.append([piece])
    if len(runs) > 1 and cuts[0] in flat:  # the last range goes on with the first
        runs[0] = [*runs.pop(), *runs[0]]
    return runs


def same_cell(mechanism: Mechanism) -> int:
    """Branches, whose ends, number and circuits must be those of the closed form; how many there are."""
    found = branches(mechanism)
    expected = pieces(mechanism)
    assert len(found) == 4 * sum(len(run) for run in expected)
    circuits: set[int] = set()
    for run in expected:
        of_run: list[int] = []
        for low, high in run:
            full = high - low == TURN
            met = [
                branch.circuit
                for branch in found
                if branch.full == full and (full or max(_apart(branch.low, low), _apart(branch.high, high)) < 1e-9)
            ]
            assert len(met) == 4
            of_run += met
        # Folded, B is on C, they exchange their places, and P turns about them freely; flat, P leaves A.
        # Where neither happens the assemblies stay apart.
        folds = any(not _is_flat(mechanism, end) for piece in run for end in piece)
        passes = any(_is_flat(mechanism, end) for piece in run for end in piece)
        if run[0][1] - run[0][0] == TURN:
            folds = passes = False
        assert len(set(of_run)) == (1 if folds else 2 if passes else 4)
        assert circuits.isdisjoint(of_run)
        circuits |= set(of_run)
    return len(found)


def _apart(one: float, other: float) -> float:
    return float(abs(np.exp(1j * one) - np.exp(1j * other)))


def _is_flat(mechanism: Mechanism, at: float) -> bool:
    joint = {name: complex(z) for name, z in mechanism.joints.items()}
    arm, side = abs(joint["B"] - joint["O4"]), abs(joint["B"] - joint["A"])
    turned = np.exp(1j * (at - float(mechanism.reference_input)))
    reach = abs(joint["O2"] + (joint["A"] - joint["O2"]) * turned - joint["O4"])
    return bool(abs(reach**2 - (arm**2 - side**2)) < 1e-6 * arm**2)


def general_cell(rng: np.random.Generator) -> Mechanism:
    """A crank of any length, so that P is on a circle; some of these turn through."""
    while True:
        ground, crank, side = rng.uniform(0.2, 3.0, 3)
        arm = side + rng.uniform(0.2, 3.0)
        o2 = complex(*rng.normal(size=2))
        o4 = o2 + ground * np.exp(1j * rng.uniform(-np.pi, np.pi))
        try:
            return peaucellier(o2, complex(o4), crank, arm, side, rng.uniform(-np.pi, np.pi))
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
    found = branches(cell)
    monkeypatch.setattr("tests.kinematics.test_peaucellier_branches.branches", lambda _: found[1:])
    with pytest.raises(AssertionError):
        same_cell(cell)
