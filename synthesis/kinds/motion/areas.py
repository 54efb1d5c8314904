"""Where the pivots of one side may lie: the client's region for all pivots, and the zones of the side itself."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task import Complex, MotionTask, Real
from synthesis.model.linkage_statement import Region
from synthesis.model.zones import AnyOf, Area, Zone


class SideAreas(NamedTuple):
    """Areas in all of which the fixed and the moving pivot of a side lie; none where they may lie anywhere.

    The most special comes last: pivots are drawn there.
    """

    fixed: tuple[Area, ...]
    moving: tuple[Area, ...]


def side_areas(problem: MotionProblem) -> tuple[SideAreas, SideAreas]:
    """The areas of the input's side and of the output's."""
    constraints, space = problem.constraints, problem.space
    sides = []
    for side in ("input", "output"):
        areas: list[tuple[Area, ...]] = []
        for region, zones in (
            (constraints.fixed_pivot_region, space.fixed_pivots if space else None),
            (constraints.moving_pivot_region, space.moving_pivots if space else None),
        ):
            of_side: Zone | list[Zone] | None = getattr(zones, side, None)
            listed: list[Area] = [] if region is None else [region]
            if of_side is not None:
                listed.append(of_side if isinstance(of_side, Zone) else AnyOf(of_side))
            areas.append(tuple(listed))
        sides.append(SideAreas(*areas))
    return sides[0], sides[1]


def within(task: MotionTask, areas: tuple[Area, ...], points: Complex) -> NDArray[np.bool_]:
    """Which points, in task coordinates, lie in all areas."""
    return np.asarray(outside(task, areas, points) == 0.0)


def outside(task: MotionTask, areas: tuple[Area, ...], points: Complex) -> Real:
    """How far points, in task coordinates, lie outside the area from which they are farthest, in task sizes."""
    places = task.origin + points * task.size
    away = np.zeros(points.shape)
    for area in areas:
        away = np.maximum(away, area.distance_each(places) / task.size)
    return away


def drawn(task: MotionTask, areas: tuple[Area, ...], rng: np.random.Generator, count: int) -> Complex | None:
    """Random points of the last area, in task coordinates, shape (count,); None where there is none."""
    return np.asarray((areas[-1].sampled(rng, count) - task.origin) / task.size) if areas else None


def box_of(task: MotionTask, region: Region | None) -> Real:
    """A region (x from, to, y from, to) in task coordinates; infinite where there is none."""
    if region is None:
        return np.array([-np.inf, np.inf, -np.inf, np.inf])
    (left, right), (low, high) = region.x, region.y
    own = np.array([left, right, low, high]) - np.array([task.origin.real] * 2 + [task.origin.imag] * 2)
    return np.asarray(own / task.size)
