"""From what a client fixes of one side to the dyads that are tried there.

n positions leave 5 − n free choices per dyad (Norton, Table 5-3). When the client makes them all, the dyads are solved
for; when some are left open, the missing ones are drawn at random, many times, and a *cloud* of dyads results.

Free pivots are drawn around the body: the moving pivot about P in the first position, the fixed pivot about the middle
of the positions, at distances spread evenly in logarithm from a small part of the task's size to some multiples of it.
A region that the client gives is filled evenly instead, and dyads with a pivot outside it are left out.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.motion.dyads import FAR, DyadConditions, Dyads, directions_hold, linear_family, solve_dyads
from synthesis.motion.task import Complex, MotionTask, Real
from synthesis.problems import Constraints, DyadChoices, Region

NEAR_REACH, FAR_REACH = 0.05, 6.0
"""Free pivots are drawn between these distances, in task sizes; beyond them links get too short or too long."""

NEWTON_STARTS = 400
"""Starts for conditions that determine a dyad, but not linearly; at most a few solutions exist, each met many times."""

NEWTON_REACH = 300.0
"""Distance of the farthest starts, in task sizes: what a client states may stand far away."""

NEWTON_CLOUD = 4000
"""Dyads of a cloud at most where each takes Newton's method: some tenths of a second."""

SAME_DYAD = 1e-7
"""Solutions from different starts closer than this, in task sizes, are one."""

REGION_DRAWS = 6
"""Draws of a whole cloud at most, until half of it lies in the client's regions."""

SAME_PLACE = 1e-12
"""Angles (radians) and lengths (task sizes) that differ by less are equal: rounding of the positions, no motion."""

_NO_DYADS = Dyads(np.empty(0, np.complex128), np.empty(0, np.complex128))


class Cloud(NamedTuple):
    """The dyads of one side.

    Attributes
    ----------
    dyads : Dyads
        Task coordinates, shape (count,).
    sampled : bool
        The choices leave some freedom, and these dyads are drawn from what it allows.
    complete : bool
        These are all the dyads that satisfy the client's choices; where there are none, that is proved.
    reason : str
        Why there are none, in a sentence about "the side".
    """

    dyads: Dyads
    sampled: bool
    complete: bool
    reason: str = ""


def stated_conditions(task: MotionTask, choices: DyadChoices) -> DyadConditions:
    """The client's choices in task coordinates and radians."""

    def pivot(point: tuple[float, float] | None) -> Complex | None:
        return None if point is None else np.asarray(task.to_task(complex(*point)))

    def angle(degrees: float | None) -> Real | None:
        return None if degrees is None else np.asarray(math.radians(degrees))

    vector = choices.coupler_vector
    length = None if vector is None or vector.length is None else np.asarray(vector.length / task.size)
    moving = pivot(choices.moving_pivot)
    if vector is not None and vector.length is not None and vector.angle is not None:
        moving = np.asarray(task.points[0] - cmath.rect(vector.length / task.size, math.radians(vector.angle)))
        vector = length = None
    return DyadConditions(
        fixed_pivot=pivot(choices.fixed_pivot),
        moving_pivot=moving,
        rotations=tuple(angle(b) for b in choices.rotations or [None] * (len(task.points) - 1)),
        link_angle=angle(choices.link_angle),
        coupler_length=length,
        coupler_angle=None if vector is None else angle(vector.angle),
    )


def side_dyads(
    task: MotionTask, choices: DyadChoices, constraints: Constraints, rng: np.random.Generator, count: int
) -> Cloud:
    """All dyads that one side's choices determine, or a cloud of about ``count`` where some are left open."""
    reason = why_no_dyads(task)
    if reason:
        return Cloud(_NO_DYADS, False, True, reason)
    conditions = stated_conditions(task, choices)
    if conditions.linear and (conditions.count() == 5 - len(task.points) or _pivot(conditions) is not None):
        return _of_family(task, conditions, constraints, rng, count)
    if conditions.count() == 5 - len(task.points):
        return _isolated(task, conditions, rng)
    if _pivot(conditions) is not None or conditions.count() > 0:
        count = min(count, NEWTON_CLOUD)
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
    cloud = Dyads(np.concatenate(fixed)[:count], np.concatenate(moving)[:count])
    return Cloud(cloud, True, False, "No dyad was met that satisfies the choices and regions of the side.")


