"""Worst points of a motion program, and the smallest radius for which all of them keep the limit.

A limit on pressure angle or curvature must hold at every cam angle θ, and it depends on one radius p: it is a
semi-infinite constraint g(θ, p) ≤ 0. Where the set of radii that it allows at a given θ is an interval, the smallest
radius is a greatest value over θ, found exactly. Where it is not, as for curvature, radii are exchanged for angles
(Hettich & Kortanek, SIAM Review 35 (1993) 380, doi:10.1137/1035089): at the current
radius the worst angles are found exactly; each excludes all radii up to the next one that it allows, and the greatest
of these is the next radius. No allowed radius is skipped, and near the solution the steps are those of Newton.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.extremes import roots, stationary_points
from kinematics.cam.pieces import Motion, Pieces
from kinematics.cam.program import Program

Real = NDArray[np.float64]
Function = Callable[[Motion], Real]

MET = 1e-11
"""Excess, as a share of the limit, that is rounding."""

WORST = 32
"""Angles that are exchanged at once, the worst first; a motion of many knots has hundreds."""

EXCHANGES = 100
"""Most steps from radius to radius; a dozen is usual."""

SHARES = np.concatenate([[0.0], np.geomspace(1e-12, 1.0, 6000)])
"""Radii at which a worst angle is asked whether it allows them, as shares of the way to the largest one."""

BISECTIONS = 60
"""To rounding."""


def critical_motion(program: Program, *functions: Function) -> Motion:
    """The motion at every stationary point of functions of it, at both sides of every break, and where v vanishes."""
    pieces = program.pieces
    points = [program.breaks]
    for function in functions:
        points.append(stationary_points(partial(_along, function, pieces), program.breaks)[0])
    points.append(roots(lambda at: pieces.motion(at).v, program.breaks))
    at = np.unique(np.concatenate(points))
    both = program.motion(at[1:], before=True), program.motion(at[:-1])
    return Motion(*(np.concatenate(pair) for pair in zip(*both, strict=True)))


def _along(function: Function, pieces: Pieces, at: Real) -> Real:
    return function(pieces.motion(at))


def smallest_allowed(
    program: Program, excess: Callable[[Motion, Real], Real], start: float, stop: float
) -> float | None:
    """The smallest p from start to stop with g(θ, p) ≤ 0 everywhere.

    Parameters
    ----------
    program : Program
        Whose angles θ are meant.
    excess : callable
        g of a motion of shape (m, 1) or (m,) and radii of shape (k,) or (); smooth between the program's breaks.
    start, stop : float
        Between which p is looked for.

    Returns
    -------
    float or None
        None where a worst angle allows no radius up to ``stop``. Where the exchanges do not end, the last radius: none
        below it is allowed, and whether it is itself the measurement of the finished cam tells.
    """
    p = start
    for _ in range(EXCHANGES):
        here: Real = np.asarray(p)
        motion = critical_motion(program, partial(_at_radius, excess, here))
        over = excess(motion, here)
        if not (over > MET).any():
            return p
        broken = [k for k in np.argsort(-over)[:WORST] if over[k] > MET]
        worst = Motion(*(values[broken][:, None] for values in motion))
        radii = p + (stop - p) * SHARES
        allowed = excess(worst, radii) <= 0.0
        if not allowed.any(axis=1).all():
            return None
        first = allowed.argmax(axis=1)
        low, high = radii[np.maximum(first - 1, 0)], radii[first]
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            good = excess(Motion(*(values[:, 0] for values in worst)), middle) <= 0.0
            high, low = np.where(good, middle, high), np.where(good, low, middle)
        p = float(high.max())
    return p


def _at_radius(excess: Callable[[Motion, Real], Real], radius: Real, motion: Motion) -> Real:
    """The excess and one, of the size of the limit: the excess alone is rounding where the limit is just reached."""
    return excess(motion, radius) + 1.0
