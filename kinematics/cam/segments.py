"""Segments of a motion program: laws, dwells, polynomials and splines that meet conditions, knots of a solver.

Angles are radians of cam rotation, displacements any unit (radians for an oscillating follower); derivatives are per
radian of cam rotation.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.cam.extremes import Extremes, extremes
from kinematics.cam.motion_laws import Law
from kinematics.cam.pieces import Pieces, polynomial_pieces
from kinematics.errors import DimensionError

Real = NDArray[np.float64]

INDEPENDENT = 1e-12
"""Least singular value, relative to the largest, of conditions that determine a polynomial; below it they do not."""


class Condition(NamedTuple):
    """The derivative of an order at an angle from the segment's start has a value; order 0 is the displacement."""

    angle: float
    order: int
    value: float


@dataclass(frozen=True, eq=False)
class Segment:
    """A part of a motion program: what it is called, and its motion from angle 0 on."""

    name: str
    pieces: Pieces

    @property
    def angle(self) -> float:
        """Cam rotation that the segment takes."""
        return self.pieces.length

    def extremes(self, order: int) -> Extremes:
        """Exact extremes of s, v, a or j (order 0 to 3) within the segment; angles are from its start."""
        return extremes(lambda angle: self.pieces.motion(angle)[order], self.pieces.start)


def law_segment(law: Law, angle: float, start: float, end: float) -> Segment:
    """A rise or fall by a law; a fall is the law upside down."""
    return Segment(law.name, law.pieces.scaled(_angle(angle), _finite("end", end) - start, _finite("start", start)))


def dwell(angle: float, position: float) -> Segment:
    """A rest."""
    return Segment("dwell", polynomial_pieces([0.0, _angle(angle)], [[_finite("position", position)]]))


def polynomial_segment(angle: float, conditions: Sequence[Condition]) -> Segment:
    """The polynomial of least degree through conditions anywhere in the segment (Norton §8.3, §8.5).

    n conditions determine n coefficients; degree n − 1.

    Raises
    ------
    DimensionError
        A condition outside the segment, or conditions that do not determine one polynomial.
    """
    return Segment("polynomial", _through(_angle(angle), conditions, len(conditions) - 1, []))


def coefficient_segment(angle: float, coefficients: ArrayLike) -> Segment:
    """Σ c_k (θ/β)^k with Norton's coefficients, constant first."""
    return Segment("polynomial", polynomial_pieces([0.0, 1.0], np.atleast_2d(coefficients)).scaled(_angle(angle), 1.0))


def spline_segment(
    angle: float, conditions: Sequence[Condition], degree: int, knots: Sequence[float] | None = None
) -> Segment:
    """The spline of a degree through conditions; all but the last derivative run through its knots.

    n conditions determine n − degree − 1 inner knots. Unless given they are the averages of ``degree`` neighbouring
    conditions' angles (de Boor, *A Practical Guide to Splines*, ch. XIII), which keeps the spline determined.
    """
    inner = len(conditions) - degree - 1
    if degree < 1 or inner < 0:
        raise DimensionError(
            "degree of the spline", f"from 1 to {len(conditions) - 1}, one less than conditions", degree
        )
    if knots is None:
        at = np.sort([condition.angle for condition in conditions])
        knots = [float(at[k + 1 : k + 1 + degree].mean()) for k in range(inner)]
    if len(knots) != inner or any(not 0.0 < knot < angle for knot in knots):
        raise DimensionError("knots", f"{inner} angles within the segment", list(knots))
    return Segment("spline", _through(_angle(angle), conditions, degree, sorted(knots)))


def knot_segment(knots: ArrayLike, coefficients: ArrayLike) -> Segment:
    """A piecewise polynomial: angles of its knots from 0, shape (n + 1,), and local coefficients, shape (n, k)."""
    pieces = polynomial_pieces(knots, coefficients)
    if pieces.start[0] != 0.0:
        raise DimensionError("first knot", "0", float(pieces.start[0]))
    return Segment("spline", pieces)


