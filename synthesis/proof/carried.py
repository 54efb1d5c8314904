"""What a body travels and turns between its positions, against what is needed: measured on the driven linkage.

Needed is the straight way of P from each position to the next, and the shorter turn. What the body does more than that
is seldom wanted: it swings out on its way, or turns to and fro, and sweeps room that is needed otherwise.

The length of P's path is that of chords over ever finer grids, extrapolated (Richardson); the turning of the body is
the sum of its turns between reversals, which lie on parabolas through three samples. Both are refined until two grids
agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

Pose = Callable[[Real], tuple[Complex, Real]]
"""P and the body's angle, radians, at inputs of shape (n,)."""

STEPS, MOST_STEPS = 480, 15360
"""Steps of the first grid over the used range, and of the finest."""

SETTLED = 1e-8
"""Relative change from one grid to the next at which what is measured has settled."""

NOTHING = 1e-9
"""Needed travel, in task sizes, and needed turn, in radians, up to which there is nothing to compare with."""

LONG_TURN = math.pi
"""Turn of the input that halves the quality."""

LITTLE_TURN = math.radians(15.0)
"""What a body turns more than is needed is weighed by the needed turn, or by this where less is needed."""


class Carried(NamedTuple):
    """How a linkage carries a body over the used range.

    Attributes
    ----------
    input_turn : float
        What the input turns, radians; 0 where it slides.
    travel_ratio, turn_ratio : float or None
        Length of P's path over that of the straight ways between its positions, and all that the body turns over the
        sum of the turns that are needed; None where none is needed, and where no motion leads through the positions.
    excess : float
        The greater of what the body travels more than is needed, as a share of that, and what it turns more, as a share
        of that or of :data:`LITTLE_TURN`.
    """

    input_turn: float = 0.0
    travel_ratio: float | None = None
    turn_ratio: float | None = None
    excess: float = 0.0


@njit(cache=True, nogil=True)
def ease(input_turn: float, excess: float) -> float:
    """The factor of the quality, between 0 and 1, by which a long turn of the input and a body that wanders count.

    Parameters
    ----------
    input_turn : float
        Radians.
    excess : float
        As in :class:`Carried`.
    """
    return 1.0 / ((1.0 + (input_turn / LONG_TURN) ** 2) * (1.0 + excess * excess))


def carried(
    pose: Pose, span: tuple[float, float], places: Complex, turns: Real, size: float, *, slides: bool
) -> Carried:
    """Measure how a body is carried through its positions.

    Parameters
    ----------
    pose : callable
        Drives the linkage.
    span : pair of float
        First and last input of the used range.
    places, turns : complex and float, shape (positions,)
        P and the body's rotation, radians, where the positions are met.
    size : float
        The size of the task, in length units.
    slides : bool
        Whether the input slides.
    """
    input_turn = 0.0 if slides else abs(span[1] - span[0])
    travelled, turned = _ways(pose, *span)
    steps = np.diff(turns)
    needed_turn = float(np.abs(steps - 2.0 * np.pi * np.round(steps / (2.0 * np.pi))).sum())
    needed = float(np.abs(np.diff(places)).sum())
    travel_ratio = turn_ratio = None
    excess = 0.0
    if not math.isfinite(travelled + turned):
        return Carried(input_turn)
    if needed > NOTHING * size:
        travel_ratio = travelled / needed
        excess = max(excess, (travelled - needed) / max(needed, size))
    if needed_turn > NOTHING:
        turn_ratio = turned / needed_turn
    excess = max(excess, (turned - needed_turn) / max(needed_turn, LITTLE_TURN))
    return Carried(input_turn, travel_ratio, turn_ratio, excess)


def _ways(pose: Pose, start: float, end: float) -> tuple[float, float]:
    """The length of P's path and all turning of the body between two inputs; NaN where the linkage does not close."""
    before = math.nan, math.nan
    count = STEPS
    while True:
        places, angles = pose(np.linspace(start, end, count + 1))
        if not np.all(np.isfinite(places)):
            return math.nan, math.nan
        angles = np.unwrap(angles)
        ways = _path(places), _turning(angles)
        if count == STEPS:
            before = _path(places[::2]), _turning(angles[::2])
        settled = all(abs(now - then) <= SETTLED * now for now, then in zip(ways, before, strict=True))
        if settled or count >= MOST_STEPS:
            return ways
        before = ways
        count *= 2


def _path(places: Complex) -> float:
    """The length of a path by its chords, extrapolated from those over two steps."""
    fine, coarse = float(np.abs(np.diff(places)).sum()), float(np.abs(np.diff(places[::2])).sum())
    return fine + (fine - coarse) / 3.0


def _turning(angles: Real) -> float:
    """All turning of a body, to and fro."""
    steps = np.diff(angles)
    back = np.flatnonzero(steps[1:] * steps[:-1] < 0.0)
    slope, bend = 0.5 * (steps[back + 1] + steps[back]), steps[back + 1] - steps[back]
    return float(np.abs(steps).sum() + (slope * slope / np.abs(bend)).sum())
