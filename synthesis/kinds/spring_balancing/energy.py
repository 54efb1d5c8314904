"""Potential energy of a linkage held at rest: of its weights, steady loads and springs. It involves no forces."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Real
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places, dot
from kinematics.dynamics.springs import Spring, TorsionSpring
from synthesis.mechanisms.machine import locate_on_link
from synthesis.model.dynamics.request import DynamicsBlock


def has_potential(block: DynamicsBlock) -> bool:
    """Return whether all loads are steady: constant torques, and forces of constant direction."""
    for load in block.loads:
        course = load.torque if load.force is None else load.force
        if course is None or course.constant is None or (load.force is not None and load.frame == "link"):
            return False
    return True


def compute_potential(machine: Machine, block: DynamicsBlock, now: Places) -> tuple[Real, float]:
    """Compute the energy over positions, up to a constant, and its maximum part, for a block with a potential."""
    gravity = np.asarray(machine.gravity)
    parts: list[Real] = [np.zeros(now.smooth.shape)]
    for link, part in machine.bodies.items():
        parts.append(-float(part.mass) * dot(gravity, now.point(link, part.cg)[0]))
    for joint, mass in machine.pin_masses.items():
        parts.append(-float(mass) * dot(gravity, now.joints[joint][0]))
    for load in block.loads:
        if load.torque is not None:
            steady = load.torque.constant
            assert isinstance(steady, float)
            parts.append(-steady * now.spins[str(load.link)][0])
            continue
        assert load.force is not None
        assert isinstance(load.force.constant, tuple)
        # A constant force has the potential −F·r.
        force = np.asarray(complex(*load.force.constant))
        if load.joint is not None:
            place = now.joints[load.joint][0]
        else:
            assert load.point is not None
            at = locate_on_link(machine.mechanism, str(load.link), load.point, machine.scale)
            place = now.point(str(load.link), np.asarray(at))[0]
        parts.append(-dot(force, place))
    for spring in machine.loads:
        if isinstance(spring, Spring):
            parts.append(_compute_stored_energy(spring, compute_lengths(spring, now)))
        elif isinstance(spring, TorsionSpring):
            parts.append(0.5 * spring.rate * (spring.rotation(now) - spring.free) ** 2)
    return np.asarray(np.sum(parts, axis=0)), max(float(np.abs(part).max()) for part in parts)


def compute_lengths(spring: Spring, now: Places) -> Real:
    """Compute the length of a spring over positions."""
    first, second = (now.point(link, at)[0] for link, at in zip(spring.links, spring.places, strict=True))
    return np.asarray(np.abs(second - first))


def compute_tension(spring: Spring, length: Real) -> Real:
    """Compute the tension of a spring at rest as if it were two-sided."""
    return np.asarray(spring.rate * (length - spring.free_length) + spring.preload)


def _compute_stored_energy(spring: Spring, length: Real) -> Real:
    """Return ½ T²/k, or T L without a rate."""
    pull = compute_tension(spring, length)
    if spring.one_sided == "pull":
        pull = np.maximum(pull, 0.0)
    elif spring.one_sided == "push":
        pull = np.minimum(pull, 0.0)
    return 0.5 * pull**2 / spring.rate if spring.rate > 0.0 else pull * length
