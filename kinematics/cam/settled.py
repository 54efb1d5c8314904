"""By how much what is measured of a finished profile depends on how close its points stand.

Two curves run through the points: one through all of them, one through every second. Where they agree the measure is
settled. Where they do not, and the worst value may be there, points have to be put closer, and a share of what they
differ by is added to it. An error of the fourth order, as one beside the end of a stretch has it, is divided by sixteen
when points stand twice as close.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.program import TURN

Real = NDArray[np.float64]

SETTLED = 1e-6
"""Relative difference of the curvatures through all points and through every second one at which the first is right."""

FAINT = 0.02
"""Curvature, as a share of the greatest, below which another one is right to that share of its own: a profile is hollow
or convex there by so little that nothing hangs on it."""

GAINED = 0.2
"""Share of that difference by which the first may be off: its error is of the fourth order, so that a fifteenth is
usual, and more at the ends of stretches."""

STEADY = SETTLED / GAINED
"""Relative difference of a pressure angle, or of a face's width, at which what is added to it is as little."""

SHARES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
"""Of a chord, where the two curves are compared."""

REACH = 2
"""Chords on each side that are divided with an unsettled one."""

NEARLY = 5e-3
"""Share of the greatest curvature by which a place may be less and lie beside it all the same."""

HIDDEN = 1e-4
"""Share of the greatest curvature by which a small break of the motion may change it, where curves run over it."""

FEW = 7.0
"""What an unsettledness counts as at most: chords are divided in two at once, and again in the next round."""

ROUGH = 0.25
"""Share of the difference of two curvatures that are not close yet, by which the one through all points may be off."""

WIDELY = 1e4
"""Stands for the unsettledness of a chord that has to be divided as finely as possible."""

SHORT = 1e-6
"""Length of a chord, as a share of the distance from the centre, below which it is divided no further: its direction
then has no more than nine digits."""


class Stretches(NamedTuple):
    """How the breaks of a motion divide a profile.

    Attributes
    ----------
    breaks : int, shape (b,)
        Points over which no curve is fitted: the breaks, but for those whose neighbours on both sides are too near for
        curves of their own.
    blurred : bool, shape (n,)
        Chords whose curves run over breaks.
    narrow : bool, shape (n,)
        Those of them between breaks so near to each other that no curvature can be measured there.
    single : bool, shape (n,)
        Chords between breaks with too few points for a second curve through every second one.
    """

    breaks: NDArray[np.int64]
    blurred: NDArray[np.bool_]
    narrow: NDArray[np.bool_]
    single: NDArray[np.bool_]


def doubt(near: Real, wide: Real, unexplained: Real, room: Real, stretches: Stretches) -> tuple[float, float, Real]:
    """By how much the greatest and the least curvature may be greater and less than they are through all points.

    Parameters
    ----------
    near, wide : float, shape (n, m)
        Curvatures at m places of n chords, of the curve through all points and of that through every second one.
    unexplained : float, shape (n,)
        What else the curvature of each chord may be off.
    room : float, shape (n,)
        Length of each chord, of which 1 is the least that is divided.
    stretches : Stretches
        A curve that runs over breaks may hide them at both densities.

    Returns
    -------
    above, below : float
        What to add to the greatest, and to take from the least.
    unsettled : float, shape (n,)
        More than 1 at chords that have to be divided, as what is not known of their curvature may be worse than all
        that is known: how many times more than allowed that is, and no more than there is room for. 0 elsewhere.
    """
    measured = ~stretches.narrow
    unsettled = np.zeros(len(near))
    near, wide, more = near[measured], wide[measured], unexplained[measured, None]
    apart = np.abs(near - wide)
    faint = FAINT * np.abs(near).max()
    error, factor = [], np.zeros(len(near))
    for toward in (near, -near):
        top = float(toward.max())
        allowed = SETTLED * max(abs(top), faint)
        rough = (apart > allowed) | (more > GAINED * allowed)
        off = np.where(apart > allowed, ROUGH, GAINED) * apart + more
        error.append(float((toward + off).max()) - top)
        beside = toward + apart + more > top - NEARLY * abs(top)
        worse = rough & beside
        factor = np.maximum(factor, np.where(worse, apart + more / GAINED, 0.0).max(axis=1) / allowed)
        factor[beside.any(axis=1) & stretches.single[measured]] = FEW
    above, below = error
    hidden = (near > near.max() - HIDDEN * np.abs(near.max())) | (near < near.min() + HIDDEN * np.abs(near.min()))
    unsettled[measured] = np.where(hidden.any(axis=1) & stretches.blurred[measured], WIDELY, np.minimum(factor, FEW))
    # A chord is divided into as many parts as the fourth root says.
    return above, below, np.where(room >= 1.0, np.minimum(spread(unsettled, stretches), FEW * room**4), 0.0)


def unsteadiness(near: Real, wide: Real, sign: Real, lengths: Real, stretches: Stretches) -> Real:
    """By how many times what is allowed a value depends on how close points stand, where it may be the greatest.

    Parameters
    ----------
    near, wide : float, shape (n, m)
        The value at m places of n chords, of the curve through all points and of that through every second one.
    sign : float, shape (n, m)
        −1, 0 or 1: the values of either sign have their own greatest one, and belong to both where it is 0.
    lengths : float, shape (n,)
        Of the chords, as shares of the cam.
    stretches : Stretches
    """
    apart, factor = np.abs(near - wide), np.zeros(len(near))
    for some in (sign >= 0.0, sign <= 0.0):
        top = float(near[some].max(initial=0.0))
        worse = some & (apart > STEADY * top) & (near + apart > (1.0 - NEARLY) * top)
        factor = np.maximum(factor, np.where(worse, apart, 0.0).max(axis=1) / (STEADY * top or 1.0))
    divided = spread(np.where(stretches.narrow, 0.0, np.minimum(factor, FEW)), stretches)
    return np.where(lengths > SHORT, divided, 0.0)


def spread(unsettled: Real, stretches: Stretches) -> Real:
    """To the neighbours of each chord too, since its curve runs through their points, but over no break."""
    ends = np.zeros(len(unsettled), np.bool_)
    ends[stretches.breaks] = True
    ends &= ~(stretches.blurred | np.roll(stretches.blurred, 1))
    for _ in range(REACH):
        before = np.where(ends, 0.0, np.roll(unsettled, 1))
        after = np.roll(np.where(ends, 0.0, unsettled), -1)
        unsettled = np.maximum(unsettled, np.maximum(before, after))
    return unsettled


def coarser_places(at: Real, coarser: Real, share: Real) -> tuple[NDArray[np.int64], Real]:
    """Where shares of chords lie in a curve through fewer of the same points: its chords, and the shares of those.

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
    start = np.where(chord < 0, coarser[-1] - TURN, coarser[chord])
    step = np.diff(np.append(coarser, coarser[0] + TURN))[chord]
    angle = at[:, None] + share * np.diff(np.append(at, at[0] + TURN))[:, None]
    return np.repeat(chord[:, None], len(share), axis=1), (angle - start[:, None]) / step[:, None]
