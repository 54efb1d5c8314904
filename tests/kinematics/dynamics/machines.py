"""Random machines: mechanisms of every type with masses, loads and a motion that all follow from a seed."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinematics.dynamics import (
    Body,
    JointForce,
    Load,
    Machine,
    Places,
    PointForce,
    Torque,
    compute_balance,
    compute_reactions,
    make_constant,
)
from kinematics.dynamics.friction import Friction, find_rubbing_joints
from kinematics.dynamics.loads import Resistance, TurningResistance
from kinematics.dynamics.springs import Spring, TorsionSpring
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism

Rng = np.random.Generator

GRAVITY = complex(1.7, -9.6)

REMAINDER = 1e-6
"""Share of the forces in the joints (of the parts of the drive) below which the shaking force (the drive) is what is
left of them by cancelling: rounding of the parts is as large as 1e-9 of it."""


def masses(rng: Rng, mechanism: Mechanism) -> tuple[dict[str, Body], dict[str, np.ndarray]]:
    """Bodies of all links but one, and point masses at a few joints."""
    n = mechanism.shape
    moving = [link for link in mechanism.links if link != GROUND]
    weightless = moving[int(rng.integers(len(moving)))] if len(moving) > 1 else ""
    bodies = {
        link: Body(rng.uniform(0.1, 2.0, n), rng.normal(size=n) + 1j * rng.normal(size=n), rng.uniform(0.1, 1.0, n))
        for link in moving
        if link != weightless
    }
    joints = list(mechanism.joints)
    heavy = rng.choice(joints, size=min(2, len(joints)), replace=False)
    return bodies, {str(joint): rng.uniform(0.1, 1.0, n) for joint in heavy}


def loads(rng: Rng, mechanism: Mechanism) -> tuple[Load, ...]:
    """A force that turns with its link and one that does not, a force on a joint, a torque, and what resists."""
    moving = [link for link in mechanism.links if link != GROUND]

    def strength() -> complex:
        return complex(*rng.normal(size=2)) * 10.0

    def place() -> np.ndarray:
        return np.asarray(rng.normal(size=mechanism.shape) + 1j * rng.normal(size=mechanism.shape))

    links = rng.choice(moving, size=3)
    return (
        PointForce(str(links[0]), place(), make_constant(strength()), True),
        PointForce(str(links[1]), place(), make_constant(strength())),
        JointForce(str(rng.choice(list(mechanism.joints))), make_constant(strength())),
        Torque(str(links[2]), make_constant(strength().real)),
        Resistance(str(rng.choice(list(mechanism.joints))), 3.0, 5.0),
        TurningResistance(str(rng.choice(moving)), 2.0, 1.0),
    )


def springs(rng: Rng, mechanism: Mechanism) -> tuple[Load, ...]:
    """A spring to the ground with a damper, one between two links that only pulls, and one that turns."""
    moving = [link for link in mechanism.links if link != GROUND]

    def place() -> np.ndarray:
        return np.asarray(rng.normal(size=mechanism.shape) + 1j * rng.normal(size=mechanism.shape))

    first, second = (str(link) for link in rng.choice([GROUND, *moving], size=2, replace=False))
    return (
        Spring((GROUND, str(rng.choice(moving))), (place(), place()), 5.0, 0.7, 0.4, 0.3),
        Spring((first, second), (place(), place()), 8.0, 1.5, damping=0.2, one_sided="pull"),
        TorsionSpring((first, second), 4.0, 0.2, 0.5),
    )


def machine(rng: Rng, mechanism: Mechanism) -> Machine:
    """A machine of all sorts of masses and loads."""
    bodies, pin_masses = masses(rng, mechanism)
    acting = (*loads(rng, mechanism), *springs(rng, mechanism))
    return Machine(mechanism, bodies, pin_masses, GRAVITY, acting, complex(*rng.normal(size=2)))


def rubbing(rng: Rng, whole: Machine) -> Machine:
    """The same machine with friction at all pins and slides."""
    pins = {joint: (float(rng.uniform(0.05, 0.3)), 0.05) for joint in find_rubbing_joints(whole.mechanism)}
    slides = {n: float(rng.uniform(0.05, 0.2)) for n in range(len(whole.mechanism.slides))}
    return replace(whole, friction=Friction(pins, slides))


def moved(
    mechanism: Mechanism, reach: float = 0.3, count: int = 5, speed: float = 2.0, acceleration: float = 3.0
) -> tuple[Places, Places]:
    """Places about the reference as the input moves, and at an input speed of 1."""
    at = np.asarray(mechanism.reference_input)[..., None] + np.linspace(-reach, reach, count)
    now = drive(mechanism, at, speed=speed, acceleration=acceleration, order=2)
    return Places(mechanism, now), Places(mechanism, drive(mechanism, at, order=2))


class Differences(NamedTuple):
    """Of both routes to drive, shaking force and shaking moment, shape (3, machines): as shares of their own peaks, and
    of these where they are not below :data:`REMAINDER`; NaN where a machine has no position with forces."""

    bare: np.ndarray
    told: np.ndarray


def differences(rng: Rng, mechanism: Mechanism, reach: float = 0.3, count: int = 5) -> Differences:
    """The largest disagreement of reactions with energy and momentum over all positions that have forces."""
    whole = machine(rng, mechanism)
    now, paced = moved(mechanism, reach, count)
    found, check = compute_reactions(whole, now), compute_balance(whole, now, paced)

    def peak(values: np.ndarray) -> np.ndarray:
        return np.where(found.solved, np.abs(values), 0.0).max(axis=-1)

    pairs = (
        (found.drive, check.drive),
        (found.shaking_force, check.shaking_force),
        (found.shaking_moment, check.shaking_moment),
    )
    apart = np.stack([peak(one - other) for one, other in pairs])
    peaks = np.stack([peak(one) for one, _ in pairs])
    pins = np.max([peak(force) for on in found.joints.values() for force in on.values()], axis=0)
    far = np.max([peak(jet[0] - whole.about) for jet in now.joints.values()], axis=0)
    parts = np.stack([peak(check.scale), pins, pins * far])
    with np.errstate(invalid="ignore"):
        return Differences(apart / peaks, apart / np.maximum(peaks, REMAINDER * parts))
