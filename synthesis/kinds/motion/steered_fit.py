"""Constrained fits of fourbars to positions with tolerances: set up from a start, solve, verify.

A fit is a vector of unknowns with a setting (:mod:`synthesis.kinds.motion.steered_rows`). The start fixes the direction
in which the input turns, and the assembly.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from synthesis.fit.held import held
from synthesis.fit.room import AIM, NONE, packed
from synthesis.fit.room_margins import margins_of
from synthesis.kinds.motion.areas import box_of
from synthesis.kinds.motion.demanded import Demanded
from synthesis.kinds.motion.least_squares import fit_demands
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.screening import SHORTEST_LINK
from synthesis.kinds.motion.steered_room import least_margins
from synthesis.kinds.motion.steered_rows import (
    ASSEMBLY,
    BOXES,
    COSINE,
    DIRECTION,
    GIVEN,
    HOME,
    LINE,
    LINKS,
    OTHERS,
    PIVOTS,
    RATIO,
    SHORTEST,
    STEPS,
    WEIGHT_OF_HOME,
    equations,
    limits,
    steered_rows,
)
from synthesis.kinds.motion.steered_starts import Start, stated_coordinates
from synthesis.kinds.motion.task import MotionTask, Real
from synthesis.kinds.motion.verification import verify
from synthesis.model.linkage_answer import LinkageDesign
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.numerics.augmented_lagrangian import MAX_ROUNDS, MAX_STEPS
from synthesis.numerics.portions import in_portions
from synthesis.numerics.status import Status
from synthesis.outcome.ranking import distinct

STAYING = 0.3
"""Weight of the distance from the start, in task sizes, for a linkage that should stay near it."""

WEIGHT, WEIGHT_IN_ROOM = 10.0, 1e4
"""Penalty weights of limits in the first descent: in general, and with workspace margins, which have kinks."""

ROUNDS_IN_ROOM, STEPS_IN_ROOM = 20, 12
"""Maximum number of descents in a workspace, and of steps in each."""

SAME_LINKAGE = 0.02
"""Distance of joints, as a share of the task's size, below which two linkages are duplicates; the better is kept."""

LEAST_ANGLE = 2.0
"""Minimum transmission angle, degrees, if the client sets no limit; it keeps the fit away from toggles."""

_SHORTEST = {"double_crank": 0, "crank_rocker": 1, "double_rocker": 2}
"""Index of the shortest link, in the order d, a, b, c, by Grashof class."""


class Steered(NamedTuple):
    """State of a constrained fit: unknowns and setting (:mod:`synthesis.kinds.motion.steered_rows`)."""

    x: Real
    setting: Real


def demanded_rows(problem: MotionProblem, task: MotionTask) -> Real:
    """Return target poses and tolerances in the form of :func:`~synthesis.kinds.motion.steered_rows.steered_rows`."""
    points = np.stack([task.points.real, task.points.imag, np.angle(task.turns)], axis=1)
    return np.ascontiguousarray(np.concatenate([points, fit_demands(problem, task).tolerances], axis=1))


def begun(problem: MotionProblem, task: MotionTask, rows: Real, start: Start, room: Real = NONE) -> Steered:
    """Set up a fit that stays near its start."""
    pivots = np.ascontiguousarray(start.pivots).view(np.float64)
    setting = _setting(problem, task, start, room)
    setting[HOME : HOME + PIVOTS], setting[WEIGHT_OF_HOME] = pivots, STAYING
    return Steered(np.concatenate([pivots, start.deviations[rows[:, 3:] > 0.0]]), setting)


def let_go(linkage: Steered) -> Steered:
    """Return the fit without the term that keeps it near its start."""
    setting = linkage.setting.copy()
    setting[WEIGHT_OF_HOME] = 0.0
    return linkage._replace(setting=setting)


def with_angle(linkage: Steered, degrees: float) -> Steered:
    """Return the fit with another minimum transmission angle, degrees."""
    setting = linkage.setting.copy()
    setting[COSINE] = math.cos(math.radians(min(degrees, 89.0)))
    return linkage._replace(setting=setting)


def room_of(problem: MotionProblem, task: MotionTask, aim: float = AIM) -> Real:
    """Return the workspace constraints as parameters (:mod:`synthesis.fit.room`), empty without a workspace.

    ``aim`` tightens the constraints by a share of the task's size.
    """
    if problem.space is None:
        return NONE
    spare = problem.space.spared_at(*problem.held_at_ends)
    return packed(problem.space, task.origin, task.size, first=task.origin, aim=aim, spare=spare)


def in_rooms(linkages: Sequence[Steered], rows: Real, room: Real) -> list[Steered]:
    """Return the fits with another workspace."""
    end = STEPS + len(rows) - 1
    return [one._replace(setting=np.concatenate([one.setting[:end], room])) for one in linkages]


def room_left(linkages: Sequence[Steered], rows: Real, room: Real) -> Real:
    """Return the minimum workspace margin of each linkage, in task sizes; infinite without a workspace."""
    if not len(room) or not linkages:
        return np.full(len(linkages), math.inf)
    settings = np.array([one.setting[: STEPS + len(rows) - 1] for one in linkages])
    x = np.array([one.x for one in linkages])
    return np.asarray(least_margins(x, rows, settings[:, ASSEMBLY].copy(), settings[:, STEPS:].copy(), room))


