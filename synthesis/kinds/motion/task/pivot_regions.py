"""Permitted areas for the pivots of each side: the region common to both sides, and the side's own zones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.model.linkage.problem import Region
from synthesis.model.linkage.workspace import FixedPivotZones, MovingPivotZones
from synthesis.model.linkage.zones import AnyZone, Area, Zone


class SideAreas(NamedTuple):
    """Areas whose intersection must contain the fixed and the moving pivot of a side; empty if unrestricted.

    The most specific area comes last: pivots are sampled there.
    """

    fixed: tuple[Area, ...]
    moving: tuple[Area, ...]


def list_side_areas(problem: MotionProblem) -> tuple[SideAreas, SideAreas]:
    """Return the areas of the input side and of the output side."""
    constraints, space = problem.constraints, problem.space
    fixed, moving = FixedPivotZones(), MovingPivotZones()
    if space is not None:
        fixed, moving = space.fixed_pivots or fixed, space.moving_pivots or moving
    return (
        SideAreas(
            _list_areas(constraints.fixed_pivot_region, fixed.input),
            _list_areas(constraints.moving_pivot_region, moving.input),
        ),
        SideAreas(
            _list_areas(constraints.fixed_pivot_region, fixed.output),
            _list_areas(constraints.moving_pivot_region, moving.output),
        ),
    )


def _list_areas(region: Region | None, zones: Zone | Sequence[Zone] | None) -> tuple[Area, ...]:
    """Return the region common to both sides and the zones of one side, as far as they are given."""
    listed: list[Area] = [] if region is None else [region]
    if zones is not None:
        listed.append(zones if isinstance(zones, Zone) else AnyZone(zones))
    return tuple(listed)


def inside_mask(task: MotionTask, areas: tuple[Area, ...], points: Complex) -> NDArray[np.bool_]:
    """Return a mask of the points, in task coordinates, that lie in all areas."""
    return np.asarray(measure_outside_distance(task, areas, points) == 0.0)


def measure_outside_distance(task: MotionTask, areas: tuple[Area, ...], points: Complex) -> Real:
    """Return the distance of points, in task coordinates, from the farthest of the areas, in task sizes; 0 inside."""
    places = task.origin + points * task.size
    away = np.zeros(points.shape)
    for area in areas:
        # A point must lie in all areas, so the farthest one counts.
        away = np.maximum(away, area.compute_distances(places) / task.size)
    return away


def sample_area(task: MotionTask, areas: tuple[Area, ...], rng: np.random.Generator, count: int) -> Complex | None:
    """Sample random points of the last area, in task coordinates, shape (count,); None without areas."""
    return np.asarray((areas[-1].sample_points(rng, count) - task.origin) / task.size) if areas else None


def make_box(task: MotionTask, region: Region | None) -> Real:
    """Return a region as (x min, x max, y min, y max) in task coordinates; infinite bounds without a region."""
    if region is None:
        return np.array([-np.inf, np.inf, -np.inf, np.inf])
    (left, right), (low, high) = region.x, region.y
    own = np.array([left, right, low, high]) - np.array([task.origin.real] * 2 + [task.origin.imag] * 2)
    return np.asarray(own / task.size)
