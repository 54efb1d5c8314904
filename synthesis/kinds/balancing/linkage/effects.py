"""Linear effects of a counterweight on the shaking force, the shaking moment, the drive and the joint forces.

A weight of mass μ, first moment s and moment of inertia J about a joint O of its link, S = s e^{iφ}, adds

    to the force on the frame      −(μ a_O + S'') + μ g,                          S'' = (i α − ω²) S,
    to its moment about c          −((O − c) × (μ a_O + S'') + S × a_O + J α) + (μ (O − c) + S) × g,
    to the power of the drive      μ a_O·v_O + a_O·S' + v_O·S'' + J ω α − g·(μ v_O + S'),   S' = i ω S,

by the momentum and energy balances. The forces in the joints change by the reactions to a unit of each parameter.
All quantities are therefore linear in four numbers for each weight (Demeulenaere, Verschuure, Swevers and De Schutter,
A general and numerically efficient framework to design sector-type and cylindrical counterweights for balancing of
planar linkages, J. Mech. Des. 132, 2010).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.dynamics.bodies import make_body
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places, cross, dot
from kinematics.dynamics.reactions import Reactions, compute_reactions
from synthesis.kinds.balancing.linkage.motion import find_pivot

PARAMETER_COUNT = 4
"""Number of parameters of a weight: mass, both components of the first moment, and the moment of inertia."""


class LinearQuantity(NamedTuple):
    """A quantity over positions: its value without weights, shape (N,), and its change per parameter, shape (K, N).

    Forces are complex; other quantities are real.
    """

    fixed: Complex
    by: Complex

    def evaluate(self, parameters: Real) -> Complex:
        """Return the quantity with weights, shape (..., N), for parameters of shape (..., K)."""
        return np.asarray(self.fixed + parameters @ self.by)


def compute_quantities(
    machine: Machine, now: Places, links: Sequence[str], joints: Sequence[str]
) -> dict[str, list[LinearQuantity]]:
    """Compute shaking force, shaking moment, drive and joint forces (one per link of a joint), keyed by name."""
    found = compute_reactions(machine, now)
    force, moment, drive = [], [], []
    gravity = np.asarray(machine.gravity)
    rate = now.input[1]
    for link in links:
        place, velocity, acceleration = now.joints[find_pivot(machine.mechanism, link)]
        arm = place - machine.about
        _, omega, alpha = now.spins[link]
        turn = now.turns[link][0]
        none = np.zeros(len(rate))
        rows = [(np.ones(len(rate)), 0j * turn, none), (none, turn, none), (none, 1j * turn, none)]
        # One row for each parameter: unit mass at O, unit first moment along x and y, unit inertia.
        for mass, moved, inertia in [*rows, (none, 0j * turn, np.ones(len(rate)))]:
            first, second = 1j * omega * moved, (1j * alpha - omega**2) * moved
            forced = mass * acceleration + second
            force.append(mass * gravity - forced)
            moment.append(
                cross(mass * arm + moved, gravity) - cross(arm, forced) - cross(moved, acceleration) - inertia * alpha
            )
            power = mass * dot(acceleration, velocity) + dot(acceleration, first) + dot(velocity, second)
            power = power + inertia * omega * alpha - dot(gravity, mass * velocity + first)
            # The power divided by the input's rate is the drive's torque (or force).
            drive.append(power / rate)
    listed = {
        "shaking_force": [LinearQuantity(found.shaking_force, np.array(force))],
        "shaking_moment": [LinearQuantity(found.shaking_moment.astype(np.complex128), np.array(moment, np.complex128))],
        "drive": [LinearQuantity(found.drive.astype(np.complex128), np.array(drive, np.complex128))],
    }
    if joints:
        # Joint forces have no closed form: take the reactions to unit parameters.
        units = [unit for link in links for unit in _compute_unit_reactions(machine, now, link)]
        for joint in joints:
            listed[f"joint {joint}"] = [
                LinearQuantity(on, np.array([unit.joints[joint][link] for unit in units]))
                for link, on in found.joints[joint].items()
            ]
            for changed in listed[f"joint {joint}"]:
                _convert_to_parameters(changed.by)
    return listed


def _compute_unit_reactions(machine: Machine, now: Places, link: str) -> list[Reactions]:
    """Compute the reactions to a unit mass at O, to unit masses offset by one along x and y, and to a unit inertia."""
    about = complex(now.reference(find_pivot(machine.mechanism, link)))
    bare = replace(machine, loads=(), pin_masses={}, bodies={})
    parts = [make_body(1.0, about), make_body(1.0, about + 1.0), make_body(1.0, about + 1j), make_body(0.0, about, 1.0)]
    return [compute_reactions(replace(bare, bodies={link: part}), now) for part in parts]


def _convert_to_parameters(by: Complex) -> None:
    """Convert reactions to parameters in place.

    A unit mass offset by one from O has a mass and an inertia of 1 besides its first moment: subtract both effects.
    """
    for n in range(0, len(by), PARAMETER_COUNT):
        by[n + 1] -= by[n] + by[n + 3]
        by[n + 2] -= by[n] + by[n + 3]
