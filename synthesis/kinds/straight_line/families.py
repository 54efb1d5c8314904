"""Fourbars with an approximate straight line: the free proportions of each type, and the resulting motion.

Each type is a family of shapes in a frame of its own, O2 at the origin and O4 on the real axis at 1, or with a crank of
length 1. The relevant motion is the input turning by the given range, counter-clockwise, about a middle that is known
by symmetry up to an offset:

hoeken     crank 1, ground L1, coupler = output = B P = L3, with A, B, P in line; the middle is θ2 = 180° exactly. B is
           the centre of a circle through A, O4, P, and A P a diameter of it (Norton, Sec. 3.7, Fig. 3-29)
chebyshev  crossed, equal rockers, P amid the coupler
watt       equal rockers on opposite sides, P amid the coupler
roberts    equal rockers, P below the coupler's middle
evans      crank 1, P beyond A on the line B A; a rocker in place of Scott-Russell's slide
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.fourbar import CROSSED_ASSEMBLY, OPEN_ASSEMBLY, Fourbar, coupler_motion, positions
from synthesis.kinds.straight_line.problem import LineMechanism
from synthesis.numerics.narrowing import ShapeValues

SAMPLE_COUNT = 65
"""Number of inputs at which a motion is evaluated, in Chebyshev's spacing; a band of six ripples is resolved to 1 %."""

CONSTRAINT_STRIDE = 4
"""Number of samples per constraint on velocity and transmission angle, which change slowly."""

MIN_FORWARD_VELOCITY = 0.02
"""Minimum velocity along the line, in units of the mean velocity, so that P does not turn back."""

MAX_MIDDLE_OFFSET, MAX_CHORD_ANGLE = 0.6, 0.3
"""Maximum offset of the middle of the range from its place by symmetry, and of the line from the chord, radians."""

MIDDLE_OFFSETS = np.linspace(-0.9 * MAX_MIDDLE_OFFSET, 0.9 * MAX_MIDDLE_OFFSET, 13)
"""Offsets of the middle that are tried first, radians."""

MIN_GRASHOF_MARGIN = 0.02
"""Minimum margin in Grashof's condition, in lengths of the crank; without it the linkage would have a change point."""


class Shapes(NamedTuple):
    """Fourbars, the middles of their input ranges (radians), and margins that must be positive; shape (m, ...)."""

    linkage: Fourbar
    middle: Real
    spare: Real


@dataclass(frozen=True)
class Family:
    """A type of straight-line fourbar.

    ``classical`` are the proportions of the literature, ``low`` and ``high`` bounds of sensible ones. ``symmetric`` is
    true if middle and direction are exact and need no search.
    """

    name: LineMechanism
    make: Callable[[Real], Shapes]
    assembly: int
    classical: tuple[float, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]
    symmetric: bool = False

    def get_bounds(self, *, fixed: tuple[float, ...] | None = None) -> tuple[Real, Real]:
        """Return bounds of a shape, with the proportions fixed or free."""
        off = [] if self.symmetric else [MAX_MIDDLE_OFFSET, MAX_CHORD_ANGLE]
        low, high = (self.low, self.high) if fixed is None else (fixed, fixed)
        return np.array([*low, *(-x for x in off)]), np.array([*high, *off])

    def list_starts(self, proportions: Real) -> Real:
        """Return shapes with given proportions (m, k) and, if the middle is free, several offsets of it."""
        if self.symmetric:
            return proportions
        repeated = np.repeat(proportions, len(MIDDLE_OFFSETS), axis=0)
        offsets = np.stack([np.tile(MIDDLE_OFFSETS, len(proportions)), np.zeros(len(repeated))], axis=1)
        return np.concatenate([repeated, offsets], axis=1)


class LineLimits(NamedTuple):
    """Requirements on a motion: the input's range (radians), the measure, and the constraints on the linkage."""

    span: float
    velocity: bool
    transmission: float
    link_ratio: float


class LineMotion(NamedTuple):
    """Motion of P: its points (m, N), the direction of the line (unit vectors) and its length, and the input angles."""

    p: Complex
    velocity: Complex
    direction: Complex
    length: Real
    theta: Real


def compute_chebyshev_nodes(count: int) -> Real:
    """Return points in [−1/2, 1/2] that are densest at the ends, which they include."""
    return np.asarray(-0.5 * np.cos(np.pi * np.arange(count) / (count - 1)))


