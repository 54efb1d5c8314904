"""Verify a straight-line mechanism: drive it along its line, and measure the motion of P.

The mechanism stands at the line's start; its input turns by the given range in the direction that moves P forward.
Deviation and velocity are evaluated on a grid, and their extremes refined.
"""

from __future__ import annotations

import cmath
import math
from functools import partial
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.linkage.refined_extremes import (
    GRID_SIZE,
    find_extremes,
    find_min_transmission_angles,
    list_full_turn,
)
from synthesis.kinds.straight_line.design import ExactLineMechanism, LinePoint, StraightLineDesign, StraightLineMetrics
from synthesis.kinds.straight_line.problem import LineMechanism, StraightLineProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import LENGTH, PERCENT
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.verification.checks import check_error, check_maximum
from synthesis.verification.constraints import check_constraints
from synthesis.verification.measures import (
    Measures,
    classify_fourbar,
    list_fixed_pivots,
    list_link_lengths,
    list_moving_pivots,
    measure_linkage,
    measure_reach,
)
from synthesis.verification.reconstruction import rebuild_mechanism

REACH_TOLERANCE = 1e-9
"""Maximum distance of P from the ends of the line, along it, and from an exact line: a share of the length."""

ROUNDING_ALLOWANCE = 64.0 * float(np.finfo(np.float64).eps)
"""Additional allowance for rounding, as a share of the largest coordinate, because mechanisms far from the origin lose
digits."""

MIN_TOGGLE_SINE = 1e-6
"""Minimum sine of a transmission angle at which the mechanism still moves in a defined direction."""

LineMechanisms = FourbarMechanism | ExactLineMechanism


class _LineMeasurement(NamedTuple):
    """Motion along the line: places of P, and the extremes of its distance from the line and its velocity along it."""

    across: tuple[float, float]
    velocity: tuple[float, float]
    ends: tuple[complex, complex]
    middle_velocity: float
    transmission: dict[str, float]
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
        The problem.
    design : FourbarMechanism or ExactLineMechanism
        Dimensions; a fourbar's skeleton is not used.
    family, proportions
        Type of the design, as reported in its metrics; the family's usual range is the default.

    Returns
    -------
    StraightLineDesign or None
        None if the mechanism cannot be driven through the range.
    """
    mechanism = rebuild_mechanism(design)
    if mechanism is None:
        return None
    span = math.radians(problem.get_range(family))
    start, along = complex(*problem.start), cmath.exp(1j * math.radians(problem.direction))
    sense = _find_sense(mechanism, along)
    if sense is None:
        return None
    inputs = float(mechanism.reference_input) + sense * span * np.linspace(0.0, 1.0, GRID_SIZE)
    driven = _drive_along_line(mechanism, inputs, start, along, sense)
    if driven is None:
        return None
    length = problem.length
    travelled = driven.ends[1].real - driven.ends[0].real
    # P must have advanced, or the mean velocity is undefined.
    if not travelled > 0.0:
        return None
    mean = travelled / span
    whole = _measure_full_turn(mechanism)
    measures = measure_linkage(
        _list_lengths(design, mechanism),
        measure_reach(mechanism),
        length,
        driven.transmission,
        driven.joints,
        barker=classify_fourbar(mechanism) if isinstance(design, FourbarMechanism) else None,
        same_branch=min(driven.transmission.values()) > MIN_TOGGLE_SINE,
        visits_in_order=driven.velocity[0] > 0.0,
        full_rotation=whole is not None,
        used=(float(inputs[0]), float(inputs[-1])),
    )
    metrics = StraightLineMetrics(
        family=family,
        proportions=proportions,
        deviation=max(abs(x) for x in driven.across),
        straightness_error=100.0 * (driven.across[1] - driven.across[0]) / length,
        velocity_variation=100.0 * (driven.velocity[1] - driven.velocity[0]) / mean,
        mean_velocity=mean,
        middle_velocity=driven.middle_velocity,
        input_rotation=math.degrees(sense * span),
        moving_links=len(mechanism.links) - 1,
        runs_on_slide=bool(mechanism.slides),
        cycle_transmission_angle=whole,
        **measures.select_fields(StraightLineMetrics),
    )
    checks = _check_design(problem, driven, metrics, sense, mechanism, measures)
    return StraightLineDesign(
        mechanism=design,
        targets=_list_ends(driven, inputs, start, along),
        verification=Verification.from_checks(checks),
        metrics=metrics,
    )


def _list_ends(driven: _LineMeasurement, inputs: Real, start: complex, along: complex) -> list[LinePoint]:
    """Return both ends of the line as reported; ``start`` and ``along`` place it in the problem's plane."""
    places = [start + along * local for local in driven.ends]
    return [
        LinePoint(index=k, input_angle=math.degrees(at), x=place.real, y=place.imag, deviation=abs(local.imag))
        for k, (at, local, place) in enumerate(zip(inputs[[0, -1]].tolist(), driven.ends, places, strict=True))
    ]


