"""Vibration of an elastic follower train, one degree of freedom, in the steady state.

A mass m follows the cam through a train of stiffness k and damping c; a return spring k_s with a preload F0 presses it
to the cam (Norton §15.3–15.5; Koster, *Vibrations of Cam Mechanisms*, 1974). With x the mass's displacement, y = x − s
its lag and primes for derivatives by the cam angle,

    y″ + 2 ζ r y′ + r² y = −a − (k_s s + F0)/(m ω²),    r = ω_n/ω,  ω_n² = (k + k_s)/m,  2 ζ ω_n = c/m.

On each step the right side is replaced by the cubic with its values and slopes at both ends, and the equation is solved
exactly; the steady motion starts from the state that one turn maps to itself.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from kinematics.arrays import Real
from kinematics.cam.motion.program import TURN, Program
from kinematics.compiling import njit
from kinematics.errors import DimensionError

MIN_STEPS_PER_TURN = 1440
"""Minimum number of steps per turn; the cubic then approximates the right side to 1e-9 of it."""

MIN_STEPS_PER_PERIOD = 24
"""Minimum number of steps per period of the natural frequency, so that the oscillation is resolved in plots."""

MAX_STEPS = 50_000
"""Maximum number of steps, for a very stiff train whose single oscillations need not be resolved; the solution is exact
on steps of any length."""

RESONANCE_TOLERANCE = 1e-9
"""Smallest singular value of 1 − (transfer matrix of a turn) below which no steady motion exists."""

MIN_FREQUENCY_RATIO = 10.0
"""Ratio of natural frequency to speed below which the program's harmonics excite the train strongly (Norton §15.3)."""


@dataclass(frozen=True)
class FollowerTrain:
    """An elastic follower.

    Parameters
    ----------
    mass, stiffness : float
        Mass reduced to the follower, and stiffness of the train between cam and mass.
    damping : float
        Damping coefficient c of the train.
    spring_rate, preload : float
        Rate and preload of the return spring on the mass; 0 for a form-closed joint.
    """

    mass: float
    stiffness: float
    damping: float = 0.0
    spring_rate: float = 0.0
    preload: float = 0.0

    def __post_init__(self) -> None:
        for name in ("mass", "stiffness", "damping", "spring_rate", "preload"):
            value = getattr(self, name)
            least = name in ("mass", "stiffness")
            if not (math.isfinite(value) and (value > 0.0 if least else value >= 0.0)):
                raise DimensionError(name, "kinematics-positive" if least else "kinematics-at-least", value, least=0)

    @property
    def natural_frequency(self) -> float:
        """Natural frequency ω_n of the mass on its train and spring."""
        return math.sqrt((self.stiffness + self.spring_rate) / self.mass)

    @property
    def damping_ratio(self) -> float:
        """Damping ratio ζ."""
        return 0.5 * self.damping / (self.mass * self.natural_frequency)


