"""Draw fourbars with their pivots in the zones of a workspace and P at the first point: starts of fits.

Pivots are drawn in their zones, at the first point. A pivot without a zone is drawn in the box, or else around the
points. Each linkage is swept, and the points are assigned to its curve in order, so that only linkages near the points
are kept.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import FOURBAR, POINT, write_unknowns
from synthesis.fit.constraints import FULL_TURN_INDEX, SIGN_INDEX
from synthesis.fit.workspace import pack_workspace
from synthesis.kinds.path.points.starts import assign_nearest_angles
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.constraint_vector import pack_setting
from synthesis.model.linkage.workspace import Space
from synthesis.model.linkage.zones import AnyZone, Zone
from synthesis.numerics.portions import run_in_portions

DRAW_COUNT = 16000
"""Number of linkages drawn per family."""

PIVOT_SPREAD = 1.5
"""Standard deviation of the distance from the points, in task sizes, of a pivot with neither zone nor box."""

MAX_COMPARED_POINTS = 16
"""Maximum number of points that the curves of drawn linkages are compared with; more are thinned evenly."""

PORTION_SIZE = 256
"""Number of linkages that a thread takes at a time."""

START_DUPLICATE_TOLERANCE = 0.08
"""Starts whose joints agree to this share of the task's size lead to one linkage."""


def is_workspace_constrained(problem: PathProblem) -> bool:
    """Return whether a problem constrains the workspace; an empty ``space`` constrains nothing."""
    return len(pack_workspace(problem.space, 0j, problem.task_size)) > 0


class WorkspaceStarts:
    """Linkages with their pivots in their zones, those nearest to the points first.

    Attributes
    ----------
    x : float, shape (n, 9)
        Unknowns in the family's chart.
    sign : float, shape (n,)
        Assembly.
    theta : float, shape (n, points)
        Crank angles at the points, absolute, radians.
    """

    def __init__(self, x: Real, sign: Real, theta: Real) -> None:
        self.x, self.sign, self.theta = x, sign, theta


def draw_workspace_starts(
    problem: PathProblem,
    points: Complex,
    origin: complex,
    size: float,
    family: int,
    rng: np.random.Generator,
    keep: int,
    drawn: int = DRAW_COUNT,
) -> WorkspaceStarts:
    """Draw linkages of a family in a workspace and return the ``keep`` nearest to the points.

    Parameters
    ----------
    problem : PathProblem
        With a ``space``.
    points : complex, shape (n,)
        In task coordinates: ``origin`` at 0, ``size`` at 1.
    origin, size : complex and float
        Origin and unit of the task.
    family : int
        A family of fourbars.
    rng : numpy.random.Generator
    keep, drawn : int
        Maximum number of linkages returned, and number drawn.
    """
    assert problem.space is not None
    joints = _draw_joints(problem.space, origin, size, rng, drawn, points)
    few = np.unique(np.linspace(0, len(points) - 1, min(len(points), MAX_COMPARED_POINTS)).round().astype(int))
    rows = np.stack([points[few].real, points[few].imag, np.zeros(len(few)), np.ones(len(few))], axis=1)
    x, sign = np.zeros((drawn, 9)), np.ones(drawn)
    angles, costs = np.zeros((drawn, len(few))), np.full(drawn, np.inf)
    setting = pack_setting(problem, origin, size, sign=1.0, family=family)

    def process_portion(some: slice) -> None:
        _compare_linkages(
            joints[some], complex(points[0]), rows, setting, family, x[some], sign[some], angles[some], costs[some]
        )

    run_in_portions(process_portion, drawn, PORTION_SIZE)
    # Some of the nearest are duplicates; a fourfold number leaves enough distinct ones.
    order = np.argsort(costs, kind="stable")[: 4 * keep]
    order = order[np.isfinite(costs[order])]
    order = order[_select_distinct(joints[order], keep)]
    theta = np.array([np.interp(np.arange(len(points)), few, run) for run in angles[order]]).reshape(-1, len(points))
    return WorkspaceStarts(x[order], sign[order], theta + x[order, 2, None])


