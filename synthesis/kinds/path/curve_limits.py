"""Least squares of a traced curve under a problem's demands: hard limits, kept by sequential quadratic programming.

The unknowns are the linkage's own; each point's crank angle is settled to the nearest place on the curve for every
trial linkage, so that the sum of squares has, by the envelope theorem, the gradient 2 Σ w Re(z̄ₓ r) without the angles'
derivatives. Demands are inequalities of the lengths, the pivots and the transmission angle (SLSQP, through scipy).
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.optimize import minimize

from synthesis.fit.chart import OPTIONS, natural
from synthesis.fit.coupler_curve import place, place_with_slopes
from synthesis.kinds.path.curve_descent import Descent, descend
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage_statement import Region

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

ROOM = 1e-9
"""Demands are kept with this much room, so that rounding does not break them."""

SETTLING = 12
"""Newton steps at most with which a point finds the nearest place on a changed curve."""

STEPS, ACCURACY = 60, 1e-15
"""Steps of the programme at most, and the change of the cost at which it stops."""

USABLE = 25.0
"""Transmission angle, degrees, with which designs are offered beside the nearest where none is demanded: fits tend to
change points, where it vanishes."""

SHORTENINGS = 6
"""Times that a fit's longest link is brought nearer to the limit; twice are enough as a rule."""

BOUNDS = -40.0, 40.0
"""No unknown, a logarithm or a coordinate in target sizes, leaves these on the way."""

RANGE = 25
"""Crank positions over a stroke at which the transmission angle is held."""


@dataclass(frozen=True)
class Limits:
    """A problem's demands in the target's unit, about its centre."""

    longest: float
    shortest: float
    ratio: float
    cosine: float
    both_pivots: Region | None
    input_pivot: Region | None
    whole: bool
    centre: complex
    size: float

    @classmethod
    def of(cls, problem: PathProblem, centre: complex, size: float) -> Limits:
        """The limits that a problem states."""
        demands = problem.constraints
        lengths = demands.link_length
        angle = demands.min_transmission_angle
        return cls(
            longest=problem.longest_link / size,
            shortest=0.0 if lengths is None else lengths.min / size,
            ratio=math.inf if demands.max_link_ratio is None else demands.max_link_ratio,
            cosine=1.0 if angle is None else math.cos(math.radians(angle)),
            both_pivots=demands.fixed_pivot_region,
            input_pivot=demands.input_pivot_region,
            whole=problem.closed or demands.full_rotation,
            centre=centre,
            size=size,
        )

    def lengths_kept(self, links: tuple[float, float, float, float]) -> bool:
        """Whether lengths, in the target's unit, are within their limits."""
        slack = 1.0 + 2.0 * ROOM
        short, long = min(links), max(links)
        return long <= self.longest * slack and short * slack >= self.shortest and long <= self.ratio * short * slack

    def inequalities(self, family: int, x: Real, theta: Real) -> Real:
        """Numbers that must not be negative."""
        lengths, chart = np.zeros(4), np.zeros((4, 4))
        natural(family, x, lengths, chart)
        d, a, b, c = lengths
        found = [*((self.longest - lengths) / self.longest)]
        if self.shortest > 0.0:
            found += [*((lengths - self.shortest) / self.shortest)]
        if math.isfinite(self.ratio):
            found += [1.0 - one / (self.ratio * other) for one in lengths for other in lengths if one is not other]
        if self.cosine < 1.0:
            if self.whole:
                squares = np.array([(d - a) ** 2, (d + a) ** 2])
            else:
                run = np.linspace(theta.min(), theta.max(), RANGE)
                squares = d * d + a * a - 2.0 * d * a * np.cos(run - x[2])
            cosines = (b * b + c * c - squares) / (2.0 * b * c)
            found += [*(self.cosine - cosines), *(self.cosine + cosines)]
        o2 = complex(x[0], x[1])
        o4 = o2 + cmath.rect(float(d), float(x[2]))
        for region, pivots in ((self.both_pivots, (o2, o4)), (self.input_pivot, (o2,))):
            if region is None:
                continue
            for pivot in pivots:
                at = self.centre + self.size * pivot
                for value, (low, high) in ((at.real, region.x), (at.imag, region.y)):
                    found += [(value - low) / self.size, (high - value) / self.size]
        return np.array(found) - ROOM

    def usable(self) -> Limits | None:
        """The same with a transmission angle that practice asks for; None where one is stated."""
        return replace(self, cosine=math.cos(math.radians(USABLE))) if self.cosine == 1.0 else None

    def kept(self, family: int, x: Real, theta: Real) -> bool:
        """Whether all are kept."""
        return float(self.inequalities(family, x, theta).min()) >= -ROOM