@dataclass(frozen=True, eq=False)
class Response:
    """Steady motion of an elastic follower under a program.

    Parameters
    ----------
    program : Program
    train : FollowerTrain
    speed : float
        Speed of the cam, radians per unit of time.

    Raises
    ------
    DimensionError
        If the speed is not positive, or the train is damped critically or more: it does not vibrate.
    """

    program: Program
    train: FollowerTrain
    speed: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.speed) and self.speed > 0.0):
            raise DimensionError("speed", "kinematics-positive", self.speed)
        if not self.train.damping_ratio < 1.0:
            raise DimensionError("kinematics-damping-ratio", "kinematics-less-than-1", self.train.damping_ratio)

    @property
    def frequency_ratio(self) -> float:
        """Ratio r of the natural frequency to the speed."""
        return self.train.natural_frequency / self.speed

    @property
    def too_slow(self) -> bool:
        """Whether the natural frequency is so low that the program's first harmonics reach it."""
        return self.frequency_ratio < MIN_FREQUENCY_RATIO

    @cached_property
    def angle(self) -> Real:
        """Cam angles of the steps from 0 to 2π, every break of the program among them."""
        # Fine enough for both the program and the oscillation, but bounded.
        step = TURN / min(max(MIN_STEPS_PER_TURN, MIN_STEPS_PER_PERIOD * self.frequency_ratio), MAX_STEPS)
        breaks = self.program.breaks
        parts = [
            np.linspace(low, high, max(2, math.ceil((high - low) / step) + 1))[:-1] for low, high in pairwise(breaks)
        ]
        return np.concatenate([*parts, breaks[-1:]])

    @cached_property
    def state(self) -> Real:
        """y and y′ at the angles, shape (2, n); NaN at a resonance, where no steady motion exists."""
        r, zeta = self.frequency_ratio, self.train.damping_ratio
        steps = np.diff(self.angle)
        transfer = _build_transfer(r, zeta, steps)
        # Linear recurrence y_{k+1} = T_k y_k + f_k; the periodic solution solves (1 − ΠT) y₀ = Σ.
        driven = self._compute_forcing(steps, transfer)
        # The turn's transfer matrix, column by column, from unit initial states without forcing.
        columns = [_integrate_steps(transfer, push, start) for push, start in ((0.0 * driven, e) for e in np.eye(2))]
        gap = np.eye(2) - np.stack([column[-1] for column in columns], axis=1)
        # Near resonance the periodic solution grows without bound; report NaN instead.
        if np.linalg.svd(gap, compute_uv=False).min() <= RESONANCE_TOLERANCE:
            return np.full((2, len(self.angle)), np.nan)
        start = np.linalg.solve(gap, _integrate_steps(transfer, driven, np.zeros(2))[-1])
        return np.ascontiguousarray(_integrate_steps(transfer, driven, start).T)

    @property
    def resonant(self) -> bool:
        """Whether a harmonic of the speed coincides with the natural frequency of the undamped train."""
        return bool(np.isnan(self.state).any())

    @property
    def displacement(self) -> Real:
        """Displacement x of the mass at the angles."""
        return np.asarray(self.program.motion(self.angle).s + self.state[0])

    @property
    def acceleration(self) -> Real:
        """Acceleration x″ of the mass, per radian squared."""
        train, (y, rate) = self.train, self.state
        s = self.program.motion(self.angle).s
        spring = (train.spring_rate * (s + y) + train.preload) / (train.mass * self.speed**2)
        train_force = train.stiffness * y + train.damping * self.speed * rate
        return np.asarray(-spring - train_force / (train.mass * self.speed**2))

    @property
    def contact_force(self) -> Real:
        """Force of the cam on the train at the angles; where it is ≤ 0 the follower leaves the cam."""
        y, rate = self.state
        return np.asarray(-self.train.stiffness * y - self.train.damping * self.speed * rate)

    def residual(self) -> Real:
        """Return the amplitude of the free vibration at the start of each segment; it matters in dwells."""
        index = np.searchsorted(self.angle, self.program.joints[:-1])
        r, zeta, train = self.frequency_ratio, self.train.damping_ratio, self.train
        y, rate = self.state[:, index]
        s = self.program.motion(self.program.joints[:-1]).s
        # Static deflection; the free vibration is measured about it.
        rest = -(train.spring_rate * s + train.preload) / (train.stiffness + train.spring_rate)
        lag = y - rest
        return np.asarray(np.hypot(lag, (rate + zeta * r * lag) / (r * math.sqrt(1.0 - zeta**2))))

    def _compute_forcing(self, steps: Real, transfer: Real) -> Real:
        """Compute the forcing of each step on y, y′: end of the particular cubic minus the free motion from its
        start."""
        r, zeta, train = self.frequency_ratio, self.train.damping_ratio, self.train
        scale = 1.0 / (train.mass * self.speed**2)
        at_start = self.program.motion(self.angle[:-1])
        # One-sided values, because steps end at breaks of the program.
        at_end = self.program.motion(self.angle[1:], before=True)
        f0, f1 = (-m.a - scale * (train.spring_rate * m.s + train.preload) for m in (at_start, at_end))
        g0, g1 = (-m.j - scale * train.spring_rate * m.v for m in (at_start, at_end))
        slope = (f1 - f0) / steps
        cubic = np.stack([f0, g0, (3.0 * slope - 2.0 * g0 - g1) / steps, (g0 + g1 - 2.0 * slope) / steps**2])
        # The cubic p with p″ + 2ζr p′ + r² p = f, from its highest coefficient down.
        p = np.zeros((6, len(steps)))
        for k in range(3, -1, -1):
            p[k] = (cubic[k] - 2.0 * zeta * r * (k + 1) * p[k + 1] - (k + 2) * (k + 1) * p[k + 2]) / r**2
        end = p[0] + steps * (p[1] + steps * (p[2] + steps * p[3]))
        rate = p[1] + steps * (2.0 * p[2] + 3.0 * steps * p[3])
        start = np.stack([p[0], p[1]], axis=1)
        return np.asarray(np.stack([end, rate], axis=1) - (transfer @ start[..., None])[..., 0])


def _build_transfer(r: float, zeta: float, h: Real) -> Real:
    """Build the transfer matrices of y, y′ over steps of free vibration, shape (n, 2, 2)."""
    # Damped frequency per radian of cam rotation; ζ < 1 is checked on construction.
    w = r * math.sqrt(1.0 - zeta**2)
    decay, sine, cosine = np.exp(-zeta * r * h), np.sin(w * h), np.cos(w * h)
    lag = zeta * r / w * sine
    rows = [[cosine + lag, sine / w], [-(r * r) / w * sine, cosine - lag]]
    return np.asarray(np.moveaxis(decay * np.array(rows), -1, 0))


@njit(cache=True, nogil=True)
def _integrate_steps(transfer: Real, driven: Real, start: Real) -> Real:
    """Return the states after each step, the start first."""
    states = np.empty((len(transfer) + 1, 2))
    states[0] = start
    for k in range(len(transfer)):
        for row in range(2):
            free = transfer[k, row, 0] * states[k, 0] + transfer[k, row, 1] * states[k, 1]
            states[k + 1, row] = free + driven[k, row]
    return states
