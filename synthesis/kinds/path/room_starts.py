"""Draw fourbars with their pivots in the zones of a workspace and P at the first point: starts of fits.

Pivots are drawn in their zones, at the first point; one without a zone is drawn in the box, or else around the points.
Each linkage is swept, and the points are assigned to its curve in order, so that only linkages near the points go on.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.fit.chart import FOURBAR, POINT, from_lengths
from synthesis.fit.demands import SIGN, WHOLE
from synthesis.fit.room import packed
from synthesis.kinds.path.limits import setting_of
from synthesis.kinds.path.point_starts import reassign
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.space import Space
from synthesis.model.zones import AnyOf, Zone
from synthesis.numerics.portions import in_portions

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

DRAWN = 16000
"""Number of linkages drawn per family."""

ABOUT = 1.5
"""Standard deviation of the distance from the points, in task sizes, of a pivot with neither zone nor box."""

MOST_POINTS = 16
"""Maximum number of points that the curves of drawn linkages are compared with; more are thinned evenly."""

PORTION = 256
"""Number of linkages that a thread takes at a time."""

SAME_START = 0.08
"""Starts whose joints agree to this share of the task's size lead to one linkage."""


def bounded(problem: PathProblem) -> bool:
    """Return whether a problem constrains the workspace: an empty block constrains nothing."""
    return len(packed(problem.space, 0j, problem.task_size)) > 0


class RoomStarts:
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


def room_starts(
    problem: PathProblem,
    points: Complex,
    origin: complex,
    size: float,
    family: int,
    rng: np.random.Generator,
    keep: int,
    drawn: int = DRAWN,
) -> RoomStarts:
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
        Number of linkages returned at most, and drawn.
    """
    assert problem.space is not None
    joints = _joints(problem.space, origin, size, rng, drawn, points)
    few = np.unique(np.linspace(0, len(points) - 1, min(len(points), MOST_POINTS)).round().astype(int))
    rows = np.stack([points[few].real, points[few].imag, np.zeros(len(few)), np.ones(len(few))], axis=1)
    x, sign = np.zeros((drawn, 9)), np.ones(drawn)
    angles, costs = np.zeros((drawn, len(few))), np.full(drawn, np.inf)
    setting = setting_of(problem, origin, size, sign=1.0, family=family)

    def work(some: slice) -> None:
        _compared(
            joints[some], complex(points[0]), rows, setting, family, x[some], sign[some], angles[some], costs[some]
        )

    in_portions(work, drawn, PORTION)
    # Some of the nearest are duplicates; a fourfold number leaves enough distinct ones.
    order = np.argsort(costs, kind="stable")[: 4 * keep]
    order = order[np.isfinite(costs[order])]
    order = order[_apart(joints[order], keep)]
    theta = np.array([np.interp(np.arange(len(points)), few, run) for run in angles[order]]).reshape(-1, len(points))
    return RoomStarts(x[order], sign[order], theta + x[order, 2, None])


def _apart(joints: Complex, keep: int) -> NDArray[np.int64]:
    """Return rows whose joints are not all near to those of an earlier row."""
    chosen: list[int] = []
    for n, one in enumerate(joints):
        if not chosen or np.abs(joints[chosen] - one).max(axis=1).min() > SAME_START:
            chosen.append(n)
            if len(chosen) == keep:
                break
    return np.array(chosen, np.int64)


def _joints(
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
    return np.stack([_pivots(zone, space, origin, size, rng, count, points) for zone in zones], axis=1)


def _pivots(
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
        area = zones if isinstance(zones, Zone) else AnyOf(zones)
        return np.asarray((area.sampled(rng, count) - origin) / size)
    if space.box is not None:
        (left, low), (right, high) = space.box
        z = rng.uniform(left, right, count) + 1j * rng.uniform(low, high, count)
        return np.asarray((z - origin) / size)
    return np.asarray(points.mean() + ABOUT * rng.normal(size=(count, 2)) @ np.array([1.0, 1.0j]))


@njit(cache=True, nogil=True)
def _compared(
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
        if not lengths.min() > 0.0 or not from_lengths(lengths, family, 0.0, x[i]):
            continue
        x[i, 0], x[i, 1] = o2.real, o2.imag
        x[i, 2] = math.atan2(ground.imag, ground.real)
        # P in the coupler's frame, such that it lies at the first point.
        point = (first - a) * bar.conjugate() / lengths[2]
        x[i, POINT], x[i, POINT + 1] = point.real, point.imag
        sign[i] = 1.0 if ((o4 - a).conjugate() * bar).imag > 0.0 else -1.0
        stated[SIGN] = sign[i]
        pin = (a - o2) * ground.conjugate()
        angles[i] = math.atan2(pin.imag, pin.real)
        # A closed curve needs a crank that turns through, which this family does not guarantee.
        if setting[WHOLE] > 0.0 and family >= FOURBAR:
            continue
        costs[i] = reassign(x[i], points, stated, angles[i])
