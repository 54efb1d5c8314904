"""Drive and shaking force from the balances of energy and momentum, without reactions.

With ' the derivative by the input q, and kinetic energy ½ J q̇²,

    J = Σ m |r'|² + Σ I φ'²,    drive = J q̈ + ½ J' q̇² − (work of weight, loads and springs per unit of q),

which is virtual work (Norton 10.26, 11.16) with d'Alembert's forces taken from the kinetic energy. Momentum P q̇ and
angular momentum H q̇ about a fixed point give the force and the moment on the frame:

    shaking force = Σ external forces − (P q̈ + P' q̇²),    P = Σ m r',
    shaking moment = Σ external moments − (H q̈ + H' q̇²),  H = Σ m (r − c) × r' + Σ I φ'.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.dynamics.friction import NO_RUBBING, Rubbing
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places, cross, dot


class Balance(NamedTuple):
    """Results over designs × positions, shape S + (N,); ``scale`` sums the magnitudes of all parts of the drive."""

    drive: Real
    shaking_force: Complex
    shaking_moment: Real
    scale: Real


def compute_balance(machine: Machine, now: Places, paced: Places, rubbing: Rubbing = NO_RUBBING) -> Balance:
    """Compute the balances of a machine at positions ``now``; ``paced`` is the same motion at an input speed of 1.

    Friction losses come from the reactions (``rubbing``), since a balance of energy cannot determine them. Friction is
    internal to the mechanism and does not change momentum.
    """
    # Speed and acceleration of the input; all other derivatives are by the input itself.
    q1, q2 = now.input[1], now.input[2]
    masses: list[tuple[Real, Complex]] = [
        (np.asarray(part.mass)[..., None], paced.point(link, part.cg)) for link, part in machine.bodies.items()
    ]
    # Point masses at pins contribute like bodies without inertia.
    masses += [(np.asarray(mass)[..., None], paced.joints[joint]) for joint, mass in machine.pin_masses.items()]
    shape = now.smooth.shape
    inertia, inertia_rate, weight, angular, angular_rate, moment = (np.zeros(shape) for _ in range(6))
    momentum, momentum_rate, force = (np.zeros(shape, np.complex128) for _ in range(3))
    for mass, (r, r1, r2) in masses:
        inertia += mass * dot(r1, r1)
        # dJ/dq for the term ½ J' q̇² of the drive.
        inertia_rate += 2.0 * mass * dot(r1, r2)
        weight += mass * dot(np.asarray(machine.gravity), r1)
        momentum += mass * r1
        momentum_rate += mass * r2
        angular += mass * cross(r - machine.about, r1)
        angular_rate += mass * cross(r - machine.about, r2)
        force += mass * machine.gravity
        moment += mass * cross(r - machine.about, np.asarray(machine.gravity))
    for link, part in machine.bodies.items():
        turned, own = paced.spins[link], np.asarray(part.inertia)[..., None]
        inertia += own * turned[1] ** 2
        inertia_rate += 2.0 * own * turned[1] * turned[2]
        angular += own * turned[1]
        angular_rate += own * turned[2]
    works = [load.work(now, paced) for load in machine.loads]
    for load in machine.loads:
        for effort in load.efforts(now):
            force = force + effort.force
            moment = moment + cross(effort.at - machine.about, effort.force) + effort.couple
    # Kept separate, because the scale for tolerances is the sum of their magnitudes.
    parts = [inertia * q2, 0.5 * inertia_rate * q1**2, -weight, *(-work for work in works), -rubbing.work(paced)]
    return Balance(
        np.asarray(sum(parts)),
        force - momentum * q2 - momentum_rate * q1**2,
        moment - angular * q2 - angular_rate * q1**2,
        np.asarray(sum(np.abs(part) for part in parts)),
    )
