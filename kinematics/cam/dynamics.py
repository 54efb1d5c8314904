"""Forces between cam and follower at a speed: contact force, spring and preload, camshaft torque, flywheel.

The follower is a mass that the cam carries through its program (Norton, *Design of Machinery*, §15.2, eq. 15.4),

    F(θ) = m ω² a + c ω v + k s + F0,        T(θ) = F v,

F along the follower's motion and positive from the cam to the follower; s, v, a are of the program, per radian. With a
moment of inertia, a torsional spring and a torque preload the same holds for an oscillating follower. Contact holds
where F > 0. A groove or a yoke closes the joint by form: k = F0 = 0, and F changes sides where it changes sign. Units
are any consistent set.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.cam.extremes import Extremes, extremes, roots
from kinematics.cam.pieces import Motion
from kinematics.cam.program import TURN, Program
from kinematics.errors import DimensionError

Real = NDArray[np.float64]

CONVERGED = 1e-12
"""Relative change at which an iteration for a spring or a speed has ended."""

STEPS = 500
"""At most; the iterations end after a dozen, for a speed with damping after about a hundred."""

SAME = 1e-10
"""Radians within which joints of several cams are one; share of the lift that is rounding."""


PRESSED = 1e-6
"""Share of the greatest force from which a force presses the follower to a wall; less is what a motion that was found
by a convex program has instead of none, and no play would show it."""


@dataclass(frozen=True)
class FollowerLoad:
    """What the cam has to move.

    Parameters
    ----------
    mass : float
        Of the follower and all that moves with it, reduced to it; a moment of inertia for an oscillating one.
    spring_rate : float
        Of the spring that closes the joint; 0 where it is closed by form.
    preload : float
        Force of spring and constant load at s = 0, toward the cam.
    damping : float
        c, of viscous friction.
    """

    mass: float
    spring_rate: float = 0.0
    preload: float = 0.0
    damping: float = 0.0

    def __post_init__(self) -> None:
        for name in ("mass", "spring_rate", "preload", "damping"):
            value = getattr(self, name)
            if not (math.isfinite(value) and (value > 0.0 if name == "mass" else value >= 0.0)):
                expected = "positive" if name == "mass" else "at least 0"
                raise DimensionError(name.replace("_", " "), expected, value)

    def damped(self, ratio: float) -> FollowerLoad:
        """With the damping of a ratio ζ: c = 2 ζ √(k m)."""
        if not (math.isfinite(ratio) and ratio >= 0.0):
            raise DimensionError("damping ratio", "at least 0", ratio)
        return replace(self, damping=2.0 * ratio * math.sqrt(self.spring_rate * self.mass))

    @property
    def natural_frequency(self) -> float:
        """√(k/m), radians per unit of time; 0 without a spring."""
        return math.sqrt(self.spring_rate / self.mass)

    def force(self, motion: Motion, speed: float) -> Real:
        """F at a program's s, v, a."""
        inertia = self.mass * speed**2 * motion.a
        return np.asarray(inertia + self.damping * speed * motion.v + self.spring_rate * motion.s + self.preload)


@dataclass(frozen=True, eq=False)
class RunningCam:
    """A cam's program at a constant speed with its follower's load.

    Parameters
    ----------
    program : Program
    load : FollowerLoad
    speed : float
        Of the camshaft, radians per unit of time, positive.
    phase : float
        Camshaft angle at which the program begins, for several cams on one shaft.
    """

    program: Program
    load: FollowerLoad
    speed: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.speed) and self.speed > 0.0):
            raise DimensionError("speed", "positive", self.speed)
        if not math.isfinite(self.phase):
            raise DimensionError("phase", "finite", self.phase)

    def force(self, angle: ArrayLike) -> Real:
        """F along the follower's motion at cam angles; the normal force is F over the cosine of the pressure angle."""
        return self.load.force(self.program.motion(angle), self.speed)

    def torque(self, angle: ArrayLike) -> Real:
        """Torque that turns the camshaft against the follower, at cam angles."""
        motion = self.program.motion(angle)
        return np.asarray(self.load.force(motion, self.speed) * motion.v)

    @cached_property
    def force_extremes(self) -> Extremes:
        """Exact extremes of F; not above zero the follower leaves a cam that is closed by force."""
        return extremes(self.force, self.program.breaks)

    @cached_property
    def torque_extremes(self) -> Extremes:
        """Exact extremes of the torque."""
        return extremes(self.torque, self.program.breaks)

    def reversals(self) -> Real:
        """Angles from which F has the other sign than before: a form-closed follower crosses to the other wall there.

        Where F is zero in between, as in a rest without spring and preload, it is where that ends; where F only comes
        to zero, or has one sign before a rest and after it, there is none. F has one sign between two neighbouring
        roots or breaks. The last sign of a turn is the one before its first.
        """
        pieces = np.unique(np.concatenate([roots(self.force, self.program.breaks), self.program.breaks]))
        force = self.force(0.5 * (pieces[:-1] + pieces[1:]))
        pressed = np.flatnonzero(np.abs(force) > PRESSED * self.force_extremes.largest)
        changed = force[pressed] * force[np.roll(pressed, 1)] < 0.0
        return np.asarray(np.mod(pieces[:-1][pressed[changed]], TURN))

    def least_preload(self, floor: float = 0.0) -> float:
        """The preload with which F is nowhere below a floor, the rest of the load as it is; 0 where none is needed."""
        return max(0.0, floor + self.load.preload - self.force_extremes.least)

    def jump_speed(self, floor: float = 0.0) -> float:
        """The speed at which F first falls to a floor; the given speed does not matter.

        Between speeds ω and ω + δ the least F falls by at most c δ max|v| + m (2 ω δ + δ²) max(−a), so that steps of
        that size never pass the first fall. 0 where the follower does not even rest on the cam, infinite where nothing
        throws it off.
        """
        load, (s, v, a) = self.load, self.program.peaks[:3]
        push, drag = load.mass * max(-a.least, 0.0), load.damping * v.largest
        if push + drag <= 0.0:
            return math.inf if load.spring_rate * s.least + load.preload >= floor else 0.0
        if load.damping == 0.0:
            return self._jump_speed_without_damping(floor)
        speed = 0.0
        for _ in range(STEPS):
            spare = self._least_force(speed) - floor
            if spare <= 0.0:
                return speed
            # push δ² + (drag + 2 push ω) δ = spare
            half = 0.5 * drag + push * speed
            step = spare / (half + math.sqrt(half * half + push * spare))
            speed += step
            if step <= CONVERGED * speed:
                return speed
        return speed

    def _least_force(self, speed: float) -> float:
        return extremes(lambda angle: self.load.force(self.program.motion(angle), speed), self.program.breaks).least

    def _jump_speed_without_damping(self, floor: float) -> float:
        """m ω² (−a) = k s + F0 − floor where that asks for the least ω: 1/ω² is the greatest of m (−a)/(k s + ...)."""
        load, motion = self.load, self.program.motion

        def spare(angle: Real) -> Real:
            return np.asarray(load.spring_rate * motion(angle).s + load.preload - floor)

        if extremes(spare, self.program.breaks).least <= 0.0:
            return 0.0
        square = extremes(lambda angle: -load.mass * motion(angle).a / spare(angle), self.program.breaks).greatest
        return 1.0 / math.sqrt(square)


