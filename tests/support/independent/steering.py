"""Steering mechanisms: the wheels' angles to both sides, against those of wheels that roll about one centre."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from kinematics.arrays import Real
from tests.support.independent.comparison import Beside
from tests.support.independent.drive import Drive
from tests.support.independent.extremes import GRID, greatest, root
from tests.support.independent.linkage import Used, compare_linkage

HALVINGS = 60
"""Steps of the bisection for the input at the lock."""

EXACT = 1e-3
"""Degrees: steering errors below this are compared as they are and not by their size."""


def _inner(left: Real, right: Real) -> float:
    """The angle of the wheel nearer to the centre of the turn, of one position."""
    return float(left[0]) if float(left[0] + right[0]) > 0.0 else -float(right[0])


def compare_steering(beside: Beside, stated: dict[str, Any]) -> None:
    """Errors at the targets and at most, locks, radius."""
    design = beside.design
    drive = Drive(design.mechanism.skeleton)
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
        # The cotangents of outer and inner angle differ by the share.
        return np.arctan(np.tan(inner) / (1.0 + share * np.tan(inner)))

    def error(turns: Real) -> Real:
        left, right = wheels(turns)
        # To the left the wheels turn counter-clockwise, and the left one is the inner one.
        inner, outer = np.where(left + right > 0.0, left, -right), np.where(left + right > 0.0, right, -left)
        return np.asarray(outer - required(inner))

    turned = np.array([t.position for t in design.targets])
    turned = turned if davis else np.radians(turned) - drive.reference
    turned = turned if davis else turned - math.tau * round(float(turned[0]) / math.tau)
    # The bar or the left arm that is driven on until the inner wheel is at its lock.
    ends = []
    for side in (1.0, -1.0):
        low, high = 0.0, 0.0
        while high == 0.0 or _inner(*wheels(np.array([high]))) < lock:
            low, high = high, high + side * 0.05 * float(np.abs(turned).max())
            if abs(high) > 2.0 * float(np.abs(turned).max()) or not drive.follow(min(0.0, high), max(0.0, high)):
                beside.unmeasured("could not be driven")
                return
        for _ in range(HALVINGS):
            at = 0.5 * (low + high)
            low, high = (at, high) if _inner(*wheels(np.array([at]))) < lock else (low, at)
        ends.append(low)
    inner, outer = wheels(turned)
    for k, target in enumerate(design.targets):
        demanded = float(required(inner[k : k + 1])[0])
        beside.add("targets.inner", target.inner, math.degrees(inner[k]), 90.0)
        beside.add("targets.outer", target.outer, math.degrees(outer[k]), 90.0)
        beside.add("targets.required", target.required, math.degrees(demanded), 90.0)
        beside.add("targets.error", target.error, math.degrees(outer[k] - demanded), 90.0)
        _compare_input(beside, drive, target, float(turned[k]), k / (len(turned) - 1), ends)
    low, high = min(ends), max(ends)
    most = math.degrees(greatest(lambda turns: np.abs(error(turns)), low, high).value)
    beside.metric("steering_error", most, max(most, EXACT))
    beside.check("steering_error", most, max(most, EXACT))
    beside.check("steers_correctly", most, 90.0)
    left = ends[0] if ends[0] * turned[-1] > 0.0 else ends[1]
    at_lock = wheels(np.array([left]))
    beside.check("reaches_locks", abs(float(at_lock[0][0]) - lock) < 1e-9)
    beside.metric("outer_lock", math.degrees(at_lock[1][0]), 90.0)
    _compare_changes(beside, error, wheels, left, most)
    radius = stated["wheelbase"] / math.sin(float(required(np.array([lock]))[0]))
    radius += 0.5 * (stated.get("track", stated["pivot_distance"]) - stated["pivot_distance"])
    beside.metric("turning_radius", radius, radius)
    pin = complex(drive.home[drive.names.index("A")] - drive.home[drive.names.index("O2")])
    beside.metric("arm_length", abs(pin), abs(pin))
    # The arms lean inward, towards the other kingpin, where the tie rod is behind.
    inward = math.copysign(1.0, float(drive.home[drive.names.index("O4")].real - drive.home[0].real))
    lean = math.degrees(math.atan(inward * pin.real / abs(pin.imag))) * (1.0 if pin.imag < 0.0 else -1.0)
    beside.metric("arm_angle", lean, 90.0)
    beside.same("metrics.tie_rod", design.metrics.tie_rod, "behind" if pin.imag < 0.0 else "ahead")
    track = stated.get("track", stated["pivot_distance"])
    wheel = stated.get("wheel_width", 0.12 * track if "track" in stated else 0.0)
    face = 0.5 * (track - stated["pivot_distance"] - wheel)
    beside.metric("tie_rod_clearance", face + inward * pin.real, abs(pin))
    beside.check("tie_rod_clearance", face + inward * pin.real, abs(pin))
    beside.metric("bar_travel", max(map(abs, ends)), max(map(abs, ends)))
    compare_linkage(beside, stated, drive, Used((low, high), None, drive.home, None))


def _compare_input(beside: Beside, drive: Drive, target: Any, turn: float, share: float, ends: list[float]) -> None:
    """The positions are even steps of the input from straight ahead to the lock."""
    lock = next(end for end in ends if turn == 0.0 or end * turn > 0.0)
    if drive.slides_in:
        found = share * lock if turn else 0.0
        beside.add("targets.input_place", target.input_place, found, abs(lock))
        return
    off = target.input_angle - math.degrees(drive.reference + (share * lock if turn else 0.0))
    beside.add("targets.input_angle", target.input_angle, target.input_angle - math.remainder(off, 360.0), 360.0)


def _compare_changes(
    beside: Beside,
    error: Callable[[Real], Real],
    wheels: Callable[[Real], tuple[Real, Real]],
    lock: float,
    most: float,
) -> None:
    """The inner wheel's angles at which the error changes its sign on the way to the lock on the left."""
    stated = beside.design.metrics.correct_at
    places = lock * np.linspace(0.0, 1.0, GRID)[1:]
    signs = np.sign(error(places))
    changes = np.flatnonzero(signs[1:] * signs[:-1] < 0.0).tolist() if most > 1e-9 else []
    beside.same("metrics.correct_at", len(stated), len(changes))
    for value, k in zip(stated, changes, strict=False):
        at = root(error, float(places[k]), float(places[k + 1]))
        beside.add("metrics.correct_at", value, math.degrees(float(wheels(np.array([at]))[0][0])), 90.0)
