"""Constrained fits of fourbars to positions with tolerances: set up from a start, solve, verify.

A fit is a vector of unknowns with a setting (:mod:`synthesis.kinds.motion.constrained.residuals`). The start fixes the
direction in which the input turns, and the assembly.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from synthesis.fit.constrained_fit import RowCounts, Schedule, fit_constrained
from synthesis.fit.workspace import AIM_SHARE, NO_WORKSPACE, pack_workspace
from synthesis.fit.workspace_margins import count_margins
from synthesis.kinds.motion.constrained.clearance_residuals import compute_min_margins
from synthesis.kinds.motion.constrained.residuals import (
    ASSEMBLY,
    COSINE,
    DIRECTION,
    FIXED_BOXES,
    FIXED_RESIDUAL_COUNT,
    GIVEN_COORDINATES,
    HOME_PIVOTS,
    HOME_WEIGHT_INDEX,
    LINE,
    MAX_LINK,
    MIN_LINK,
    MOVING_BOXES,
    PIVOT_COORDINATE_COUNT,
    RATIO,
    SHORTEST,
    STEPS,
    count_equations,
    count_pose_margins,
    evaluate_rows,
)
from synthesis.kinds.motion.constrained.starts import Start, list_given_coordinates
from synthesis.kinds.motion.exact.screening import MIN_LINK_SHARE
from synthesis.kinds.motion.least_squares.solver import make_pose_constraints
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.pivot_regions import make_box
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.kinds.motion.task.target_poses import TargetPoses
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.numerics.augmented_lagrangian import MAX_ROUNDS, MAX_STEPS
from synthesis.numerics.portions import run_in_portions
from synthesis.numerics.status import Status
from synthesis.results.ranking import select_distinct

HOME_WEIGHT = 0.3
"""Weight of the distance from the start, in task sizes, for a linkage that should stay near it."""

SCHEDULE, WORKSPACE_SCHEDULE = Schedule(10.0, MAX_ROUNDS, MAX_STEPS), Schedule(1e4, 20, 12)
"""Weight of the limits in the first descent, and maximum number of descents and of steps in each: in general, and with
workspace margins, which have kinks."""

DUPLICATE_TOLERANCE = 0.02
"""Distance of joints, as a share of the task's size, below which two linkages are duplicates; the better is kept."""

MIN_ANGLE = 2.0
"""Minimum transmission angle, degrees, if the client sets no limit; it keeps the fit away from toggles."""

_SHORTEST_INDEX = {"double_crank": 0, "crank_rocker": 1, "double_rocker": 2}
"""Index of the shortest link, in the order d, a, b, c, by Grashof class."""


class ConstrainedFit(NamedTuple):
    """State of a constrained fit: unknowns and setting (:mod:`synthesis.kinds.motion.constrained.residuals`)."""

    x: Real
    setting: Real


def make_target_rows(problem: MotionProblem, task: MotionTask) -> Real:
    """Return target poses and tolerances in the form of
    :func:`~synthesis.kinds.motion.constrained.residuals.evaluate_rows`."""
    points = np.stack([task.points.real, task.points.imag, np.angle(task.turns)], axis=1)
    return np.ascontiguousarray(np.concatenate([points, make_pose_constraints(problem, task).tolerances], axis=1))


def make_constrained_fit(
    problem: MotionProblem, task: MotionTask, rows: Real, start: Start, room: Real = NO_WORKSPACE
) -> ConstrainedFit:
    """Set up a fit that stays near its start."""
    pivots = np.ascontiguousarray(start.pivots).view(np.float64)
    setting = _pack_setting(problem, task, start, room)
    # The term near the start keeps fits of different starts different.
    setting[HOME_PIVOTS], setting[HOME_WEIGHT_INDEX] = pivots, HOME_WEIGHT
    return ConstrainedFit(np.concatenate([pivots, start.deviations[rows[:, 3:] > 0.0]]), setting)


def release_from_start(linkage: ConstrainedFit) -> ConstrainedFit:
    """Return the fit without the term that keeps it near its start."""
    setting = linkage.setting.copy()
    setting[HOME_WEIGHT_INDEX] = 0.0
    return linkage._replace(setting=setting)


