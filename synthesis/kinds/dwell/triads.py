"""Stephenson II dwell sixbars as shapes: what is minimised and kept of them, their joints, and their way.

A shape has the numbers that :mod:`triad_turn` names, in a frame with the crank's pivot O2 at the origin, O4 on the
positive real axis and O2–A of 1. Its pins stand where the first dwell begins, so that its lengths and its assembly
follow from them. While the output rests its pin E stands still, and link 4 turns about it; seen from the crank, E goes
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
"""Coordinates at most, in units of the greatest link ratio."""

LEAST_LENGTH = 0.02
"""Least that the least distance of two pins of a link may be, beside O2–A."""


class Turned(NamedTuple):
    """Shapes over a turn of their crank, NaN where one does not go through it.

    Attributes
    ----------
    pins : complex, shape (m, n, 3)
        B, D and E at the angles that were asked for.
    course : float, shape (m, N)
        The output at even steps of the turn from where the first dwell begins, as an angle from there.
    sines : float, shape (m, N, 3)
        Magnitudes of the sines of its transmission angles: output, link 3, link 5.
    """

    pins: Complex
    course: Real
    sines: Real


def over_a_turn(shapes: Real, at: Real, steps: int) -> Turned:
    """Shapes (m, ...) driven through a turn in so many steps; ``at`` (m, n): further angles of the crank."""
    driven = Turned(
        np.empty((*at.shape, LEGS), np.complex128),
        np.empty((len(shapes), steps)),
        np.empty((len(shapes), steps, LEGS)),
    )
    each_turned(np.ascontiguousarray(shapes), at, *driven)
    return driven


def judged(task: Task, nodes: Real, shapes: Real) -> Values:
    """What is minimised, the output's way during the dwells as a share of the whole, and what is kept."""
    at = np.concatenate([shapes[:, BEGIN + k, None] + dwell * nodes for k, dwell in enumerate(task.dwells)], axis=1)
    driven, ground = over_a_turn(shapes, at, CYCLE), shapes[:, FIXED]
    arms = (driven.pins[:, :, -1] - ground[:, None]) / (pins_of(shapes)[:, -1] - ground)[:, None]
    banded, kept = dwelling(task, len(nodes), np.concatenate([np.angle(arms), driven.course], axis=1), ground)
    transmitted = driven.sines[:, ::SPARSE] ** 2 - task.transmission**2
    lengths, least = pin_distances(shapes), shapes[:, SHORTEST, None]
    even = [lengths / least - 1.0, task.link_ratio * least / lengths - 1.0]
    positive = np.concatenate([kept, transmitted.reshape(len(shapes), -1), *even], axis=1)
    return Values(banded, np.empty((len(shapes), 0)), positive)


def pins_of(shapes: Real) -> Complex:
    """A, C, B, D and E where the first dwell begins, (m, 5)."""
    crank = np.exp(1j * shapes[:, BEGIN])
    carried = [shapes[:, at] + 1j * shapes[:, at + 1] for at in (C, B, D, E)]
    return np.stack([crank, carried[0] * crank, *carried[1:]], axis=1)


def pin_distances(shapes: Real) -> Real:
    """All distances between two pins of a link, the crank's O2–A of 1 first, (m, 10)."""
    o4 = shapes[:, FIXED]
    a, c, b, d, e = pins_of(shapes).T
    lengths = [np.abs(c), np.abs(c - a), np.abs(b - a), np.abs(d - c), np.abs(d - b), np.abs(e - b), np.abs(e - d)]
    return np.stack([np.ones(len(shapes)), *lengths, np.abs(e - o4), o4], axis=1)


def bounds(numbers: int, link_ratio: float) -> tuple[Real, Real]:
    """Least and greatest numbers of a shape that has so many; angles have none."""
    high = np.full(numbers, FARTHEST_PIN * link_ratio)
    high[BEGIN:] = np.inf
    low = -high
    low[[FIXED, SHORTEST]] = LEAST_LENGTH
    return low, high


def joints(shape: Real) -> dict[str, complex]:
    """Joints by name where the first dwell begins."""
    moving = zip("ACBDE", pins_of(shape[None])[0], strict=True)
    return {"O2": 0j, "O4": complex(shape[FIXED]), **{name: complex(z) for name, z in moving}}


def way_of(shape: Real, steps: int) -> float:
    """Swing over a turn, radians; NaN where it does not go through it."""
    low, high = extremes(over_a_turn(shape[None], np.empty((1, 0)), steps).course)
    return float(high[0] - low[0])


def with_pivot(shape: Real, factor: float) -> Real:
    """The output's pivot ``factor`` times as far from its pin E as that stands where the first dwell begins.

    As long as E rests the output does, wherever its pivot is.
    """
    moved = shape.copy()
    e = complex(shape[E], shape[E + 1])
    o4 = e + factor * (complex(shape[FIXED]) - e)
    back = o4.conjugate() / abs(o4) if o4 else 1.0 + 0j
    moved[FIXED] = abs(o4)
    for at in (B, D, E):
        pin = complex(shape[at], shape[at + 1]) * back
        moved[at], moved[at + 1] = pin.real, pin.imag
    moved[BEGIN:] += float(np.angle(back))
    return moved
