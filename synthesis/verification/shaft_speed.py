"""Speed of a shaft under a periodic torque, integrated over two cycles.

The equation of motion I ω dω/dθ = T̄ − T(θ) is integrated by the classical Runge-Kutta method, with T the torque taken
from the shaft and T̄ its mean. The initial speed is found such that the mean speed over time is the required one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from kinematics.arrays import Real

CYCLE_COUNT = 2
"""Number of integrated cycles. The second one shows that the speed repeats."""

MIN_START_SPEED, MAX_START_SPEED = 1e-6, 4.0
"""Minimum and maximum initial speed in the search, as multiples of the mean speed. They suffice for coefficients of
fluctuation up to 1."""


class SpeedHistory(NamedTuple):
    """Speed of a shaft over the cycles.

    Attributes
    ----------
    angle, demand, speed : float, shape (2 N + 1,)
        Angle (radians), torque taken from the shaft, and speed (rad/s).
    least, greatest : float
        Minimum and maximum speed, refined between the steps, rad/s.
    cycle : float
        Angle of one cycle, radians.
    """

    angle: Real
    demand: Real
    speed: Real
    least: float
    greatest: float
    cycle: float


def integrate_speed(angle: Real, middle: Real, ends: Real, inertia: float, mean_speed: float) -> SpeedHistory | None:
    """Integrate the speed over the cycles, with the required mean over time.

    Parameters
    ----------
    angle, ends : float, shape (N + 1,)
        Angles over one cycle, radians, and the torque taken from the shaft there. Corners of the torque must be among
        the angles.
    middle : float, shape (N,)
        Torque in the middle of each step.
    inertia : float
        Moment of inertia of the shaft.
    mean_speed : float
        Required mean of the speed over time, rad/s.

    Returns
    -------
    SpeedHistory or None
        None if the shaft comes to rest.
    """
    step = np.diff(angle)
    cycle = float(angle[-1] - angle[0])
    # Simpson's rule gives the mean torque; it uses the same points as the Runge-Kutta method.
    mean = float((step * (ends[:-1] + 4.0 * middle + ends[1:])).sum() / 6.0) / cycle
    # The drive supplies the constant mean torque; the difference accelerates the shaft.
    first = np.tile((mean - ends[:-1]) / inertia, CYCLE_COUNT).tolist()
    half = np.tile((mean - middle) / inertia, CYCLE_COUNT).tolist()
    last = np.tile((mean - ends[1:]) / inertia, CYCLE_COUNT).tolist()
    steps = np.tile(step, CYCLE_COUNT).tolist()

    def compute_mean_error(start: float) -> float:
        """Return the mean speed over time minus the required one, for an initial speed."""
        speed = _integrate_cycle(start, steps, first, half, last)
        if not speed:
            # A shaft that comes to rest is too slow; the negative value moves the root search to higher speeds.
            return -mean_speed
        w = np.array(speed)
        slope = np.array(first) / w[:-1], np.array(last) / w[1:]
        # The cubic Hermite interpolant gives the speed at mid-step, and Simpson's rule the time.
        between = 0.5 * (w[1:] + w[:-1]) + np.array(steps) * (slope[0] - slope[1]) / 8.0
        time = float((np.array(steps) * (1.0 / w[:-1] + 4.0 / between + 1.0 / w[1:])).sum()) / 6.0
        return CYCLE_COUNT * cycle / time - mean_speed

    # If even the fastest start does not reach the mean, the torque is too uneven for this inertia.
    if not compute_mean_error(MAX_START_SPEED * mean_speed) > 0.0:
        return None
    start = float(
        # The tolerance is near rounding, because the fluctuation is a small difference of speeds.
        brentq(compute_mean_error, MIN_START_SPEED * mean_speed, MAX_START_SPEED * mean_speed, xtol=1e-14 * mean_speed)
    )
    speed = _integrate_cycle(start, steps, first, half, last)
    if not speed:
        return None
    w, h = np.array(speed), np.array(steps)
    tops = _interpolate_extremes(w, np.array(first) / w[:-1], np.array(last) / w[1:], h)
    return SpeedHistory(
        np.concatenate([angle[:-1], angle[:-1] + cycle, [angle[-1] + cycle]]),
        np.concatenate([ends[:-1], ends[:-1], ends[-1:]]),
        w,
        float(tops.min()),
        float(tops.max()),
        cycle,
    )


def _integrate_cycle(
    start: float, h: list[float], first: list[float], half: list[float], last: list[float]
) -> list[float]:
    """Integrate dω/dθ = a/ω, with a given at the start, middle and end of each step of length h.

    Return the speeds at the ends of the steps; an empty list if the shaft comes to rest.
    """
    w, speed = start, [start]
    for step, a, b, c in zip(h, first, half, last, strict=True):
        one = a / w
        two = w + 0.5 * step * one
        # At a speed of 0 or less the shaft is at rest, and the equation in θ has no solution beyond.
        if two <= 0.0:
            return []
        two = b / two
        three = w + 0.5 * step * two
        if three <= 0.0:
            return []
        three = b / three
        four = w + step * three
        if four <= 0.0:
            return []
        w += step * (one + 2.0 * two + 2.0 * three + c / four) / 6.0
        if w <= 0.0:
            return []
        speed.append(w)
    return speed


def _interpolate_extremes(w: Real, before: Real, after: Real, h: Real) -> Real:
    """Return the speeds at the steps' ends and at the extremes of the cubic Hermite interpolant within the steps."""
    # An extreme lies within a step if the slope changes its sign over the step.
    turns = before * after < 0.0
    # Linear interpolation of the slope locates the extreme. The inner `where` avoids a division by 0.
    share = np.where(turns, before / np.where(turns, before - after, 1.0), 0.0)
    lead = (1.0 + 2.0 * share) * (1.0 - share) ** 2 * w[:-1] + share**2 * (3.0 - 2.0 * share) * w[1:]
    bend = share * (1.0 - share) ** 2 * h * before - share**2 * (1.0 - share) * h * after
    return np.concatenate([w, lead + bend])
