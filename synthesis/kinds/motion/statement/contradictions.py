"""Contradictions of a motion problem: errors that involve more than one field.

The model of the problem imports this module, so that here it is imported for type checkers only.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from kinematics.message import compose
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices, to_complete_point
from synthesis.kinds.motion.statement.mechanism_types import find_motion_sixbar_contradictions
from synthesis.kinds.motion.statement.positions import MAX_EXACT_POSITIONS
from synthesis.model.problem import Contradiction, PartialPoint

if TYPE_CHECKING:
    from synthesis.kinds.motion.problem import MotionProblem

MIN_DISPLACEMENT = 1e-12
"""Minimum distance, in length units, between positions that differ; smaller motions indicate a wrong unit."""

EQUALITY_TOLERANCE = 1e-9
"""Tolerance for equal positions, as a share of the largest coordinate and in radians.

Double precision keeps about 1e-16 of the largest coordinate, so a displacement below 1e-9 of it has lost
half its digits, and no residual of 1e-9 could be verified for it."""

PARALLEL_TOLERANCE = 1e-9
"""Tolerance for lines parallel to an axis: the component of their unit vector across that axis."""

ON_LINE_TOLERANCE = 1e-9
"""Tolerance for a given pivot on a given line, as a share of the task's size; it covers rounding."""


def list_contradictions(problem: MotionProblem) -> list[Contradiction]:
    """Return all contradictions of a problem: equal positions, too many or conflicting choices, sides and pivots."""
    return [
        *_check_equal_positions(problem),
        *_check_exact_tolerances(problem),
        *_check_exact_count(problem),
        *_check_fit_choices(problem),
        *_check_tolerated_choices(problem),
        *_check_slider_choices(problem),
        *_check_free_choices(problem),
        *_check_coinciding_pivots(problem),
        *_check_ground_line(problem),
        *_check_pivot_regions(problem),
        *_check_slider_class(problem),
        *find_motion_sixbar_contradictions(problem),
        *problem.find_contradicting_constraints(),
        *_check_workspace(problem),
    ]


def _check_equal_positions(problem: MotionProblem) -> list[Contradiction]:
    size = max(max(abs(p.x), abs(p.y)) for p in problem.positions)
    moved = max(abs(p.point - q.point) for p in problem.positions for q in problem.positions)
    if 0.0 < moved < MIN_DISPLACEMENT:
        return [
            Contradiction(
                "/positions",
                compose("motion-positions-nearly-equal", distance=f"{MIN_DISPLACEMENT}", unit=problem.length_unit),
            )
        ]
    contradictions = []
    for k, later in enumerate(problem.positions):
        for j, earlier in enumerate(problem.positions[:k]):
            turn = math.remainder(later.angle - earlier.angle, 360.0)
            near = abs(later.point - earlier.point) <= EQUALITY_TOLERANCE * size
            if near and abs(math.radians(turn)) <= EQUALITY_TOLERANCE:
                contradictions.append(Contradiction(f"/positions/{k}", compose("motion-position-repeated", position=j)))
    return contradictions


def _check_workspace(problem: MotionProblem) -> list[Contradiction]:
    if problem.space is None:
        return []
    held = [k for k, limits in enumerate(problem.limits) if limits == (0.0, 0.0, 0.0)]
    if 0 not in held:
        return []
    faults: list[Contradiction] = problem.space.find_body_collisions(*problem.list_poses(held))
    return faults


def _check_exact_tolerances(problem: MotionProblem) -> list[Contradiction]:
    return [
        Contradiction(f"/positions/{k}/exact", compose("motion-exact-position-with-tolerance"))
        for k, position in enumerate(problem.positions)
        if position.exact and position.tolerance is not None
    ]


def _check_exact_count(problem: MotionProblem) -> list[Contradiction]:
    if problem.method == "exact" and len(problem.positions) > MAX_EXACT_POSITIONS and not problem.approximate:
        return [
            Contradiction("/method", compose("motion-method-exact-too-many-positions", maximum=MAX_EXACT_POSITIONS))
        ]
    if problem.method == "least_squares" and not (problem.approximate or problem.has_few_tolerances):
        detail = compose("motion-too-few-positions-to-fit")
        return [Contradiction("/method", detail)]
    held = [k for k, limits in enumerate(problem.limits) if limits == (0.0, 0.0, 0.0)]
    if len(held) > MAX_EXACT_POSITIONS:
        detail = compose("motion-too-many-exact-positions", maximum=MAX_EXACT_POSITIONS)
        return [Contradiction(f"/positions/{held[MAX_EXACT_POSITIONS]}", detail)]
    return []


