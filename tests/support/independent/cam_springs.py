"""Springs of cams by another route: forces on a grid of speeds, and rates tried out."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from kinematics.arrays import Real
from tests.support.independent.cam_motion import greatest, least
from tests.support.independent.comparison import Beside

SPEEDS = 129
"""Speeds of a grid from 0 to the greatest."""

RATES = 60
"""Springs that are tried beside the one that was chosen."""

SEEN = 1e-6
"""Share of the greatest force that a sampled one is not blamed for."""


@dataclass(frozen=True)
class Moved:
    """What is moved: the motion, mass, damping ratio and preload, all at the arm's end times its length."""

    s: Real
    v: Real
    a: Real
    mass: float
    ratio: float
    preload: float

    def force(self, rate: float, speed: float, preload: float | None = None) -> Real:
        """Contact force at a rate and a speed."""
        damping = 2.0 * self.ratio * math.sqrt(self.mass * rate)
        pressed = self.preload if preload is None else preload
        return np.asarray(self.mass * speed**2 * self.a + damping * speed * self.v + rate * self.s + pressed)

    def weakest(self, rate: float, top: float) -> float:
        """The least force without preload from rest to a speed."""
        return min(least(self.force(rate, speed, 0.0)) for speed in np.linspace(0.0, top, SPEEDS))

    def jumps(self, rate: float, below: float) -> bool:
        """Whether the force falls below zero at a lower speed."""
        allowed = SEEN * greatest(np.abs(self.force(rate, below)))
        return any(least(self.force(rate, speed)) < -allowed for speed in np.linspace(0.0, below, SPEEDS))


def compare_springs(beside: Beside, stated: dict[str, Any], moved: Moved, arm: float, speed: float) -> None:
    """The spring's rate and frequencies, the jump, and the least force over the speeds of an answer."""
    forces, dynamics = beside.design.metrics.forces, stated["dynamics"]
    given = dynamics.get("spring_rate", 0.0)
    rate = forces.spring_rate * arm**2
    natural = math.sqrt(rate / moved.mass)
    if isinstance(given, float):
        beside.add("metrics.forces.spring_rate", forces.spring_rate, given, given or 1.0)
    else:
        beside.compared.add("metrics.forces.spring_rate")
    beside.add(
        "metrics.forces.damped_frequency", forces.damped_frequency, _damped(natural, moved.ratio), natural or 1.0
    )
    beside.check("frequency_ratio", natural / speed, natural / speed or 1.0)
    if forces.jump_speed is not None:
        found = forces.jump_speed * math.tau / 60.0
        scale = greatest(np.abs(moved.force(rate, found)))
        # Where little is missing the force falls through zero slowly: a force is what is compared.
        fallen = max(least(moved.force(rate, found)), 0.0) if found == 0.0 else least(moved.force(rate, found))
        beside.add("metrics.forces.jump_speed", fallen / scale, 0.0, 1.0)
        beside.same("metrics.forces.jump_speed", moved.jumps(rate, 0.999 * found), False)
    if forces.train is not None:
        _compare_train(beside, dynamics, moved, rate, (arm, speed))
    if forces.over_speeds is None:
        return
    top = forces.over_speeds.max_rpm * math.tau / 60.0
    weakest, scale = moved.weakest(rate, top) + moved.preload, forces.max_contact_force * arm
    beside.add(
        "metrics.forces.over_speeds.max_rpm", top, dynamics.get("max_rpm", stated["speed_rpm"]) * math.tau / 60.0, top
    )
    beside.add(
        "metrics.forces.over_speeds.min_contact_force", forces.over_speeds.min_contact_force * arm, weakest, scale
    )
    beside.check("contact_force", min(weakest, least(moved.force(rate, speed))) / arm, scale / arm)
    checks = {check.name: check.passed for check in beside.design.verification.checks}
    # A profile with a corner turns the follower about it, and has other forces than the requested motion.
    if checks.get("reproduces_program", True):
        beside.check("contact_on_profile", weakest / arm, 1e3 * scale / arm)
    else:
        beside.without("checks.contact_on_profile", "the profile has a corner")
    beside.compared |= {f"metrics.forces.over_speeds.{name}" for name in ("angle", "rpm")}
    if forces.spring is not None:
        _compare_choice(beside, stated, moved, arm, (speed, top))


def _compare_train(
    beside: Beside, dynamics: dict[str, Any], moved: Moved, rate: float, arm_and_speed: tuple[float, float]
) -> None:
    """Frequencies of mass, train and spring; how it swings is integrated in the tests."""
    arm, speed = arm_and_speed
    train, place = beside.design.metrics.forces.train, "metrics.forces.train"
    natural = math.sqrt((dynamics["train_stiffness"] * arm**2 + rate) / moved.mass)
    damped = _damped(natural, dynamics.get("train_damping_ratio", 0.0))
    moves = [x.angle for x in beside.design.segments if x.motion != "dwell"]
    tau = 360.0 / natural * speed / min(moves)
    beside.add(f"{place}.natural_frequency", train.natural_frequency, natural, natural)
    beside.add(f"{place}.damped_frequency", train.damped_frequency, damped, natural)
    beside.add(f"{place}.frequency_ratio", train.frequency_ratio, natural / speed, natural / speed)
    beside.add(f"{place}.period_ratio", train.period_ratio, tau, tau)
    beside.compared |= {f"{place}.{x}" for x in ("residual_amplitude", "min_contact_force", "max_contact_force")}


def _damped(natural: float, ratio: float) -> float:
    return natural * math.sqrt(max(1.0 - ratio**2, 0.0))


def _compare_choice(
    beside: Beside, stated: dict[str, Any], moved: Moved, arm: float, speeds: tuple[float, float]
) -> None:
    """No spring of many that are tried and keep the demands has a smaller force than the bound."""
    forces, dynamics = beside.design.metrics.forces, stated["dynamics"]
    chosen, given = forces.spring, dynamics.get("spring_rate")
    speed, top = speeds
    found = greatest(moved.force(forces.spring_rate * arm**2, speed))
    beside.add("metrics.forces.spring.max_contact_force", chosen.max_contact_force * arm, found, found)
    beside.compared |= {f"metrics.forces.spring.{name}" for name in ("bound", "gap", "binding")}
    if chosen.bound is None:
        return
    low, high = (given["min"], given["max"]) if isinstance(given, dict) else (0.0, 10.0 * forces.spring_rate + 1.0)
    low = max(low * arm**2, moved.mass * (dynamics.get("min_frequency_ratio", 0.0) * speed) ** 2)
    for rate in np.linspace(low, max(high * arm**2, low), RATES):
        needed = max(dynamics.get("least_force", 0.0) * arm - moved.weakest(float(rate), top), 0.0)
        preload = dynamics["preload"] * arm if dynamics.get("preload") is not None else needed
        if needed <= preload:
            better = greatest(moved.force(float(rate), speed, preload))
            beside.same("metrics.forces.spring.bound", better < chosen.bound * arm * (1.0 - SEEN), False)
