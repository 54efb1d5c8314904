"""The faces of a rotor: its correction planes viewed along the axis, each with its corrections."""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

from synthesis.kinds.balancing.design import RotorCorrection, RotorMechanism


class Mark(NamedTuple):
    """A mass on a face: its place, in length units or, without a radius, as a share of the largest unbalance."""

    at: complex
    correction: RotorCorrection


class Face(NamedTuple):
    """A correction plane: its place along the axis, its marks, and the radius of the outermost mark."""

    z: float
    marks: list[Mark]
    radius: float


def make_faces(mechanism: RotorMechanism) -> list[Face]:
    """Return the faces of all planes, drawn to one radius."""
    # Without radii, marks are placed by their share of the largest unbalance.
    size = max((entry.unbalance for entry in mechanism.corrections), default=0.0) or 1.0
    reach = max((entry.radius or entry.unbalance / size for entry in mechanism.corrections), default=1.0)
    return [
        Face(z, [mark for mark in _make_marks(mechanism, size) if mark.correction.plane == plane], reach)
        for plane, z in enumerate(mechanism.planes)
    ]


def _make_marks(mechanism: RotorMechanism, size: float) -> list[Mark]:
    return [
        Mark(cmath.rect(entry.radius or entry.unbalance / size, math.radians(entry.angle)), entry)
        for entry in mechanism.corrections
    ]
