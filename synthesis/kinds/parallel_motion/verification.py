"""Verify a parallel motion: drive the sixbar from its skeleton, and measure the body's rotation.

P is compared with the curve of the given fourbar without driving that fourbar: a point is on the curve if the coupler,
placed with A on the input's circle and P on the point, has B at the output's length from O4.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.linkage.refined_extremes import GRID_SIZE, find_min_transmission_angles, list_full_turn
from synthesis.analyses.linkages.cycle import find_cycle
from synthesis.kinds.parallel_motion.design import ParallelMotionDesign, ParallelMotionMechanism, ParallelMotionMetrics
from synthesis.kinds.parallel_motion.problem import ParallelMotionProblem, SourceLinkage
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.model.answer import Check, Verification
from synthesis.model.linkage.answer import Target
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.verification.checks import check_error
from synthesis.verification.constraints import check_constraints
from synthesis.verification.measures import (
    ROTATING_INPUT_CLASSES,
    classify_fourbar,
    list_fixed_pivots,
    list_link_lengths,
    list_moving_pivots,
    measure_diagonal,
    measure_linkage,
    measure_reach,
)
from synthesis.verification.reconstruction import rebuild_mechanism

TRANSLATION_TOLERANCE = 1e-9
"""Maximum rotation of the body, radians, and maximum distance of P from the curve, as a share of the curve's size."""

ROUNDING_ALLOWANCE = 64.0 * float(np.finfo(np.float64).eps)
"""Additional allowance for rounding, to be multiplied by the largest coordinate over the body's length or the curve's
size."""

MIN_TOGGLE_SINE = 1e-6
"""Minimum sine of a transmission angle at which the mechanism still moves in a defined direction."""

TOGGLE_MARGIN_SHARE = 0.01
"""Share of the range of an input between toggles that is left out at each toggle."""


class _PathVerification(NamedTuple):
    """Verification results of the fourbar itself, for problems with a path."""

    checks: list[Check]
    targets: list[Target]
    rotation: float
    rms: float


def verify_parallel_motion(
    problem: ParallelMotionProblem,
    design: ParallelMotionMechanism,
    base: Literal["source", "left_cognate", "right_cognate", "path"],
    input_side: Literal["input", "output"],
) -> ParallelMotionDesign | None:
    """Drive a sixbar and measure whether its body translates along the curve of a problem.

    Parameters
    ----------
    problem : ParallelMotionProblem
        The problem.
    design : ParallelMotionMechanism
        Dimensions.
    base, input_side
        Origin of the design, as reported in its metrics.

    Returns
    -------
    ParallelMotionDesign or None
        None if the mechanism cannot be driven.
    """
    mechanism = rebuild_mechanism(design)
    if mechanism is None:
        return None
    path = _verify_path(problem, mechanism)
    if problem.path is not None and path is None:
        return None
    turns = classify_fourbar(mechanism).motion in ROTATING_INPUT_CLASSES
    inputs = _list_inputs(mechanism, None if turns or path is None else path.rotation, turns=turns)
    motion = drive(mechanism, inputs, order=1)
    if not motion.smooth.all():
        return None
    p, q = motion.joints["P"][0], motion.joints["Q"][0]
    translation = complex(q[0] - p[0])
    curve_size = measure_diagonal(p)
    joints = np.concatenate([jet[0] for jet in motion.joints.values()])
    rounding = ROUNDING_ALLOWANCE * float(np.abs(joints).max())
    rotation = _measure_rotation(motion.angles["body"][0])
    transmission = find_min_transmission_angles(partial(drive, mechanism, order=0), inputs, motion)
    off_curve = None if problem.linkage is None else float(_measure_curve_distance(problem.linkage, p).max())
    measures = measure_linkage(
        list_link_lengths(design),
        measure_reach(mechanism),
        curve_size if problem.path is None else problem.path.task_size,
        transmission,
        joints,
        barker=classify_fourbar(mechanism),
        same_branch=min(transmission.values()) > MIN_TOGGLE_SINE and (path is None or _has_passed(path, "same_branch")),
        visits_in_order=path is None or _has_passed(path, "visits_in_order"),
        full_rotation=turns,
        used=(float(inputs[0]), float(inputs[-1])),
    )
    metrics = ParallelMotionMetrics(
        input_rotation=math.degrees(float(inputs[-1] - inputs[0])),
        rms_residual=0.0 if path is None else path.rms,
        base=base,
        input_side=input_side,
        rotation=math.degrees(rotation),
        translation=(translation.real, translation.imag),
        curve_distance=off_curve,
        input_range=(math.degrees(float(inputs[0])), math.degrees(float(inputs[-1]))),
        **measures.select_fields(ParallelMotionMetrics),
    )
    checks = [check_error("translates", rotation, TRANSLATION_TOLERANCE + rounding / abs(translation))]
    if off_curve is not None:
        checks.append(_check_curve(off_curve, curve_size, rounding))
    fixed, moving = list_fixed_pivots(mechanism), list_moving_pivots(mechanism)
    constraints = check_constraints(problem.constraints, measures, fixed, moving)
    checks = _merge_checks([*checks, *([] if path is None else path.checks)], constraints)
    return ParallelMotionDesign(
        mechanism=design,
        targets=[] if path is None else path.targets,
        verification=Verification.from_checks(checks),
        metrics=metrics,
    )


