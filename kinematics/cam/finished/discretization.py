"""Discretization error of values measured on a finished profile.

Two curves are fitted: one through all points, one through every second point. Where they agree the value is *settled*.
Where they differ and the worst value may be there, the points must be closer, and a share of the difference is added to
the value. An error of fourth order, as next to the end of a stretch, is divided by sixteen when the spacing is halved.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.cam.motion.program import TURN

SETTLED_TOLERANCE = 1e-6
"""Relative difference of the curvatures of the two curves up to which the finer one counts as exact."""

FAINT_CURVATURE = 0.02
"""Curvature, as a share of the maximum, below which the tolerance no longer shrinks with the value: a profile that is
so slightly curved needs no higher accuracy."""

ERROR_SHARE = 0.2
"""Share of the difference between both curves taken as the error of the finer one: with an error of fourth order a
fifteenth is usual, more at the ends of stretches."""

STEADY_TOLERANCE = SETTLED_TOLERANCE / ERROR_SHARE
"""Relative difference of a pressure angle, or of a face's width, at which the amount added equals
:data:`SETTLED_TOLERANCE`."""

CHORD_SHARES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
"""Shares of a chord at which the two curves are compared."""

NEIGHBOUR_REACH = 2
"""Neighbouring chords on each side that are divided together with an unsettled one."""

NEAR_MAXIMUM_TOLERANCE = 5e-3
"""Share of the maximum curvature within which a place still counts as near the maximum."""

HIDDEN_BREAK_EFFECT = 1e-4
"""Share of the maximum curvature by which a small break of the motion may change it, if curves cross the break."""

MAX_UNSETTLEDNESS = 7.0
"""Maximum unsettledness: chords are divided in two at once, and again in the next round."""

ROUGH_ERROR_SHARE = 0.25
"""Share of the difference taken as the error of the finer curve while the two curvatures are not close yet."""

FINEST_DIVISION = 1e4
"""Unsettledness assigned to a chord that has to be divided as finely as possible."""

MIN_CHORD_LENGTH = 1e-6
"""Length of a chord, as a share of the distance from the centre, below which it is not divided further: its direction
then has no more than nine digits."""


class Stretches(NamedTuple):
    """Division of a profile by the breaks of its motion.

    Attributes
    ----------
    breaks : int, shape (b,)
        Points that no curve crosses: the breaks, except those whose neighbours on both sides are too near for curves
        of their own.
    blurred : bool, shape (n,)
        Chords whose curves cross breaks.
    narrow : bool, shape (n,)
        Those blurred chords whose breaks are too close to measure a curvature between them.
    single : bool, shape (n,)
        Chords between breaks with too few points for a second curve through every second one.
    """

    breaks: NDArray[np.int64]
    blurred: NDArray[np.bool_]
    narrow: NDArray[np.bool_]
    single: NDArray[np.bool_]


def estimate_uncertainty(
    near: Real, wide: Real, unexplained: Real, room: Real, stretches: Stretches
) -> tuple[float, float, Real]:
    """Estimate how far the true extremes of the curvature may exceed those of the finer curve.

    Parameters
    ----------
    near, wide : float, shape (n, m)
        Curvatures at m places of n chords, of the curve through all points and of that through every second one.
    unexplained : float, shape (n,)
        Further error of the curvature of each chord.
    room : float, shape (n,)
        Size of each chord; chords below 1 are not divided.
    stretches : Stretches
        Breaks of the motion; a curve that crosses one may hide it at both densities.

    Returns
    -------
    above, below : float
        Amounts to add to the maximum and to subtract from the minimum.
    unsettled : float, shape (n,)
        Above 1 at chords that have to be divided because their true curvature may exceed the known extremes: the error
        as a multiple of the tolerance, limited by the size of the chord. 0 elsewhere.
    """
    measured = ~stretches.narrow
    unsettled = np.zeros(len(near))
    near, wide, more = near[measured], wide[measured], unexplained[measured, None]
    apart = np.abs(near - wide)
    faint = FAINT_CURVATURE * np.abs(near).max()
    error, factor = [], np.zeros(len(near))
    # Maximum first, then the minimum as the maximum of the negated curvature.
    for toward in (near, -near):
        top = float(toward.max())
        allowed = SETTLED_TOLERANCE * max(abs(top), faint)
        rough = (apart > allowed) | (more > ERROR_SHARE * allowed)
        off = np.where(apart > allowed, ROUGH_ERROR_SHARE, ERROR_SHARE) * apart + more
        error.append(float((toward + off).max()) - top)
        beside = toward + apart + more > top - NEAR_MAXIMUM_TOLERANCE * abs(top)
        worse = rough & beside
        factor = np.maximum(factor, np.where(worse, apart + more / ERROR_SHARE, 0.0).max(axis=1) / allowed)
        # Without a second curve there is no error estimate: divide near the extreme in any case.
        factor[beside.any(axis=1) & stretches.single[measured]] = MAX_UNSETTLEDNESS
    above, below = error
    hidden = (near > near.max() - HIDDEN_BREAK_EFFECT * np.abs(near.max())) | (
        near < near.min() + HIDDEN_BREAK_EFFECT * np.abs(near.min())
    )
    unsettled[measured] = np.where(
        hidden.any(axis=1) & stretches.blurred[measured], FINEST_DIVISION, np.minimum(factor, MAX_UNSETTLEDNESS)
    )
    # A chord is divided into the fourth root of its factor parts, so a chord of size ``room`` limits it to room⁴.
    return (
        above,
        below,
        np.where(
            room >= 1.0, np.minimum(share_with_neighbours(unsettled, stretches), MAX_UNSETTLEDNESS * room**4), 0.0
        ),
    )


def measure_unsteadiness(near: Real, wide: Real, sign: Real, lengths: Real, stretches: Stretches) -> Real:
    """Return the discretization error of a value as a multiple of the tolerance, where it may be the maximum.

    Parameters
    ----------
    near, wide : float, shape (n, m)
        The value at m places of n chords, of the curve through all points and of that through every second one.
    sign : float, shape (n, m)
        Signs −1, 0 or 1: the values of each sign have their own maximum, and those with 0 belong to both.
    lengths : float, shape (n,)
        Lengths of the chords, as shares of the cam's size.
    stretches : Stretches
    """
    apart, factor = np.abs(near - wide), np.zeros(len(near))
    for some in (sign >= 0.0, sign <= 0.0):
        top = float(near[some].max(initial=0.0))
        worse = some & (apart > STEADY_TOLERANCE * top) & (near + apart > (1.0 - NEAR_MAXIMUM_TOLERANCE) * top)
        factor = np.maximum(factor, np.where(worse, apart, 0.0).max(axis=1) / (STEADY_TOLERANCE * top or 1.0))
    divided = share_with_neighbours(np.where(stretches.narrow, 0.0, np.minimum(factor, MAX_UNSETTLEDNESS)), stretches)
    return np.where(lengths > MIN_CHORD_LENGTH, divided, 0.0)


def share_with_neighbours(unsettled: Real, stretches: Stretches) -> Real:
    """Spread unsettledness to neighbouring chords, whose points the curve uses too, but not across a break."""
    ends = np.zeros(len(unsettled), np.bool_)
    ends[stretches.breaks] = True
    ends &= ~(stretches.blurred | np.roll(stretches.blurred, 1))
    for _ in range(NEIGHBOUR_REACH):
        before = np.where(ends, 0.0, np.roll(unsettled, 1))
        after = np.roll(np.where(ends, 0.0, unsettled), -1)
        unsettled = np.maximum(unsettled, np.maximum(before, after))
    return unsettled


def locate_on_coarser(at: Real, coarser: Real, share: Real) -> tuple[NDArray[np.int64], Real]:
    """Locate shares of chords on a curve through fewer of the same points: its chords, and their shares.

    Parameters
    ----------
    at, coarser : float, shapes (n,) and (m,)
        Cam angles of the points of both.
    share : float, shape (k,)

    Returns
    -------
    chord, share : int and float, shape (n, k)
    """
    chord = np.searchsorted(coarser, at, side="right") - 1
    # Angles before the first coarse point lie on the last chord of the previous turn.
    start = np.where(chord < 0, coarser[-1] - TURN, coarser[chord])
    step = np.diff(np.append(coarser, coarser[0] + TURN))[chord]
    angle = at[:, None] + share * np.diff(np.append(at, at[0] + TURN))[:, None]
    return np.repeat(chord[:, None], len(share), axis=1), (angle - start[:, None]) / step[:, None]
