"""Verification of a straight-line mechanism: it is driven along its line, and what P does is measured.

The mechanism stands at the line's start; its input turns by the stated range the way that takes P forward. Deviation
and velocity are looked at on a grid, and their extremes ever closer.
"""

from __future__ import annotations

import cmath
import math
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter, ValidationError

from kinematics.errors import DimensionError
from kinematics.linkage.fourbar import Fourbar, barker_class
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import (
    GROUND,
    Mechanism,
    TopologyError,
)
from synthesis.kinds.straight_line.design import (
    ExactLineMechanism,
    LinePoint,
    StraightLineDesign,
    StraightLineMetrics,
)
from synthesis.kinds.straight_line.problem import LineMechanism, StraightLineProblem
from synthesis.mechanisms import GivenMechanism, MechanismError
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import LENGTH, PERCENT
from synthesis.model.linkage_answer import FourbarMechanism
from synthesis.outcome.ranking import quality
from synthesis.proof.checks import at_most, constraint_checks
from synthesis.proof.closer import (
    extremes_of,
    least_of,
    sine_at,
)

Real = NDArray[np.float64]

GRID = 1441
"""Inputs along the line that are looked at first."""

REACHED = 1e-9
"""How far P may be from the ends of the line, along it, and from an exact line: a share of the length."""

ROUNDING = 64.0 * float(np.finfo(np.float64).eps)
"""What rounding adds to that, as a share of the largest coordinate: mechanisms far from the origin lose digits."""

NO_TOGGLE = 1e-6
"""The least sine of a transmission angle at which the mechanism still moves one way."""

_GIVEN: TypeAdapter[GivenMechanism] = TypeAdapter(GivenMechanism)

LineMechanisms = FourbarMechanism | ExactLineMechanism


class _Along(NamedTuple):
    """The motion along the line: extremes of the distance across it and of the velocity along it, and places."""

    across: tuple[float, float]
    velocity: tuple[float, float]
    ends: tuple[complex, complex]
    middle_velocity: float
    sines: dict[str, float]
    joints: NDArray[np.complex128]


def verify_straight_line(
    problem: StraightLineProblem,
    design: LineMechanisms,
    family: LineMechanism,
    proportions: Literal["optimal", "classical", "exact"],
) -> StraightLineDesign | None:
    """Drive a mechanism along the line of a problem and measure it.

    Parameters
    ----------
    problem : StraightLineProblem
        What was asked.
    design : FourbarMechanism or ExactLineMechanism
        Dimensions; a fourbar's skeleton is not looked at.
    family, proportions
        What the design is called in its metrics; the family's usual range is taken where none is stated.

    Returns
    -------
    StraightLineDesign or None
        None where the dimensions are no mechanism that can be driven through the range.
    """
    told = design.model_dump(exclude={"skeleton"} if isinstance(design, FourbarMechanism) else None)
    try:
        mechanism = _GIVEN.validate_python(told).mechanism()
    except (ValidationError, MechanismError, DimensionError, TopologyError):
        return None  # ValidationError: a length beyond what any statement may hold
    span = math.radians(problem.range_of(family))
    start, along = complex(*problem.start), cmath.exp(1j * math.radians(problem.direction))
    sense = _sense(mechanism, along)
    if sense is None:
        return None
    inputs = float(mechanism.reference_input) + sense * span * np.linspace(0.0, 1.0, GRID)
    measured = _measured(mechanism, inputs, start, along, sense)
    if measured is None:
        return None
    length = problem.length
    travelled = measured.ends[1].real - measured.ends[0].real
    if not travelled > 0.0:
        return None
    mean = travelled / span
    least = {link: math.degrees(math.asin(min(sine, 1.0))) for link, sine in measured.sines.items()}
    same_branch = min(measured.sines.values()) > NO_TOGGLE
    barker = _barker(mechanism) if isinstance(design, FourbarMechanism) else None
    whole = _whole_turn(mechanism)
    lengths = _lengths(design, mechanism)
    arms = np.abs(mechanism.joints["P"] - mechanism.joints["A"])
    least_sine = math.sin(math.radians(min(least.values())))
    metrics = StraightLineMetrics(
        family=family,
        proportions=proportions,
        deviation=max(abs(x) for x in measured.across),
        straightness_error=100.0 * (measured.across[1] - measured.across[0]) / length,
        velocity_variation=100.0 * (measured.velocity[1] - measured.velocity[0]) / mean,
        mean_velocity=mean,
        middle_velocity=measured.middle_velocity,
        input_rotation=math.degrees(sense * span),
        moving_links=len(mechanism.links) - 1,
        grashof=None if barker is None else barker[0],
        barker=None if barker is None else barker[1],
        min_transmission_angle=min(least.values()),
        transmission_angles=least,
        cycle_transmission_angle=whole,
        same_branch=same_branch,
        visits_in_order=measured.velocity[0] > 0.0,
        full_rotation=whole is not None,
        link_ratio=max(lengths) / min(lengths),
        size=math.hypot(*np.ptp(measured.joints.view(np.float64).reshape(-1, 2), axis=0)),
        quality=quality(least_sine, max(*lengths, float(arms)) / length, max(lengths) / min(lengths)),
    )
    checks = _checks(problem, measured, metrics, sense, mechanism, lengths)
    return StraightLineDesign(
        mechanism=design,
        targets=[
            LinePoint(index=k, input_angle=math.degrees(at), x=place.real, y=place.imag, deviation=abs(local.imag))
            for k, (at, local) in enumerate(zip(inputs[[0, -1]].tolist(), measured.ends, strict=True))
            for place in [start + along * local]
        ],
        verification=Verification(passed=all(check.passed for check in checks), checks=checks),
        metrics=metrics,
    )


