"""Transmission angle of the fourbar: the acute angle between coupler and output (Norton, Sec. 4.10).

The included angle γ at B of the triangle A B O4 depends on the diagonal f = |O4 − A| alone,

    tan²(γ/2) = (f² − (b − c)²) / ((b + c)² − f²),

and rises with f; f in turn rises with the distance of the input angle from the ground line. Over a range of input
angles the extremes therefore occur at its ends, or where the input lies along the ground line.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Real
from kinematics.linkage.batch import broadcast_over_designs
from kinematics.linkage.fourbar import circuit_kernels as kernels
from kinematics.linkage.fourbar.closed_form import Fourbar, broadcast_shape, is_closed, with_angle_axis


def transmission_angle(linkage: Fourbar, input_angle: ArrayLike) -> Real:
    """Return the transmission angle in radians, 0 to π/2; the same for both assemblies; NaN without a position.

    Parameters
    ----------
    linkage : Fourbar
        Designs of shape S.
    input_angle : float
        Absolute input angles, radians, as for :func:`kinematics.linkage.positions`; the result has shape S + (N,).
    """
    theta, axis = with_angle_axis(linkage, input_angle)
    b, c = linkage.coupler[axis], linkage.output[axis]
    f = np.abs((linkage.output_pivot - linkage.input_pivot)[axis] - linkage.input[axis] * np.exp(1j * theta))
    # Heron's product in factored form, accurate near a toggle.
    product = (b + c + f) * (b + c - f) * (f + (b - c)) * (f - (b - c))
    return np.where(is_closed(product, b, c, f) & (f > 0.0), _reduce_to_acute(_compute_included_angle(b, c, f)), np.nan)


def find_transmission_extremes(linkage: Fourbar, start: ArrayLike, end: ArrayLike) -> tuple[Real, Real]:
    """Find the exact minimum and maximum transmission angle while the input turns from ``start`` to ``end``.

    Parameters
    ----------
    linkage : Fourbar
        Designs of shape S.
    start, end : float
        Absolute input angles, radians, not reduced by full turns; shape S. A full turn or more covers the cycle.

    Returns
    -------
    least, greatest : float
        Radians in 0 to π/2, shape S. If the range contains inputs that cannot be assembled, ``least`` is 0, since the
        linkage stops at a toggle there, and ``greatest`` refers to the rest of the range (0 if empty).

    Raises
    ------
    ShapeError
        For angles that do not broadcast with the designs.
    """
    shape = linkage.input.shape
    start, end = np.asarray(start, np.float64), np.asarray(end, np.float64)
    if not (start.ndim == end.ndim == 0):
        shape = broadcast_shape(designs=shape, start=start.shape, end=end.shape)
    least, greatest = np.empty(shape), np.empty(shape)
    pivots, lengths, (starts, ends) = broadcast_over_designs(linkage.blocks, shape, start, end)
    kernels.find_extremes(pivots, lengths, starts, ends, least.reshape(-1), greatest.reshape(-1))
    return least, greatest


def _compute_included_angle(b: Real, c: Real, f: Real) -> Real:
    """Compute the angle at B of the triangle with sides b, c and base f; 0 or π for a base too short or too long."""
    numerator = (f + (b - c)) * (f - (b - c))
    denominator = (b + c + f) * (b + c - f)
    return np.asarray(2.0 * np.arctan2(np.sqrt(np.maximum(numerator, 0.0)), np.sqrt(np.maximum(denominator, 0.0))))


def _reduce_to_acute(gamma: Real) -> Real:
    return np.minimum(gamma, np.pi - gamma)
