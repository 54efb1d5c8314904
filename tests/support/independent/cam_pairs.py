"""Conjugate cams by the textbooks: the second cam is that of the follower upside down, and both rollers keep apart."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from tests.support.independent.comparison import Beside

Shape = Callable[[Any], dict[str, float]]
"""The metrics of a cam that follow from its shape, of the motion upside down."""

CHECKED = {
    "second_pressure_angle": "max_pressure_angle_rise",
    "second_pressure_angle_fall": "max_pressure_angle_fall",
    "second_curvature_ratio": "curvature_ratio",
    "second_clears_pivot": "size",
}
"""Checks whose value is a metric."""


def compare_pair(beside: Beside, shape: Shape) -> None:
    """Compare the second cam's metrics and checks, the distance of the rollers, and which cam pushes."""
    mechanism, metrics = beside.design.mechanism, beside.design.metrics
    second = mechanism.second
    found = shape(
        SimpleNamespace(
            type="cam",
            follower=second.follower,
            prime_radius=second.prime_radius,
            base_radius=None,
            rotation=mechanism.rotation,
        )
    )
    for name, value in found.items():
        beside.add(f"metrics.second.{name}", getattr(metrics.second, name), value, 90.0 if "angle" in name else value)
    for check, name in CHECKED.items():
        if name in found:
            beside.check(check, found[name], 90.0 if "angle" in name else found[name])
    hub = second.prime_radius - second.follower.roller_radius
    beside.check("second_hub_radius", hub, hub)
    beside.check("second_size", second.prime_radius, second.prime_radius)
    for name in ("no_cusp", "does_not_cross_itself"):
        beside.check(f"second_{name}", True)
    beside.check("second_reproduces_program", 0.0)
    beside.check("roller_distance", 0.0)
    one, two = (_points(curve) for curve in (mechanism.pitch_curve, second.pitch_curve))
    apart = second.roller_distance
    beside.add("mechanism.second", float(np.abs(np.abs(one - two) - apart).max()), 0.0, apart)
    inside = float(np.abs(np.abs(_points(second.profile) - two) - second.follower.roller_radius).max())
    beside.add("mechanism.second", inside, 0.0, second.prime_radius)


def compare_pushing(beside: Beside, at: Real, force: Real) -> None:
    """The first cam pushes where the force is along the displacement, the second where it is against it."""
    forces = beside.design.metrics.forces
    for push in forces.pushing or []:
        end = push.end if push.end > push.start else push.end + 360.0
        inside = np.mod(np.degrees(at) - push.start, 360.0) < end - push.start
        strongest = force[inside][np.abs(force[inside]).argmax()] if inside.any() else 1.0
        beside.same("metrics.forces.pushing.cam", push.cam, 1 if strongest >= 0.0 else 2)
        beside.compared |= {"metrics.forces.pushing.start", "metrics.forces.pushing.end"}


def _points(curve: Any) -> NDArray[np.complex128]:
    return np.array(curve.x) + 1j * np.array(curve.y)