def _select_distinct(joints: Complex, keep: int) -> NDArray[np.int64]:
    """Return at most ``keep`` rows whose joints are not all close to those of an earlier row."""
    chosen: list[int] = []
    for n, one in enumerate(joints):
        if not chosen or np.abs(joints[chosen] - one).max(axis=1).min() > START_DUPLICATE_TOLERANCE:
            chosen.append(n)
            if len(chosen) == keep:
                break
    return np.array(chosen, np.int64)


def _draw_joints(
    space: Space, origin: complex, size: float, rng: np.random.Generator, count: int, points: Complex
) -> Complex:
    """Draw O2, A, B, O4 in task coordinates, shape (count, 4)."""
    fixed, moving = space.fixed_pivots, space.moving_pivots
    zones: tuple[Zone | Sequence[Zone] | None, ...] = (
        None if fixed is None else fixed.input,
        None if moving is None else moving.input,
        None if moving is None else moving.output,
        None if fixed is None else fixed.output,
    )
    return np.stack([_draw_pivots(zone, space, origin, size, rng, count, points) for zone in zones], axis=1)


def _draw_pivots(
    zones: Zone | Sequence[Zone] | None,
    space: Space,
    origin: complex,
    size: float,
    rng: np.random.Generator,
    count: int,
    points: Complex,
) -> Complex:
    """Draw one pivot: in its zones, else in the box, else around the points; task coordinates, shape (count,)."""
    if zones is not None:
        area = zones if isinstance(zones, Zone) else AnyZone(zones)
        return np.asarray((area.sample_points(rng, count) - origin) / size)
    if space.box is not None:
        (left, low), (right, high) = space.box
        z = rng.uniform(left, right, count) + 1j * rng.uniform(low, high, count)
        return np.asarray((z - origin) / size)
    return np.asarray(points.mean() + PIVOT_SPREAD * rng.normal(size=(count, 2)) @ np.array([1.0, 1.0j]))


@njit(cache=True, nogil=True)
def _compare_linkages(
    joints: Complex,
    first: complex,
    points: Real,
    setting: Real,
    family: int,
    x: Real,
    sign: Real,
    angles: Real,
    costs: Real,
) -> None:
    """Compute charts of linkages, their crank angles at the points from the ground line, and half the sums of squares.

    A cost is infinite if a linkage is not of the family.
    """
    lengths, stated = np.empty(4), setting.copy()
    for i in range(len(joints)):
        o2, a, b, o4 = joints[i, 0], joints[i, 1], joints[i, 2], joints[i, 3]
        ground, bar = o4 - o2, b - a
        lengths[0], lengths[1], lengths[2], lengths[3] = abs(ground), abs(a - o2), abs(bar), abs(b - o4)
        if not lengths.min() > 0.0 or not write_unknowns(lengths, family, 0.0, x[i]):
            continue
        x[i, 0], x[i, 1] = o2.real, o2.imag
        x[i, 2] = math.atan2(ground.imag, ground.real)
        # P in the coupler's frame, such that it lies at the first point.
        point = (first - a) * bar.conjugate() / lengths[2]
        x[i, POINT], x[i, POINT + 1] = point.real, point.imag
        sign[i] = 1.0 if ((o4 - a).conjugate() * bar).imag > 0.0 else -1.0
        stated[SIGN_INDEX] = sign[i]
        pin = (a - o2) * ground.conjugate()
        angles[i] = math.atan2(pin.imag, pin.real)
        # A closed curve needs a crank that turns through, which this family does not guarantee.
        if setting[FULL_TURN_INDEX] > 0.0 and family >= FOURBAR:
            continue
        costs[i] = assign_nearest_angles(x[i], points, stated, angles[i])
