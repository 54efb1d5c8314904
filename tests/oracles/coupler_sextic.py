"""The value and the gradient of the coupler curve's sextic at any point, by the factors of its equation.

The equation is that of :mod:`kinematics.linkage.fourbar.coupler_curve`, F = |N|² − D². It is used in this
form, not expanded: its gradient follows from the factors, and no powers of p cancel.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Real
from kinematics.linkage.fourbar.closed_form import AngleAxis, Fourbar, broadcast_shape
from kinematics.linkage.fourbar.coupler_curve import _scale_dimensions, _square_magnitude


class Sextic(NamedTuple):
    """Monic sextic in units of the linkage's size: its value, and its gradient ∂/∂x + i ∂/∂y per unit of length.

    ``value / |gradient|`` is the distance from the curve to first order.
    """

    value: Real
    gradient: Complex


def sextic(linkage: Fourbar, point: ArrayLike) -> Sextic:
    """The sextic at any points of the plane, by its factors; zero on the curve.

    Parameters
    ----------
    linkage : Fourbar
        Designs of shape S. A coupler point at A or B makes the sextic a double circle with two isotropic lines.
    point : complex
        Shape (N,) for the same points in every design, or S + (N,). For a single design a scalar gives scalars.

    Raises
    ------
    ShapeError
        For points that do not broadcast with the designs.
    """
    p = np.asarray(point, np.complex128)
    axis: AngleAxis = (...,) if p.ndim == 0 and linkage.input.shape == () else (..., None)
    broadcast_shape(designs=linkage.input[axis].shape, point=p.shape)
    scaled = _scale_dimensions(linkage)
    unit, a, b, c = scaled.unit[axis], scaled.a[axis], scaled.b[axis], scaled.c[axis]
    z, rest = scaled.z[axis], scaled.rest[axis]
    q2, q4 = (p - linkage.input_pivot[axis]) / unit, (p - linkage.output_pivot[axis]) / unit
    k1, k2 = (
        0.5 * (_square_magnitude(q2) + _square_magnitude(z) - a * a),
        0.5 * (_square_magnitude(q4) + _square_magnitude(rest) - c * c),
    )
    m1, m2 = q2.conj() * z, q4.conj() * rest
    cubic, circle = k1 * m2 - k2 * m1, (m1.conj() * m2).imag
    cubic_conj, cubic_p = 0.5 * (q2 * m2 - q4 * m1) + k1 * rest - k2 * z, 0.5 * (q2.conj() * m2 - q4.conj() * m1)
    circle_conj = -0.5j * (q2 * z.conj() * rest - q4 * z * rest.conj())
    slope = cubic_conj * cubic.conj() + cubic * cubic_p.conj() - 2.0 * circle * circle_conj
    lead = 4.0 / (b * b)
    return Sextic(lead * (_square_magnitude(cubic) - circle * circle), lead * 2.0 * slope / unit)
