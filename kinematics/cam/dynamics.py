"""Forces between cam and follower at a speed: contact force, spring and preload, camshaft torque, flywheel.

The follower is a mass that the cam moves through its program (Norton, *Design of Machinery*, §15.2, eq. 15.4),

    F(θ) = m ω² a + c ω v + k s + F0,        T(θ) = F v,

with F along the follower's motion, positive from the cam to the follower, and the program's s, v, a per radian. With a
moment of inertia, a torsional spring and a torque preload the same holds for an oscillating follower. Contact holds
where F > 0. A groove or a yoke makes the joint form-closed: k = F0 = 0, and the follower changes walls where F changes
sign. Any consistent set of units may be used.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Real
from kinematics.cam.motion.extremes import Extremes, find_extremes, find_roots
from kinematics.cam.motion.pieces import Motion
from kinematics.cam.motion.program import TURN, Program
from kinematics.errors import DimensionError

MIN_ANGLE_GAP = 1e-13
"""Radians below which two breaks are merged: a closer pair differs only by rounding."""

COINCIDENCE_TOLERANCE = 1e-10
"""Radians within which joints of several cams coincide: their angles are converted from degrees and added to phases."""


MIN_PRESSING_FORCE = 1e-6
"""Share of the maximum force above which the follower is pressed to a wall. Motions found by convex optimization have
smaller spurious forces where the true force is zero, which are too weak to take up any play."""


@dataclass(frozen=True)
class FollowerLoad:
    """Inertia, spring and friction that the cam works against.

    Parameters
    ----------
    mass : float
        Mass of the follower and of everything that moves with it, reduced to the follower; for an oscillating
        follower a moment of inertia.
    spring_rate : float
        Rate of the return spring; 0 for a form-closed joint.
    preload : float
        Force of the spring and of constant loads at s = 0, toward the cam.
    damping : float
        Coefficient c of viscous friction.
    """

    mass: float
    spring_rate: float = 0.0
    preload: float = 0.0
    damping: float = 0.0

    def __post_init__(self) -> None:
        for name in ("mass", "spring_rate", "preload", "damping"):
            value = getattr(self, name)
            if not (math.isfinite(value) and (value > 0.0 if name == "mass" else value >= 0.0)):
                expected = "kinematics-positive" if name == "mass" else "kinematics-at-least"
                raise DimensionError(name, expected, value, least=0)

    @property
    def damping_ratio(self) -> float:
        """Share of the critical damping 2 √(k m); infinite for a damped mass without a spring."""
        if not self.damping:
            return 0.0
        critical = 2.0 * math.sqrt(self.spring_rate * self.mass)
        return self.damping / critical if critical else math.inf

    def with_damping_ratio(self, ratio: float) -> FollowerLoad:
        """Return the load with the damping c = 2 ζ √(k m) of a ratio ζ."""
        if not (math.isfinite(ratio) and ratio >= 0.0):
            raise DimensionError("kinematics-damping-ratio", "kinematics-at-least", ratio, least=0)
        return replace(self, damping=2.0 * ratio * math.sqrt(self.spring_rate * self.mass))

    @property
    def natural_frequency(self) -> float:
        """√(k/m), radians per unit of time; 0 without a spring."""
        return math.sqrt(self.spring_rate / self.mass)

    def find_weakest_speed(self, motion: Motion, top_speed: float) -> Real:
        """Return the speed between 0 and a top speed at which F is minimal, given a program's s, v, a."""
        curving = 2.0 * self.mass * motion.a
        vertex = -self.damping * motion.v / np.where(curving > 0.0, curving, 1.0)
        # Without a minimum inside, compare F at the top speed with F at 0 (divided by the speed).
        at_end = self.damping * motion.v + self.mass * top_speed * motion.a < 0.0
        end = np.where(at_end, top_speed, 0.0)
        return np.asarray(np.where(curving > 0.0, np.clip(vertex, 0.0, top_speed), end))

    def force(self, motion: Motion, speed: ArrayLike) -> Real:
        """Return F at a program's s, v, a; ``speed`` is one speed for all points, or one for each."""
        w = np.asarray(speed, dtype=np.float64)
        inertia = self.mass * w**2 * motion.a
        return np.asarray(inertia + self.damping * w * motion.v + self.spring_rate * motion.s + self.preload)


class WeakestContact(NamedTuple):
    """Minimum contact force over angles and speeds, with the cam angle and the speed at which it occurs."""

    force: float
    angle: float
    speed: float


