"""Rotors: their unbalance from what is stated of it, and the masses that balance them."""

from __future__ import annotations

import cmath
import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.rotor import influence_coefficients, plane_corrections, unbalances_by_influence
from synthesis.kinds.balancing.places import Choice, Chosen, best_choices
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.stated_rotor import Correction, Holes
from synthesis.model.dynamics import METRES
from synthesis.model.motions import RAD_PER_S

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]


class Rotor(NamedTuple):
    """The unbalances of a rotor in masses times length units, and their places along the axis."""

    moments: Complex
    z: Real


class Weight(NamedTuple):
    """A mass at an angle (degrees) and a radius; ``moment`` is what it adds, of a mass that is taken away as well."""

    plane: int
    moment: complex
    angle: float
    mass: float | None
    radius: float | None
    removed: bool


class Balancing(NamedTuple):
    """The weights of all planes; what each of these has to have added, and what is proved to be left at least."""

    weights: list[Weight]
    needed: Complex
    bounds: list[float]
    proved: bool


def metres(problem: BalancingProblem) -> float:
    """The length unit in that of the forces."""
    return METRES[problem.length_unit] if problem.units == "si" else 1.0


def rotor_of(problem: BalancingProblem) -> Rotor:
    """The unbalances that a statement tells; of runs with trial weights, those in the planes."""
    if problem.influence is not None:
        initial = np.array([reading.vector for reading in problem.influence.initial])
        moments = unbalances_by_influence(initial, coefficients(problem))
    elif problem.masses:
        moments = np.array([mass.moment for mass in problem.masses])
    else:
        assert problem.rpm is not None
        square = metres(problem) * (problem.rpm * RAD_PER_S) ** 2
        moments = np.array([reading.vector / square for reading in problem.bearing_readings])
    return Rotor(moments, np.array(problem.places, np.float64))


def coefficients(problem: BalancingProblem) -> Complex:
    """The influence coefficients of the stated runs, readings by masses times length units."""
    assert problem.influence is not None
    return influence_coefficients(
        np.array([reading.vector for reading in problem.influence.initial]),
        np.array([[reading.vector for reading in run.readings] for run in problem.influence.trials]),
        np.array([run.moment for run in problem.influence.trials]),
    )


def balanced(problem: BalancingProblem, rotor: Rotor) -> list[Balancing]:
    """The ways to balance a rotor, the least residual first: one, or the best for each number of places."""
    needed = plane_corrections(rotor.moments, rotor.z, np.array(problem.used_planes))
    stated = problem.correction
    if stated is None or stated.placed is None:
        weights = [_single(plane, complex(moment), stated) for plane, moment in enumerate(needed) if moment != 0.0]
        return [Balancing(weights, needed, [0.0] * len(needed), True)]
    return _placed(stated, needed)


def _single(plane: int, moment: complex, stated: Correction | None) -> Weight:
    """One mass of a plane."""
    size, removed = abs(moment), stated is not None and stated.removed
    angle = math.degrees(cmath.phase(-moment if removed else moment))
    if stated is None:
        return Weight(plane, moment, angle, None, None, False)
    if stated.radius is not None:
        return Weight(plane, moment, angle, size / stated.radius, stated.radius, removed)
    assert stated.mass is not None
    return Weight(plane, moment, angle, stated.mass, size / stated.mass, removed)


def _placed(stated: Correction, needed: Complex) -> list[Balancing]:
    """Holes or stock weights of all planes: the Pareto set of places and residual."""
    placed = stated.placed
    assert placed is not None
    sign = -1.0 if stated.holes is not None else 1.0
    directions = placed.directions
    masses = placed.step * np.arange(1, placed.steps + 1) if isinstance(placed, Holes) else np.array(placed.masses)
    # Of two opposite holes the shallower undoes a part of the deeper: one of them is enough.
    opposite = isinstance(placed, Holes)
    axes = _axes(directions) if opposite else [[angle] for angle in directions]
    options = [[(angle, float(mass)) for angle in axis for mass in masses] for axis in axes]
    contributions = [
        np.array([cmath.rect(sign * mass * placed.radius, math.radians(angle)) for angle, mass in axis])
        for axis in options
    ]
    most = min(placed.max_places or len(axes), len(axes))
    chosen = [best_choices(complex(moment), contributions, most) for moment in needed]
    ways = []
    for together in _fronts(chosen):
        weights = []
        for plane, choice in enumerate(together):
            for axis, pick in sorted(choice.picks.items()):
                angle, mass = options[axis][pick]
                moment = complex(contributions[axis][pick])
                weights.append(Weight(plane, moment, angle, mass, placed.radius, stated.holes is not None))
        ways.append(
            Balancing(weights, needed, [plane.bound for plane in chosen], all(plane.proved for plane in chosen))
        )
    return ways


def _fronts(chosen: list[Chosen]) -> list[tuple[Choice, ...]]:
    """Choices of all planes that no others beat by places and residual in sum, the least residual first."""
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


def _axes(directions: list[float]) -> list[list[float]]:
    """The angles, opposite ones together."""
    axes: dict[float, list[float]] = {}
    for angle in directions:
        axes.setdefault(round(angle % 180.0, 9) % 180.0, []).append(angle)
    return list(axes.values())
