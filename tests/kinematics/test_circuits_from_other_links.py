"""Circuits and toggles of mechanisms that no dyads close from their input, against elimination from another link.

Here is said by hand which link is held and which drives, and where the true input stands still.
"""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.linkage.planar.limits import find_branches
from tests.kinematics.mechanism_sampling import CLASS_THREE, EVERY, take
from tests.oracles.constraints import Constraints
from tests.support.kinematics.circuits_from_other_links import TURNED, same_circuit, same_circuits, turning_of

TURN = 2.0 * np.pi


@pytest.mark.parametrize("name", TURNED)
def test_circuits_are_those_by_elimination_from_another_link(name: str) -> None:
    mechanism = EVERY[name](np.random.default_rng([52, TURNED.index(name)]), 6)
    assert sum(same_circuits(name, take(mechanism, k)) for k in range(6)) > 12


@pytest.mark.campaign
def test_toggles_that_lie_close_together() -> None:
    """The input goes back by 1.2e-4 rad. Newton from random starts finds four configurations there, and two beside."""
    name = "stephenson_2 driven by its input"
    mechanism = take(EVERY[name](np.random.default_rng([71, list(EVERY).index(name)]), 10_000), 491)
    assert same_circuits(name, mechanism) == 5
    constraints = Constraints.of(mechanism)
    for at, count in ((3.5008, 2), (3.5009, 4), (3.5010, 2)):
        way = at - float(mechanism.reference_input)
        assert len(constraints.all_configurations(0, way, np.random.default_rng(1), 400)) == count


@pytest.mark.parametrize("name", CLASS_THREE)
def test_a_branch_less_or_a_toggle_elsewhere_would_be_seen(name: str) -> None:
    mechanism = take(EVERY[name](np.random.default_rng([53, TURNED.index(name)]), 1), 0)
    found, theirs = find_branches(mechanism), turning_of(name, mechanism).circuits()
    own = [branch for branch in found if branch.circuit == 0]
    assert same_circuit(own, theirs[0], 1.0, False)
    assert not same_circuit(own[1:], theirs[0], 1.0, False)
    assert not same_circuit([own[0]._replace(high=own[0].high + 1e-8), *own[1:]], theirs[0], 1.0, False)