def jerk_segment(knots: ArrayLike, state: tuple[float, float, float], jerk: ArrayLike) -> Segment:
    """The motion from s, v, a at angle 0 under a given jerk: what a solver over knots has found, without gaps.

    Parameters
    ----------
    knots : float, shape (n + 1,)
        Angles from 0.
    state : tuple of three floats
        s, v, a at the first knot.
    jerk : float, shape (n,) or (n, 2)
        Of each interval: constant, or at its start and its end, linear between.
    """
    breaks, values = np.asarray(knots, dtype=np.float64), np.asarray(jerk, dtype=np.float64)
    if values.ndim not in (1, 2) or len(values) != len(breaks) - 1 or values.shape[1:] not in ((), (2,)):
        raise DimensionError("jerk", "one value, or two, for each interval between knots", values.shape)
    ends = values if values.ndim == 2 else np.stack([values, values], axis=1)
    coefficients = np.zeros((len(values), 5 if values.ndim == 2 else 4))
    s, v, a = state
    for row, h, (j0, j1) in zip(coefficients, np.diff(breaks), ends, strict=True):
        slope = (j1 - j0) / h
        row[:4] = s, v, a / 2.0, j0 / 6.0
        if values.ndim == 2:
            row[4] = slope / 24.0
        s += h * (v + h * (a / 2.0 + h * (j0 / 6.0 + h * slope / 24.0)))
        v += h * (a + h * (j0 / 2.0 + h * slope / 6.0))
        a += h * (j0 + h * slope / 2.0)
    return knot_segment(breaks, coefficients)


def _through(angle: float, conditions: Sequence[Condition], degree: int, knots: Sequence[float]) -> Pieces:
    """Local coefficients of the piecewise polynomial, in the unit of each piece, from one square linear system."""
    if not conditions:
        raise DimensionError("conditions", "at least one", [])
    breaks = np.array([0.0, *knots, angle])
    spans = np.diff(breaks)
    terms, count = degree + 1, len(spans)
    matrix, values = np.zeros((terms * count, terms * count)), np.zeros(terms * count)
    scale = max(abs(c.value) * angle**c.order for c in conditions) or 1.0
    for row, (at, order, value) in enumerate(conditions):
        if not (0.0 <= at <= angle and math.isfinite(value) and 0 <= order <= degree):
            raise DimensionError(
                "condition", f"at an angle from 0 to {angle}, of an order up to {degree}", (at, order, value)
            )
        piece = min(int(np.searchsorted(breaks, at, side="right")) - 1, count - 1)
        here = matrix[row, piece * terms : (piece + 1) * terms]
        here[:] = _powers((at - breaks[piece]) / spans[piece], terms, order) * (angle / spans[piece]) ** order
        values[row] = value * angle**order / scale
    row = len(conditions)
    for piece in range(count - 1):
        for order in range(degree):
            left, right = angle / spans[piece], angle / spans[piece + 1]
            matrix[row, piece * terms : (piece + 1) * terms] = _powers(1.0, terms, order) * left**order
            matrix[row, (piece + 1) * terms : (piece + 2) * terms] = -_powers(0.0, terms, order) * right**order
            row += 1
    size = np.abs(matrix).max(axis=1)
    matrix, values = matrix / size[:, None], values / size
    if np.linalg.cond(matrix) > 1.0 / INDEPENDENT:
        raise DimensionError("conditions", "such that they determine one polynomial", [tuple(c) for c in conditions])
    solution = np.linalg.solve(matrix, values)
    solution += np.linalg.solve(matrix, values - matrix @ solution)
    rows = solution.reshape(count, terms) * scale / spans[:, None] ** np.arange(terms)
    return polynomial_pieces(breaks, rows)


def _powers(x: float, terms: int, order: int) -> Real:
    """The derivative of an order of 1, x, x², ... at x."""
    return np.array([math.perm(k, order) * x ** (k - order) if k >= order else 0.0 for k in range(terms)])


def _angle(value: float) -> float:
    if not (math.isfinite(value) and value > 0.0):
        raise DimensionError("angle of a segment", "positive", value)
    return value


def _finite(name: str, value: float) -> float:
    if not math.isfinite(value):
        raise DimensionError(name, "finite", value)
    return value
