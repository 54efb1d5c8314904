"""Critical points of a motion program, and the smallest radius for which all of them keep the limit.

A limit on pressure angle or curvature must hold at every cam angle θ and depends on one radius p: it is a
semi-infinite constraint g(θ, p) ≤ 0. If the set of allowed radii at a given θ is an interval, the smallest radius is a
maximum over θ and is found exactly. If it is not, as for curvature, an exchange method is used
(Hettich & Kortanek, SIAM Review 35 (1993) 380, doi:10.1137/1035089). At the current radius the worst angles are found
exactly. Each of them excludes all radii up to the next one that it allows, and the largest of these is the next
radius. No allowed radius is skipped, and near the solution the steps are Newton steps.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from kinematics.arrays import Real
from kinematics.cam.motion.extremes import find_roots, find_stationary_points
from kinematics.cam.motion.pieces import Motion, Pieces
from kinematics.cam.motion.program import Program

Function = Callable[[Motion], Real]

EXCESS_TOLERANCE = 1e-11
"""Excess, as a share of the limit, that is attributed to rounding."""

MAX_EXCHANGED_ANGLES = 32
"""Maximum number of angles per exchange, the worst first; a motion with many knots has hundreds of candidates."""

MAX_EXCHANGES = 100
"""Maximum number of exchanges; a dozen is usual."""

TRIAL_SHARES = np.concatenate([[0.0], np.geomspace(1e-12, 1.0, 6000)])
"""Trial radii for the worst angles, as shares of the distance to the largest radius. The geometric spacing resolves
small steps."""

BISECTION_COUNT = 60
"""Number of halvings of a bracket: enough to reach rounding."""


def find_critical_motion(program: Program, *functions: Function) -> Motion:
    """Return the motion at stationary points of the functions, at both sides of every break, and where v vanishes."""
    pieces = program.pieces
    points = [program.breaks]
    for function in functions:
        points.append(find_stationary_points(partial(_evaluate_along, function, pieces), program.breaks)[0])
    # Rise and fall have different limits, so that the zeros of v, which separate them, are candidates, too.
    points.append(find_roots(lambda at: pieces.motion(at).v, program.breaks))
    at = np.unique(np.concatenate(points))
    # Derivatives may jump at a break: take the values on both sides.
    both = program.motion(at[1:], before=True), program.motion(at[:-1])
    return Motion(*(np.concatenate(pair) for pair in zip(*both, strict=True)))


def _evaluate_along(function: Function, pieces: Pieces, at: Real) -> Real:
    return function(pieces.motion(at))


def find_smallest_allowed(
    program: Program, excess: Callable[[Motion, Real], Real], start: float, stop: float
) -> float | None:
    """Find the smallest p from start to stop with g(θ, p) ≤ 0 everywhere.

    Parameters
    ----------
    program : Program
        The program whose cam angles θ must all keep the constraint.
    excess : callable
        g of a motion of shape (m, 1) or (m,) and radii of shape (k,) or (); smooth between the program's breaks.
    start, stop : float
        Bounds of the search for p.

    Returns
    -------
    float or None
        None if a worst angle allows no radius up to ``stop``. If the exchanges do not converge, the last radius is
        returned. No radius below it is allowed, and the measurement of the finished cam decides whether it is itself.
    """
    p = start
    for _ in range(MAX_EXCHANGES):
        here: Real = np.asarray(p)
        motion = find_critical_motion(program, partial(_shift_excess, excess, here))
        over = excess(motion, here)
        if not (over > EXCESS_TOLERANCE).any():
            return p
        broken = [k for k in np.argsort(-over)[:MAX_EXCHANGED_ANGLES] if over[k] > EXCESS_TOLERANCE]
        worst = Motion(*(values[broken][:, None] for values in motion))
        radii = p + (stop - p) * TRIAL_SHARES
        allowed = excess(worst, radii) <= 0.0
        if not allowed.any(axis=1).all():
            return None
        # Every worst angle allows some radius: bracket the smallest allowed one between two trial radii, then
        # bisect.
        first = allowed.argmax(axis=1)
        low, high = radii[np.maximum(first - 1, 0)], radii[first]
        for _ in range(BISECTION_COUNT):
            middle = 0.5 * (low + high)
            good = excess(Motion(*(values[:, 0] for values in worst)), middle) <= 0.0
            high, low = np.where(good, middle, high), np.where(good, low, middle)
        # Take the largest of these radii: no smaller radius is allowed at its angle.
        p = float(high.max())
    return p


def _shift_excess(excess: Callable[[Motion, Real], Real], radius: Real, motion: Motion) -> Real:
    """Return the excess plus one, which near the limit is about 1, whereas the excess alone would be rounding noise."""
    return excess(motion, radius) + 1.0