def _check_design(
    problem: StraightLineProblem,
    driven: _LineMeasurement,
    metrics: StraightLineMetrics,
    sense: int,
    mechanism: Mechanism,
    measures: Measures,
) -> list[Check]:
    length = problem.length
    limit = REACH_TOLERANCE + ROUNDING_ALLOWANCE * float(np.abs(driven.joints).max()) / length
    gap = max(abs(driven.ends[0].real), abs(driven.ends[1].real - length)) / length
    checks = [check_error("reaches_ends", gap, limit)]
    # An exact mechanism may deviate by rounding only.
    if metrics.proportions == "exact":
        off = metrics.deviation / length
        checks.append(check_error("exact_line", off, limit))
    if problem.max_deviation is not None:
        checks.append(check_maximum("deviation", metrics.deviation, problem.max_deviation, LENGTH))
    if problem.max_velocity_variation is not None:
        checks.append(
            check_maximum("velocity_variation", metrics.velocity_variation, problem.max_velocity_variation, PERCENT)
        )
    if problem.rotation != "any":
        checks.append(Check(name="rotation", passed=(sense > 0) == (problem.rotation == "ccw")))
    return [
        *checks,
        *check_constraints(problem.constraints, measures, list_fixed_pivots(mechanism), list_moving_pivots(mechanism)),
    ]


def _find_sense(mechanism: Mechanism, along: complex) -> int | None:
    """Return the direction in which the input turns while P goes forward; None at a toggle."""
    motion = drive(mechanism, mechanism.reference_input[None], order=1)
    # First derivative of P by the input, along the line.
    forward = (motion.joints["P"][1, 0] * along.conjugate()).real
    return (1 if forward > 0.0 else -1) if motion.smooth[0] and forward != 0.0 else None


def _drive_along_line(
    mechanism: Mechanism, inputs: Real, start: complex, along: complex, sense: int
) -> _LineMeasurement | None:
    """Measure the motion of P along the line; None if the mechanism cannot be driven over its whole length."""
    motion = drive(mechanism, inputs, order=1)
    if not motion.smooth.all():
        return None

    def measure_offset(motion: MechanismMotion) -> Real:
        return np.asarray(((motion.joints["P"][0] - start) * along.conjugate()).imag)

    def measure_velocity(motion: MechanismMotion) -> Real:
        return np.asarray(sense * (motion.joints["P"][1] * along.conjugate()).real)

    local = (motion.joints["P"][0] - start) * along.conjugate()
    return _LineMeasurement(
        find_extremes(mechanism, inputs, measure_offset(motion), measure_offset),
        find_extremes(mechanism, inputs, measure_velocity(motion), measure_velocity),
        (complex(local[0]), complex(local[-1])),
        float(measure_velocity(motion)[GRID_SIZE // 2]),
        find_min_transmission_angles(partial(drive, mechanism, order=0), inputs, motion),
        np.concatenate([jet[0] for jet in motion.joints.values()]),
    )


def _measure_full_turn(mechanism: Mechanism) -> float | None:
    """Return the minimum transmission angle over a full turn, degrees; None if the input cannot make a full turn."""
    inputs = list_full_turn(float(mechanism.reference_input))
    motion = drive(mechanism, inputs, order=1)
    if not motion.smooth.all():
        return None
    least = min(find_min_transmission_angles(partial(drive, mechanism, order=0), inputs, motion).values())
    # A linkage may return in another assembly after one turn of its input.
    closed = all(
        abs(jet[0, -1] - jet[0, 0]) <= REACH_TOLERANCE * np.abs(jet[0]).max() for jet in motion.joints.values()
    )
    return math.degrees(least) if closed and least > MIN_TOGGLE_SINE else None


def _list_lengths(design: LineMechanisms, mechanism: Mechanism) -> list[float]:
    """Return the lengths of the links, including the ground if it has two pivots."""
    lengths = list_link_lengths(design)
    if isinstance(design, FourbarMechanism):
        return lengths
    return [*lengths, *(abs(after - before) for before, after in pairwise(list_fixed_pivots(mechanism)))]