@dataclass(frozen=True, eq=False)
class RunningCam:
    """A cam's program at a constant speed with its follower's load.

    Parameters
    ----------
    program : Program
    load : FollowerLoad
    speed : float
        Speed of the camshaft, radians per unit of time, positive.
    phase : float
        Camshaft angle at which the program begins, for several cams on one shaft.
    """

    program: Program
    load: FollowerLoad
    speed: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.speed) and self.speed > 0.0):
            raise DimensionError("speed", "kinematics-positive", self.speed)
        if not math.isfinite(self.phase):
            raise DimensionError("phase", "kinematics-finite", self.phase)

    def force(self, angle: ArrayLike) -> Real:
        """Return F along the follower's motion at cam angles; the normal force is F/cos(pressure angle)."""
        return self.load.force(self.program.motion(angle), self.speed)

    def torque(self, angle: ArrayLike) -> Real:
        """Return the torque that turns the camshaft against the follower, at cam angles."""
        motion = self.program.motion(angle)
        return np.asarray(self.load.force(motion, self.speed) * motion.v)

    @cached_property
    def force_extremes(self) -> Extremes:
        """Exact extremes of F; where F ≤ 0 the follower leaves a force-closed cam."""
        return find_extremes(self.force, self.program.breaks)

    @cached_property
    def torque_extremes(self) -> Extremes:
        """Exact extremes of the torque."""
        return find_extremes(self.torque, self.program.breaks)

    def find_reversals(self) -> Real:
        """Find the angles where F changes sign: there a form-closed follower crosses to the other wall.

        If F stays at zero in between, as in a dwell without spring and preload, the angle is the end of that zone. If F
        only touches zero, or has the same sign before and after a dwell, there is no reversal.
        """
        # F has one sign between neighbouring roots or breaks, so its value in the middle decides.
        pieces = np.unique(np.concatenate([find_roots(self.force, self.program.breaks), self.program.breaks]))
        force = self.force(0.5 * (pieces[:-1] + pieces[1:]))
        pressed = np.flatnonzero(np.abs(force) > MIN_PRESSING_FORCE * self.force_extremes.largest)
        # The program is periodic: the piece before the first is the last of the previous turn.
        changed = force[pressed] * force[np.roll(pressed, 1)] < 0.0
        return np.asarray(np.mod(pieces[:-1][pressed[changed]], TURN))

    def compute_min_preload(self, floor: float = 0.0) -> float:
        """Compute the smallest preload, at least 0, that keeps F at or above a floor; all other loads are unchanged."""
        return max(0.0, floor + self.load.preload - self.force_extremes.least)

    def find_weakest_contact(self, top_speed: float) -> WeakestContact:
        """Find the minimum F over all cam angles and all speeds from 0 to a top speed; the running speed is irrelevant.

        At one angle F is a parabola in the speed. It is minimal at its vertex if a > 0 and the vertex lies in the
        range, otherwise at an end of the range.
        """
        load, motion = self.load, self.program.motion
        c, m = load.damping, load.mass

        def slope_at_top_speed(angle: Real) -> Real:
            now = motion(angle)
            return np.asarray(c * now.v + 2.0 * m * top_speed * now.a)

        def difference_over_speed(angle: Real) -> Real:
            now = motion(angle)
            return np.asarray(c * now.v + m * top_speed * now.a)

        # Where the minimizing speed switches between vertex and ends, the minimum over speeds has a kink: split there.
        switches = [lambda angle: motion(angle).a]
        if c > 0.0:
            switches += [lambda angle: motion(angle).v, slope_at_top_speed, difference_over_speed]
        breaks = self.program.breaks
        breaks = np.unique(np.concatenate([breaks, *(find_roots(switch, breaks) for switch in switches)]))
        apart = np.append(True, np.diff(breaks) > MIN_ANGLE_GAP)

        def minimize_over_speed(angle: Real) -> Real:
            now = motion(angle)
            return load.force(now, load.find_weakest_speed(now, top_speed))

        found = find_extremes(minimize_over_speed, breaks[apart])
        # At a break the minimum may be a limit from either side.
        sides = [motion(found.at_least, before=side) for side in (False, True)]
        speeds = [float(load.find_weakest_speed(now, top_speed)) for now in sides]
        forces = [float(load.force(now, speed)) for now, speed in zip(sides, speeds, strict=True)]
        return WeakestContact(found.least, found.at_least, speeds[int(np.argmin(forces))])

    def find_jump_speed(self, floor: float = 0.0) -> float:
        """Find the speed at which F first falls to a floor; the running speed is irrelevant.

        With q = k s + F0 − floor > 0 and u = 1/ω the force at one angle equals the floor where q u² + c v u + m a = 0.
        As ω rises from 0 (u falls from ∞) the larger root comes first; the result is the largest positive u over all
        angles. The speed is 0 if the follower does not even rest on the cam, infinite if it never leaves it.
        """
        load, motion = self.load, self.program.motion
        c, m, breaks = load.damping, load.mass, self.program.breaks

        def resting_margin(angle: Real) -> Real:
            return np.asarray(load.spring_rate * motion(angle).s + load.preload - floor)

        _, v, a = self.program.peaks[:3]
        resting = find_extremes(resting_margin, breaks).least
        # Neither deceleration nor damping pulls the follower off at any speed.
        if m * max(-a.least, 0.0) + c * v.largest <= 0.0:
            return math.inf if resting >= 0.0 else 0.0
        if resting <= 0.0:
            return 0.0
        if c == 0.0:
            # Without damping u² itself is smooth; taking the root at the end avoids the kink at zero.
            square = find_extremes(lambda angle: -m * motion(angle).a / resting_margin(angle), breaks).greatest
            return 1.0 / math.sqrt(square)

        def discriminant(angle: Real) -> Real:
            now = motion(angle)
            return np.asarray((c * now.v) ** 2 - 4.0 * m * now.a * resting_margin(angle))

        def slowness(angle: Real) -> Real:
            square = discriminant(angle)
            root = (np.sqrt(np.maximum(square, 0.0)) - c * motion(angle).v) / (2.0 * resting_margin(angle))
            return np.where(square >= 0.0, np.maximum(root, 0.0), 0.0)

        breaks = np.unique(np.concatenate([breaks, find_roots(discriminant, breaks)]))
        # The larger root exists only where the discriminant is positive; its roots are kinks and become breaks.
        u = find_extremes(slowness, breaks[np.append(True, np.diff(breaks) > MIN_ANGLE_GAP)]).greatest
        return 1.0 / u if u > 0.0 else math.inf