def run_linkages(family: Family, shapes: Real, span: float, nodes: Real) -> tuple[LineMotion, Shapes]:
    """Compute the motion of P over the range, in the family's frame; NaN where a shape cannot be assembled."""
    k = len(family.classical)
    members = family.make(shapes[:, :k])
    # Unsymmetric families search the offset of the middle as a further unknown.
    middle = members.middle if family.symmetric else members.middle + shapes[:, k]
    theta = middle[:, None] + span * nodes
    motion = coupler_motion(members.linkage, theta, np.full(len(shapes), family.assembly))
    chord = motion.p[:, -1] - motion.p[:, 0]
    with np.errstate(invalid="ignore", divide="ignore"):
        # By symmetry the line of Hoeken's linkage lies along the axis; lines of other types lie near the chord.
        along = np.sign(chord.real) + 0j if family.symmetric else chord / np.abs(chord) * np.exp(1j * shapes[:, k + 1])
        length = (chord * along.conj()).real
    return LineMotion(motion.p, motion.velocity, along, length, theta), members


def make_objective(family: Family, demands: LineLimits, nodes: Real) -> Callable[[Real], ShapeValues]:
    """Return the function that computes objective and constraints of shapes."""

    def evaluate_shapes(shapes: Real) -> ShapeValues:
        line, members = run_linkages(family, shapes, demands.span, nodes)
        turned = line.direction.conj()[:, None]
        with np.errstate(invalid="ignore", divide="ignore"):
            across = (line.p * turned).imag / line.length[:, None]
            # In units of the mean velocity, so that 1 means even motion.
            speed = (line.velocity * turned).real * (demands.span / line.length)[:, None]
            positive = np.concatenate(
                [
                    speed[:, ::CONSTRAINT_STRIDE] - MIN_FORWARD_VELOCITY,
                    _compute_transmission(members.linkage, line.theta[:, ::CONSTRAINT_STRIDE])
                    - math.sin(demands.transmission) ** 2,
                    _compute_ratio_margins(members.linkage, demands.link_ratio),
                    members.spare,
                ],
                axis=1,
            )
        # Even velocity is the objective, and the width of the strip is limited by the caller.
        if demands.velocity:
            return ShapeValues(speed, across, positive)
        return ShapeValues(across, np.empty((len(shapes), 0)), positive)

    return evaluate_shapes


def build_configuration(family: Family, shape: Real, span: float) -> tuple[Complex, LineMotion]:
    """Return joints O2, A, B, O4, P at the start of the range, and the motion of one shape in the family's frame."""
    line, members = run_linkages(family, shape[None], span, compute_chebyshev_nodes(SAMPLE_COUNT))
    at = positions(members.linkage, line.theta[:, :1], np.array([family.assembly]))
    pivots = members.linkage.input_pivot[0], members.linkage.output_pivot[0]
    return np.array([pivots[0], at.a[0, 0], at.b[0, 0], pivots[1], at.p[0, 0]]), LineMotion(*(part[0] for part in line))


def _compute_transmission(linkage: Fourbar, theta: Real) -> Real:
    """Return sin² of the transmission angle, by the law of cosines in the triangle A B O4."""
    pin = linkage.input_pivot[:, None] + linkage.input[:, None] * np.exp(1j * theta)
    diagonal = np.abs(linkage.output_pivot[:, None] - pin)
    b, c = linkage.coupler[:, None], linkage.output[:, None]
    return np.asarray(1.0 - ((b * b + c * c - diagonal * diagonal) / (2.0 * b * c)) ** 2)


def _compute_ratio_margins(linkage: Fourbar, most: float) -> Real:
    """Return log(most) − log(longest / shortest), for each pair of links."""
    logs = np.log(linkage.lengths)
    return np.asarray((math.log(most) + logs[:, :, None] - logs[:, None, :]).reshape(len(logs), -1))


def _make_hoeken(x: Real) -> Shapes:
    ground, coupler = x[:, 0], x[:, 1]
    # A, B and P in line with B in the middle: the coupler point is at twice the coupler.
    linkage = Fourbar.from_lengths(np.ones_like(ground), coupler, coupler, ground, 2.0 * coupler)
    spare = np.stack([ground - 1.0 - MIN_GRASHOF_MARGIN, 2.0 * coupler - ground - 1.0 - MIN_GRASHOF_MARGIN], axis=1)
    return Shapes(linkage, np.full(len(x), np.pi), spare)