def with_angle(linkage: ConstrainedFit, degrees: float) -> ConstrainedFit:
    """Return the fit with another minimum transmission angle, degrees."""
    setting = linkage.setting.copy()
    # Below 90°, where no linkage could satisfy the limit.
    setting[COSINE] = math.cos(math.radians(min(degrees, 89.0)))
    return linkage._replace(setting=setting)


def pack_task_workspace(problem: MotionProblem, task: MotionTask, aim: float = AIM_SHARE) -> Real:
    """Return the workspace constraints as parameters (:mod:`synthesis.fit.workspace`), empty without a workspace.

    ``aim`` tightens the constraints by a share of the task's size.
    """
    if problem.space is None:
        return NO_WORKSPACE
    spare = problem.space.compute_spare_clearance(*problem.exact_end_poses)
    return pack_workspace(problem.space, task.origin, task.size, first=task.origin, aim=aim, spare=spare)


def replace_workspace(linkages: Sequence[ConstrainedFit], rows: Real, room: Real) -> list[ConstrainedFit]:
    """Return the fits with another workspace."""
    # The workspace stands last in the setting, so it can be exchanged without touching the rest.
    end = STEPS + len(rows) - 1
    return [one._replace(setting=np.concatenate([one.setting[:end], room])) for one in linkages]


def measure_workspace_margins(linkages: Sequence[ConstrainedFit], rows: Real, room: Real) -> Real:
    """Return the minimum workspace margin of each linkage, in task sizes; infinite without a workspace."""
    # Without a workspace everything fits.
    if not len(room) or not linkages:
        return np.full(len(linkages), math.inf)
    settings = np.array([one.setting[: STEPS + len(rows) - 1] for one in linkages])
    x = np.array([one.x for one in linkages])
    return np.asarray(compute_min_margins(x, rows, settings[:, ASSEMBLY].copy(), settings[:, STEPS:].copy(), room))


def solve_constrained(rows: Real, linkages: Sequence[ConstrainedFit]) -> list[ConstrainedFit]:
    """Fit linkages to all constraints; drop those that cannot satisfy them."""
    n = len(rows)
    ended: list[ConstrainedFit | None] = [None] * len(linkages)

    def fit_linkage(linkage: ConstrainedFit) -> ConstrainedFit | None:
        roomy = int(count_margins(linkage.setting[STEPS + n - 1 :]))
        # Only accept fits that satisfy all constraints; the workspace has its own tolerance.
        count = roomy + count_pose_margins(n)
        x, state = linkage.x.copy(), np.zeros(count)
        counts = RowCounts(len(x) + FIXED_RESIDUAL_COUNT + count, count, count_equations(n), roomy)
        schedule = WORKSPACE_SCHEDULE if roomy else SCHEDULE
        status, cost = fit_constrained(evaluate_rows, x, rows, linkage.setting, state, counts, schedule)
        if status in (Status.IMPOSSIBLE, Status.INFEASIBLE) or not math.isfinite(cost):
            return None
        return ConstrainedFit(x, linkage.setting)

    def fit_portion(some: slice) -> None:
        ended[some] = [fit_linkage(linkage) for linkage in linkages[some]]

    # The kernels release the interpreter lock, so portions run in parallel threads.
    run_in_portions(fit_portion, len(linkages), 1)
    return [linkage for linkage in ended if linkage is not None]