def all_steered(rows: Real, linkages: Sequence[Steered]) -> list[Steered]:
    """Fit linkages to all constraints; drop those that cannot satisfy them."""
    n = len(rows)
    ended: list[Steered | None] = [None] * len(linkages)

    def steered(linkage: Steered) -> Steered | None:
        roomy = int(margins_of(linkage.setting[STEPS + n - 1 :]))
        count = roomy + limits(n)
        x, state = linkage.x.copy(), np.zeros(count)
        status, cost = held(
            steered_rows, x, rows, linkage.setting, state,
            most=len(x) + OTHERS + count, roomy=roomy, limits=count, equations=equations(n),
            weight=WEIGHT_IN_ROOM if roomy else WEIGHT,
            rounds=ROUNDS_IN_ROOM if roomy else MAX_ROUNDS, steps=STEPS_IN_ROOM if roomy else MAX_STEPS,
        )  # fmt: skip
        if status in (Status.IMPOSSIBLE, Status.INFEASIBLE) or not math.isfinite(cost):
            return None
        return Steered(x, linkage.setting)

    def work(some: slice) -> None:
        ended[some] = [steered(linkage) for linkage in linkages[some]]

    # The kernels release the interpreter lock, so portions run in parallel threads.
    in_portions(work, len(linkages), 1)
    return [linkage for linkage in ended if linkage is not None]


def _setting(problem: MotionProblem, task: MotionTask, start: Start, room: Real) -> Real:
    """Pack the constraints, and the choices of the start (direction of the input, assembly), into a setting."""
    constraints = problem.constraints
    n = len(start.poses)
    setting = np.full(STEPS + n - 1, math.inf)
    o2, o4, a, b = (complex(z) for z in start.pivots)
    spins = np.exp(1j * start.poses[:, 2])
    places = start.poses[:, 0] + 1j * start.poses[:, 1]
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
    setting[ASSEMBLY] = math.copysign(1.0, float(((others - pins)[0].conjugate() * (others[0] - o4)).imag))
    setting[SHORTEST] = _SHORTEST.get(constraints.grashof, -1)
    # A fully rotating input needs the ground or the input as shortest link: take the shorter one of the start.
    if constraints.full_rotation and setting[SHORTEST] < 0:
        setting[SHORTEST] = 0 if abs(o4 - o2) < abs(pins[0] - o2) else 1
    setting[COSINE] = math.cos(math.radians(max(constraints.min_transmission_angle or 0.0, LEAST_ANGLE)))
    lengths = constraints.link_length
    setting[LINKS] = 0.0 if lengths is None else lengths.min / task.size
    setting[LINKS + 1] = math.inf if lengths is None or lengths.max is None else lengths.max / task.size
    setting[RATIO] = math.inf if constraints.max_link_ratio is None else constraints.max_link_ratio
    for k, region in enumerate((constraints.fixed_pivot_region, constraints.moving_pivot_region)):
        setting[BOXES + 8 * k : BOXES + 8 * (k + 1)] = np.tile(box_of(task, region), 2)
    setting[GIVEN : GIVEN + PIVOTS] = stated_coordinates(task, problem)
    setting[LINE : LINE + 3] = math.nan
    if problem.ground_line is not None:
        normal = 1j * cmath.rect(1.0, math.radians(problem.ground_line.angle))
        offset = -problem.ground_line.offset(task.origin) / task.size
        setting[LINE : LINE + 3] = normal.real, normal.imag, offset
    return np.concatenate([setting, room])


def different(linkages: list[Steered]) -> list[Steered]:
    """Return the distinct linkages, in their given order."""
    if not linkages:
        return []
    joints = np.array([linkage.x[:PIVOTS] for linkage in linkages]).view(np.complex128)
    return [linkages[k] for k in distinct(joints, len(linkages), SAME_LINKAGE)]


def driven(
    problem: MotionProblem, task: MotionTask, rows: Real, x: Real, target: Demanded
) -> LinkageDesign | str | None:
    """Build the linkage of a constrained fit and verify it; return a design, a rejection reason, or None."""
    # The first pose includes its fitted deviations, so the body angle is stored with the mechanism.
    pose = rows[0, :3].copy()
    free = rows[0, 3:] > 0.0
    pose[free] += rows[0, 3:][free] * x[PIVOTS : PIVOTS + int(free.sum())]
    place, spin = complex(pose[0], pose[1]), cmath.exp(1j * float(pose[2]))
    o2, o4, a, b = (complex(z) for z in np.ascontiguousarray(x[:PIVOTS]).view(np.complex128))
    o2, o4 = task.pivot(problem.input_side.fixed_pivot, o2), task.pivot(problem.output_side.fixed_pivot, o4)
    a, b = (task.to_problem(place + spin * (z - complex(task.points[0]))) for z in (a, b))
    joints = FourbarConfiguration(o2, a, b, o4, task.to_problem(place))
    if not joints.has_no_link_below(SHORTEST_LINK):
        return "degenerate"
    angle = problem.positions[0].angle + math.degrees(float(pose[2])) if free[2] else None
    return verify(problem, fourbar_mechanism(joints, angle), target)