def _make_norton(x: Real) -> Shapes:
    """Return Hoeken's linkages with 2 L3 = 3 L1 − L2, which include those of Norton's Table 3-1."""
    return _make_hoeken(np.stack([x[:, 0], 1.5 * x[:, 0] - 0.5], axis=1))


def _compute_height(height: Real) -> Real:
    """Return the root of a squared height that must be positive for the middle position to exist."""
    with np.errstate(invalid="ignore"):
        return np.sqrt(height)


def _make_chebyshev(x: Real) -> Shapes:
    rocker, coupler = x[:, 0], x[:, 1]
    reach = 0.5 * (1.0 + coupler)
    middle = np.arctan2(_compute_height(rocker**2 - reach**2), reach)
    linkage = Fourbar.from_lengths(rocker, coupler, rocker, np.ones_like(rocker), 0.5 * coupler)
    return Shapes(linkage, middle, np.empty((len(x), 0)))


def _make_watt(x: Real) -> Shapes:
    rocker, coupler = x[:, 0], x[:, 1]
    with np.errstate(invalid="ignore"):
        # In the middle A and B lie opposite each other about the ground's middle: |1 − 2 a e^{iθ}| = b.
        middle = np.arccos((1.0 + 4.0 * rocker**2 - coupler**2) / (4.0 * rocker))
    linkage = Fourbar.from_lengths(rocker, coupler, rocker, np.ones_like(rocker), 0.5 * coupler)
    return Shapes(linkage, middle, np.empty((len(x), 0)))


def _make_roberts(x: Real) -> Shapes:
    rocker, coupler, drop = x[:, 0], x[:, 1], x[:, 2]
    reach = 0.5 * (1.0 - coupler)
    middle = np.arctan2(_compute_height(rocker**2 - reach**2), reach)
    linkage = Fourbar.from_lengths(rocker, coupler, rocker, np.ones_like(rocker), 0.5 * coupler - 1j * drop)
    return Shapes(linkage, middle, np.empty((len(x), 0)))


def _make_evans(x: Real) -> Shapes:
    coupler, rocker, beyond = x[:, 0], x[:, 1], x[:, 2]
    pivot = x[:, 3] - 1j * x[:, 4]
    linkage = Fourbar(np.zeros(len(x)), pivot, np.ones(len(x)), coupler, rocker, -beyond)
    return Shapes(linkage, np.zeros(len(x)), np.empty((len(x), 0)))


HOEKEN = Family("hoeken", _make_hoeken, OPEN_ASSEMBLY, (2.625, 3.4375), (1.0, 1.0), (6.0, 12.0), symmetric=True)
NORTON = Family("hoeken", _make_norton, OPEN_ASSEMBLY, (1.9,), (1.0,), (6.0,), symmetric=True)

FOURBARS: dict[str, Family] = {
    "hoeken": HOEKEN,
    "chebyshev": Family("chebyshev", _make_chebyshev, CROSSED_ASSEMBLY, (1.25, 0.5), (0.3, 0.1), (4.0, 3.0)),
    "watt": Family(
        "watt", _make_watt, CROSSED_ASSEMBLY, (2.0 / math.sqrt(17.0), 1.0 / math.sqrt(17.0)), (0.2, 0.1), (2.0, 2.0)
    ),
    "roberts": Family(
        "roberts", _make_roberts, OPEN_ASSEMBLY, (0.5, 0.5, math.sqrt(3.0) / 4.0), (0.3, 0.1, 0.05), (2.0, 2.0, 2.0)
    ),
    "evans": Family(
        "evans",
        _make_evans,
        OPEN_ASSEMBLY,
        (1.0, 3.0, 1.0, 1.9, 3.0),
        (0.5, 0.8, 0.3, 0.2, 0.3),
        (3.0, 6.0, 4.0, 6.0, 6.0),
    ),
}
"""Families by the names of the types. Classical: Chebyshev 4:5:2; Watt rockers 2, coupler 1 at right angles to both in
the middle; Roberts ground twice the coupler, all other sides equal to it; Evans' grasshopper crank = A B = A P with a
rocker of three times that at right angles to the path of B."""
