"""Verify a fourbar that guides a point: drive it to where its coupler point passes each required point.

:mod:`synthesis.kinds.path.verification.passages` finds the inputs; the measurements are the place of P there and, for
fits, the excursion of P between the points (:mod:`synthesis.kinds.path.verification.excursion`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.errors import DimensionError
from kinematics.linkage.fourbar import (
    Fourbar,
    barker_class,
    can_assemble,
    find_transmission_extremes,
    is_same_circuit,
    positions,
    stays_on_branch,
    traverse,
)
from synthesis.kinds.path.design import PathDesign, PathMetrics
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.task.target_curve import MIN_POLYLINE_POINTS
from synthesis.kinds.path.verification.excursion import compute_tolerance_used, compute_two_way_rms, measure_excursion
from synthesis.kinds.path.verification.passages import (
    Passages,
    locate_at_angles,
    locate_at_points,
    locate_in_order,
    locate_nearest,
)
from synthesis.kinds.path.verification.stance import check_stance, measure_stance
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import LENGTH
from synthesis.model.linkage.answer import FourbarMechanism, LinkageMechanism, MultiloopMechanism, Target
from synthesis.model.linkage.conversion import DrivenFourbar, build_driven_fourbar
from synthesis.verification.checks import CHOICE_TOLERANCE, check_error, check_maximum, check_targets_reached
from synthesis.verification.constraints import check_constraints
from synthesis.verification.measures import (
    ROTATING_INPUT_CLASSES,
    Measures,
    list_link_lengths,
    measure_fourbar_reach,
    measure_linkage,
)

ROUNDING_SLACK = 1e-9
"""Distance from a required interval, as a share of its larger end, that counts as rounding."""


class _Motion(NamedTuple):
    """The motion through the targets: inputs in one run, properties of the run, and the used range."""

    angles: Real
    same_branch: bool
    on_circuit: bool
    in_order: bool
    start: float
    end: float


def verify_path(problem: PathProblem, mechanism: FourbarMechanism) -> PathDesign | None:
    """Drive a fourbar past a problem's points and measure it.

    Parameters
    ----------
    problem : PathProblem
        The problem.
    mechanism : FourbarMechanism
        Only the dimensions are used, not the skeleton.

    Returns
    -------
    PathDesign or None
        None if the linkage cannot be assembled, or cannot reach a point.
    """
    try:
        fourbar = build_driven_fourbar(mechanism)
    except DimensionError:
        return None
    linkage = fourbar.linkage
    if not can_assemble(linkage):
        return None
    points = np.array([point.point for point in problem.points])
    passed = _find_passages(problem, fourbar, points)
    if passed is None:
        return None
    way = _compute_motion(linkage, passed)
    barker = barker_class(linkage)
    turns = barker.motion in ROTATING_INPUT_CLASSES
    # Across a toggle there is no single motion; the extreme inputs bound the report.
    used = (way.start, way.end) if way.same_branch else (float(way.angles.min()), float(way.angles.max()))
    if problem.closed and turns:
        # A closed curve is traced by a full turn, not only from its first point to its last.
        used = float(way.angles[0]), float(way.angles[0]) + math.tau
    least = float(find_transmission_extremes(linkage, *used)[0]) if way.same_branch else 0.0
    pivots = [complex(linkage.input_pivot), complex(linkage.output_pivot)]
    joints = np.concatenate([passed.a, passed.b, passed.p, pivots])
    inputs = np.degrees(way.angles)
    # Report angles in the same turn as the mechanism's reference angle.
    inputs += 360.0 * np.round((mechanism.reference_input_angle - inputs[0]) / 360.0)
    away = math.radians(inputs[0]) - float(way.angles[0])
    measures = measure_linkage(
        list_link_lengths(mechanism),
        measure_fourbar_reach(linkage),
        problem.task_size,
        {"coupler": least},
        joints,
        barker=barker,
        same_branch=way.same_branch,
        visits_in_order=way.on_circuit and way.in_order,
        full_rotation=turns,
        used=(used[0] + away, used[1] + away) if way.same_branch else None,
    )
    at_points = AtPoints(inputs, passed.misses, way.on_circuit, pivots, [complex(passed.a[0]), complex(passed.b[0])])
    own = [*_check_coupler_point(problem, linkage), *_check_crank_phase(problem, mechanism, linkage)]

    def evaluate_place(at: Real) -> Complex:
        return np.asarray(positions(linkage, at, fourbar.assembly).p)

    return build_path_design(problem, mechanism, measures, at_points, own, TracedPath(evaluate_place, used))


class AtPoints(NamedTuple):
    """A linkage at the required points.

    Attributes
    ----------
    inputs : float, shape (n,)
        Degrees, in one run.
    misses : float, shape (n,)
        Distances of P from the points, length units.
    on_circuit : bool
        Whether all lie on one circuit.
    fixed_pivots, moving_pivots : list of complex
        The pivots at the first point; the input's fixed pivot comes first.
    """

    inputs: Real
    misses: Real
    on_circuit: bool
    fixed_pivots: list[complex]
    moving_pivots: list[complex]


class TracedPath(NamedTuple):
    """The path of P: its place at inputs (n,), NaN where there is no position; and the used range of inputs.

    The range is a whole cycle for a closed curve, else from the first point to the last, radians.
    """

    place: Callable[[Real], Complex]
    used: tuple[float, float]


def build_path_design(
    problem: PathProblem,
    mechanism: LinkageMechanism,
    measures: Measures,
    at: AtPoints,
    own: list[Check],
    way: TracedPath,
) -> PathDesign:
    """Check a linkage of any type against all constraints and build its design; ``own`` are checks of its type."""
    residuals = at.misses / problem.task_size
    gone: dict[str, float] = {}
    is_multiloop = isinstance(mechanism, MultiloopMechanism)
    if problem.is_fitted:
        points = np.array([point.point for point in problem.points])
        gone = measure_excursion(*way, points, problem.closed, float(at.misses.max()))._asdict()
        # Only a dense polyline defines the curve well enough for the reverse distance.
        if is_multiloop and len(points) >= MIN_POLYLINE_POINTS:
            gone["both_way_rms"] = compute_two_way_rms(*way, points, problem.closed, at.misses)
        checks = _check_tolerances(problem, at, way, points)
        stance = measure_stance(problem, way.place, way.used, np.radians(at.inputs))
        own = [*check_stance(problem, stance), *own]
        gone |= {f"stance_{name}": value for name, value in stance.items()}
    else:
        checks = [check_targets_reached(float(residuals.max()))]
    checks.append(Check(name="same_circuit", passed=at.on_circuit))
    checks += check_constraints(problem.constraints, measures, at.fixed_pivots, at.moving_pivots)
    checks += _check_path_constraints(problem, measures, at.fixed_pivots)
    return PathDesign(
        mechanism=mechanism,
        targets=[
            Target(index=k, input_angle=float(angle), residual=float(residual), point_residual=float(miss))
            for k, (angle, residual, miss) in enumerate(zip(at.inputs, residuals, at.misses, strict=True))
        ],
        verification=Verification.from_checks([*checks, *own]),
        point_link=next(link.name for link in mechanism.skeleton.links if "P" in link.joints) if is_multiloop else None,
        metrics=PathMetrics(
            input_rotation=float(at.inputs[-1] - at.inputs[0]),
            rms_residual=math.sqrt(float(np.mean(residuals**2))),
            sum_of_squares=float(np.sum(at.misses**2)),
            rms_distance=math.sqrt(float(np.mean(at.misses**2))),
            max_distance=float(at.misses.max()),
            **measures.select_fields(PathMetrics),
            **gone,
        ),
    )


def _check_tolerances(problem: PathProblem, at: AtPoints, way: TracedPath, points: Complex) -> list[Check]:
    """Check that the points are within their tolerances of the curve, and the curve within those of its course."""
    widths = problem.tolerances
    if widths is None:
        return []
    along = compute_tolerance_used(*way, points, problem.closed, widths)
    return [
        check_maximum("within_tolerance", float((at.misses / widths).max()), 1.0),
        check_maximum("curve_within_tolerance", along, 1.0),
    ]


def _find_passages(problem: PathProblem, fourbar: DrivenFourbar, points: Complex) -> Passages | None:
    """Find where the linkage meets the points, in the way that the problem requires."""
    if problem.prescribed:
        turns = np.array(problem.crank_turns)
        ways = (turns, -turns) if problem.crank_direction == "either" else (turns,)
        driven = [
            passed
            for way in ways
            if (passed := locate_at_angles(fourbar, points, way, both=not problem.is_fitted)) is not None
        ]
        # Either direction is allowed: take the more accurate one.
        return min(driven, key=lambda passed: float(np.sum(passed.misses**2)), default=None)
    if not problem.is_fitted:
        return locate_at_points(fourbar, points)
    return locate_in_order(fourbar, points) if problem.constraints.in_order else locate_nearest(fourbar, points)


def _compute_motion(linkage: Fourbar, passed: Passages) -> _Motion:
    """Return the motion from the first target to the last."""
    if passed.run:
        steps = np.diff(passed.angles)
        low, high = float(passed.angles.min()), float(passed.angles.max())
        one_way = bool(np.all(steps >= 0.0) or np.all(steps <= 0.0)) and high - low <= math.tau * (1.0 + ROUNDING_SLACK)
        on_branch = bool(stays_on_branch(linkage, low, high))
        angles, start, end, ordered = passed.angles, low, high, one_way
    else:
        way = traverse(linkage, passed.angles, passed.assemblies)
        angles, start, end, on_branch, ordered = way.angles, way.start, way.end, way.same_branch, way.in_order
    # A branch is part of a circuit; the converse needs the closed-form test.
    on_circuit = on_branch or bool(
        np.all(is_same_circuit(linkage, passed.angles[0], passed.assemblies[0], passed.angles, passed.assemblies))
    )
    return _Motion(angles, on_branch, on_circuit, ordered and (on_branch or not passed.run), start, end)


def _check_path_constraints(problem: PathProblem, measures: Measures, pivots: list[complex]) -> list[Check]:
    """Check the constraints specific to path generation: pivots, a closed path, and the lengths for a curve."""
    checks = []
    limits = problem.constraints
    if limits.input_pivot_region is not None:
        checks.append(Check(name="input_pivot_region", passed=limits.input_pivot_region.contains(pivots[0])))
    if problem.fixed_pivots.count_given():
        gap = 0.0
        for pivot, stated in zip(pivots, (problem.fixed_pivots.input, problem.fixed_pivots.output), strict=False):
            for value, wanted in zip((pivot.real, pivot.imag), stated or (None, None), strict=True):
                gap = gap if wanted is None else max(gap, abs(value - wanted) / problem.task_size)
        checks.append(check_error("fixed_pivots", gap, CHOICE_TOLERANCE))
    if problem.closed and not limits.full_rotation:
        checks.append(Check(name="full_rotation", passed=measures.full_rotation))
    if problem.is_matched and (limits.link_length is None or limits.link_length.max is None):
        checks.append(check_maximum("longest_link", max(measures.lengths), problem.longest_link, LENGTH))
    return checks


def _check_coupler_point(problem: PathProblem, linkage: Fourbar) -> list[Check]:
    """Check that P lies in its allowed area of the coupler."""
    limits, point = problem.constraints.coupler_point, complex(linkage.coupler_point)
    if limits is None:
        return []
    places = (point.real, limits.along), (point.imag, limits.across)
    inside = all(interval is None or _is_within(value, interval) for value, interval in places)
    return [Check(name="coupler_point", passed=inside)]


def _check_crank_phase(problem: PathProblem, mechanism: FourbarMechanism, linkage: Fourbar) -> list[Check]:
    """Check that the crank has its prescribed angle at the first point."""
    if problem.crank_phase == "free":
        return []
    stands, wanted = mechanism.reference_input_angle, problem.points[0].crank_angle or 0.0
    if problem.crank_phase == "ground_line":
        stands -= math.degrees(float(linkage.ground_angle))
    signs = (1.0, -1.0) if problem.crank_direction == "either" else (1.0,)
    gap = min(abs(math.radians(math.remainder(stands - sign * wanted, 360.0))) for sign in signs)
    return [check_error("crank_phase", gap, CHOICE_TOLERANCE)]


def _is_within(value: float, interval: tuple[float, float]) -> bool:
    slack = ROUNDING_SLACK * max(abs(interval[0]), abs(interval[1]))
    return interval[0] - slack <= value <= interval[1] + slack
