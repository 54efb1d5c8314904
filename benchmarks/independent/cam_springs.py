"""Springs of cams by another route: forces on a grid of speeds, the speed of the jump by bisection, rates tried out."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.independent.comparison import Beside
from benchmarks.independent.extremes import greatest, least

Real = NDArray[np.float64]

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

    def jump(self, rate: float, upto: float) -> float | None:
        """The first speed at which the force falls below zero; None where it does at none up to one."""
        allowed = -SEEN * greatest(np.abs(self.force(rate, upto)))

        def off(speed: float) -> bool:
            return least(self.force(rate, speed)) < min(allowed, 0.0)

        grid = np.linspace(0.0, upto, SPEEDS)
        first = next((k for k, speed in enumerate(grid) if off(float(speed))), None)
        if first is None or first == 0:
            return None if first is None else 0.0
        return _bisected(off, float(grid[first - 1]), float(grid[first]))


def _bisected(off: Callable[[float], bool], low: float, high: float) -> float:
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if off(middle) else (middle, high)
    return high


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
        jump = moved.jump(rate, 2.0 * found)
        # Where little is missing the force falls through zero slowly: a force is what is compared.
        scale = greatest(np.abs(moved.force(rate, found)))
        beside.same("metrics.forces.jump_speed", jump is None, found == 0.0)
        beside.add("metrics.forces.jump_speed", least(moved.force(rate, found)) / scale, 0.0, 1.0)
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
    beside.check("contact_on_profile", weakest / arm, 1e3 * scale / arm)
    beside.compared |= {f"metrics.forces.over_speeds.{name}" for name in ("angle", "rpm")}
    if forces.spring is not None:
        _compare_choice(beside, stated, moved, arm, (speed, top))


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
