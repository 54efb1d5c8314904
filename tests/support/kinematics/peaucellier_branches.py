"""Code that several tests share: peaucellier branches."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from kinematics.linkage.planar.limits import find_branches
from kinematics.linkage.planar.mechanism import Mechanism

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
    found = find_branches(mechanism)
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
