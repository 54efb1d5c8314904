"""From what a client fixes of one side to the dyads that are tried there.

n positions leave 5 − n free choices per dyad (Norton, Table 5-3). When the client makes them all, the dyads are solved
for; when some are left open, the missing ones are drawn at random, many times, and a *cloud* of dyads results.

Free pivots are drawn around the body: the moving pivot about P in the first position, the fixed pivot about the middle
of the positions, at distances spread evenly in logarithm from a small part of the task's size to some multiples of it.
A region that the client gives is filled evenly instead, and dyads with a pivot outside it are left out.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.motion.dyads import DyadConditions, Dyads, solve_dyads
from synthesis.motion.task import Complex, MotionTask, Real
from synthesis.problems import Constraints, DyadChoices, Region

NEAR_REACH, FAR_REACH = 0.05, 6.0
"""Free pivots are drawn between these distances, in task sizes; beyond them links get too short or too long."""

NEWTON_STARTS = 400
"""Starts for conditions that determine a dyad, but not linearly; at most a few solutions exist, each met many times."""

SAME_DYAD = 1e-7
"""Solutions from different starts closer than this, in task sizes, are one."""

REGION_DRAWS = 12
"""Draws of a whole cloud at most, until half of it lies in the client's regions."""

Degeneracy = Literal["slider", "pole", "undetermined"]

_UNIQUE_START = Dyads(np.array([0.31 - 0.83j]), np.array([-0.57 + 0.43j]))
"""Any start does where the system is linear; this one is no special point of a task."""

_NO_DYADS = Dyads(np.empty(0, np.complex128), np.empty(0, np.complex128))


class Cloud(NamedTuple):
    """The dyads of one side.

    Attributes
    ----------
    dyads : Dyads
        Task coordinates, shape (count,).
    complete : bool
        These are all the dyads that satisfy the client's choices.
    degeneracy : str or None
        Why there is none: ``slider`` (a pivot would lie at infinity), ``pole`` (the fixed pivot is the pole of the
        motion, so that the link would turn with the body as one piece) or ``undetermined`` (the conditions do not
        determine a dyad).
    """

    dyads: Dyads
    complete: bool
    degeneracy: Degeneracy | None = None


def stated_conditions(task: MotionTask, choices: DyadChoices) -> DyadConditions:
    """The client's choices in task coordinates and radians."""

    def pivot(point: tuple[float, float] | None) -> Complex | None:
        return None if point is None else np.asarray(task.to_task(complex(*point)))

    def angle(degrees: float | None) -> Real | None:
        return None if degrees is None else np.asarray(math.radians(degrees))

    vector = choices.coupler_vector
    length = None if vector is None or vector.length is None else np.asarray(vector.length / task.size)
    return DyadConditions(
        fixed_pivot=pivot(choices.fixed_pivot),
        moving_pivot=pivot(choices.moving_pivot),
        rotations=tuple(angle(b) for b in choices.rotations or [None] * (len(task.points) - 1)),
        link_angle=angle(choices.link_angle),
        coupler_length=length,
        coupler_angle=None if vector is None else angle(vector.angle),
    )


def side_dyads(
    task: MotionTask, choices: DyadChoices, constraints: Constraints, rng: np.random.Generator, count: int
) -> Cloud:
    """All dyads that one side's choices determine, or a cloud of about ``count`` where some are left open."""
    conditions = stated_conditions(task, choices)
    if conditions.count() == 5 - len(task.points):
        return _determined(task, conditions, rng)
    if not can_have_dyads(task):
        return Cloud(_NO_DYADS, True, "slider")
    if conditions.fixed_pivot is not None and np.ptp(task.inverted_images(conditions.fixed_pivot)) <= SAME_DYAD:
        return Cloud(_NO_DYADS, False, "pole")
    fixed, moving = [], []
    for _ in range(REGION_DRAWS):
        start = _sampled_pivots(task, constraints, rng, count)
        for pinned, share in _pinned(task, conditions, start, constraints, rng):
            dyads, found = solve_dyads(task, pinned, share)
            found &= _within(task, constraints.fixed_pivot_region, dyads.fixed)
            found &= _within(task, constraints.moving_pivot_region, dyads.moving)
            fixed.append(dyads.fixed[found])
            moving.append(dyads.moving[found])
        if sum(map(len, fixed)) >= count // 2:
            break
    return Cloud(Dyads(np.concatenate(fixed)[:count], np.concatenate(moving)[:count]), False)