@njit(**OPTIONS)
def settle(family: int, x: Real, sign: float, theta: Real, points: Complex, weights: Real, gradient: Real) -> float:
    """The weighed sum of squared distances with every angle moved, in place, to the nearest place beside it.

    ``gradient`` (m) is that of the sum in x. Infinite where the linkage does not close at some point.
    """
    m = len(x)
    lengths, chart, slopes = np.zeros(4), np.zeros((4, 4)), np.empty(m + 1, np.complex128)
    natural(family, x, lengths, chart)
    gradient[:] = 0.0
    total = 0.0
    for i in range(len(points)):
        closes, z = place_with_slopes(family, x, lengths, chart, sign, 0.0, theta[i], slopes)
        if not closes:
            return math.inf
        for _ in range(SETTLING):
            r, along = z - points[i], slopes[m]
            speed = along.real * along.real + along.imag * along.imag
            step = -(along.real * r.real + along.imag * r.imag) / (speed + 1e-300)
            step = min(max(step, -0.3), 0.3)
            here = r.real * r.real + r.imag * r.imag
            if abs(step) < 1e-13:
                break
            better = False
            for _ in range(20):
                closes, moved, _ = place(family, x, lengths, sign, 0.0, theta[i] + step)
                gap = moved - points[i]
                if closes and gap.real * gap.real + gap.imag * gap.imag < here:
                    better = True
                    break
                step *= 0.4
            if not better:
                break
            theta[i] += step
            _, z = place_with_slopes(family, x, lengths, chart, sign, 0.0, theta[i], slopes)
        r = z - points[i]
        total += weights[i] * (r.real * r.real + r.imag * r.imag)
        for j in range(m):
            gradient[j] += 2.0 * weights[i] * (slopes[j].real * r.real + slopes[j].imag * r.imag)
    return total


def descend_within(
    family: int, free: Descent, sign: float, points: Complex, weights: Real, limits: Limits
) -> Descent | None:
    """The fit nearest to a free one that keeps all limits; None where the free one keeps them, or none was reached.

    Parameters
    ----------
    family : int
        A family of fourbars.
    free : Descent
        One fit, shapes (m,), (points,), ().
    sign : float
        Assembly.
    points, weights : complex and float, shape (points,)
        What is fitted, in the target's unit.
    limits : Limits
    """
    if limits.kept(family, free.x, free.theta):
        return None
    x, theta = np.array(free.x), np.array(free.theta)
    shorter = _shortened(family, free, sign, points, weights, limits)
    if shorter is not None:
        if limits.kept(family, shorter.x, shorter.theta):
            return shorter
        x, theta = np.array(shorter.x), np.array(shorter.theta)
    gradient = np.empty(len(x))
    settled = {"theta": theta.copy()}

    def cost(trial: Real) -> tuple[float, Real]:
        angles = settled["theta"].copy()
        value = settle(family, trial, sign, angles, points, weights, gradient)
        if not math.isfinite(value):
            return 1e3, np.zeros(len(trial))
        settled["theta"] = angles
        return value, gradient.copy()

    x = np.asarray(
        minimize(
            cost,
            np.clip(x, *BOUNDS),
            jac=True,
            method="SLSQP",
            bounds=[BOUNDS] * len(x),
            constraints={"type": "ineq", "fun": lambda trial: limits.inequalities(family, trial, settled["theta"])},
            options={"maxiter": STEPS, "ftol": ACCURACY},
        ).x
    )
    theta = settled["theta"].copy()
    value = settle(family, x, sign, theta, points, weights, gradient)
    if not math.isfinite(value):
        return None
    return Descent(x, theta, np.asarray(value))


def _shortened(
    family: int, free: Descent, sign: float, points: Complex, weights: Real, limits: Limits
) -> Descent | None:
    """The fit with its longest link brought below the limit by a guide that is moved; None where it is below."""
    fit, guide = free, limits.longest
    for _ in range(SHORTENINGS):
        lengths, chart = np.zeros(4), np.zeros((4, 4))
        natural(family, fit.x, lengths, chart)
        excess = float(lengths.max()) / limits.longest - 1.0
        if excess <= 0.0:
            break
        guide *= 1.0 - 1.5 * min(excess, 0.3)
        found = descend(
            family,
            fit.x[None],
            np.array([sign]),
            fit.theta[None],
            points,
            weights=weights,
            longest=guide,
            iterations=STEPS,
        )
        fit = Descent(found.x[0], found.theta[0], found.cost[0])
    return None if fit is free or not math.isfinite(fit.cost) else fit
