"""Code that several tests share: gear drawing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.gear.teeth import Gear

SVG = "{http://www.w3.org/2000/svg}"


def assert_involute(gear: Gear, points: np.ndarray) -> None:
    """From the pitch circle to the tip every point lies on a string unwound from the base circle.

    Both flanks of all teeth are two families of such curves; they start at the middle of a tooth plus and minus the
    half tooth on the pitch circle and the involute of the pressure angle.
    """
    radius, phi = np.abs(points), gear.pressure_angle
    assert radius.max() == pytest.approx(gear.tip_radius)
    assert radius.min() == pytest.approx(gear.root_radius)
    flank = points[(radius > gear.pitch_radius) & (radius < gear.tip_radius * (1.0 - 1e-9))]
    assert len(flank) > 8 * gear.teeth
    roll = np.sqrt((np.abs(flank) / gear.base_radius) ** 2 - 1.0)
    start = 0.5 * math.pi / gear.teeth + math.tan(phi) - phi - (roll - np.arctan(roll))
    off = np.stack([np.angle(flank * np.exp(sign * 1j * start)) for sign in (1.0, -1.0)]) * gear.teeth / (2.0 * math.pi)
    # In units of a pitch from the middle of the first tooth: whole numbers.
    middles = np.mod(off - _middle(points, gear), 1.0)
    assert np.minimum(middles, 1.0 - middles).min(axis=0).max() < 1e-6


def _middle(points: np.ndarray, gear: Gear) -> float:
    """Where the middle of a tooth is, in pitches: the mean direction of its tip."""
    tip = points[np.abs(points) > gear.tip_radius * (1.0 - 1e-9)]
    return float(np.angle(np.mean((tip / np.abs(tip)) ** gear.teeth))) / (2.0 * math.pi)