def _within(task: MotionTask, region: Region | None, points: Complex) -> NDArray[np.bool_]:
    """Which points, in task coordinates, lie in a region of the problem's coordinates."""
    if region is None:
        return np.ones(points.shape, np.bool_)
    return np.array([region.contains(z) for z in task.origin + points * task.size], np.bool_)


def why_no_dyads(task: MotionTask) -> str:
    """Why no pin-jointed dyad of positive length exists for the positions, in a sentence; empty where some do.

    There is none for a translation along one straight line through three or more positions (every point of the body
    moves on a line), nor for a rotation about one point, which every dyad would have for its fixed pivot.
    """
    if len(task.points) < 3:
        return ""
    if np.abs(task.turns - 1.0).max() <= SAME_PLACE:
        sides = task.points[1:] - task.points[0]
        if np.abs((np.conj(sides[0]) * sides).imag).max() > SAME_PLACE:
            return ""
        return (
            "The positions are a translation along a straight line: every point of the body moves on a line, "
            "so only a slider can guide it and no pin-jointed fourbar exists."
        )
    turning = int(np.abs(task.turns - 1.0).argmax())
    pole = _pole(task, turning)
    if np.abs(task.images(np.asarray(pole)) - pole).max() > SAME_PLACE * (1.0 + abs(pole)):
        return ""
    return (
        "The positions are a rotation about one point: a pin joint there carries the body, "
        "and every dyad would have it for its fixed pivot, so no fourbar exists."
    )


def _pole(task: MotionTask, k: int) -> complex:
    """Displacement pole of positions 1 and k: the point that A_k = A fixes."""
    turn = task.turns[k]
    return complex((task.points[k] - turn * task.points[0]) / (1.0 - turn))


def _pivot(conditions: DyadConditions) -> Complex | None:
    """The pivot that is stated, if one is."""
    return conditions.moving_pivot if conditions.fixed_pivot is None else conditions.fixed_pivot


def _of_family(
    task: MotionTask, conditions: DyadConditions, constraints: Constraints, rng: np.random.Generator, count: int
) -> Cloud:
    """The dyads of linear conditions: one, none, or a cloud where a freedom is left or a pivot is a pole."""
    family = linear_family(task, conditions)
    if family is None:
        return Cloud(_NO_DYADS, False, True, _why_contradictory(task, conditions))
    free = len(family.directions)
    if not free:
        reach = max(abs(family.dyad.fixed[0]), abs(family.dyad.moving[0]))
        if reach >= FAR:
            text = f"The other pivot of the side would lie about {reach:.0e} task sizes away; a slider stands for that."
            return Cloud(_NO_DYADS, False, False, text)
        return _forwards(task, conditions, family.dyad, sampled=False)
    distance = np.exp(rng.uniform(math.log(NEAR_REACH), math.log(FAR_REACH), (count, free)))
    moved = (distance * rng.choice([-1.0, 1.0], (count, free))) @ family.directions
    fixed = family.dyad.fixed + (moved[:, 0] + 1j * moved[:, 1])
    moving = family.dyad.moving + (moved[:, 2] + 1j * moved[:, 3])
    good = _within(task, constraints.fixed_pivot_region, fixed) & _within(task, constraints.moving_pivot_region, moving)
    return _forwards(task, conditions, Dyads(fixed[good], moving[good]), sampled=True)


def _forwards(task: MotionTask, conditions: DyadConditions, dyads: Dyads, *, sampled: bool) -> Cloud:
    """Those dyads that meet stated directions forwards."""
    good = directions_hold(task, conditions, dyads)
    text = "The choices of the side are met by a link or coupler vector of negative length only."
    return Cloud(Dyads(dyads.fixed[good], dyads.moving[good]), sampled, not sampled, text)


