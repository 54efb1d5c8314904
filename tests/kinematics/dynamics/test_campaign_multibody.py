"""The drive's torque against a simulation forwards in time by an independent multibody program."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from kinematics.dynamics import Machine, Places, Spring, compute_reactions, make_body
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from tests.oracles.multibody import simulated

pytestmark = [pytest.mark.campaign, pytest.mark.timeout(600)]

SPEED = 4.0 * np.pi
STEPS = (900, 1800, 3600, 7200)
BEGUN = 0.02
"""Share of the turn that is not compared: from its start the integrator has to find the accelerations."""

JOINTS = {"O2": 0j, "A": 0.0878 + 0.0479j, "O4": 0.3 + 0j, "B": 0.2865 + 0.1996j}
LINKS = {GROUND: ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B"), "output": ("O4", "B")}
FOURBAR = Mechanism(JOINTS, LINKS, "input")
SIXBAR = Mechanism(
    {**JOINTS, "C": 0.38 + 0.15j, "O6": 0.72 - 0.02j, "D": 0.70 + 0.25j},
    {
        GROUND: ("O2", "O4", "O6"),
        "input": ("O2", "A"),
        "coupler": ("A", "B"),
        "rocker": ("O4", "B", "C"),
        "link 5": ("C", "D"),
        "output": ("O6", "D"),
    },
    "input",
)


def weighed(mechanism: Mechanism) -> Machine:
    """Masses of all links off their lines, weight, and a spring with a damper from the ground to the last link."""
    bodies = {}
    for n, link in enumerate(link for link in mechanism.links if link != GROUND):
        first, second = (complex(mechanism.joints[joint]) for joint in mechanism.links[link][:2])
        bodies[link] = make_body(0.4 + 0.2 * n, first + (0.4 + 0.1j) * (second - first), 0.001 + 0.002 * n)
    last = list(mechanism.links)[-1]
    end = complex(mechanism.joints[mechanism.links[last][-1]])
    spring = Spring((GROUND, last), (np.asarray(end + 0.2 + 0.3j), np.asarray(end)), 60.0, 0.25, damping=2.0)
    return Machine(mechanism, bodies, {}, -9.81j, (spring,))


@pytest.mark.parametrize("mechanism", [FOURBAR, SIXBAR], ids=["fourbar", "sixbar"])
def test_torque_is_what_a_simulation_converges_to(mechanism: Mechanism) -> None:
    machine = weighed(mechanism)
    apart = []
    for steps in STEPS:
        found = simulated(machine, SPEED, steps)
        torque = compute_reactions(
            machine, Places(mechanism, drive(mechanism, found.input, speed=SPEED, order=2))
        ).drive
        compared = slice(round(BEGUN * steps), None)
        apart.append(np.abs(found.torque - torque)[compared].max() / np.abs(torque).max())
    assert apart[-1] < 1e-3
    # Halved at least with the step: convergence is of the first order or better.
    assert all(coarse / fine > 1.8 for coarse, fine in pairwise(apart)), apart
    print("differences, as shares of the peak:", ", ".join(f"{share:.1e}" for share in apart))