def _pack_setting(problem: MotionProblem, task: MotionTask, start: Start, room: Real) -> Real:
    """Pack the constraints, and the choices of the start (direction of the input, assembly), into a setting."""
    constraints = problem.constraints
    n = len(start.poses)
    setting = np.full(STEPS + n - 1, math.inf)
    o2, o4, a, b = (complex(z) for z in start.pivots)
    spins = np.exp(1j * start.poses[:, 2])
    places = start.poses[:, 0] + 1j * start.poses[:, 1]
    # Angles of the crank at the poses decide the direction in which the targets are met in order.
    pins = places + spins * (a - task.points[0])
    others = places + spins * (b - task.points[0])
    turned = np.angle((pins - o2) / (pins[0] - o2))
    onward, backward = np.mod(turned, math.tau), -np.mod(-turned, math.tau)
    rises, falls = bool(np.all(np.diff(onward) > 0.0)), bool(np.all(np.diff(backward) < 0.0))
    # If both directions keep the order (two poses), take the shorter rotation.
    forward = rises and not (falls and -backward[-1] < onward[-1])
    steps = np.diff(onward if forward else backward)
    if len(room) and not (rises or falls):
        # The poses are out of order; deviations within tolerances may fix that. Use the overall direction.
        steps = np.diff(np.unwrap(turned))
        forward = bool(steps.sum() > 0.0)
    setting[DIRECTION] = 1.0 if forward else -1.0
    setting[STEPS:] = steps
    # The cross product of coupler and output at the first pose is positive for one assembly.
    setting[ASSEMBLY] = math.copysign(1.0, float(((others - pins)[0].conjugate() * (others[0] - o4)).imag))
    setting[SHORTEST] = _SHORTEST_INDEX.get(constraints.grashof, -1)
    # A fully rotating input needs the ground or the input as shortest link: take the shorter one of the start.
    if constraints.full_rotation and setting[SHORTEST] < 0:
        setting[SHORTEST] = 0 if abs(o4 - o2) < abs(pins[0] - o2) else 1
    # Without a limit a small angle keeps the fit away from toggles.
    setting[COSINE] = math.cos(math.radians(max(constraints.min_transmission_angle or 0.0, MIN_ANGLE)))
    lengths = constraints.link_length
    setting[MIN_LINK] = 0.0 if lengths is None else lengths.min / task.size
    setting[MAX_LINK] = math.inf if lengths is None or lengths.max is None else lengths.max / task.size
    setting[RATIO] = math.inf if constraints.max_link_ratio is None else constraints.max_link_ratio
    # The same region applies to both pivots of a pair.
    setting[FIXED_BOXES] = np.tile(make_box(task, constraints.fixed_pivot_region), 2)
    setting[MOVING_BOXES] = np.tile(make_box(task, constraints.moving_pivot_region), 2)
    setting[GIVEN_COORDINATES] = list_given_coordinates(task, problem)
    setting[LINE] = math.nan
    if problem.ground_line is not None:
        normal = 1j * cmath.rect(1.0, math.radians(problem.ground_line.angle))
        offset = -problem.ground_line.offset(task.origin) / task.size
        setting[LINE] = normal.real, normal.imag, offset
    return np.concatenate([setting, room])


def select_distinct_fits(linkages: list[ConstrainedFit]) -> list[ConstrainedFit]:
    """Return the distinct linkages, in their given order."""
    if not linkages:
        return []
    joints = np.array([linkage.x[:PIVOT_COORDINATE_COUNT] for linkage in linkages]).view(np.complex128)
    return [linkages[k] for k in select_distinct(joints, len(linkages), DUPLICATE_TOLERANCE)]


def verify_fit(
    problem: MotionProblem, task: MotionTask, rows: Real, x: Real, target: TargetPoses
) -> LinkageDesign | str | None:
    """Build the linkage of a constrained fit and verify it; return a design, a rejection reason, or None."""
    # The first pose includes its fitted deviations, so the body angle is stored with the mechanism.
    pose = rows[0, :3].copy()
    free = rows[0, 3:] > 0.0
    pose[free] += rows[0, 3:][free] * x[PIVOT_COORDINATE_COUNT : PIVOT_COORDINATE_COUNT + int(free.sum())]
    place, spin = complex(pose[0], pose[1]), cmath.exp(1j * float(pose[2]))
    o2, o4, a, b = (complex(z) for z in np.ascontiguousarray(x[:PIVOT_COORDINATE_COUNT]).view(np.complex128))
    # Given pivots keep their exact values instead of the fitted ones.
    o2, o4 = task.pivot(problem.input_side.fixed_pivot, o2), task.pivot(problem.output_side.fixed_pivot, o4)
    a, b = (task.to_problem(place + spin * (z - complex(task.points[0]))) for z in (a, b))
    joints = FourbarConfiguration(o2, a, b, o4, task.to_problem(place))
    if not joints.has_no_link_below(MIN_LINK_SHARE):
        return "degenerate"
    angle = problem.positions[0].angle + math.degrees(float(pose[2])) if free[2] else None
    return verify(problem, build_fourbar(joints, angle), target)
