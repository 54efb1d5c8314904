"""Joints, links and topologies of sixbars, and their assembly from dyads.

The sixbars consist of a fourbar O₂ A B O₄, driven by one of its ground links, and a dyad Q₁ J Q₂ on two of its links.
The links that carry Q₁ and Q₂ define the topology (*make*).
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex
from kinematics.compiling import njit
from synthesis.kinds.motion.sixbar.relative_dyads import JIT_OPTIONS

O2, A, B, O4, Q1, Q2, J = range(7)
"""Indices of a candidate's joints, in the first position."""

GROUND, INPUT, COUPLER, OUTPUT = range(4)
"""Links that may carry Q₁ and Q₂."""

TOPOLOGY_LINKS = np.array([[COUPLER, INPUT], [COUPLER, OUTPUT], [COUPLER, GROUND], [INPUT, OUTPUT], [OUTPUT, INPUT]])
"""Links of Q₁ and of Q₂, by topology number."""

WATT_1_IN, WATT_1_OUT, STEPHENSON_3, STEPHENSON_1_IN, STEPHENSON_1_OUT = range(5)
"""Numbers of the topologies, by the link that is the input."""

LINK_PINS = np.array([[O2, O4], [O2, A], [A, B], [O4, B]])
"""Pins of each link of the fourbar."""


@njit(**JIT_OPTIONS)
def place_on_link(
    link: int, point: complex, joints: Complex, a: complex, into: complex, through: complex, out: complex
) -> complex:
    """Return a point of a link of the fourbar after the rotations ``into``, ``through``, ``out`` of its links."""
    place = point
    if link == INPUT:
        place = joints[O2] + into * (point - joints[O2])
    elif link == COUPLER:
        place = a + through * (point - joints[A])
    elif link == OUTPUT:
        place = joints[O4] + out * (point - joints[O4])
    return place


@njit(**JIT_OPTIONS)
def close_dyad(pin: complex, other: complex, first: float, second: float, side: float) -> tuple[complex, float]:
    """Close a dyad: return the joint of two links on two pins; ``side`` is +1 to the left of the line between these.

    The second value is the cosine of the angle between the links; it is outside ±1 if they do not meet.
    """
    base = other - pin
    square = base.real * base.real + base.imag * base.imag
    cosine = (first * first + second * second - square) / (2.0 * first * second)
    # Negated, so that NaN counts as not closing.
    if not abs(cosine) < 1.0:
        return pin, cosine
    along, height = (
        0.5 * (first * first - second * second + square) / square,
        first * second * compute_sine(cosine) / square,
    )
    return pin + base * complex(along, side * height), cosine


@njit(**JIT_OPTIONS)
def compute_sine(cosine: float) -> float:
    """Return the sine of the angle between two links, or a negative measure of the gap if they do not meet."""
    return math.sqrt((1.0 - cosine) * (1.0 + cosine)) if abs(cosine) < 1.0 else 1.0 - abs(cosine)


@njit(**JIT_OPTIONS)
def compute_signed_sine(pin: complex, other: complex, joint: complex) -> float:
    """Return the sine of the angle between two links, negative if their joint is to the right of the pins' line."""
    one, two = joint - pin, joint - other
    return (one.conjugate() * two).imag / (abs(one) * abs(two))
