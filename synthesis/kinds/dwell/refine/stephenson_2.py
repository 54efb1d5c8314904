"""Stephenson II dwell sixbars as shapes: their objective and constraints, their joints, and their range.

A shape has the numbers listed in :mod:`synthesis.kinds.dwell.refine.stephenson_2_cycle`, in a frame with the crank's
pivot O2 at the origin, O4 on the positive real axis and O2–A of 1. The pins are given at the beginning of the first
dwell and determine the lengths and the assembly. While the output rests, its pin E stands still and link 4 turns about
it. Seen from the crank, E then moves along an arc about O2.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.dwell.motion.outputs import (
    CYCLE_SAMPLE_COUNT,
    TRANSMISSION_STRIDE,
    Task,
    evaluate_dwells,
    find_extremes,
)
from synthesis.kinds.dwell.refine.stephenson_2_cycle import (
    BEGIN_INDEX,
    FIXED_INDEX,
    LEG_COUNT,
    SHORTEST_INDEX,
    B,
    C,
    D,
    E,
    drive_triads,
)
from synthesis.numerics.narrowing import ShapeValues

MAX_COORDINATE = 4.0
"""Maximum coordinates, in units of the maximum link ratio."""

MIN_LENGTH = 0.02
"""Lower bound of the minimum distance of two pins of a link, relative to O2–A."""


class DrivenShapes(NamedTuple):
    """Shapes over a turn of their crank, NaN where one does not complete it.

    Attributes
    ----------
    pins : complex, shape (m, n, 3)
        B, D and E at the requested angles.
    course : float, shape (m, N)
        The output at equal steps of the turn from the beginning of the first dwell, as an angle from there.
    sines : float, shape (m, N, 3)
        Magnitudes of the sines of its transmission angles: output, link 3, link 5.
    """

    pins: Complex
    course: Real
    sines: Real


def drive_shapes(shapes: Real, at: Real, steps: int) -> DrivenShapes:
    """Drive shapes (m, ...) through a turn in ``steps`` steps; ``at`` (m, n): further angles of the crank."""
    driven = DrivenShapes(
        np.empty((*at.shape, LEG_COUNT), np.complex128),
        np.empty((len(shapes), steps)),
        np.empty((len(shapes), steps, LEG_COUNT)),
    )
    drive_triads(np.ascontiguousarray(shapes), at, *driven)
    return driven


def evaluate_shapes(task: Task, nodes: Real, shapes: Real) -> ShapeValues:
    """Compute the objective, the output's movement during the dwells as a share of its range, and the constraints."""
    at = np.concatenate(
        [shapes[:, BEGIN_INDEX + k, None] + dwell * nodes for k, dwell in enumerate(task.dwells)], axis=1
    )
    driven, ground = drive_shapes(shapes, at, CYCLE_SAMPLE_COUNT), shapes[:, FIXED_INDEX]
    arms = (driven.pins[:, :, -1] - ground[:, None]) / (locate_pins(shapes)[:, -1] - ground)[:, None]
    banded, kept = evaluate_dwells(task, len(nodes), np.concatenate([np.angle(arms), driven.course], axis=1), ground)
    transmitted = driven.sines[:, ::TRANSMISSION_STRIDE] ** 2 - task.transmission**2
    lengths, least = compute_pin_distances(shapes), shapes[:, SHORTEST_INDEX, None]
    # The shortest distance is an unknown of its own, which makes the link ratio a smooth constraint.
    even = [lengths / least - 1.0, task.link_ratio * least / lengths - 1.0]
    positive = np.concatenate([kept, transmitted.reshape(len(shapes), -1), *even], axis=1)
    return ShapeValues(banded, np.empty((len(shapes), 0)), positive)


def locate_pins(shapes: Real) -> Complex:
    """Return A, C, B, D and E at the beginning of the first dwell, shape (m, 5)."""
    crank = np.exp(1j * shapes[:, BEGIN_INDEX])
    carried = [shapes[:, at] + 1j * shapes[:, at + 1] for at in (C, B, D, E)]
    return np.stack([crank, carried[0] * crank, *carried[1:]], axis=1)


def compute_pin_distances(shapes: Real) -> Real:
    """Return all distances between two pins of a link, the crank's O2–A of 1 first, (m, 10)."""
    o4 = shapes[:, FIXED_INDEX]
    a, c, b, d, e = locate_pins(shapes).T
    lengths = [np.abs(c), np.abs(c - a), np.abs(b - a), np.abs(d - c), np.abs(d - b), np.abs(e - b), np.abs(e - d)]
    return np.stack([np.ones(len(shapes)), *lengths, np.abs(e - o4), o4], axis=1)


def get_bounds(numbers: int, link_ratio: float) -> tuple[Real, Real]:
    """Return minimum and maximum values of a shape's numbers; angles are unbounded."""
    high = np.full(numbers, MAX_COORDINATE * link_ratio)
    high[BEGIN_INDEX:] = np.inf
    low = -high
    # Lengths must stay positive.
    low[[FIXED_INDEX, SHORTEST_INDEX]] = MIN_LENGTH
    return low, high


def name_joints(shape: Real) -> dict[str, complex]:
    """Return the joints by name at the beginning of the first dwell."""
    moving = zip("ACBDE", locate_pins(shape[None])[0], strict=True)
    return {"O2": 0j, "O4": complex(shape[FIXED_INDEX]), **{name: complex(z) for name, z in moving}}


def measure_range(shape: Real, steps: int) -> float:
    """Return the swing over a turn, radians; NaN if the sixbar does not complete it."""
    low, high = find_extremes(drive_shapes(shape[None], np.empty((1, 0)), steps).course)
    return float(high[0] - low[0])


def move_pivot(shape: Real, factor: float) -> Real:
    """Move the output's pivot to ``factor`` times its distance from its pin E at the beginning of the first dwell.

    The output rests as long as E rests, wherever its pivot is.
    """
    moved = shape.copy()
    e = complex(shape[E], shape[E + 1])
    o4 = e + factor * (complex(shape[FIXED_INDEX]) - e)
    # Rotate the frame so that O4 is on the positive real axis again.
    back = o4.conjugate() / abs(o4) if o4 else 1.0 + 0j
    moved[FIXED_INDEX] = abs(o4)
    for at in (B, D, E):
        pin = complex(shape[at], shape[at + 1]) * back
        moved[at], moved[at + 1] = pin.real, pin.imag
    moved[BEGIN_INDEX:] += float(np.angle(back))
    return moved
