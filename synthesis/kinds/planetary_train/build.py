"""Construction of a planetary train from a search candidate, and the search's constraints on tooth numbers."""

from __future__ import annotations

import math

import numpy as np

from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from synthesis.kinds.planetary_train.design import PlanetaryMechanism, PlanetPlaces
from synthesis.kinds.planetary_train.nearest import Candidate
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.planetary_train.tooth_numbers import Demands, compute_divisions, compute_ring_addendum
from synthesis.kinds.planetary_train.verification import SIZE_SLACK
from synthesis.model.gears import mesh_limits
from synthesis.model.gears.answer import Ratio

MIN_ADDENDUM = 0.5
"""Minimum remaining addendum, in modules, of a ring with teeth that are shortened although this is not required."""


def build_demands(problem: PlanetaryProblem, arrangement: Arrangement, module: float | None = None) -> Demands:
    """Build an arrangement's constraints on tooth numbers, in half modules, for a module or for any listed one."""
    listed = problem.module_choices if module is None else [module]
    return Demands(
        {gear.name: problem.compute_tooth_limits(gear.name, gear.internal) for gear in arrangement.gears},
        problem.planets,
        problem.spacing == "equal",
        # Use the most favourable modules of the list: the finest for size, the coarsest for clearance.
        math.radians(problem.pressure_angle),
        problem.min_contact_ratio,
        problem.compute_min_clearance(listed[-1]),
        math.inf if problem.max_size is None else problem.max_size / listed[0] * (1.0 + SIZE_SLACK),
        problem.fillets == "refuse",
    )


def build_mechanism(problem: PlanetaryProblem, candidate: Candidate, module: float) -> PlanetaryMechanism:
    """Build the mechanism of a train with a module."""
    arrangement = ARRANGEMENTS[candidate.arrangement]
    known = dict(candidate.teeth)
    teeth = {gear: known[gear] for gear in arrangement.gear_names}
    driving, driven, fixed = candidate.roles
    return PlanetaryMechanism(
        arrangement=arrangement.name,
        teeth=teeth,
        planets=problem.planets,
        places=_place_planets(problem, arrangement, teeth),
        module=module,
        pressure_angle=problem.pressure_angle,
        addendum={gear: _compute_addendum(problem, arrangement, teeth, gear) for gear in teeth},
        input=driving,
        output=driven,
        fixed=fixed,
        ratio=Ratio.from_fraction(candidate.ratio),
    )


def _place_planets(
    problem: PlanetaryProblem, arrangement: Arrangement, teeth: dict[str, int]
) -> dict[str, PlanetPlaces]:
    """Place the planets at equal angles, or at the assembly positions nearest to equal angles."""
    count = problem.planets
    places = {}
    for planets in arrangement.planet_sets:
        whole = count
        if problem.spacing == "nearest":
            whole = (
                int(compute_divisions(arrangement, planets, {gear: np.array([z]) for gear, z in teeth.items()})[0])
                or count
            )
        # Rounded k/n of the divisions, in integers.
        steps = [(2 * k * whole + count) // (2 * count) for k in range(count)]
        places.update({planet: PlanetPlaces(divisions=whole, steps=steps) for planet in planets})
    return places


def _compute_addendum(problem: PlanetaryProblem, arrangement: Arrangement, teeth: dict[str, int], gear: str) -> float:
    """Return one module, or the remaining addendum of a ring that is shortened for its planets and their fillets."""
    if not arrangement.places[gear].internal:
        return 1.0
    mates = [np.array([float(teeth[mate])]) for mate in arrangement.list_mates(gear)]
    ring = np.array([float(teeth[gear])])
    angle = math.radians(problem.pressure_angle)

    def shorten_ring(fillets: bool) -> float:
        return min(round(float(compute_ring_addendum(mate, ring, angle, fillets)[0]), 6) for mate in mates)

    if problem.fillets == "report":
        return shorten_ring(fillets=False)
    # Shortening for fillets costs contact: it is only done if enough remains.
    short = shorten_ring(fillets=True)
    contact = min(
        float(mesh_limits.compute_internal_contact_ratio(mate, ring, np.array([short]), angle)[0]) for mate in mates
    )
    keeps = problem.fillets == "refuse" or (short >= MIN_ADDENDUM and contact >= problem.min_contact_ratio)
    return short if keeps else shorten_ring(fillets=False)
