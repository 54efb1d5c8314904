"""Steering mechanisms: the wheels' angles to both sides, against those of wheels that roll about one centre."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.independent.comparison import Measured
from benchmarks.independent.drive import Drive
from benchmarks.independent.extremes import greatest
from benchmarks.independent.linkage import box, compare_linkage

Real = NDArray[np.float64]

HALVINGS = 60
"""Steps of the bisection for the input at the lock."""


def _inner(left: Real, right: Real) -> float:
    """The angle of the wheel nearer to the centre of the turn, of one position."""
    return float(left[0]) if float(left[0] + right[0]) > 0.0 else -float(right[0])


def compare_steering(result: Measured, stated: dict[str, Any], design: Any, name: str) -> set[str]:
    """Errors at the targets and at most, locks, radius."""
    drive, metrics = Drive(design.mechanism.skeleton), design.metrics
    lock, davis = math.radians(stated["lock"]), design.mechanism.type == "davis"
    arms = [
        tuple(drive.names.index(j) for j in pins)
        for pins in ((("O2", "C"), ("O4", "D")) if davis else (("O2", "A"), ("O4", "B")))
    ]
    share = stated["pivot_distance"] / stated["wheelbase"]

    def wheels(turns: Real) -> tuple[Real, Real]:
        z = drive.at(turns)
        left, right = (
            np.angle((z[:, pin] - z[:, pivot]) / (drive.home[pin] - drive.home[pivot])) for pivot, pin in arms
        )
        return left, right

    def required(inner: Real) -> Real:
        return np.arctan2(np.sin(inner), np.cos(inner) + share * np.sin(inner))

    def error(turns: Real) -> Real:
        left, right = wheels(turns)
        # To the left the wheels turn counter-clockwise, and the left one is the inner one.
        inner, outer = np.where(left + right > 0.0, left, -right), np.where(left + right > 0.0, right, -left)
        return np.asarray(outer - required(inner))

    turned = np.array([t.at for t in design.targets])
    turned = turned if davis else np.radians(turned) - drive.reference
    turned = turned if davis else turned - math.tau * round(float(turned[0]) / math.tau)
    # The bar or the left arm that is driven on until the inner wheel is at its lock.
    ends = []
    for side in (1.0, -1.0):
        low, high = 0.0, 0.0
        while high == 0.0 or _inner(*wheels(np.array([high]))) < lock:
            low, high = high, high + side * 0.05 * float(np.abs(turned).max())
            if abs(high) > 2.0 * float(np.abs(turned).max()) or not drive.follow(min(0.0, high), max(0.0, high)):
                result.left[f"{design.mechanism.type}: could not be driven"] += 1
                return set()
        for _ in range(HALVINGS):
            at = 0.5 * (low + high)
            low, high = (at, high) if _inner(*wheels(np.array([at]))) < lock else (low, at)
        ends.append(low)
    inner, outer = wheels(turned)
    for k, target in enumerate(design.targets):
        result.add("steering inner", target.inner, math.degrees(inner[k]), 90.0, name)
        result.add("steering outer", target.outer, math.degrees(outer[k]), 90.0, name)
        result.add("steering required", target.required, math.degrees(float(required(inner[k : k + 1])[0])), 90.0, name)
        result.add(
            "steering error", target.error, math.degrees(outer[k] - float(required(inner[k : k + 1])[0])), 90.0, name
        )
    low, high = min(ends), max(ends)
    most = math.degrees(greatest(lambda turns: np.abs(error(turns)), low, high).value)
    result.add("steering steering_error", metrics.steering_error, most, 90.0, name)
    _, at_lock = wheels(np.array([ends[0] if ends[0] * turned[-1] > 0.0 else ends[1]]))
    result.add("steering outer_lock", metrics.outer_lock, math.degrees(at_lock[0]), 90.0, name)
    radius = stated["wheelbase"] / math.sin(float(required(np.array([lock]))[0]))
    radius += 0.5 * (stated.get("track", stated["pivot_distance"]) - stated["pivot_distance"])
    result.add("steering turning_radius", metrics.turning_radius, radius, radius, name)
    pin = drive.home[drive.names.index("A")] - drive.home[drive.names.index("O2")]
    result.add("steering arm_length", metrics.arm_length, float(abs(pin)), float(abs(pin)), name)
    lean = math.degrees(math.atan(abs(pin.real / pin.imag)))
    result.add("steering arm_angle", abs(metrics.arm_angle), lean, 90.0, name)
    compared = {"steering_error", "outer_lock", "turning_radius", "arm_length", "arm_angle"}
    if davis:
        result.add("steering bar_travel", metrics.bar_travel, max(map(abs, ends)), max(map(abs, ends)), name)
        result.add("steering size", metrics.size, box(drive.home), box(drive.home), name)
        return compared | {"bar_travel", "size"}
    return compared | compare_linkage(
        result, "steering", design, drive, name, way=(low, high), task=None, places=drive.home
    )
