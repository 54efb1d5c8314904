"""The simulated motion of a design: a full turn of a continuously rotating input, otherwise the verified range."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from pydantic import ValidationError

from kinematics.arrays import Real
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.message import compose
from service.simulation.query import NotSimulated, SimulationQuery, check_nonzero, refuse_unused
from synthesis.analyses.linkages.cycle import find_cycle
from synthesis.model.design_interface import AnyDesign
from synthesis.model.dynamics.request import DynamicsBlock, LoadedLinkage
from synthesis.model.problem import ProblemBase
from synthesis.results.forces import apply_link_shape

STEP_COUNT = 360
"""Number of steps of the motion; joint angles are compared at their ends."""

DEFAULT_RPM = 60.0
"""Default speed of a rotating input, in rev/min."""


class SimulatedMotion(NamedTuple):
    """Motion of the input: its positions (radians or length units, shape (n + 1,)), and its signed speed."""

    inputs: Real
    speed: float


def get_dynamics(problem: ProblemBase, design: AnyDesign, mechanism: Mechanism) -> LoadedLinkage | None:
    """Return the masses and loads of the links from the block `dynamics` of the design, or else of the problem.

    Return None if neither has this block.
    """
    # A design may have its own masses, for example counterweights added by balancing.
    own = getattr(design, "dynamics", None)
    if own:
        try:
            return DynamicsBlock.model_validate(own)
        except ValidationError as error:
            reason = error.errors()[0]["msg"].removeprefix("Value error, ")
            raise NotSimulated(compose("simulation-design-dynamics-invalid", reason=reason)) from None
    dynamics = getattr(problem, "dynamics", None)
    return None if dynamics is None else apply_link_shape(dynamics, mechanism.links)


def plan_motion(
    problem: ProblemBase, design: AnyDesign, mechanism: Mechanism, query: SimulationQuery
) -> SimulatedMotion:
    """Return the motion of a design and its speed.

    Raises
    ------
    NotSimulated
        If the design has no motion, or the query gives a speed that does not fit its input.
    """
    slides = mechanism.has_slide_input
    if slides:
        refuse_unused(query, "simulation-unused-with-sliding-input", "speed_rpm")
    else:
        refuse_unused(query, "simulation-unused-with-turning-input", "speed")
    low, high = _find_ends(problem, design, mechanism)
    speed = check_nonzero(query.speed if slides else query.speed_rpm, "speed" if slides else "speed_rpm")
    if speed is None:
        speed = _get_requested_speed(problem, slides) or (abs(high - low) if slides else DEFAULT_RPM)
    rate = speed if slides else speed * math.tau / 60.0
    inputs = np.linspace(low, high, STEP_COUNT + 1)
    # A negative speed reverses the motion; a full turn starts at the same angle either way.
    if rate * (high - low) < 0.0:
        turn = abs(high - low - math.tau) <= 1e-9 and not slides
        # The analysis covers low to high; a partial range is traversed from its other end.
        inputs = np.linspace(low, low - math.tau, STEP_COUNT + 1) if turn else inputs[::-1]
    return SimulatedMotion(inputs, rate)


def _get_requested_speed(problem: ProblemBase, slides: bool) -> float | None:
    """Return the speed from the problem's dynamics, else from its motion; None if missing or 0."""
    for block in (getattr(problem, "dynamics", None), getattr(problem, "motion", None)):
        found = getattr(block, "speed" if slides else "speed_rpm", None)
        if found:
            return float(found)
    return None


def _find_ends(problem: ProblemBase, design: AnyDesign, mechanism: Mechanism) -> tuple[float, float]:
    slides, metrics = mechanism.has_slide_input, design.metrics
    if getattr(metrics, "full_rotation", False) and not slides:
        start = float(mechanism.reference_input)
        return start, start + math.tau
    ends = getattr(metrics, "used_stroke" if slides else "used_range", None)
    motion = getattr(problem, "motion", None)
    # Kinds without a verified range use the motion of the problem.
    if ends is None and motion is not None:
        ends = motion.start, motion.end
        if None in ends:
            return find_cycle(mechanism)
    if ends is None:
        raise NotSimulated(compose("simulation-not-verified-over-motion"))
    low, high = (float(end) if slides else math.radians(float(end)) for end in ends)
    # A single position has no motion to compare with.
    if low == high:
        raise NotSimulated(compose("simulation-input-at-rest"))
    return low, high