@dataclass(frozen=True, eq=False)
class Camshaft:
    """Several cams on one shaft, each with its phase, at one speed."""

    cams: Sequence[RunningCam]

    def __post_init__(self) -> None:
        if len({cam.speed for cam in self.cams}) != 1:
            raise DimensionError("speeds of the cams", "one and the same", [cam.speed for cam in self.cams])

    @property
    def speed(self) -> float:
        """Of the shaft."""
        return self.cams[0].speed

    @cached_property
    def breaks(self) -> Real:
        """Shaft angles from 0 to 2π between which the torque is smooth."""
        shifted = [np.mod(cam.program.breaks + cam.phase, TURN) for cam in self.cams]
        angles = np.unique(np.concatenate([[0.0], *shifted, [TURN]]))
        kept: Real = angles[np.append(True, np.diff(angles) > SAME)]
        kept[-1] = TURN
        return kept

    def torque(self, angle: ArrayLike) -> Real:
        """Sum of the cams' torques at shaft angles."""
        at = np.asarray(angle, dtype=np.float64)
        return np.asarray(np.sum([cam.torque(at - cam.phase) for cam in self.cams], axis=0))

    @cached_property
    def torque_extremes(self) -> Extremes:
        """Exact extremes of the shaft's torque."""
        return extremes(self.torque, self.breaks)

    @cached_property
    def mean_torque(self) -> float:
        """Over a turn: what friction takes, since masses and springs give all back."""
        return float(self._work(self.breaks).sum()) / TURN

    @cached_property
    def energy_fluctuation(self) -> float:
        """Greatest difference of the energy that the shaft gives and takes around its mean, over a turn.

        The energy ∫(T − T̄) dθ has its extremes where the torque crosses its mean (Norton §11.11).
        """
        mean = self.mean_torque
        crossings = roots(lambda angle: self.torque(angle) - mean, self.breaks)
        at = np.unique(np.concatenate([self.breaks, crossings]))
        at = at[np.append(True, np.diff(at) > SAME)]
        energy = np.concatenate([[0.0], np.cumsum(self._work(at) - mean * np.diff(at))])
        return float(energy.max() - energy.min())

    def flywheel_inertia(self, fluctuation: float) -> float:
        """Moment of inertia that keeps (ω_max − ω_min)/ω at a coefficient k: E/(k ω²) (Norton eq. 11.22)."""
        if not (math.isfinite(fluctuation) and fluctuation > 0.0):
            raise DimensionError("coefficient of fluctuation", "positive", fluctuation)
        return self.energy_fluctuation / (fluctuation * self.speed**2)

    def _work(self, at: Real) -> Real:
        """∫ T dθ between neighbouring angles, by Gauss's rule on quarters of each."""
        nodes, weights = np.polynomial.legendre.leggauss(GAUSS)
        low, step = at[:-1, None], np.diff(at)[:, None] / PARTS
        middles = low + step * (np.arange(PARTS) + 0.5)
        values = self.torque(middles[..., None] + 0.5 * step[..., None] * nodes)
        return np.asarray((values @ weights).sum(axis=1) * 0.5 * step[:, 0])


GAUSS = 12
PARTS = 4
"""Nodes of Gauss's rule and parts of each smooth stretch: torques of all laws are integrated to rounding."""