def _checks(
    problem: StraightLineProblem,
    measured: _Along,
    metrics: StraightLineMetrics,
    sense: int,
    mechanism: Mechanism,
    lengths: list[float],
) -> list[Check]:
    length = problem.length
    limit = REACHED + ROUNDING * float(np.abs(measured.joints).max()) / length
    gap = max(abs(measured.ends[0].real), abs(measured.ends[1].real - length)) / length
    checks = [Check(name="reaches_ends", passed=gap <= limit, value=gap, limit=limit)]
    if metrics.proportions == "exact":
        off = metrics.deviation / length
        checks.append(Check(name="exact_line", passed=off <= limit, value=off, limit=limit))
    if problem.max_deviation is not None:
        checks.append(at_most("deviation", metrics.deviation, problem.max_deviation, LENGTH))
    if problem.max_velocity_variation is not None:
        checks.append(
            at_most("velocity_variation", metrics.velocity_variation, problem.max_velocity_variation, PERCENT)
        )
    if problem.rotation != "any":
        checks.append(Check(name="rotation", passed=(sense > 0) == (problem.rotation == "ccw")))
    pins = [complex(mechanism.joints[name]) for name in mechanism.joints if name not in (*mechanism.links[GROUND], "P")]
    pivots = [complex(mechanism.joints[name]) for name in mechanism.links[GROUND]]
    return [*checks, *constraint_checks(problem.constraints, lengths, pivots, pins, metrics)]


def _sense(mechanism: Mechanism, along: complex) -> int | None:
    """Which way the input turns where P goes forward; None at a toggle."""
    motion = drive(mechanism, mechanism.reference_input[None], order=1)
    forward = (motion.joints["P"][1, 0] * along.conjugate()).real
    return (1 if forward > 0.0 else -1) if motion.smooth[0] and forward != 0.0 else None


def _measured(mechanism: Mechanism, inputs: Real, start: complex, along: complex, sense: int) -> _Along | None:
    """What P does along the line, or None where the mechanism cannot be driven all along it."""
    motion = drive(mechanism, inputs, order=1)
    if not motion.smooth.all():
        return None

    def across(found: MechanismMotion) -> Real:
        return np.asarray(((found.joints["P"][0] - start) * along.conjugate()).imag)

    def velocity(found: MechanismMotion) -> Real:
        return np.asarray(sense * (found.joints["P"][1] * along.conjugate()).real)

    local = (motion.joints["P"][0] - start) * along.conjugate()
    sines = {link: least_of(mechanism, inputs, sine_at(link)(motion), sine_at(link)) for link in motion.sines}
    return _Along(
        extremes_of(mechanism, inputs, across(motion), across),
        extremes_of(mechanism, inputs, velocity(motion), velocity),
        (complex(local[0]), complex(local[-1])),
        float(velocity(motion)[GRID // 2]),
        sines,
        np.concatenate([jet[0] for jet in motion.joints.values()]),
    )


def _whole_turn(mechanism: Mechanism) -> float | None:
    """The least transmission angle over a whole turn of the input, degrees; None where it does not turn through."""
    inputs = float(mechanism.reference_input) + np.linspace(0.0, 2.0 * np.pi, GRID)
    motion = drive(mechanism, inputs, order=1)
    if not motion.smooth.all():
        return None
    least = min(least_of(mechanism, inputs, sine_at(link)(motion), sine_at(link)) for link in motion.sines)
    closed = all(abs(jet[0, -1] - jet[0, 0]) <= REACHED * np.abs(jet[0]).max() for jet in motion.joints.values())
    return math.degrees(math.asin(min(least, 1.0))) if closed and least > NO_TOGGLE else None


def _barker(mechanism: Mechanism) -> tuple[str, str]:
    """Grashof's class and Barker's code of a fourbar."""
    o2, a, b, o4 = (complex(mechanism.joints[name]) for name in ("O2", "A", "B", "O4"))
    row = barker_class(Fourbar(o2, o4, abs(a - o2), abs(b - a), abs(b - o4)))
    return row.motion, row.code


def _lengths(design: LineMechanisms, mechanism: Mechanism) -> list[float]:
    """Lengths of the links, with the ground's where it has two pivots."""
    if isinstance(design, FourbarMechanism):
        return list(design.links.model_dump().values())
    ground = [complex(mechanism.joints[name]) for name in mechanism.links[GROUND]]
    return [*design.links.values(), *(abs(ground[1] - ground[0]) for _ in ground[1:])]