@dataclass(frozen=True, eq=False)
class Camshaft:
    """Several cams on one shaft, each with its phase, at one speed."""

    cams: Sequence[RunningCam]

    def __post_init__(self) -> None:
        if len({cam.speed for cam in self.cams}) != 1:
            raise DimensionError("kinematics-cam-speeds", "kinematics-all-equal", [cam.speed for cam in self.cams])

    @property
    def speed(self) -> float:
        """Speed of the shaft, radians per unit of time."""
        return self.cams[0].speed

    @cached_property
    def breaks(self) -> Real:
        """Shaft angles from 0 to 2π between which the torque is smooth."""
        shifted = [np.mod(cam.program.breaks + cam.phase, TURN) for cam in self.cams]
        angles = np.unique(np.concatenate([[0.0], *shifted, [TURN]]))
        kept: Real = angles[np.append(True, np.diff(angles) > COINCIDENCE_TOLERANCE)]
        # The end of the turn must stay exact even if its neighbour was merged into it.
        kept[-1] = TURN
        return kept

    def torque(self, angle: ArrayLike) -> Real:
        """Return the sum of the cams' torques at shaft angles."""
        at = np.asarray(angle, dtype=np.float64)
        return np.asarray(np.sum([cam.torque(at - cam.phase) for cam in self.cams], axis=0))

    @cached_property
    def torque_extremes(self) -> Extremes:
        """Exact extremes of the shaft's torque."""
        return find_extremes(self.torque, self.breaks)

    @cached_property
    def mean_torque(self) -> float:
        """Mean torque over a turn: only friction contributes, since masses and springs return their energy."""
        return float(self._integrate_torque(self.breaks).sum()) / TURN

    @cached_property
    def energy_fluctuation(self) -> float:
        """Largest fluctuation over a turn of the energy exchanged with the shaft, about its mean.

        The energy ∫(T − T̄) dθ has its extremes where the torque crosses its mean (Norton §11.11).
        """
        mean = self.mean_torque
        crossings = find_roots(lambda angle: self.torque(angle) - mean, self.breaks)
        at = np.unique(np.concatenate([self.breaks, crossings]))
        at = at[np.append(True, np.diff(at) > COINCIDENCE_TOLERANCE)]
        energy = np.concatenate([[0.0], np.cumsum(self._integrate_torque(at) - mean * np.diff(at))])
        return float(energy.max() - energy.min())

    def compute_flywheel_inertia(self, fluctuation: float) -> float:
        """Compute the inertia that keeps (ω_max − ω_min)/ω at a coefficient k: E/(k ω²) (Norton eq. 11.22)."""
        if not (math.isfinite(fluctuation) and fluctuation > 0.0):
            raise DimensionError("kinematics-coefficient-of-fluctuation", "kinematics-positive", fluctuation)
        return self.energy_fluctuation / (fluctuation * self.speed**2)

    def _integrate_torque(self, at: Real) -> Real:
        """Integrate the torque between neighbouring angles by Gauss's rule on quarters of each interval."""
        nodes, weights = np.polynomial.legendre.leggauss(GAUSS_NODE_COUNT)
        low, step = at[:-1, None], np.diff(at)[:, None] / PARTS_PER_STRETCH
        middles = low + step * (np.arange(PARTS_PER_STRETCH) + 0.5)
        values = self.torque(middles[..., None] + 0.5 * step[..., None] * nodes)
        return np.asarray((values @ weights).sum(axis=1) * 0.5 * step[:, 0])


GAUSS_NODE_COUNT = 12
PARTS_PER_STRETCH = 4
"""Nodes of Gauss's rule and parts of each smooth stretch: enough to integrate the torque of every law to rounding."""