def _check_tolerated_choices(problem: MotionProblem) -> list[Contradiction]:
    """Return the choices that conflict with tolerances: link rotations, and a link angle at a tolerated first position.

    A position with a tolerance is met at the point of closest approach, for any rotation of the links.
    """
    contradictions = []
    for name, side in (("input_side", problem.input_side), ("output_side", problem.output_side)):
        if not problem.has_few_tolerances:
            break
        if any(rotation is not None for rotation in side.rotations or []):
            detail = compose("motion-rotations-need-exact-positions")
            contradictions.append(Contradiction(f"/{name}/rotations", detail))
        if side.link_angle is not None and problem.positions[0].tolerance is not None:
            detail = compose("motion-link-angle-needs-exact-position")
            contradictions.append(Contradiction(f"/{name}/link_angle", detail))
    return contradictions


def _check_fit_choices(problem: MotionProblem) -> list[Contradiction]:
    """Return the choices that a fit does not support: it takes one pivot (or Z) of a side, and a slider's angle."""
    contradictions = []
    for name, side in (("input_side", problem.input_side), ("output_side", problem.output_side)):
        if not problem.approximate:
            break
        vector = side.coupler_vector
        if side.rotations is not None or side.link_angle is not None:
            field = "link_angle" if side.rotations is None else "rotations"
            contradictions.append(Contradiction(f"/{name}/{field}", compose("motion-not-with-fitted-positions")))
        if vector is not None and (vector.length is None or vector.angle is None):
            contradictions.append(Contradiction(f"/{name}/coupler_vector", compose("motion-fitted-vector-incomplete")))
        if side.fixed_pivot is not None and (side.moving_pivot is not None or vector is not None):
            contradictions.append(Contradiction(f"/{name}", compose("motion-fitted-side-two-pivots")))
        contradictions += _check_partial_pivots(name, side, "motion-fitted-pivot-incomplete")
    if problem.approximate and problem.ground_line is not None:
        contradictions.append(Contradiction("/ground_line", compose("motion-not-with-fitted-positions")))
    return contradictions


def _check_partial_pivots(name: str, side: DyadChoices, message_id: str) -> list[Contradiction]:
    return [
        Contradiction(f"/{name}/{field}", compose(message_id))
        for field, pivot in (("fixed_pivot", side.fixed_pivot), ("moving_pivot", side.moving_pivot))
        if pivot is not None and to_complete_point(pivot) is None
    ]


def _check_slider_choices(problem: MotionProblem) -> list[Contradiction]:
    """Return the choices that a slider lacks: it has one pivot, no link, and one free choice less than an RR dyad."""
    contradictions = []
    sides = ("input_side", problem.input_side), ("output_side", problem.output_side)
    for name, side in sides:
        if side.slide_angle is not None and side.dyad not in ("PR", "RP"):
            contradictions.append(Contradiction(f"/{name}/slide_angle", compose("motion-slide-angle-without-slider")))
        if side.dyad not in ("PR", "RP"):
            continue
        absent = ["link_angle", "rotations"]
        absent += ["fixed_pivot"] if side.dyad == "PR" else ["moving_pivot", "coupler_vector"]
        for field in absent:
            if getattr(side, field) is not None:
                contradictions.append(Contradiction(f"/{name}/{field}", compose("motion-not-for-dyad", dyad=side.dyad)))
        contradictions += _check_partial_pivots(name, side, "motion-slider-pivot-incomplete")
        if problem.ground_line is not None:
            contradictions.append(Contradiction("/ground_line", compose("motion-ground-line-with-slider")))
        free = max(4 - len(problem.positions), 0)
        if not problem.approximate and side.count() > free and not side.is_one_pivot:
            detail = compose(
                "motion-slider-overdetermined", fixed=side.count(), positions=len(problem.positions), free=free
            )
            contradictions.append(Contradiction(f"/{name}", detail))
    if problem.driver is not None and any(side.dyad in ("PR", "RP") for _, side in sides):
        contradictions.append(Contradiction("/driver_dyad", compose("motion-driver-with-slider")))
    if problem.input_side.dyad == "RP":
        contradictions.append(Contradiction("/input_side/dyad", compose("motion-driven-block")))
    if all(side.dyad in ("PR", "RP") for _, side in sides):
        contradictions.append(Contradiction("/output_side/dyad", compose("motion-two-sliders")))
    return contradictions


