"""Where a line meets the coupler curve, by the roots of its sextic along the line."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Mask, Real
from kinematics.linkage.fourbar.closed_form import Fourbar, broadcast_shape, require
from kinematics.linkage.fourbar.coupler_curve import (
    REAL_ROOT_TOLERANCE,
    _find_roots,
    _multiply_polynomials,
    _require_sextic,
    _scale_dimensions,
    _square_magnitude,
)


class LineCrossings(NamedTuple):
    """Points of the curve on a line, shape designs + (6,), the real ones first, in the order of the line's direction.

    ``distance`` is measured along the direction from the line's given point. A tangent point counts twice.
    """

    valid: Mask
    point: Complex
    distance: Real


def line_crossings(linkage: Fourbar, point: ArrayLike, direction: ArrayLike) -> LineCrossings:
    """All points that the coupler curve has on a line, by the roots of the sextic along it; at most six.

    Parameters
    ----------
    linkage : Fourbar
        Designs of shape S.
    point, direction : complex
        A point on each line and its direction (of any length but zero), shape S.

    Raises
    ------
    DimensionError
        For a direction of zero, or a coupler point at A or B.
    ShapeError
        For lines that do not broadcast with the designs.
    """
    _require_sextic(linkage)
    start, way = np.asarray(point, np.complex128), np.asarray(direction, np.complex128)
    shape = broadcast_shape(designs=linkage.input.shape, point=start.shape, direction=way.shape)
    require("point", "finite", start, np.isfinite(start))
    require("direction", "finite and not zero", way, np.isfinite(way) & (way != 0.0))
    way = way / np.abs(way)
    unit, a, _, c, z, rest, _ = _scale_dimensions(linkage)
    ahead = ((linkage.input_pivot - start) * way.conj()).real
    foot = start + ahead * way

    def along(pivot: Complex, arm: Complex, radius: Real) -> tuple[Complex, Complex]:
        """Factors k and m of one side as polynomials of the distance from the foot, lowest power first."""
        q = (foot - pivot) / unit
        k = (0.5 * (_square_magnitude(q) + _square_magnitude(arm) - radius * radius), (q * way.conj()).real, 0.5)
        m = (q.conj() * arm, way.conj() * arm)
        return _row(k, shape), _row(m, shape)

    (k1, m1), (k2, m2) = along(linkage.input_pivot, z, a), along(linkage.output_pivot, rest, c)
    cubic, circle = (
        _multiply_polynomials(k1, m2) - _multiply_polynomials(k2, m1),
        _multiply_polynomials(m1.conj(), m2).imag.astype(np.complex128),
    )
    found = _multiply_polynomials(cubic, cubic.conj()).real
    found[..., :5] -= _multiply_polynomials(circle, circle).real
    roots = _find_roots(found[..., 0, :])
    valid = np.abs(roots.imag) <= REAL_ROOT_TOLERANCE * (1.0 + np.abs(roots))
    distance = np.where(valid, roots.real, np.inf)
    order = np.argsort(distance, axis=-1)
    valid = np.take_along_axis(valid, order, axis=-1)
    distance = np.where(valid, np.take_along_axis(distance, order, axis=-1), np.nan) * unit[..., None]
    return LineCrossings(valid, foot[..., None] + distance * way[..., None], distance + ahead[..., None])


def _row(coefficients: tuple[ArrayLike, ...], shape: tuple[int, ...]) -> Complex:
    """Polynomial of one variable as a grid of one row, for :func:`_multiply_polynomials`."""
    return np.stack([np.broadcast_to(np.asarray(x, np.complex128), shape) for x in coefficients], axis=-1)[..., None, :]