def _check_curve(distance: float, size: float, rounding: float) -> Check:
    """Check the maximum distance of P from the curve; ``size`` is the curve's, ``rounding`` a length."""
    limit = TRANSLATION_TOLERANCE + rounding / size
    return Check(name="on_curve", passed=distance <= limit * size, value=distance / size, limit=limit)


def _measure_rotation(angles: Real) -> float:
    """Return the largest rotation from the first angle, radians, modulo full turns."""
    return float(np.abs(np.angle(np.exp(1j * (angles - angles[0])))).max())


def _merge_checks(checks: list[Check], constraints: list[Check]) -> list[Check]:
    """Report checks that both lists contain once, as failed if either fails."""
    own = {check.name: check for check in constraints}
    kept = [check for check in checks if not check.passed or check.name not in own]
    return kept + [check for name, check in own.items() if name not in {check.name for check in kept}]


def _verify_path(problem: ParallelMotionProblem, mechanism: Mechanism) -> _PathVerification | None:
    """Drive the fourbar of the sixbar past the points of the requested path."""
    if problem.path is None:
        return None
    configuration = FourbarConfiguration(*(complex(mechanism.joints[name]) for name in ("O2", "A", "B", "O4", "P")))
    driven = verify_path(problem.path, build_fourbar(configuration))
    if driven is None:
        return None
    metrics = driven.metrics
    assert metrics.input_rotation is not None, "the input of a fourbar turns"
    return _PathVerification(
        driven.verification.checks, driven.targets, math.radians(metrics.input_rotation), metrics.rms_residual
    )


def _has_passed(path: _PathVerification, name: str) -> bool:
    """Return whether a check of the path passed, or is not part of it."""
    return all(check.passed for check in path.checks if check.name == name)


def _list_inputs(mechanism: Mechanism, rotation: float | None, *, turns: bool) -> Real:
    """Return the inputs of the range: a full turn, the path's rotation, or almost from toggle to toggle."""
    at = float(mechanism.reference_input)
    if turns:
        return list_full_turn(at)
    if rotation is not None:
        return np.asarray(np.linspace(at, at + rotation, GRID_SIZE))
    fourbar = Mechanism(
        {name: mechanism.joints[name] for name in ("O2", "O4", "A", "B")},
        {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B"), "output": ("O4", "B")},
        "input",
    )
    # The toggles are those of the fourbar; the guide and the body follow.
    low, high = find_cycle(fourbar)
    spare = TOGGLE_MARGIN_SHARE * (high - low)
    return np.asarray(np.linspace(low + spare, high - spare, GRID_SIZE))


def _measure_curve_distance(linkage: SourceLinkage, points: Complex) -> Real:
    """Return the approximate distance of points from a fourbar's coupler curve.

    It is the distance of B from the output's circle, with A on the input's circle and P on the point.
    """
    o2, o4 = complex(*linkage.fixed_pivots.input), complex(*linkage.fixed_pivots.output)
    a, b, c = linkage.links.input, linkage.links.coupler, linkage.links.output
    arm = linkage.coupler_point.distance * np.exp(1j * math.radians(linkage.coupler_point.angle))
    reach = points - o2
    # Avoid a division by zero at a point on the input's pivot.
    f = np.maximum(np.abs(reach), np.finfo(np.float64).tiny)
    cosine = np.clip((a * a + f * f - abs(arm) ** 2) / (2.0 * a * f), -1.0, 1.0)
    misses = []
    for side in (1.0, -1.0):
        pin = o2 + a * reach / f * (cosine + 1j * side * np.sqrt(1.0 - cosine**2))
        turned = (points - pin) / arm
        # Either assembly of the coupler may pass the point.
        misses.append(np.abs(np.abs(pin + b * turned - o4) - c))
    return np.asarray(np.minimum(*misses))
