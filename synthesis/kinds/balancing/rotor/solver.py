"""Balancing of rotors: the unbalance from the given data, and the masses that correct it."""

from __future__ import annotations

import cmath
import itertools
import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.dynamics.rotor import compute_influence_coefficients, compute_plane_corrections, solve_unbalances
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.rotor.discrete_places import Choice, ChoiceFront, find_best_choices
from synthesis.kinds.balancing.statement.rotor import Correction, Holes
from synthesis.model.dynamics.request import METRES_PER_UNIT
from synthesis.model.linkage.input_motion import RAD_PER_S


class Rotor(NamedTuple):
    """The unbalances of a rotor (mass times length unit), and their positions along the axis."""

    moments: Complex
    z: Real


class Weight(NamedTuple):
    """A mass at an angle (degrees) and a radius, added or removed; ``moment`` is the unbalance that results from it."""

    plane: int
    moment: complex
    angle: float
    mass: float | None
    radius: float | None
    removed: bool


class Balancing(NamedTuple):
    """The weights of all planes, the unbalance that each plane needs, and the proven lower bound of its residual."""

    weights: list[Weight]
    needed: Complex
    bounds: list[float]
    proved: bool


def get_length_scale(problem: BalancingProblem) -> float:
    """Return the length unit, expressed in the length unit of the forces."""
    return METRES_PER_UNIT[problem.length_unit] if problem.units == "si" else 1.0


def build_rotor(problem: BalancingProblem) -> Rotor:
    """Build the rotor from the given unbalances; for runs with trial weights, those in the planes."""
    if problem.influence is not None:
        initial = np.array([reading.vector for reading in problem.influence.initial])
        moments = solve_unbalances(initial, compute_coefficients(problem))
    elif problem.masses:
        moments = np.array([mass.moment for mass in problem.masses])
    else:
        assert problem.rpm is not None
        # F = m r ω²: a bearing force determines an unbalance at this speed.
        square = get_length_scale(problem) * (problem.rpm * RAD_PER_S) ** 2
        moments = np.array([reading.vector / square for reading in problem.bearing_readings])
    return Rotor(moments, np.array(problem.places, np.float64))


def compute_coefficients(problem: BalancingProblem) -> Complex:
    """Compute the influence coefficients of the given runs: readings per mass times length unit."""
    assert problem.influence is not None
    return compute_influence_coefficients(
        np.array([reading.vector for reading in problem.influence.initial]),
        np.array([[reading.vector for reading in run.readings] for run in problem.influence.trials]),
        np.array([run.moment for run in problem.influence.trials]),
    )


def balance_rotor(problem: BalancingProblem, rotor: Rotor) -> list[Balancing]:
    """Return the corrections of a rotor, the smallest residual first: one, or the best for each number of places."""
    # The vectors that the planes must add to cancel the force and, with two planes, the moment.
    needed = compute_plane_corrections(rotor.moments, rotor.z, np.array(problem.used_planes))
    stated = problem.correction
    if stated is None or stated.place_choice is None:
        weights = [
            _choose_single(plane, complex(moment), stated) for plane, moment in enumerate(needed) if moment != 0.0
        ]
        return [Balancing(weights, needed, [0.0] * len(needed), True)]
    return _choose_places(stated, needed)


def _choose_single(plane: int, moment: complex, correction: Correction | None) -> Weight:
    """Return the single mass of a plane."""
    size, removed = abs(moment), correction is not None and correction.removed
    angle = math.degrees(cmath.phase(-moment if removed else moment))
    if correction is None:
        return Weight(plane, moment, angle, None, None, False)
    if correction.radius is not None:
        return Weight(plane, moment, angle, size / correction.radius, correction.radius, removed)
    assert correction.mass is not None
    return Weight(plane, moment, angle, correction.mass, size / correction.mass, removed)


def _choose_places(correction: Correction, needed: Complex) -> list[Balancing]:
    """Choose holes or stock weights in all planes: the Pareto set of number of places against residual."""
    placed = correction.place_choice
    assert placed is not None
    sign = -1.0 if correction.holes is not None else 1.0
    directions = placed.directions
    masses = placed.step * np.arange(1, placed.steps + 1) if isinstance(placed, Holes) else np.array(placed.masses)
    # The shallower of two opposite holes cancels part of the deeper one: one of them is enough.
    opposite = isinstance(placed, Holes)
    axes = _group_opposite(directions) if opposite else [[angle] for angle in directions]
    options = [[(angle, float(mass)) for angle in axis for mass in masses] for axis in axes]
    contributions = [
        np.array([cmath.rect(sign * mass * placed.radius, math.radians(angle)) for angle, mass in axis])
        for axis in options
    ]
    most = min(placed.max_places or len(axes), len(axes))
    chosen = [find_best_choices(complex(moment), contributions, most) for moment in needed]
    ways = []
    for together in _combine_fronts(chosen):
        weights = []
        for plane, choice in enumerate(together):
            for axis, pick in sorted(choice.picks.items()):
                angle, mass = options[axis][pick]
                moment = complex(contributions[axis][pick])
                weights.append(Weight(plane, moment, angle, mass, placed.radius, correction.holes is not None))
        ways.append(
            Balancing(weights, needed, [plane.bound for plane in chosen], all(plane.proved for plane in chosen))
        )
    return ways


def _combine_fronts(chosen: list[ChoiceFront]) -> list[tuple[Choice, ...]]:
    """Combine the planes' choices into the Pareto set of total places and residual, the smallest residual first."""
    # Sort by number of places first, so that one pass finds the front.
    combined = sorted(
        itertools.product(*(plane.choices for plane in chosen)),
        key=lambda choices: (sum(len(one.picks) for one in choices), sum(abs(one.residual) for one in choices)),
    )
    front: list[tuple[Choice, ...]] = []
    least = math.inf
    for choices in combined:
        residual = sum(abs(one.residual) for one in choices)
        if residual < least:
            front.append(choices)
            least = residual
    return front[::-1]


def _group_opposite(directions: list[float]) -> list[list[float]]:
    """Group each angle with the opposite angle, if that is present too."""
    axes: dict[float, list[float]] = {}
    for angle in directions:
        axes.setdefault(round(angle % 180.0, 9) % 180.0, []).append(angle)
    return list(axes.values())