def _within(task: MotionTask, region: Region | None, points: Complex) -> NDArray[np.bool_] | np.bool_:
    """Which points, in task coordinates, lie in a region of the problem's coordinates."""
    if region is None:
        return np.True_
    z = task.origin + points * task.size
    (left, right), (low, high) = region.x, region.y
    return np.asarray((left <= z.real) & (z.real <= right) & (low <= z.imag) & (z.imag <= high))


def can_have_dyads(task: MotionTask) -> bool:
    """Whether any pin-jointed dyad of positive length exists for the positions.

    There is none for a translation along one straight line through three or more positions (every point of the body
    moves on a line), nor for a rotation about one point, which every dyad would have for its fixed pivot.
    """
    if len(task.points) < 3:
        return True
    probes = np.array([0.37 + 0.91j, -1.13 + 0.29j, 0.71 - 1.57j])
    images = task.images(probes)
    if np.allclose(task.turns, 1.0, rtol=0.0, atol=1e-12):
        sides = images[:, 1:] - images[:, :1]
        cross = (np.conj(sides[:, :1]) * sides[:, 1:]).imag
        return bool(np.any(np.abs(cross) > 1e-12))
    turning = int(np.abs(task.turns - 1.0).argmax())
    pole = _pole(task, turning)
    radii = np.abs(images - pole)
    return not np.allclose(radii, radii[:, :1], rtol=1e-12, atol=1e-12)


def _pole(task: MotionTask, k: int) -> complex:
    """Displacement pole of positions 1 and k: the point that A_k = A fixes."""
    turn = task.turns[k]
    return complex((task.points[k] - turn * task.points[0]) / (1.0 - turn))


def _determined(task: MotionTask, conditions: DyadConditions, rng: np.random.Generator) -> Cloud:
    """The dyads of conditions that leave no freedom."""
    if conditions.unique:
        start = _UNIQUE_START
    else:
        middle = task.points.mean(keepdims=True)
        start = Dyads(_around(middle, rng, NEWTON_STARTS), _around(task.points[:1], rng, NEWTON_STARTS))
    if conditions.fixed_pivot is not None:
        start = start._replace(fixed=np.full(start.fixed.shape, conditions.fixed_pivot))
    if conditions.moving_pivot is not None:
        start = start._replace(moving=np.full(start.moving.shape, conditions.moving_pivot))
    dyads, found = solve_dyads(task, conditions, start)
    kept: list[int] = []
    for i in np.flatnonzero(found):
        gaps = [abs(dyads.fixed[i] - dyads.fixed[j]) + abs(dyads.moving[i] - dyads.moving[j]) for j in kept]
        if min(gaps, default=math.inf) > SAME_DYAD:
            kept.append(int(i))
    if kept:
        return Cloud(Dyads(dyads.fixed[kept], dyads.moving[kept]), conditions.unique)
    return Cloud(_NO_DYADS, conditions.unique, "slider" if _needs_slider(task, conditions) else "undetermined")


def _needs_slider(task: MotionTask, conditions: DyadConditions) -> bool:
    """Whether the stated pivot's images lie on a line, so that a slider would take the link's place."""
    if conditions.moving_pivot_known:
        pivot = conditions.moving_pivot
        if pivot is None:
            assert conditions.coupler_length is not None
            assert conditions.coupler_angle is not None
            pivot = task.points[0] - conditions.coupler_length * np.exp(1j * conditions.coupler_angle)
        images = task.images(np.asarray(pivot))
    elif conditions.fixed_pivot is not None:
        images = task.inverted_images(conditions.fixed_pivot)
    else:
        return False
    sides = images[1:] - images[0]
    return bool(
        len(sides) > 1 and np.all(np.abs((np.conj(sides[0]) * sides[1:]).imag) <= 1e-9 * np.abs(sides).max() ** 2)
    )


