"""Exact straight lines: Peaucellier's eightbar, Hart's sixbar, Scott-Russell's slider-crank, sized for a given line.

Peaucellier's and Hart's cells are inversors: with A on a circle through O4, P runs on a line at right angles to O2 O4,
at the distance D = k² / 2r from O4, where k² is the cell's constant O4 A · O4 P and r the crank. The crank turns by θ
about the direction from O4 to O2, O4 A turns by θ/2, and P stands at D tan(θ/2). A range β of the crank therefore gives

    length = 2 D tan(β/4),

and two proportions of the cell are free. They are searched on a grid for the best quality
(:mod:`synthesis.verification.measures`): force transmission against size. In Scott-Russell's P is at 2r sin θ, without
any free proportion.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.verification.measures import compute_quality

PROPORTION_COUNT = 48
"""Number of values of each proportion."""

INPUT_COUNT = 33
"""Number of inputs over half the range at which force transmission is evaluated; the other half is its mirror image."""


class ExactLine(NamedTuple):
    """A mechanism at the start of its range, with P's line along the positive imaginary axis, and its dimensions."""

    mechanism: Mechanism
    links: dict[str, float]


def size_scott_russell(length: float, span: float) -> ExactLine | None:
    """Size a Scott-Russell mechanism for a line of the given length; None if the range is not below half a turn.

    The crank equals A B and A P. B slides towards O2, and P runs through O2 perpendicular to the slide. The range
    ``span`` of the crank, radians, must be below π.
    """
    if not span < math.pi:
        return None
    r = length / (4.0 * math.sin(0.5 * span))
    linkage = catalogue.make_slider_crank(0.0, 0.0, 0.0, r, r, -0.5 * span, coupler_point=-r)
    return ExactLine(linkage, {"crank": r, "coupler": r})


def size_peaucellier(length: float, span: float) -> ExactLine | None:
    """Size the Peaucellier cell with the arms and sides of best quality; None if the crank's range is a full turn."""
    far = _compute_distance(length, span)
    if far is None:
        return None
    # In units of D: crank r, and the arm's excess over the largest half sum of O4 A and O4 P.
    crank = np.geomspace(0.1, 4.0, PROPORTION_COUNT)[:, None, None]
    cosine = np.cos(np.linspace(0.0, 0.25 * span, INPUT_COUNT))
    near = 2.0 * crank * cosine
    half = 0.5 * (near + 2.0 * crank / near)
    # The rhombus closes only if the arm exceeds this half sum over the whole range.
    arm = half.max(axis=-1, keepdims=True) * (1.0 + np.geomspace(0.003, 2.0, PROPORTION_COUNT))[None, :, None]
    side = np.sqrt(arm**2 - 2.0 * crank)
    # Law of cosines in the triangle O4 B A.
    at_pins = (arm**2 + side**2 - near**2) / (2.0 * arm * side)
    # The rhombus: its corner at P is the angle between its last two sides.
    height = np.sqrt(np.maximum(arm**2 - half**2, 0.0))
    apart = 2.0 * crank / near - near
    # P must not pass A, where the rhombus would be folded flat.
    apart = np.where((apart * apart[..., :1]).min(axis=-1, keepdims=True) > 0.0, np.abs(apart), 0.0)
    at_point = height * apart / side**2
    sine = np.minimum(np.sqrt(np.maximum(1.0 - at_pins**2, 0.0)), at_point).min(axis=-1)
    lengths = np.stack(np.broadcast_arrays(crank, arm, side), axis=-1)[:, :, 0]
    best = _select_best(sine, lengths, length / far)
    if best is None:
        return None
    r, long, short = (float(x) * far for x in lengths[best])
    # O4 at −r: the crank's circle passes through it, and P runs on the real part D − r.
    linkage = catalogue.make_peaucellier(0.0, -r, r, long, short, -0.5 * span)
    return ExactLine(linkage, {"input": r, "arm_1": long, "arm_2": long} | {f"side_{k}": short for k in (1, 2, 3, 4)})


def size_hart(length: float, span: float) -> ExactLine | None:
    """Size the crossed parallelogram of best quality; None if the crank's range is a full turn."""
    far = _compute_distance(length, span)
    if far is None:
        return None
    # In units of the long link: the short one, the share, and the widest base D C as a part of the links' reach.
    short = np.linspace(0.1, 0.9, PROPORTION_COUNT)[:, None, None]
    share = np.linspace(0.15, 0.85, 15)[None, :, None]
    least = math.cos(0.25 * span)
    widest = (1.0 - short) / least + (1.0 + short - (1.0 - short) / least) * np.linspace(0.04, 0.96, PROPORTION_COUNT)
    with np.errstate(invalid="ignore"):
        sines = [np.sqrt(1.0 - ((1.0 + short**2 - base**2) / (2.0 * short)) ** 2) for base in (widest, least * widest)]
    sine = np.nan_to_num(np.minimum(*sines) + 0.0 * share)
    # The crossed parallelogram closes between these bases.
    sine = np.where((widest * least > 1.0 - short) & (widest < 1.0 + short), sine, 0.0)
    distance = (1.0 - share) * (1.0 - short**2) / widest
    lengths = np.stack(np.broadcast_arrays(0.5 * share * widest, np.ones_like(short), short), axis=-1)
    lengths = lengths / distance[..., None]
    best = _select_best(sine, lengths, length / far)
    if best is None:
        return None
    r, long, small = (float(x) * far for x in lengths[best])
    part = float(share[0, best[1], 0])
    # O4 at +r: the line is on the other side of O4.
    linkage = catalogue.make_hart(0.0, r, r, long, small, part, math.pi - 0.5 * span)
    return ExactLine(linkage, {"input": r, "long_1": long, "short_1": small, "short_2": small, "long_2": long})


def _compute_distance(length: float, span: float) -> float | None:
    """Return the distance D of the line from O4, length units; None for a full turn."""
    return length / (2.0 * math.tan(0.25 * span)) if span < 2.0 * math.pi else None


def _select_best(sine: Real, lengths: Real, size: float) -> tuple[int, ...] | None:
    """Return the index of the cell with the best quality; ``size`` is the line's length in the unit of ``lengths``."""
    sound = np.flatnonzero((sine > 0.0) & np.isfinite(lengths).all(axis=-1))
    if not len(sound):
        return None
    longest, shortest = (f(axis=-1).ravel()[sound] for f in (lengths.max, lengths.min))
    # Quality weighs transmission, size and link ratio.
    worth = _QUALITY(sine.ravel()[sound], longest / size, longest / shortest)
    return tuple(int(k) for k in np.unravel_index(sound[int(worth.argmax())], sine.shape))


_QUALITY = np.vectorize(compute_quality, otypes=[np.float64])
