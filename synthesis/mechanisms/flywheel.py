"""How much a flywheel must store: energy of the fluctuation of a torque over a cycle, and the inertia that evens it.

The driver gives the mean torque T̄ all the time; what the machine takes more or less goes through the flywheel's
energy. With W(θ) = ∫ (T − T̄) dθ, its fluctuation is E = max W − min W (Norton, *Design of Machinery*, eq. 11.18-11.20:
W stands at its extremes where T crosses T̄, and no single pulse need be as large as E). Then ω² = ω₀² − 2 W / I, and to
first order in the coefficient k = (ω_max − ω_min)/ω̄ of fluctuation I = E/(k ω̄²) (11.22). Exactly, ω̄ is the mean over
time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline, PPoly
from scipy.optimize import brentq

from kinematics.arrays import Real

ENERGY_TOLERANCE = 1e-12
"""Energy, as a share of the torque's largest magnitude times the cycle, that is none: rounding."""

FINE_POSITIONS = 4096
"""Positions of a cycle over which the time of a turn is summed; the trapezoid rule on a smooth periodic speed."""

MAX_COEFFICIENT = 2.0
"""A coefficient of fluctuation is less than this: the flywheel would stand still, and turn back."""


@dataclass(frozen=True)
class Fluctuation:
    """A torque over a cycle against its mean; angles in radians.

    Attributes
    ----------
    mean, energy : float
        T̄ and E.
    crossings, areas : float, shape (P,)
        Angles at which T crosses its mean, and the area from each to the next one round the cycle.
    highest, lowest : float
        Angles at which the most energy is taken out of the flywheel (the least speed follows), and the least.
    demand : float, shape (FINE,)
        W over the cycle in equal steps.
    """

    mean: float
    energy: float
    crossings: Real
    areas: Real
    highest: float
    lowest: float
    demand: Real


def compute_fluctuation(angle: Real, torque: Real) -> Fluctuation:
    """The fluctuation of a torque, by a periodic cubic through its samples.

    Parameters
    ----------
    angle, torque : float, shape (N + 1,)
        Equal steps of the angle over a cycle, upwards; the last position is the first one again.
    """
    mean = float(torque[:-1].mean())
    level = torque - mean
    level[-1] = level[0]
    return _compute_course_fluctuation(CubicSpline(angle, level, bc_type="periodic"), mean, float(np.abs(torque).max()))


def compute_table_fluctuation(angle: Real, torque: Real, *, smooth: bool) -> Fluctuation:
    """The fluctuation of a torque by a table: straight between its rows, or ``smooth`` by a periodic cubic.

    Parameters
    ----------
    angle, torque : float, shape (N + 1,)
        Any steps of the angle upwards over a cycle; the last row is the first one again.
    """
    if smooth:
        course = CubicSpline(angle, np.append(torque[:-1], torque[0]), bc_type="periodic")
    else:
        course = PPoly(np.stack([np.diff(torque) / np.diff(angle), torque[:-1]]), angle)
    mean = float(course.integrate(angle[0], angle[-1])) / float(angle[-1] - angle[0])
    course.c[-1] -= mean
    return _compute_course_fluctuation(course, mean, float(np.abs(torque).max()))


def _compute_course_fluctuation(course: PPoly, mean: float, greatest: float) -> Fluctuation:
    """The fluctuation of what a torque has beyond its mean, in polynomials over a cycle."""
    first, last = float(course.x[0]), float(course.x[-1])
    integral = course.antiderivative()
    period = last - first
    demand = np.asarray(integral(first + period * np.arange(FINE_POSITIONS) / FINE_POSITIONS))
    crossings = course.roots(extrapolate=False)
    crossings = np.unique(crossings[(crossings >= first) & (crossings < last)])
    stands = np.asarray(integral(crossings))
    size = greatest * period
    if len(crossings) < 2 or float(np.ptp(stands)) <= ENERGY_TOLERANCE * size:
        return Fluctuation(mean, 0.0, np.empty(0), np.empty(0), first, first, 0.0 * demand)
    # Over the whole cycle W ends where it began, but for the trapezoid's mean not being the cubic's.
    round_trip = float(integral(last))
    areas = np.diff(np.append(stands, stands[0] + round_trip))
    highest, lowest = int(np.argmax(stands)), int(np.argmin(stands))
    return Fluctuation(
        mean,
        float(stands[highest] - stands[lowest]),
        crossings,
        areas,
        float(crossings[highest]),
        float(crossings[lowest]),
        demand,
    )


def list_pulses(found: Fluctuation, period: float) -> list[dict[str, float]]:
    """In the shape of :class:`synthesis.model.dynamics.answer.Pulse`; the period of the cycle in radians."""
    ends = np.degrees(np.append(found.crossings, found.crossings[:1] + period))
    return [
        {"from": float(start), "to": float(end), "area": float(area)}
        for start, end, area in zip(ends[:-1], ends[1:], found.areas, strict=True)
    ]


def compute_first_order_inertia(energy: float, speed: float, coefficient: float) -> float:
    """E/(k ω̄²)."""
    return energy / (coefficient * speed**2)


def compute_exact_coefficient(found: Fluctuation, inertia: float, speed: float) -> float:
    """(ω_max − ω_min)/ω̄ of a shaft of so much inertia whose mean speed over time is ``speed``.

    ``MOST`` where the flywheel would come to a stand.
    """
    ends = find_extreme_speeds(found, inertia, speed)
    return MAX_COEFFICIENT if ends is None else (ends[1] - ends[0]) / speed


def find_extreme_speeds(found: Fluctuation, inertia: float, speed: float) -> tuple[float, float] | None:
    """ω_min and ω_max of a shaft whose mean speed over time is ``speed``; None where it would come to a stand."""
    if found.energy == 0.0:
        return speed, speed
    excess = (found.demand - found.demand.max()) * (-2.0 / inertia)
    span = 2.0 * found.energy / inertia

    def compute_mean_speed(least_squared: float) -> float:
        return 1.0 / float(np.mean(1.0 / np.sqrt(least_squared + excess)))

    if not compute_mean_speed(1e-9 * span) < speed:
        return None
    squared = brentq(lambda least: compute_mean_speed(least) - speed, 1e-9 * span, speed**2, xtol=1e-15 * speed**2)
    return float(np.sqrt(squared)), float(np.sqrt(squared + span))


def find_exact_inertia(found: Fluctuation, speed: float, coefficient: float) -> float:
    """Find the inertia with exactly the required coefficient of fluctuation, which decreases as the inertia grows."""
    if found.energy == 0.0:
        return 0.0
    guess = compute_first_order_inertia(found.energy, speed, coefficient)
    low, high = 0.5 * guess, 2.0 * guess
    while compute_exact_coefficient(found, low, speed) < coefficient:
        low *= 0.5
    while compute_exact_coefficient(found, high, speed) > coefficient:
        high *= 2.0
    return float(brentq(lambda i: compute_exact_coefficient(found, i, speed) - coefficient, low, high, rtol=1e-12))
