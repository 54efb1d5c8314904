"""Peaks of many fourbars in closed form against the general equations of one skeleton after the other."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.dynamics import (
    JointForce,
    Machine,
    Places,
    PointForce,
    Torque,
    compute_reactions,
    make_body,
    make_constant,
)
from kinematics.dynamics.fourbar import COUPLER, OUTPUT, PIN_A, PIN_B, Fourbars, Weights, compute_peaks
from kinematics.dynamics.fourbar import INPUT as CRANK
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism

COUNT, POSITIONS, SPEED = 40, 25, -7.0
GRAVITY = 2.0 - 9.0j
LINKS = {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B", "P"), "output": ("O4", "B")}
ON = {"input": CRANK, "coupler": COUPLER, "output": OUTPUT}


def drawn(seed):
    """Fourbars in a configuration, with a range of the input that they go through: joints by name, and the range."""
    rng = np.random.default_rng(seed)
    joints = {name: rng.normal(size=COUNT) + 1j * rng.normal(size=COUNT) for name in ("O2", "A", "B", "O4", "P")}
    return rng, joints, rng.uniform(-0.3, 0.3, COUNT)


@pytest.mark.parametrize("seed", range(3))
def test_peaks_are_those_of_the_general_equations(seed):
    rng, joints, span = drawn(seed)
    mass, inertia = rng.uniform(0.1, 2.0, (COUNT, 3)), rng.uniform(0.01, 0.5, (COUNT, 3))
    centres = rng.normal(size=(COUNT, 3)) + 1j * rng.normal(size=(COUNT, 3))
    pins = rng.uniform(0.0, 1.0, (COUNT, 3))
    places = rng.normal(size=(COUNT, 3)) + 1j * rng.normal(size=(COUNT, 3))
    forces = 5.0 * (rng.normal(size=(COUNT, 5)) + 1j * rng.normal(size=(COUNT, 5)))
    turning = np.array([True, False, True, False, False])
    couples = rng.normal(size=3)
    about = rng.normal(size=COUNT) + 1j * rng.normal(size=COUNT)
    first = {"input": "O2", "coupler": "A", "output": "O4"}
    second = {"input": "A", "coupler": "B", "output": "B"}
    lines = np.stack([joints[second[link]] - joints[first[link]] for link in first], axis=1)
    units = lines / np.abs(lines)
    bases = np.stack([joints[first[link]] for link in first], axis=1)
    arm = np.zeros((COUNT, 5), complex)
    arm[:, :3] = (places - bases) / units
    force = forces.copy()
    force[:, :3] = np.where(turning[:3], forces[:, :3] / units, forces[:, :3])
    o2, a, b, o4, p = joints.values()
    linkages = Fourbars(
        o2,
        o4,
        np.abs(a - o2),
        np.abs(b - a),
        np.abs(b - o4),
        (p - a) / units[:, 1],
        np.sign((np.conj(o4 - a) * (b - a)).imag),
        np.angle(a - o2),
        span,
    )
    on = np.array([CRANK, COUPLER, OUTPUT, PIN_A, PIN_B])
    weights = Weights(mass, (centres - bases) / units, inertia, pins, GRAVITY, on, arm, force, turning, couples, about)
    found = compute_peaks(linkages, weights, SPEED, POSITIONS)

    compared = 0
    for n in range(COUNT):
        at = {name: complex(places[n]) for name, places in joints.items()}
        mechanism = Mechanism(at, LINKS, "input")
        loads = [
            PointForce(link, complex(places[n, k]), make_constant(complex(forces[n, k])), bool(turning[k]))
            for k, link in enumerate(ON)
        ]
        loads += [
            JointForce("A", make_constant(complex(forces[n, 3]))),
            JointForce("B", make_constant(complex(forces[n, 4]))),
        ]
        loads += [Torque(link, make_constant(float(couples[k]))) for k, link in enumerate(ON)]
        machine = Machine(
            mechanism,
            {link: make_body(mass[n, k], complex(centres[n, k]), inertia[n, k]) for k, link in enumerate(ON)},
            {joint: np.asarray(pins[n, k]) for k, joint in enumerate("ABP")},
            GRAVITY,
            tuple(loads),
            complex(about[n]),
        )
        start = float(mechanism.reference_input)
        inputs = start + span[n] * np.linspace(0.0, 1.0, POSITIONS)
        motion = drive(mechanism, inputs, speed=np.full(POSITIONS, SPEED), order=2)
        if not motion.valid.all() or np.abs(motion.sines[next(iter(motion.sines))]).min() < 0.05:
            continue
        general = compute_reactions(machine, Places(mechanism, motion))
        pin = max(np.abs(f).max() for on_link in general.joints.values() for f in on_link.values())
        expected = [
            np.abs(general.drive).max(),
            pin,
            np.abs(general.shaking_force).max(),
            np.abs(general.shaking_moment).max(),
            np.abs(general.drive).max() * abs(SPEED),
        ]
        assert found[n] == pytest.approx(expected, rel=1e-9)
        compared += 1
    assert compared > COUNT // 2


def test_what_cannot_be_assembled_has_no_peaks():
    one = np.ones(1)
    linkages = Fourbars(0j * one, 10.0 + 0j * one, one, one, one, 0j * one, one, 0.0 * one, math.tau * one)
    nothing = np.zeros((1, 3))
    weights = Weights(
        nothing, nothing + 0j, nothing, nothing, 0j, np.empty(0, np.int64), np.empty((1, 0), complex),
        np.empty((1, 0), complex), np.empty(0, bool), np.zeros(3), 0j * one,
    )  # fmt: skip
    assert (compute_peaks(linkages, weights, 1.0, 9) == np.inf).all()
