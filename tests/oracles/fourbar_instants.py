"""Instant centres, Bresse circles and ratios of the fourbar, from its link vectors alone.

With u = A − O2, v = B − A, w = B − O4 and g = O4 − O2 (Kennedy; Norton, Sec. 6.3–6.4 and 6.8): I12 = O2, I23 = A,
I34 = B, I14 = O4, I13 = A + u (v×w)/(u×w), I24 = O2 + g (v×u)/(v×g); where such lines are parallel the centre is at
infinity in their direction. Bresse circles, for an input of constant speed: where the coupler's acceleration is
tangential only (the inflection circle) and where it is normal only, |r|² = Re(r̄ I') ω3²/α3. Ratios (Norton, eqs.
6.10–6.13): m_V = ω4/ω2, torque ratio ω2/ω4, mechanical advantage (ω2/ω4)(r_in/r_out).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Mask, Real
from kinematics.errors import DimensionError
from kinematics.linkage.fourbar.closed_form import OPEN_ASSEMBLY, TOGGLE_SINE, Fourbar, broadcast_shape, require
from kinematics.linkage.fourbar.curvature import (
    PARALLEL_SINE,
    _build_vectors,
    _compute_accelerations,
    _cross,
    _is_crossing,
    find_pole,
)

PAIRS = ((1, 2), (1, 3), (1, 4), (2, 3), (2, 4), (3, 4))
"""Links (1 ground, 2 input, 3 coupler, 4 output) of the six instant centres, in the order of their axis."""


class InstantCenters(NamedTuple):
    """The six instant centres over designs × input angles × :data:`PAIRS`.

    ``valid`` is False at change points and where the linkage does not close; there, all is NaN. Elsewhere ``finite``
    marks the centres at a point, and ``direction`` (unit, up to sign) is where the others lie: the NaN of ``point`` and
    that of ``direction`` exclude each other.
    """

    valid: Mask
    finite: Mask
    point: Complex
    direction: Complex


class BresseCircles(NamedTuple):
    """Centres of the circles through the pole on which the coupler's acceleration has one component only.

    ``inflection`` where ``finite`` of the pole holds: points without normal acceleration. ``tangential`` where
    ``circle`` holds (else it is the line through the pole across its tangent): points without tangential
    acceleration, while the input turns at constant speed.
    """

    finite: Mask
    inflection: Complex
    circle: Mask
    tangential: Complex


class Ratio(NamedTuple):
    """A ratio over designs × input angles; NaN where ``finite`` is False."""

    finite: Mask
    value: Real


def instant_center_count(links: int) -> int:
    """Number of instant centres of n links, n (n − 1) / 2 (Norton 6.8b).

    Raises
    ------
    DimensionError
        For fewer than one link.

    Examples
    --------
    >>> instant_center_count(6)
    15
    """
    if links < 1:
        raise DimensionError("links", "a count of at least 1", links)
    return links * (links - 1) // 2


def instant_centers(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> InstantCenters:
    """All instant centres of the fourbar (Norton, Sec. 6.4).

    Parameters and errors as for :func:`kinematics.linkage.positions`, here and in all functions of this module; the
    results have shape S + (N, 6).
    """
    x = _build_vectors(linkage, input_angle, assembly)
    o2 = np.broadcast_to(linkage.input_pivot[x.axis], x.valid.shape)
    o4 = np.broadcast_to(linkage.output_pivot[x.axis], x.valid.shape)
    ground = (linkage.output_pivot - linkage.input_pivot)[x.axis] / x.unit
    coupler_finite = _is_crossing(x.u, x.w) & x.valid
    input_finite = _is_crossing(x.v, ground) & x.valid
    nowhere = np.full_like(o2, np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        i13 = x.at.a + x.unit * x.u * (_cross(x.v, x.w) / _cross(x.u, x.w))
        i24 = o2 + x.unit * ground * (_cross(x.v, x.u) / _cross(x.v, ground))
        along_input, along_ground = x.u / np.abs(x.u), ground / np.abs(ground)
    points = (o2, np.where(coupler_finite, i13, np.nan), o4, x.at.a, np.where(input_finite, i24, np.nan), x.at.b)
    directions = (
        nowhere,
        np.where(coupler_finite, np.nan, along_input),
        nowhere,
        nowhere,
        np.where(input_finite, np.nan, along_ground),
        nowhere,
    )
    finite = (x.valid, coupler_finite, x.valid, x.valid, input_finite, x.valid)
    return InstantCenters(
        x.valid,
        np.stack(finite, axis=-1),
        np.where(x.valid[..., None], np.stack(points, axis=-1), np.nan),
        np.where(x.valid[..., None], np.stack(directions, axis=-1), np.nan),
    )


def bresse_circles(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> BresseCircles:
    """Centres of the inflection circle and of the circle of no tangential acceleration, at constant input speed.

    At a toggle the input cannot turn at constant speed; ``circle`` is False there too.
    """
    x = _build_vectors(linkage, input_angle, assembly)
    at = find_pole(linkage, input_angle, assembly)
    two, three, _ = x.rates
    first, second, _ = _compute_accelerations(x)
    # α3/ω3² at constant ω2, from rates ω = ω(s) along the smooth motion: d(ω3/ω2)/dθ2 · (ω2/ω3)².
    turning = second * two - first * three
    circle = at.finite & (np.abs(two) > TOGGLE_SINE) & (np.abs(turning) > PARALLEL_SINE)
    with np.errstate(divide="ignore", invalid="ignore"):
        diameter = np.where(circle, at.rate * three**2 * two / turning, np.nan)
    return BresseCircles(at.finite, 0.5 * (at.point + at.inflection_pole), circle, at.point + 0.5 * diameter)


def velocity_ratio(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> Ratio:
    """Angular velocity ratio m_V = ω4/ω2 (Norton 6.10); not finite at toggles of the input."""
    x = _build_vectors(linkage, input_angle, assembly)
    two, _, four = x.rates
    return _ratio(four, two, x.valid & _is_crossing(x.v, x.w, TOGGLE_SINE))


def torque_ratio(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> Ratio:
    """Torque ratio T4/T2 = ω2/ω4 of a linkage without losses (Norton 6.12); not finite at dead points of the output."""
    x = _build_vectors(linkage, input_angle, assembly)
    two, _, four = x.rates
    return _ratio(two, four, x.valid & _is_crossing(x.u, x.v, TOGGLE_SINE))


def mechanical_advantage(
    linkage: Fourbar,
    input_angle: ArrayLike,
    assembly: ArrayLike = OPEN_ASSEMBLY,
    *,
    input_radius: ArrayLike,
    output_radius: ArrayLike,
) -> Ratio:
    """Ratio of output to input force at given distances from the fixed pivots, (ω2/ω4)(r_in/r_out) (Norton 6.13).

    Raises
    ------
    DimensionError
        Also for a radius that is not positive and finite.
    """
    inner, outer = np.asarray(input_radius, np.float64), np.asarray(output_radius, np.float64)
    for name, radius in (("input_radius", inner), ("output_radius", outer)):
        require(name, "positive and finite", radius, np.isfinite(radius) & (radius > 0.0))
    found = torque_ratio(linkage, input_angle, assembly)
    shape = broadcast_shape(positions=found.value.shape, input_radius=inner.shape, output_radius=outer.shape)
    return Ratio(np.broadcast_to(found.finite, shape), found.value * (inner / outer))


def _ratio(numerator: Real, denominator: Real, finite: Mask) -> Ratio:
    with np.errstate(divide="ignore", invalid="ignore"):
        return Ratio(finite, np.where(finite, numerator / denominator, np.nan))
