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

from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.kinds.straight_line.design import ExactLineMechanism, LinePoint, StraightLineDesign, StraightLineMetrics
from synthesis.kinds.straight_line.problem import LineMechanism, StraightLineProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import LENGTH, PERCENT
from synthesis.model.linkage_answer import FourbarMechanism
from synthesis.proof.checks import at_most, tolerated
from synthesis.proof.closer import GRID, extremes_of, least_angles, turn_from
from synthesis.proof.constraints import constraint_checks
from synthesis.proof.measures import Measures, barker_of, fixed_pivots, link_lengths, measured, moving_pivots, reach_of
from synthesis.proof.rebuilt import rebuilt

Real = NDArray[np.float64]

REACHED = 1e-9
"""Maximum distance of P from the ends of the line, along it, and from an exact line: a share of the length."""

ROUNDING = 64.0 * float(np.finfo(np.float64).eps)
"""Allowance for rounding in addition, as a share of the largest coordinate: mechanisms far from the origin lose
digits."""

NO_TOGGLE = 1e-6
"""Minimum sine of a transmission angle at which the mechanism still moves in a defined direction."""

LineMechanisms = FourbarMechanism | ExactLineMechanism


class _Along(NamedTuple):
    """The motion along the line: extremes of the distance across it and of the velocity along it, and places."""

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
    mechanism = rebuilt(design)
    if mechanism is None:
        return None
    span = math.radians(problem.range_of(family))
    start, along = complex(*problem.start), cmath.exp(1j * math.radians(problem.direction))
    sense = _sense(mechanism, along)
    if sense is None:
        return None
    inputs = float(mechanism.reference_input) + sense * span * np.linspace(0.0, 1.0, GRID)
    driven = _driven(mechanism, inputs, start, along, sense)
    if driven is None:
        return None
    length = problem.length
    travelled = driven.ends[1].real - driven.ends[0].real
    # P must have advanced, or the mean velocity is undefined.
    if not travelled > 0.0:
        return None
    mean = travelled / span
    whole = _whole_turn(mechanism)
    measures = measured(
        _lengths(design, mechanism),
        reach_of(mechanism),
        length,
        driven.transmission,
        driven.joints,
        barker=barker_of(mechanism) if isinstance(design, FourbarMechanism) else None,
        same_branch=min(driven.transmission.values()) > NO_TOGGLE,
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
        cycle_transmission_angle=whole,
        **measures.within(StraightLineMetrics),
    )
    checks = _checks(problem, driven, metrics, sense, mechanism, measures)
    return StraightLineDesign(
        mechanism=design,
        targets=[
            LinePoint(index=k, input_angle=math.degrees(at), x=place.real, y=place.imag, deviation=abs(local.imag))
            for k, (at, local) in enumerate(zip(inputs[[0, -1]].tolist(), driven.ends, strict=True))
            for place in [start + along * local]
        ],
        verification=Verification.of(checks),
        metrics=metrics,
    )


def _checks(
    problem: StraightLineProblem,
    driven: _Along,
    metrics: StraightLineMetrics,
    sense: int,
    mechanism: Mechanism,
    measures: Measures,
) -> list[Check]:
    length = problem.length
    limit = REACHED + ROUNDING * float(np.abs(driven.joints).max()) / length
    gap = max(abs(driven.ends[0].real), abs(driven.ends[1].real - length)) / length
    checks = [tolerated("reaches_ends", gap, limit)]
    # An exact mechanism may deviate by rounding only.
    if metrics.proportions == "exact":
        off = metrics.deviation / length
        checks.append(tolerated("exact_line", off, limit))
    if problem.max_deviation is not None:
        checks.append(at_most("deviation", metrics.deviation, problem.max_deviation, LENGTH))
    if problem.max_velocity_variation is not None:
        checks.append(
            at_most("velocity_variation", metrics.velocity_variation, problem.max_velocity_variation, PERCENT)
        )
    if problem.rotation != "any":
        checks.append(Check(name="rotation", passed=(sense > 0) == (problem.rotation == "ccw")))
    return [
        *checks,
        *constraint_checks(problem.constraints, measures, fixed_pivots(mechanism), moving_pivots(mechanism)),
    ]


def _sense(mechanism: Mechanism, along: complex) -> int | None:
    """Return the direction in which the input turns while P goes forward; None at a toggle."""
    motion = drive(mechanism, mechanism.reference_input[None], order=1)
    # First derivative of P by the input, along the line.
    forward = (motion.joints["P"][1, 0] * along.conjugate()).real
    return (1 if forward > 0.0 else -1) if motion.smooth[0] and forward != 0.0 else None


def _driven(mechanism: Mechanism, inputs: Real, start: complex, along: complex, sense: int) -> _Along | None:
    """Measure the motion of P along the line; None if the mechanism cannot be driven all along it."""
    motion = drive(mechanism, inputs, order=1)
    if not motion.smooth.all():
        return None

    def across(motion: MechanismMotion) -> Real:
        return np.asarray(((motion.joints["P"][0] - start) * along.conjugate()).imag)

    def velocity(motion: MechanismMotion) -> Real:
        return np.asarray(sense * (motion.joints["P"][1] * along.conjugate()).real)

    local = (motion.joints["P"][0] - start) * along.conjugate()
    return _Along(
        extremes_of(mechanism, inputs, across(motion), across),
        extremes_of(mechanism, inputs, velocity(motion), velocity),
        (complex(local[0]), complex(local[-1])),
        float(velocity(motion)[GRID // 2]),
        least_angles(partial(drive, mechanism, order=0), inputs, motion),
        np.concatenate([jet[0] for jet in motion.joints.values()]),
    )


def _whole_turn(mechanism: Mechanism) -> float | None:
    """Return the minimum transmission angle over a full turn of the input, degrees; None if it does not turn
    through."""
    inputs = turn_from(float(mechanism.reference_input))
    motion = drive(mechanism, inputs, order=1)
    if not motion.smooth.all():
        return None
    least = min(least_angles(partial(drive, mechanism, order=0), inputs, motion).values())
    # A linkage may return in another assembly after one turn of its input.
    closed = all(abs(jet[0, -1] - jet[0, 0]) <= REACHED * np.abs(jet[0]).max() for jet in motion.joints.values())
    return math.degrees(least) if closed and least > NO_TOGGLE else None


def _lengths(design: LineMechanisms, mechanism: Mechanism) -> list[float]:
    """Return the lengths of the links, with the ground's if it has two pivots."""
    lengths = link_lengths(design)
    if isinstance(design, FourbarMechanism):
        return lengths
    return [*lengths, *(abs(after - before) for before, after in pairwise(fixed_pivots(mechanism)))]
