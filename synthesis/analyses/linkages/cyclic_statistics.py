"""Properties of forces over a closed cycle: mean, rms, harmonics, and a flywheel for the drive."""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Numbers, Real
from kinematics.dynamics.reactions import Reactions
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.mechanisms.flywheel import (
    compute_exact_coefficient,
    compute_first_order_inertia,
    compute_fluctuation,
    find_exact_inertia,
    list_pulses,
)
from synthesis.model.dynamics.loads import FULL_TURN
from synthesis.model.dynamics.request import FlywheelSpec
from synthesis.model.json_object import JsonObject

CYCLE_TOLERANCE = 1e-9
"""Tolerance with which a motion counts as closed, as a share of a cycle, for rounding."""

PERIODICITY_TOLERANCE = 1e-6
"""Permitted difference of the drive at the ends of a cycle, as a share of its peak, for rounding that is magnified near
a toggle."""

MAX_ORDERS = 24
"""Maximum order of reported harmonics, in periods per turn of the input."""


def is_closed(mechanism: Mechanism, at: Real, drive: Real, turns: int) -> bool:
    """Return whether the motion is a whole number of cycles of ``turns`` turns, and the drive repeats."""
    if mechanism.has_slide_input or len(at) < 3 or not turns:
        return False
    cycles = abs(float(at[-1] - at[0])) / (FULL_TURN * turns)
    steps = np.diff(at)
    even = float(np.ptp(steps)) <= CYCLE_TOLERANCE * float(np.abs(at[-1] - at[0]))
    whole = round(cycles) >= 1 and abs(cycles - round(cycles)) <= CYCLE_TOLERANCE * cycles
    # The drive does not repeat if, for example, a torsion spring is wound up turn by turn.
    known = np.abs(drive[np.isfinite(drive)])
    return even and whole and len(known) > 0 and bool(abs(drive[-1] - drive[0]) <= PERIODICITY_TOLERANCE * known.max())


def compute_mean(values: Real, closed: bool) -> float | None:
    """Compute the mean over a closed cycle by the trapezoid rule; None if it is not closed or a value is unknown."""
    return float(values[:-1].mean()) if closed and np.isfinite(values).all() else None


def compute_rms(values: Real, closed: bool) -> float | None:
    """Compute the root mean square over a closed cycle; None as for :func:`compute_mean`."""
    squared = compute_mean(values**2, closed)
    return None if squared is None else math.sqrt(squared)


def _compute_orders(values: Numbers, turns: float) -> list[tuple[str, complex, complex]]:
    """Compute Fourier coefficients of values over a closed run of ``turns`` turns, for each order and its negative."""
    count = len(values) - 1
    found = np.fft.fft(values[:-1]) / count
    most = min(MAX_ORDERS * round(turns), (count - 1) // 2)
    return [(f"{k / turns:.10g}", complex(found[k]), complex(found[-k])) for k in range(1, most + 1)]


def describe_harmonics(found: Reactions, at: Real, closed: bool) -> JsonObject:
    """Describe harmonics as :class:`synthesis.model.dynamics.answer.Harmonics`; phases are those at input angle 0."""
    parts = {"shaking_force": found.shaking_force, "shaking_moment": found.shaking_moment, "drive": found.drive}
    if not closed or not all(np.isfinite(values).all() for values in parts.values()):
        return dict.fromkeys(parts)
    turns, start = abs(float(at[-1] - at[0])) / FULL_TURN, math.radians(float(at[0]))
    # Harmonics are defined for an increasing angle, so reverse a motion that runs backward.
    if at[-1] < at[0]:
        parts, start = {name: values[::-1] for name, values in parts.items()}, math.radians(float(at[-1]))
    force = {
        order: {"forward": abs(positive), "backward": abs(negative)}
        for order, positive, negative in _compute_orders(parts["shaking_force"], turns)
    }
    waves = {
        name: {
            order: {
                "amplitude": 2.0 * abs(positive),
                "phase": math.degrees(math.remainder(float(order) * start - np.angle(positive), 2.0 * math.pi)),
            }
            for order, positive, _ in _compute_orders(parts[name], turns)
        }
        for name in ("shaking_moment", "drive")
    }
    return {"shaking_force": force, **waves}


def describe_flywheel(drive: Real, at: Real, speed: float, closed: bool, wanted: FlywheelSpec | None) -> JsonObject:
    """Describe the flywheel as :class:`synthesis.model.dynamics.answer.Flywheel`."""
    if not closed or not np.isfinite(drive).all():
        sized = {} if wanted is None else dict.fromkeys(("inertia", "inertia_exact", "coefficient_exact"))
        return {"energy": None, "mean_torque": None, **sized, "pulses": []}
    angle, torque = (at, drive) if at[-1] > at[0] else (at[::-1], drive[::-1])
    found = compute_fluctuation(np.radians(angle), torque)
    answer: JsonObject = {"energy": found.energy, "mean_torque": found.mean}
    if wanted is not None and speed != 0.0:
        whole = compute_first_order_inertia(found.energy, abs(speed), wanted.coefficient)
        exact = find_exact_inertia(found, abs(speed), wanted.coefficient)
        answer |= {
            "inertia": max(0.0, whole - wanted.existing_inertia),
            "inertia_exact": max(0.0, exact - wanted.existing_inertia),
            "coefficient_exact": compute_exact_coefficient(found, max(whole, wanted.existing_inertia), abs(speed)),
        }
    return answer | {"pulses": list_pulses(found, math.radians(float(angle[-1] - angle[0])))}
