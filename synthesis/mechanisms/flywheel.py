"""Dimensioning of a flywheel: fluctuation of energy over a cycle, and the inertia that limits the speed fluctuation.

The driver supplies the mean torque T̄ at all times; the difference from the machine's torque T changes the flywheel's
energy. With W(θ) = ∫ (T − T̄) dθ, its fluctuation is E = max W − min W (Norton, *Design of Machinery*, eq. 11.18-11.20:
W has its extremes where T crosses T̄, and no single pulse need be as large as E). Then ω² = ω₀² − 2 W / I. To first
order in the coefficient of fluctuation k = (ω_max − ω_min)/ω̄, the inertia is I = E/(k ω̄²) (eq. 11.22). The exact
values refer to the mean speed over time, ω̄.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline, PPoly
from scipy.optimize import brentq

from kinematics.arrays import Real

ENERGY_TOLERANCE = 1e-12
"""Energy that counts as rounding, as a share of the torque's largest magnitude times the cycle."""

FINE_POSITIONS = 4096
"""Number of positions of a cycle at which the mean speed is computed, by the trapezoid rule. It converges fast, because
the speed is smooth and periodic."""

MAX_COEFFICIENT = 2.0
"""Upper bound of the coefficient of fluctuation, at which the flywheel would stop."""


@dataclass(frozen=True)
class Fluctuation:
    """Deviation of a torque from its mean over a cycle; angles in radians.

    Attributes
    ----------
    mean, energy : float
        T̄ and E.
    crossings, areas : float, shape (P,)
        Angles at which T crosses its mean, and the area from each to the next one, cyclically.
    highest, lowest : float
        Angles at which the energy taken from the flywheel is at its maximum (minimum speed) and at its minimum.
    demand : float, shape (FINE_POSITIONS,)
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
    """Compute the fluctuation of a torque by a periodic cubic spline through its samples.

    Parameters
    ----------
    angle, torque : float, shape (N + 1,)
        Equal steps of the angle over a cycle, increasing; the last position repeats the first.
    """
    # Trapezoid rule over a full period: the last sample repeats the first and is left out.
    mean = float(torque[:-1].mean())
    level = torque - mean
    # A periodic spline requires exactly equal end values.
    level[-1] = level[0]
    return _compute_course_fluctuation(CubicSpline(angle, level, bc_type="periodic"), mean, float(np.abs(torque).max()))


def compute_table_fluctuation(angle: Real, torque: Real, *, smooth: bool) -> Fluctuation:
    """Compute the fluctuation of a torque given by a table.

    Between the rows the torque is linear or, if ``smooth``, a periodic cubic spline.

    Parameters
    ----------
    angle, torque : float, shape (N + 1,)
        Any increasing steps of the angle over a cycle; the last row repeats the first.
    """
    if smooth:
        course = CubicSpline(angle, np.append(torque[:-1], torque[0]), bc_type="periodic")
    else:
        course = PPoly(np.stack([np.diff(torque) / np.diff(angle), torque[:-1]]), angle)
    mean = float(course.integrate(angle[0], angle[-1])) / float(angle[-1] - angle[0])
    # The mean affects only the constant coefficients of the polynomials.
    course.c[-1] -= mean
    return _compute_course_fluctuation(course, mean, float(np.abs(torque).max()))


def _compute_course_fluctuation(course: PPoly, mean: float, greatest: float) -> Fluctuation:
    """Compute the fluctuation of a torque from its deviation from the mean, piecewise polynomials over a cycle.

    ``greatest`` is the maximum magnitude of the torque.
    """
    first, last = float(course.x[0]), float(course.x[-1])
    integral = course.antiderivative()
    period = last - first
    demand = np.asarray(integral(first + period * np.arange(FINE_POSITIONS) / FINE_POSITIONS))
    crossings = course.roots(extrapolate=False)
    # Count a crossing at both ends of the cycle once.
    crossings = np.unique(crossings[(crossings >= first) & (crossings < last)])
    stands = np.asarray(integral(crossings))
    size = greatest * period
    # The torque is constant to rounding, so no flywheel is needed.
    if len(crossings) < 2 or float(np.ptp(stands)) <= ENERGY_TOLERANCE * size:
        return Fluctuation(mean, 0.0, np.empty(0), np.empty(0), first, first, 0.0 * demand)
    # Over a cycle W returns to its start, except that the mean of the samples may differ slightly from the spline's.
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
    """Return the pulses in the form of :class:`synthesis.model.dynamics.answer.Pulse`; the period is in radians."""
    ends = np.degrees(np.append(found.crossings, found.crossings[:1] + period))
    return [
        {"from": float(start), "to": float(end), "area": float(area)}
        for start, end, area in zip(ends[:-1], ends[1:], found.areas, strict=True)
    ]


def compute_first_order_inertia(energy: float, speed: float, coefficient: float) -> float:
    """Compute the inertia E/(k ω̄²), to first order in the coefficient of fluctuation k."""
    return energy / (coefficient * speed**2)


def compute_exact_coefficient(found: Fluctuation, inertia: float, speed: float) -> float:
    """Compute the exact coefficient of fluctuation, (ω_max − ω_min)/ω̄, of a shaft with a given inertia.

    ``speed`` is the mean speed over time. Return :data:`MAX_COEFFICIENT` if the flywheel would stop.
    """
    ends = find_extreme_speeds(found, inertia, speed)
    return MAX_COEFFICIENT if ends is None else (ends[1] - ends[0]) / speed


def find_extreme_speeds(found: Fluctuation, inertia: float, speed: float) -> tuple[float, float] | None:
    """Find ω_min and ω_max of a shaft whose mean speed over time is ``speed``; None if it would stop."""
    if found.energy == 0.0:
        return speed, speed
    # ω² − ω_min²; the speed is at its minimum where the energy taken from the flywheel is at its maximum.
    excess = (found.demand - found.demand.max()) * (-2.0 / inertia)
    span = 2.0 * found.energy / inertia

    def compute_mean_speed(least_squared: float) -> float:
        # The mean over time is the harmonic mean over the angle.
        return 1.0 / float(np.mean(1.0 / np.sqrt(least_squared + excess)))

    # If the mean exceeds the required one even with a minimum speed near 0, the shaft would stop.
    if not compute_mean_speed(1e-9 * span) < speed:
        return None
    squared = brentq(lambda least: compute_mean_speed(least) - speed, 1e-9 * span, speed**2, xtol=1e-15 * speed**2)
    return float(np.sqrt(squared)), float(np.sqrt(squared + span))


def find_exact_inertia(found: Fluctuation, speed: float, coefficient: float) -> float:
    """Find the inertia that gives exactly the required coefficient of fluctuation.

    The coefficient decreases as the inertia grows, so a bracket is found first.
    """
    if found.energy == 0.0:
        return 0.0
    guess = compute_first_order_inertia(found.energy, speed, coefficient)
    # The first-order value is within a factor of two in practice; widen the bracket if it is not.
    low, high = 0.5 * guess, 2.0 * guess
    while compute_exact_coefficient(found, low, speed) < coefficient:
        low *= 0.5
    while compute_exact_coefficient(found, high, speed) > coefficient:
        high *= 2.0
    return float(brentq(lambda i: compute_exact_coefficient(found, i, speed) - coefficient, low, high, rtol=1e-12))