def _sampled_pivots(task: MotionTask, constraints: Constraints, rng: np.random.Generator, count: int) -> Dyads:
    """Random fixed and moving pivots, shape (count,) each."""
    middle = task.points.mean(keepdims=True)
    fixed = _filled(task, constraints.fixed_pivot_region, rng, count)
    moving = _filled(task, constraints.moving_pivot_region, rng, count)
    return Dyads(
        _around(middle, rng, count) if fixed is None else fixed,
        _around(task.points[:1], rng, count) if moving is None else moving,
    )


def _around(centre: Complex, rng: np.random.Generator, count: int) -> Complex:
    radius = np.exp(rng.uniform(math.log(NEAR_REACH), math.log(FAR_REACH), count))
    return np.asarray(centre + radius * np.exp(1j * rng.uniform(-np.pi, np.pi, count)))


def _filled(task: MotionTask, region: Region | None, rng: np.random.Generator, count: int) -> Complex | None:
    if region is None:
        return None
    return np.asarray((rng.uniform(*region.x, count) + 1j * rng.uniform(*region.y, count) - task.origin) / task.size)


def _pinned(
    task: MotionTask, conditions: DyadConditions, pivots: Dyads, constraints: Constraints, rng: np.random.Generator
) -> list[tuple[DyadConditions, Dyads]]:
    """Random conditions added until a dyad is determined; each way of doing so with its share of the pivots as starts.

    Where both pivots are open, half of the cloud is drawn by moving pivots and half by fixed pivots: each finds dyads
    that the other seldom meets. With a region for one of them alone, all are drawn there.
    """
    missing = 5 - len(task.points) - conditions.count()
    stated_vector = (conditions.coupler_length, conditions.coupler_angle).count(None) < 2
    pivots_open = conditions.fixed_pivot is None and conditions.moving_pivot is None and not stated_vector
    if missing >= 2 and pivots_open and conditions.link_angle is None:
        regions = constraints.moving_pivot_region, constraints.fixed_pivot_region
        moving_share = 0.5 if (regions[0] is None) == (regions[1] is None) else float(regions[0] is not None)
        half = int(len(pivots.fixed) * moving_share)
        by_moving = Dyads(pivots.fixed[:half], pivots.moving[:half])
        by_fixed = Dyads(pivots.fixed[half:], pivots.moving[half:])
        return [
            (
                _with_numbers(task, conditions.with_(moving_pivot=by_moving.moving), by_moving, missing - 2, rng),
                by_moving,
            ),
            (_with_numbers(task, conditions.with_(fixed_pivot=by_fixed.fixed), by_fixed, missing - 2, rng), by_fixed),
        ]
    return [(_with_numbers(task, conditions, pivots, missing, rng), pivots)]


def _with_numbers(
    task: MotionTask, conditions: DyadConditions, pivots: Dyads, missing: int, rng: np.random.Generator
) -> DyadConditions:
    """Add ``missing`` single random numbers: the other half of a coupler vector, rotations, then a coupler angle."""
    vector = task.points[0] - pivots.moving
    if missing and conditions.fixed_pivot is None:
        if conditions.coupler_length is None and conditions.coupler_angle is not None:
            conditions, missing = conditions.with_(coupler_length=np.abs(vector)), missing - 1
        elif conditions.coupler_angle is None and conditions.coupler_length is not None:
            conditions, missing = conditions.with_(coupler_angle=np.angle(vector)), missing - 1
    rotations = list(conditions.rotations)
    for k, rotation in enumerate(rotations):
        if missing and rotation is None:
            rotations[k] = rng.uniform(-np.pi, np.pi, len(vector))
            missing -= 1
    if missing:
        conditions = conditions.with_(coupler_angle=np.angle(vector))
    return conditions.with_(rotations=tuple(rotations))
