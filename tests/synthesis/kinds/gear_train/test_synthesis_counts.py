"""How many choices a task of n positions leaves: Norton's Tables 5-3 and 5-4, counted by ranks on driven linkages.

His standard form has for a dyad the vectors W and Z, and for each position after the first the angles α and β and the
displacement P: 4 + 4 (n − 1) numbers in 2 (n − 1) equations. What can be chosen freely is the dimension of what solves
them, that is the unknowns less the rank of the conditions.
"""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, positions
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.cases import Case, cases

STEP = 1e-6


def rank(conditions, at) -> int:
    """Of the derivatives of conditions at a solution, by central differences."""
    shifts = STEP * np.eye(len(at))
    derivatives = np.array([conditions(at + shift) - conditions(at - shift) for shift in shifts]) / (2.0 * STEP)
    sizes = np.linalg.svd(derivatives, compute_uv=False)
    return int(np.count_nonzero(sizes > 1e-6 * sizes[0]))


def dyad_choices(n: int) -> int:
    """Pivots of one dyad of a fourbar whose coupler is carried through n given positions.

    A fixed pivot m and a moving one k of the coupler are four numbers; the distance between them stays the same.
    """
    linkage = Fourbar.from_lengths(2.0, 4.0, 3.0, 3.5, 1.3 + 0.7j)
    at = positions(linkage, np.radians(np.linspace(40.0, 130.0, n)), OPEN_ASSEMBLY)
    assert np.all(at.valid)
    place, turn = at.a, np.exp(1j * at.coupler_angle)

    def lengths(pivots):
        distances = np.abs(place + turn * complex(*pivots[2:]) - complex(*pivots[:2]))
        return distances[1:] - distances[0]

    pivots = np.array([0.0, 0.0, 0.0, 0.0])
    assert np.abs(lengths(pivots)).max() < 1e-12
    return 4 - rank(lengths, pivots)


def function_choices(n: int) -> int:
    """Fourbars with O2 in the origin whose rotations of input and output are given at n positions.

    The crank as a vector, the ground as a vector, coupler and rocker are six numbers.
    """

    def rotations(numbers):
        crank, ground = complex(*numbers[:2]), complex(*numbers[2:4])
        linkage = Fourbar(0.0, ground, abs(crank), numbers[4], numbers[5])
        theta = np.angle(crank) + np.radians(np.linspace(0.0, 90.0, n))
        at = positions(linkage, theta, OPEN_ASSEMBLY)
        assert np.all(at.valid)
        return np.angle(np.exp(1j * (at.output_angle[1:] - at.output_angle[0])))

    return 6 - rank(rotations, np.array([1.5, 1.3, 3.4, 0.5, 4.0, 3.0]))


@pytest.mark.parametrize("case", cases("synthesis_counts"))
def test_free_choices(case: Case) -> None:
    n = case.inputs["n"]
    free = dyad_choices(n) if case.inputs["type"] == "motion_or_path" else function_choices(n)
    variables, equations = 4 + 4 * (n - 1), 2 * (n - 1)
    case.check(variables=variables, equations=equations, free_choices=free, prescribed=variables - equations - free)


def test_five_pairs_leave_size_and_direction_alone() -> None:
    """Of the table's two choices for five pairs: all linkages are found, so that nothing but a similarity is free."""
    linkage = Fourbar.from_lengths(1.5, 4.0, 3.0, 3.4)
    inputs = np.linspace(40.0, 130.0, 5)
    outputs = np.degrees(positions(linkage, np.radians(inputs), OPEN_ASSEMBLY).output_angle)
    stated = [{"input": float(x), "output": float(y)} for x, y in zip(inputs, outputs, strict=True)]
    problem = parse_problem({"kind": "function", "pairs": stated, "constraints": {"max_link_ratio": None}})
    result = solve(problem, lambda fraction, message: None)
    assert result.search.complete
    assert 1 <= len(result.designs) <= 3
    links = [design.mechanism.links for design in result.designs]
    assert any(
        np.allclose([m.input / m.ground, m.coupler / m.ground, m.output / m.ground], np.array([1.5, 4.0, 3.0]) / 3.4)
        for m in links
    )
