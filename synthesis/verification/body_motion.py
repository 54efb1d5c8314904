"""Path length and rotation of a driven body between its positions, compared with the minimum.

The minimum is the straight distance of P from each position to the next, and the shorter rotation. Excess motion is
seldom useful: the body swings out or turns back and forth, and sweeps space that may be needed otherwise.

The length of P's path is extrapolated from chords over finer and finer grids (Richardson). The rotation of the body is
summed between its reversals, which are located by parabolas through three samples. Both are refined until two
successive grids agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit

Pose = Callable[[Real], tuple[Complex, Real]]
"""Callable that returns P and the body's angle (radians), both of shape (n,), at inputs of shape (n,)."""

FIRST_STEP_COUNT, MAX_STEPS = 480, 15360
"""Number of steps of the first grid over the used range, and maximum number."""

PATH_TOLERANCE = 1e-8
"""Relative change from one grid to the next at which a measured length has converged."""

MIN_EXTENT = 1e-9
"""Minimum required travel (task sizes) and rotation (radians) for which ratios are defined."""

LONG_INPUT_TURN = math.pi
"""Rotation of the input, radians, that halves the quality: half a turn."""

SMALL_BODY_TURN = math.radians(15.0)
"""Rotation, radians, to which the excess rotation of a body is related if the required rotation is smaller."""


class BodyMotion(NamedTuple):
    """Motion of a carried body over the used range.

    Attributes
    ----------
    input_turn : float
        Rotation of the input, radians; 0 if it slides.
    travel_ratio, turn_ratio : float or None
        Length of P's path over the sum of the straight distances between its positions, and total rotation of the body
        over the sum of the required rotations. None if nothing is required, or if no motion passes through the
        positions.
    excess : float
        Larger of two excesses: travel beyond the required travel, as a share of the latter or of the task's size, and
        rotation beyond the required rotation, as a share of the latter or of :data:`SMALL_BODY_TURN`, whichever is
        larger.
    """

    input_turn: float = 0.0
    travel_ratio: float | None = None
    turn_ratio: float | None = None
    excess: float = 0.0


@njit(cache=True, nogil=True)
def compute_ease(input_turn: float, excess: float) -> float:
    """Compute the factor of the quality, between 0 and 1, that penalizes a long input turn and excess body motion.

    Parameters
    ----------
    input_turn, excess : float
        As in :class:`BodyMotion`.
    """
    return 1.0 / ((1.0 + (input_turn / LONG_INPUT_TURN) ** 2) * (1.0 + excess * excess))


def measure_body_motion(
    pose: Pose, span: tuple[float, float], places: Complex, turns: Real, size: float, *, slides: bool
) -> BodyMotion:
    """Measure how a body is carried through its positions.

    Parameters
    ----------
    pose : callable
        Drives the linkage and returns the body's pose.
    span : pair of float
        First and last input of the used range.
    places, turns : complex and float, shape (positions,)
        P and the body's rotation, radians, at the positions.
    size : float
        The size of the task, in length units.
    slides : bool
        Whether the input slides.
    """
    input_turn = 0.0 if slides else abs(span[1] - span[0])
    travelled, turned = _measure_path_and_turn(pose, *span)
    steps = np.diff(turns)
    # The shorter rotation is required, because a target defines the angle of the body modulo a full turn.
    needed_turn = float(np.abs(steps - 2.0 * np.pi * np.round(steps / (2.0 * np.pi))).sum())
    needed = float(np.abs(np.diff(places)).sum())
    travel_ratio = turn_ratio = None
    excess = 0.0
    # A linkage that cannot be assembled somewhere between its positions has no path; it fails other checks.
    if not math.isfinite(travelled + turned):
        return BodyMotion(input_turn)
    if needed > MIN_EXTENT * size:
        travel_ratio = travelled / needed
        # If the required travel is small, the size of the task is the reference; otherwise the excess would be
        # exaggerated.
        excess = max(excess, (travelled - needed) / max(needed, size))
    if needed_turn > MIN_EXTENT:
        turn_ratio = turned / needed_turn
    # Likewise, a fixed angle is the reference if the required rotation is small.
    excess = max(excess, (turned - needed_turn) / max(needed_turn, SMALL_BODY_TURN))
    return BodyMotion(input_turn, travel_ratio, turn_ratio, excess)


def _measure_path_and_turn(pose: Pose, start: float, end: float) -> tuple[float, float]:
    """Measure the length of P's path and the total rotation of the body; NaN if the linkage does not close."""
    before = math.nan, math.nan
    count = FIRST_STEP_COUNT
    # Double the number of steps until length and rotation agree with those of the previous grid.
    while True:
        places, angles = pose(np.linspace(start, end, count + 1))
        if not np.all(np.isfinite(places)):
            return math.nan, math.nan
        # Unwrap the angles before summing, because the angle of a pose is known modulo a full turn.
        angles = np.unwrap(angles)
        ways = _measure_path(places), _sum_turning(angles)
        # For the first comparison, every other point of the first grid is the coarser grid.
        if count == FIRST_STEP_COUNT:
            before = _measure_path(places[::2]), _sum_turning(angles[::2])
        settled = all(abs(now - then) <= PATH_TOLERANCE * now for now, then in zip(ways, before, strict=True))
        if settled or count >= MAX_STEPS:
            return ways
        before = ways
        count *= 2


def _measure_path(places: Complex) -> float:
    """Extrapolate the length of a path from its chords over one step and over two steps (Richardson)."""
    fine, coarse = float(np.abs(np.diff(places)).sum()), float(np.abs(np.diff(places[::2])).sum())
    # The error of the chords is of second order in the step, so the coarse error is four times the fine one.
    return fine + (fine - coarse) / 3.0


def _sum_turning(angles: Real) -> float:
    """Sum the rotation of a body in both directions."""
    steps = np.diff(angles)
    # A reversal lies between samples, so the differences miss the rotation from the nearest samples to the extreme.
    back = np.flatnonzero(steps[1:] * steps[:-1] < 0.0)
    # Height of the parabola's vertex above the chords: slope² / (2 |bend|), on the way there and back.
    slope, bend = 0.5 * (steps[back + 1] + steps[back]), steps[back + 1] - steps[back]
    return float(np.abs(steps).sum() + (slope * slope / np.abs(bend)).sum())
