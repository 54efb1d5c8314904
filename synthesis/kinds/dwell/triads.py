"""Stephenson II dwell sixbars as shapes: their objective and constraints, their joints, and their range.

A shape has the numbers listed in :mod:`triad_turn`, in a frame with the crank's pivot O2 at the origin, O4 on the
positive real axis and O2–A of 1. Its pins stand at the begin of the first dwell, so that its lengths and its assembly
follow from them. While the output rests, its pin E stands still and link 4 turns about it; seen from the crank, E moves
along an arc about O2.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.dwell.outputs import CYCLE, SPARSE, Task, dwelling, extremes
from synthesis.kinds.dwell.triad_turn import BEGIN, FIXED, LEGS, SHORTEST, B, C, D, E, each_turned
from synthesis.numerics.narrowing import Values

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

FARTHEST_PIN = 4.0
"""Maximum coordinates, in units of the maximum link ratio."""

LEAST_LENGTH = 0.02
"""Lower bound of the minimum distance of two pins of a link, relative to O2–A."""


class Turned(NamedTuple):
    """Shapes over a turn of their crank, NaN where one does not complete it.

    Attributes
    ----------
    pins : complex, shape (m, n, 3)
        B, D and E at the requested angles.
    course : float, shape (m, N)
        The output at equal steps of the turn from the begin of the first dwell, as an angle from there.
    sines : float, shape (m, N, 3)
        Magnitudes of the sines of its transmission angles: output, link 3, link 5.
    """

    pins: Complex
    course: Real
    sines: Real


def over_a_turn(shapes: Real, at: Real, steps: int) -> Turned:
    """Drive shapes (m, ...) through a turn in ``steps`` steps; ``at`` (m, n): further angles of the crank."""
    driven = Turned(
        np.empty((*at.shape, LEGS), np.complex128),
        np.empty((len(shapes), steps)),
        np.empty((len(shapes), steps, LEGS)),
    )
    each_turned(np.ascontiguousarray(shapes), at, *driven)
    return driven


def judged(task: Task, nodes: Real, shapes: Real) -> Values:
    """Compute the objective, the output's movement during the dwells as a share of its range, and the constraints."""
    at = np.concatenate([shapes[:, BEGIN + k, None] + dwell * nodes for k, dwell in enumerate(task.dwells)], axis=1)
    driven, ground = over_a_turn(shapes, at, CYCLE), shapes[:, FIXED]
    arms = (driven.pins[:, :, -1] - ground[:, None]) / (pins_of(shapes)[:, -1] - ground)[:, None]
    banded, kept = dwelling(task, len(nodes), np.concatenate([np.angle(arms), driven.course], axis=1), ground)
    transmitted = driven.sines[:, ::SPARSE] ** 2 - task.transmission**2
    lengths, least = pin_distances(shapes), shapes[:, SHORTEST, None]
    # The shortest distance is an unknown of its own, which makes the link ratio a smooth constraint.
    even = [lengths / least - 1.0, task.link_ratio * least / lengths - 1.0]
    positive = np.concatenate([kept, transmitted.reshape(len(shapes), -1), *even], axis=1)
    return Values(banded, np.empty((len(shapes), 0)), positive)


def pins_of(shapes: Real) -> Complex:
    """Return A, C, B, D and E at the begin of the first dwell, (m, 5)."""
    crank = np.exp(1j * shapes[:, BEGIN])
    carried = [shapes[:, at] + 1j * shapes[:, at + 1] for at in (C, B, D, E)]
    return np.stack([crank, carried[0] * crank, *carried[1:]], axis=1)


def pin_distances(shapes: Real) -> Real:
    """Return all distances between two pins of a link, the crank's O2–A of 1 first, (m, 10)."""
    o4 = shapes[:, FIXED]
    a, c, b, d, e = pins_of(shapes).T
    lengths = [np.abs(c), np.abs(c - a), np.abs(b - a), np.abs(d - c), np.abs(d - b), np.abs(e - b), np.abs(e - d)]
    return np.stack([np.ones(len(shapes)), *lengths, np.abs(e - o4), o4], axis=1)


def bounds(numbers: int, link_ratio: float) -> tuple[Real, Real]:
    """Return minimum and maximum values of a shape's numbers; angles are unbounded."""
    high = np.full(numbers, FARTHEST_PIN * link_ratio)
    high[BEGIN:] = np.inf
    low = -high
    # Lengths must stay positive.
    low[[FIXED, SHORTEST]] = LEAST_LENGTH
    return low, high


def joints(shape: Real) -> dict[str, complex]:
    """Return the joints by name at the begin of the first dwell."""
    moving = zip("ACBDE", pins_of(shape[None])[0], strict=True)
    return {"O2": 0j, "O4": complex(shape[FIXED]), **{name: complex(z) for name, z in moving}}


def way_of(shape: Real, steps: int) -> float:
    """Return the swing over a turn, radians; NaN if the sixbar does not complete it."""
    low, high = extremes(over_a_turn(shape[None], np.empty((1, 0)), steps).course)
    return float(high[0] - low[0])


def with_pivot(shape: Real, factor: float) -> Real:
    """Move the output's pivot to ``factor`` times its distance from its pin E at the begin of the first dwell.

    As long as E rests the output does, regardless of its pivot.
    """
    moved = shape.copy()
    e = complex(shape[E], shape[E + 1])
    o4 = e + factor * (complex(shape[FIXED]) - e)
    # Rotate the frame so that O4 is on the positive real axis again.
    back = o4.conjugate() / abs(o4) if o4 else 1.0 + 0j
    moved[FIXED] = abs(o4)
    for at in (B, D, E):
        pin = complex(shape[at], shape[at + 1]) * back
        moved[at], moved[at + 1] = pin.real, pin.imag
    moved[BEGIN:] += float(np.angle(back))
    return moved