def _check_slider_class(problem: MotionProblem) -> list[Contradiction]:
    if all(side.dyad not in ("PR", "RP") for side in (problem.input_side, problem.output_side)):
        return []
    faults: list[Contradiction] = problem.constraints.find_class_contradictions((), compose("motion-class-with-slider"))
    return faults


def _check_free_choices(problem: MotionProblem) -> list[Contradiction]:
    free = 5 - len(problem.positions)
    contradictions = []
    for name, side in (("input_side", problem.input_side), ("output_side", problem.output_side)):
        if problem.approximate or side.dyad in ("PR", "RP"):
            continue
        if side.rotations is not None and len(side.rotations) != len(problem.positions) - 1:
            contradictions.append(
                Contradiction(
                    f"/{name}/rotations",
                    compose(
                        "motion-rotations-miscounted", expected=len(problem.positions) - 1, given=len(side.rotations)
                    ),
                )
            )
        if side.moving_pivot is not None and side.coupler_vector is not None:
            contradictions.append(Contradiction(f"/{name}/coupler_vector", compose("motion-coupler-vector-with-pivot")))
        elif side.count() > free and not (len(problem.positions) > 3 and side.is_one_pivot):
            contradictions.append(
                Contradiction(
                    f"/{name}",
                    compose(
                        "motion-side-overdetermined-pivot-possible"
                        if len(problem.positions) > 3
                        else "motion-side-overdetermined",
                        fixed=side.count(),
                        positions=len(problem.positions),
                        free=free,
                    ),
                )
            )
        elif problem.ground_line is not None and to_complete_point(side.fixed_pivot) is None and side.count() >= free:
            contradictions.append(
                Contradiction(
                    "/ground_line",
                    compose(
                        "motion-ground-line-overdetermined",
                        positions=len(problem.positions),
                        free=free,
                        side=name,
                        fixed=side.count(),
                    ),
                )
            )
    return contradictions


def _check_pivot_regions(problem: MotionProblem) -> list[Contradiction]:
    contradictions = []
    for path, pivot in _list_given_pivots(problem):
        field = f"{path.rsplit('/')[-1]}_region"
        region = getattr(problem.constraints, field)
        # An open coordinate cannot lie outside the region: replace it by a bound of the region.
        if region is not None:
            x, y = (region.x[0] if pivot[0] is None else pivot[0]), (region.y[0] if pivot[1] is None else pivot[1])
            if not region.contains(complex(x, y)):
                contradictions.append(
                    Contradiction(path, compose("motion-pivot-outside-region", region=f"constraints.{field}"))
                )
    return contradictions


def _list_given_pivots(problem: MotionProblem) -> Iterator[tuple[str, PartialPoint]]:
    for name, side in (("input_side", problem.input_side), ("output_side", problem.output_side)):
        for field, pivot in (("fixed_pivot", side.fixed_pivot), ("moving_pivot", side.moving_pivot)):
            if pivot is not None:
                yield f"/{name}/{field}", pivot


def _check_ground_line(problem: MotionProblem) -> list[Contradiction]:
    line = problem.ground_line
    if line is None:
        return []
    contradictions = []
    along = cmath.rect(1.0, math.radians(line.angle))
    for path, pivot in _list_given_pivots(problem):
        if path.endswith("/fixed_pivot"):
            whole = to_complete_point(pivot)
            # A line along the open axis does not fix the open coordinate, so the pivot remains undetermined.
            parallel = abs(along.real if pivot[1] is None else along.imag) <= PARALLEL_TOLERANCE
            if whole is not None and abs(line.offset(whole)) > ON_LINE_TOLERANCE * problem.task_size:
                contradictions.append(Contradiction(path, compose("motion-pivot-off-ground-line")))
            elif whole is None and parallel:
                contradictions.append(Contradiction(path, compose("motion-ground-line-parallel")))
    return contradictions


def _check_coinciding_pivots(problem: MotionProblem) -> list[Contradiction]:
    contradictions = []
    for pivot in ("fixed_pivot", "moving_pivot"):
        one, other = getattr(problem.input_side, pivot), getattr(problem.output_side, pivot)
        if to_complete_point(one) is not None and one == other:
            contradictions.append(
                Contradiction(f"/output_side/{pivot}", compose("motion-pivots-coincide", pivot=pivot))
            )
    return contradictions
