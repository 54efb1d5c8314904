"""Segments of a motion program: laws, dwells, polynomials through conditions, piecewise polynomials over knots.

Angles are radians of cam rotation, displacements any unit (radians for an oscillating follower); derivatives are per
radian of cam rotation.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Real
from kinematics.cam.motion.extremes import Extremes, find_extremes
from kinematics.cam.motion.laws import Law
from kinematics.cam.motion.pieces import Pieces, build_polynomial_pieces
from kinematics.errors import DimensionError

MIN_INDEPENDENCE = 1e-12
"""Smallest relative singular value of conditions that determine a polynomial; below it they are dependent."""


class Condition(NamedTuple):
    """Value of a derivative of given order at an angle from the segment's start; order 0 is the displacement."""

    angle: float
    order: int
    value: float


@dataclass(frozen=True, eq=False)
class Segment:
    """A part of a motion program: its name, and its motion from angle 0 on."""

    name: str
    pieces: Pieces

    @property
    def angle(self) -> float:
        """Cam rotation that the segment takes."""
        return self.pieces.length

    def extremes(self, order: int) -> Extremes:
        """Find the exact extremes of s, v, a or j (order 0 to 3) within the segment; angles count from its start."""
        return find_extremes(lambda angle: self.pieces.motion(angle)[order], self.pieces.start)


def build_law_segment(law: Law, angle: float, start: float, end: float) -> Segment:
    """Build a rise or fall by a law; a fall is the law turned upside down.

    Peak velocity and acceleration of a cycloidal rise of 1 in 1 rad are 2 and 2π (Norton, Table 8-3):

    >>> from kinematics.cam.motion.laws import LAWS
    >>> rise = build_law_segment(LAWS["cycloidal"], 1.0, 0.0, 1.0)
    >>> [round(float(rise.extremes(order).greatest), 2) for order in (1, 2)]
    [2.0, 6.28]
    """
    return Segment(
        law.name,
        law.pieces.scale_to(_check_angle(angle), _check_finite("end", end) - start, _check_finite("start", start)),
    )


def build_dwell(angle: float, position: float) -> Segment:
    """Build a dwell."""
    return Segment(
        "dwell", build_polynomial_pieces([0.0, _check_angle(angle)], [[_check_finite("position", position)]])
    )


def build_polynomial_segment(angle: float, conditions: Sequence[Condition]) -> Segment:
    """Build the polynomial of minimum degree through conditions anywhere in the segment (Norton §8.3, §8.5).

    n conditions determine the n coefficients of a polynomial of degree n − 1.

    Raises
    ------
    DimensionError
        For a condition outside the segment, or conditions that do not determine one polynomial.
    """
    return Segment("polynomial", _fit_conditions(_check_angle(angle), conditions))


def build_knot_segment(knots: ArrayLike, coefficients: ArrayLike) -> Segment:
    """Build a piecewise polynomial from knot angles starting at 0, shape (n + 1,), and local coefficients (n, k)."""
    pieces = build_polynomial_pieces(knots, coefficients)
    if pieces.start[0] != 0.0:
        raise DimensionError("kinematics-first-knot", "0", float(pieces.start[0]))
    return Segment("spline", pieces)


def _fit_conditions(angle: float, conditions: Sequence[Condition]) -> Pieces:
    """Solve for the polynomial in θ/β: one square linear system, rows scaled to 1, refined once."""
    if not conditions:
        raise DimensionError("conditions", "kinematics-one-or-more", [])
    terms = len(conditions)
    matrix, values = np.zeros((terms, terms)), np.zeros(terms)
    # Values in units of the largest one, so that the conditioning does not depend on the unit of length.
    scale = max(abs(c.value) * angle**c.order for c in conditions) or 1.0
    for row, (at, order, value) in enumerate(conditions):
        if not (0.0 <= at <= angle and math.isfinite(value) and 0 <= order < terms):
            raise DimensionError(
                "condition", "kinematics-condition-in-segment", (at, order, value), angle=f"{angle}", order=terms - 1
            )
        matrix[row] = _evaluate_powers(at / angle, terms, order)
        values[row] = value * angle**order / scale
    size = np.abs(matrix).max(axis=1)
    # Row scaling: derivatives of high order have much larger coefficients than values.
    matrix, values = matrix / size[:, None], values / size
    # Conditions may repeat or imply each other, such as three positions of a line.
    if np.linalg.cond(matrix) > 1.0 / MIN_INDEPENDENCE:
        raise DimensionError("conditions", "kinematics-one-polynomial", [tuple(c) for c in conditions])
    coefficients = np.linalg.solve(matrix, values)
    # One step of iterative refinement: high-order conditions make the matrix ill-conditioned.
    coefficients += np.linalg.solve(matrix, values - matrix @ coefficients)
    return build_polynomial_pieces([0.0, angle], [coefficients * scale / angle ** np.arange(terms)])


def _evaluate_powers(x: float, terms: int, order: int) -> Real:
    """Return the derivatives of given order of 1, x, x², ... at x."""
    return np.array([math.perm(k, order) * x ** (k - order) if k >= order else 0.0 for k in range(terms)])


def _check_angle(value: float) -> float:
    if not (math.isfinite(value) and value > 0.0):
        raise DimensionError("kinematics-segment-angle", "kinematics-positive", value)
    return value


def _check_finite(name: str, value: float) -> float:
    if not math.isfinite(value):
        raise DimensionError(name, "kinematics-finite", value)
    return value
