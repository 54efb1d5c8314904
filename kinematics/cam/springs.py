"""Return spring with the smallest maximum contact force among all that keep contact at every speed.

With rate k = x², preload F0 and the damping c = 2 ζ √(k m) of a ratio ζ, the force at cam angle θ and speed w is

    F(θ, w) = m w² a + 2 ζ √m w v x + s x² + F0

(Norton, *Design of Machinery*, §15.2). Its maximum over θ at the working speed ω is minimized; at every θ and every w
from 0 to a top speed it must not fall below a floor. Each θ gives

    maximum force − F0 ≥ m ω² a + 2 ζ √m ω v x + s x²          (an *upper* cut)
    F0 ≥ floor − m w² a − 2 ζ √m w v x − s x²                   (a *need*, with any one w)

for every x: parabolas in x with known coefficients (straight lines in k without damping, where the problem is convex in
k and F0). The maximum of the upper cuts plus the maximum of the needs in the list is a lower model of the objective.
It is minimized exactly, among ends, vertices and crossings of its parabolas; the true values at that x give the next
cuts (exchange; Kelley, *J. SIAM* 8, 1960). The model's minimum is a lower bound for every spring, with damping or
without.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real
from kinematics.cam.dynamics import FollowerLoad, RunningCam
from kinematics.cam.motion.program import Program
from kinematics.errors import DimensionError

MAX_ROUNDS = 80
"""Maximum number of springs tried; a dozen is usual."""

FORCE_TOLERANCE = 1e-10
"""Share of the force by which the value may exceed its bound, and by which a given preload may miss a need."""

MAX_STIFFNESS = 1e4
"""Maximum spring force over the lift, in units of all other forces: upper end of the search."""


@dataclass(frozen=True)
class SpringConstraints:
    """Constraints on a return spring.

    Parameters
    ----------
    floor : float
        Minimum contact force.
    speed, top_speed : float
        Camshaft speeds, radians per unit of time. The maximum force is minimized at ``speed``, and contact is kept at
        all speeds up to ``top_speed``.
    least_rate, greatest_rate : float
        Range of the spring's rate; the maximum may be infinite.
    preload : float or None
        Given preload; None if it is free (at least 0).
    """

    floor: float
    speed: float
    top_speed: float
    least_rate: float = 0.0
    greatest_rate: float = math.inf
    preload: float | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.speed <= self.top_speed < math.inf:
            raise DimensionError(
                "kinematics-top-speed", "kinematics-at-least-speed", self.top_speed, speed=f"{self.speed}"
            )
        if not 0.0 <= self.least_rate <= self.greatest_rate or math.isinf(self.least_rate):
            raise DimensionError(
                "kinematics-greatest-rate", "kinematics-at-least-rate", self.greatest_rate, rate=f"{self.least_rate}"
            )


@dataclass(frozen=True)
class Spring:
    """A return spring.

    Attributes
    ----------
    rate, preload : float
    greatest_force : float
        Maximum contact force at the speed.
    bound : float or None
        Lower bound of the maximum force over all feasible springs; None if no feasible spring was found and this is
        the nearest miss.
    """

    rate: float
    preload: float
    greatest_force: float
    bound: float | None


def find_best_spring(program: Program, mass: float, damping_ratio: float, demands: SpringConstraints) -> Spring:
    """Find the feasible spring of smallest maximum contact force, or the one with the smallest violation.

    Parameters
    ----------
    program : Program
    mass : float
        Mass of the follower, or its moment of inertia.
    damping_ratio : float
        Damping ratio ζ of mass and spring.
    demands : SpringConstraints
    """
    search = _SpringSearch(program, mass, damping_ratio, demands)
    found = search.minimize_force()
    return search.find_nearest_miss() if found is None else found


class _SpringSearch:
    """State of the exchange algorithm: the current cuts."""

    def __init__(self, program: Program, mass: float, ratio: float, demands: SpringConstraints) -> None:
        self.program, self.mass, self.ratio, self.demands = program, mass, ratio, demands
        lift = program.lift
        # Scale of all forces without the spring, for the tolerances and the upper end of the search.
        others = mass * demands.top_speed**2 * program.peaks[2].largest + demands.floor + (demands.preload or 0.0)
        cap = MAX_STIFFNESS * others / lift if lift > 0.0 else 0.0
        self.ends = (
            math.sqrt(demands.least_rate),
            math.sqrt(min(demands.greatest_rate, max(cap, MAX_STIFFNESS * demands.least_rate))),
        )
        self.scale = others
        self.upper = np.empty((0, 3))
        # A free preload is at least 0: the zero parabola.
        self.needs = np.zeros((1, 3)) if demands.preload is None else np.empty((0, 3))
        # Cuts at both ends bound the model from the start.
        for x in self.ends:
            self.try_spring(x)

    def try_spring(self, x: float) -> tuple[float, float]:
        """Evaluate maximum force without preload and required preload of a spring; its worst angles become cuts."""
        demands, root = self.demands, 2.0 * self.ratio * math.sqrt(self.mass)
        load = FollowerLoad(self.mass, x * x).with_damping_ratio(self.ratio)
        running = RunningCam(self.program, load, demands.speed)
        force = running.force_extremes
        speed = demands.speed
        rows = [
            [self.mass * speed**2 * a, root * speed * v, s]
            for s, v, a in _evaluate_both_sides(self.program, force.at_greatest)
        ]
        self.upper = np.vstack([self.upper, rows])
        weakest = running.find_weakest_contact(demands.top_speed)
        w = weakest.speed
        rows = [
            [demands.floor - self.mass * w**2 * a, -root * w * v, -s]
            for s, v, a in _evaluate_both_sides(self.program, weakest.angle)
        ]
        self.needs = np.vstack([self.needs, rows])
        return force.greatest, max(0.0, demands.floor - weakest.force)

    def _clip_rate(self, x: float) -> float:
        """Return k = x², clipped to the given range to the last digit."""
        # √ and square do not return the given limit exactly; restore it.
        if x <= self.ends[0]:
            return self.demands.least_rate
        rate = max(x * x, self.demands.least_rate)
        return self.demands.greatest_rate if rate >= self.demands.greatest_rate * (1.0 - FORCE_TOLERANCE) else rate

    def minimize_force(self) -> Spring | None:
        """Exchange until value and bound meet; None if no feasible spring was found."""
        best: Spring | None = None
        bound = -math.inf
        stated = self.demands.preload
        for _ in range(MAX_ROUNDS):
            least = self._minimize_model()
            if least is None:
                return None
            x, bound = least
            greatest, needed = self.try_spring(x)
            preload = needed if stated is None else stated
            if needed <= preload + FORCE_TOLERANCE * self.scale and (
                best is None or greatest + preload < best.greatest_force
            ):
                best = Spring(self._clip_rate(x), preload, greatest + preload, None)
            # The bound is a proof of optimality to this tolerance.
            if best is not None and best.greatest_force - bound <= FORCE_TOLERANCE * abs(best.greatest_force):
                break
        if best is None:
            return None
        # Rounding may put the bound slightly above the value.
        return Spring(best.rate, best.preload, best.greatest_force, min(bound, best.greatest_force))

    def find_nearest_miss(self) -> Spring:
        """Find the spring whose required preload exceeds the given one by the smallest amount."""
        stated = self.demands.preload
        assert stated is not None, "a free preload meets every need"
        best: tuple[float, float, float] | None = None
        for _ in range(MAX_ROUNDS):
            x, bound = _select_minimum(
                lambda at: _evaluate_maximum(self.needs, at), _find_turning_points(self.needs), self.ends
            )
            greatest, needed = self.try_spring(x)
            if best is None or needed < best[0]:
                best = needed, x, greatest
            if best[0] - bound <= FORCE_TOLERANCE * self.scale:
                break
        assert best is not None
        return Spring(self._clip_rate(best[1]), stated, best[2] + stated, None)

    def _minimize_model(self) -> tuple[float, float] | None:
        """Minimize the model: return x and value; None if its needs exceed a given preload everywhere."""
        stated = self.demands.preload
        candidates = [_find_turning_points(self.upper), _find_turning_points(self.needs)]
        if stated is None:
            # The sum of the two maxima is the maximum of all pairwise sums, so its minimum is at one of their vertices.
            together = (self.upper[:, None] + self.needs[None]).reshape(-1, 3)
            candidates.append(_find_vertices(together))

            def model(x: Real) -> Real:
                return _evaluate_maximum(self.upper, x) + _evaluate_maximum(self.needs, x)
        else:
            candidates.append(_find_crossings(self.needs - np.array([stated, 0.0, 0.0])))
            # Half the tolerance, so that a spring on the model's boundary passes the full one.
            allowed = stated + 0.5 * FORCE_TOLERANCE * self.scale

            def model(x: Real) -> Real:
                return np.where(
                    _evaluate_maximum(self.needs, x) <= allowed, _evaluate_maximum(self.upper, x) + stated, math.inf
                )

        x, value = _select_minimum(model, np.concatenate(candidates), self.ends)
        return (x, value) if math.isfinite(value) else None


def _evaluate_both_sides(program: Program, angle: float) -> Real:
    """Return s, v, a on both sides of an angle, where the motion may jump; shape (2, 3)."""
    return np.array([[float(x) for x in program.motion(angle, before=side)[:3]] for side in (False, True)])


def _evaluate_maximum(rows: Real, x: Real) -> Real:
    """Return the maximum of parabolas at places."""
    at = np.asarray(x)
    return np.asarray((rows[:, 0, None] + rows[:, 1, None] * at + rows[:, 2, None] * at**2).max(axis=0))


def _find_turning_points(rows: Real) -> Real:
    """Return the places where the maximum of parabolas may switch or have a vertex."""
    # Every pair of parabolas may cross; the list stays short, as each round adds two cuts.
    first, second = np.triu_indices(len(rows), 1)
    return np.concatenate([_find_vertices(rows), _find_crossings(rows[first] - rows[second])])


def _find_vertices(rows: Real) -> Real:
    curved = rows[:, 2] != 0.0
    return np.asarray(-0.5 * rows[curved, 1] / rows[curved, 2])


def _find_crossings(rows: Real) -> Real:
    """Return the real roots of c + b x + a x², without cancellation."""
    c, b, a = rows.T
    square = b * b - 4.0 * a * c
    some = square >= 0.0
    c, b, a = c[some], b[some], a[some]
    # Adding terms of equal sign avoids cancellation; the second root is c/q.
    q = -0.5 * (b + np.copysign(np.sqrt(square[some]), b))
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.concatenate([q / a, c / q])
    return np.asarray(found[np.isfinite(found)])


def _select_minimum(model: Callable[[Real], Real], candidates: Real, ends: tuple[float, float]) -> tuple[float, float]:
    """Select the best of the candidates between two ends, ends included."""
    inside = candidates[(candidates > ends[0]) & (candidates < ends[1])]
    x = np.unique(np.concatenate([inside, ends]))
    values = model(x)
    k = int(values.argmin())
    return float(x[k]), float(values[k])