def _why_contradictory(task: MotionTask, conditions: DyadConditions) -> str:
    """Why linear conditions have no solution."""
    if conditions.fixed_pivot is None and conditions.moving_pivot is None:
        return "The rotations of the side belong to no link of finite length."
    return (
        "The stated pivot of the side has its images on one straight line: "
        "a slider, not a pin-jointed link, would guide it. No design exists with these choices."
    )


def _isolated(task: MotionTask, conditions: DyadConditions, rng: np.random.Generator) -> Cloud:
    """The dyads of conditions that leave no freedom and are not linear: found from many starts, each once."""
    middle = task.points.mean(keepdims=True)
    start = Dyads(
        _around(middle, rng, NEWTON_STARTS, NEWTON_REACH), _around(task.points[:1], rng, NEWTON_STARTS, NEWTON_REACH)
    )
    dyads, found = solve_dyads(task, conditions, start)
    kept: list[int] = []
    for i in np.flatnonzero(found):
        gaps = [abs(dyads.fixed[i] - dyads.fixed[j]) + abs(dyads.moving[i] - dyads.moving[j]) for j in kept]
        if min(gaps, default=math.inf) > SAME_DYAD:
            kept.append(int(i))
    text = "No dyad was found that meets the choices of the side."
    return Cloud(Dyads(dyads.fixed[kept], dyads.moving[kept]), False, False, text)


def _sampled_pivots(task: MotionTask, constraints: Constraints, rng: np.random.Generator, count: int) -> Dyads:
    """Random fixed and moving pivots, shape (count,) each."""
    middle = task.points.mean(keepdims=True)
    fixed = _filled(task, constraints.fixed_pivot_region, rng, count)
    moving = _filled(task, constraints.moving_pivot_region, rng, count)
    return Dyads(
        _around(middle, rng, count) if fixed is None else fixed,
        _around(task.points[:1], rng, count) if moving is None else moving,
    )


def _around(centre: Complex, rng: np.random.Generator, count: int, reach: float = FAR_REACH) -> Complex:
    radius = np.exp(rng.uniform(math.log(NEAR_REACH), math.log(reach), count))
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
    if missing >= 2 and _pivot(conditions) is None and not stated_vector and conditions.link_angle is None:
        regions = constraints.moving_pivot_region, constraints.fixed_pivot_region
        moving_share = 0.5 if (regions[0] is None) == (regions[1] is None) else float(regions[0] is not None)
        half = int(len(pivots.fixed) * moving_share)
        by_moving = Dyads(pivots.fixed[:half], pivots.moving[:half])
        by_fixed = Dyads(pivots.fixed[half:], pivots.moving[half:])
        return [
            (
                _with_numbers(task, replace(conditions, moving_pivot=by_moving.moving), by_moving, missing - 2, rng),
                by_moving,
            ),
            (
                _with_numbers(task, replace(conditions, fixed_pivot=by_fixed.fixed), by_fixed, missing - 2, rng),
                by_fixed,
            ),
        ]
    return [(_with_numbers(task, conditions, pivots, missing, rng), pivots)]


def _with_numbers(
    task: MotionTask, conditions: DyadConditions, pivots: Dyads, missing: int, rng: np.random.Generator
) -> DyadConditions:
    """Add ``missing`` single random numbers: the other half of a coupler vector, rotations, then a coupler angle."""
    vector = task.points[0] - pivots.moving
    if missing and conditions.fixed_pivot is None:
        if conditions.coupler_length is None and conditions.coupler_angle is not None:
            conditions, missing = replace(conditions, coupler_length=np.abs(vector)), missing - 1
        elif conditions.coupler_angle is None and conditions.coupler_length is not None:
            conditions, missing = replace(conditions, coupler_angle=np.angle(vector)), missing - 1
    rotations = list(conditions.rotations)
    for k, rotation in enumerate(rotations):
        if missing and rotation is None:
            rotations[k] = rng.uniform(-np.pi, np.pi, len(vector))
            missing -= 1
    if missing:
        conditions = replace(conditions, coupler_angle=np.angle(vector))
    return replace(conditions, rotations=tuple(rotations))
