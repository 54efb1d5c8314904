"""Instantaneous kinematics of the fourbar: instant centres, the coupler's pole, centrodes, path curvature, ratios.

With the link vectors u = A − O2, v = B − A, w = B − O4 and g = O4 − O2 the loop u + v = g + w gives the angular
rates ω2 u + ω3 v = ω4 w up to a common factor by cross products, without a division:

    ω2 : ω3 : ω4 = v×w : w×u : v×u.

Taken as the rates themselves they are a motion that goes smoothly through toggles (ω2 = 0) and through instants at
which the coupler does not turn (ω3 = 0); only a change point (all zero) stops it. Its accelerations are

    ω2' = (ω4 − ω3) v·w,    ω3' = (ω2 − ω4) u·w,    ω4' = (ω2 − ω3) u·v,

from u' = iω2 u and so on. What depends on geometry alone is taken from this motion.

Instant centres (Kennedy; Norton, Sec. 6.3–6.4 and 6.8): I12 = O2, I23 = A, I34 = B, I14 = O4, and

    I13 = A + u (v×w)/(u×w)        the coupler's *pole*, where the lines O2 A and O4 B meet,
    I24 = O2 + g (v×u)/(v×g)       where the lines A B and O2 O4 meet.

Where such lines are parallel the centre is at infinity in their direction.

Pole (Norton, Sec. 6.5; J. J. Uicker, G. R. Pennock, J. E. Shigley, *Theory of Machines and Mechanisms*, 3rd ed.,
ch. 4). With the coupler angle φ = θ3 as the parameter, h = (v×w)/(u×w) and k = dθ4/dφ = (u×v)/(u×w), the pole
I = A + h u moves at

    I' = dI/dφ = u (h' − i h (1 + h)),    h' = [(k − 1) v·w − h (h + k) u·w] / (u×w)

along the common tangent of the centrodes. A point X = I + r of the coupler has X' = i r and X'' = −r − i I', so that

    inflection pole  J = I − i I',  diameter of the inflection circle |I'|,
    centre of curvature  I − r Im(r̄ I') / (|r|² − Im(r̄ I'))          (Euler and Savary).

The path's curvature itself is Im(X̄' X'') / |X'|³ of the smooth motion above, which needs no finite pole.

Bresse circles, for an input of constant speed (α3/ω3² from the same motion): where the coupler's acceleration is
tangential only (the inflection circle) and where it is normal only, |r|² = Re(r̄ I') ω3²/α3.

Ratios (Norton, Sec. 6.4, eqs. 6.10–6.13): m_V = ω4/ω2, torque ratio ω2/ω4, mechanical advantage (ω2/ω4)(r_in/r_out).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.errors import DimensionError
from kinematics.linkage.fourbar.closed_form import (
    OPEN,
    TOGGLE_SINE,
    AngleAxis,
    Complex,
    Fourbar,
    Mask,
    Positions,
    Real,
    one_shape,
    positions,
    require,
    with_angle_axis,
)

PAIRS = ((1, 2), (1, 3), (1, 4), (2, 3), (2, 4), (3, 4))
"""Links (1 ground, 2 input, 3 coupler, 4 output) of the six instant centres, in the order of their axis."""

PARALLEL = 1e-12
"""Sine below which two lines are parallel: their intersection, at 1e12 lengths, has no digit left."""

STRAIGHT = 1e-12
"""Curvature below this, per size of the linkage, is none: the centre of curvature has no digit left."""

STATIONARY = 1e-9
"""Speed of the coupler point below this, as a share of the speeds of the moving pivots, is rest: a cusp of its path,
near which rounding of the position decides the direction."""


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


class Pole(NamedTuple):
    """The coupler's pole over designs × input angles.

    ``valid`` as for :class:`InstantCenters`; ``finite`` is False where the coupler only translates; all points are NaN
    there. ``point`` is the pole, ``rate`` its velocity dI/dθ3 (complex length per radian of the coupler's turn)
    along the tangent of the centrodes, ``moving`` the pole in the coupler's frame (as ``Fourbar.coupler_point`` is),
    ``inflection_pole`` the point opposite to the pole on the inflection circle of diameter ``inflection_diameter``.
    """

    valid: Mask
    finite: Mask
    point: Complex
    moving: Complex
    rate: Complex
    inflection_pole: Complex
    inflection_diameter: Real


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


class PathCurvature(NamedTuple):
    """Curvature of the coupler point's path over designs × input angles.

    ``curvature`` is positive where the path bends to the left while the input angle rises; NaN where ``valid`` is
    False: no position, a change point, or a cusp. ``curved`` is False at inflections, where ``center`` is NaN.
    """

    valid: Mask
    curvature: Real
    curved: Mask
    center: Complex


class Ratio(NamedTuple):
    """A ratio over designs × input angles; NaN where ``finite`` is False."""

    finite: Mask
    value: Real


class _Vectors(NamedTuple):
    """Link vectors in units of the linkage's size, and ω2 : ω3 : ω4 = ``scale`` × the cross products, the
    largest 1 in absolute value."""

    at: Positions
    axis: AngleAxis
    valid: Mask
    unit: Real
    u: Complex
    v: Complex
    w: Complex
    ground: Complex
    rates: tuple[Real, Real, Real]
    scale: Real


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


def instant_centers(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN) -> InstantCenters:
    """All instant centres of the fourbar (Norton, Sec. 6.4).

    Parameters and errors as for :func:`kinematics.linkage.positions`, here and in all functions of this module; the
    results have shape S + (N, 6).
    """
    x = _vectors(linkage, input_angle, assembly)
    o2 = np.broadcast_to(linkage.input_pivot[x.axis], x.valid.shape)
    o4 = np.broadcast_to(linkage.output_pivot[x.axis], x.valid.shape)
    coupler_finite = _crossing(x.u, x.w) & x.valid
    input_finite = _crossing(x.v, x.ground) & x.valid
    nowhere = np.full_like(o2, np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        i13 = x.at.a + x.unit * x.u * (_cross(x.v, x.w) / _cross(x.u, x.w))
        i24 = o2 + x.unit * x.ground * (_cross(x.v, x.u) / _cross(x.v, x.ground))
        along_input, along_ground = x.u / np.abs(x.u), x.ground / np.abs(x.ground)
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


def pole(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN) -> Pole:
    """The coupler's pole with its velocity and the inflection circle.

    Over a range of input angles ``point`` is the fixed centrode and ``moving`` the moving centrode (Norton, Sec. 6.5).
    """
    x = _vectors(linkage, input_angle, assembly)
    u, v, w = x.u, x.v, x.w
    finite = x.valid & _crossing(u, w)
    with np.errstate(divide="ignore", invalid="ignore"):
        over = np.where(finite, 1.0 / _cross(u, w), np.nan)
        h, k = _cross(v, w) * over, _cross(u, v) * over
        slope = ((k - 1.0) * _dot(v, w) - h * (h + k) * _dot(u, w)) * over
        rate = u * (slope - 1j * h * (1.0 + h)) * x.unit
        point = x.at.a + x.unit * h * u
        moving = h * u / v * linkage.coupler[x.axis]
    return Pole(x.valid, finite, point, moving, rate, point - 1j * rate, np.abs(rate))


def bresse_circles(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN) -> BresseCircles:
    """Centres of the inflection circle and of the circle of no tangential acceleration, at constant input speed.

    At a toggle the input cannot turn at constant speed; ``circle`` is False there too.
    """
    x = _vectors(linkage, input_angle, assembly)
    at = pole(linkage, input_angle, assembly)
    two, three, _ = x.rates
    first, second, _ = _accelerations(x)
    # α3/ω3² at constant ω2, from rates ω = ω(s) along the smooth motion: d(ω3/ω2)/dθ2 · (ω2/ω3)².
    turning = second * two - first * three
    circle = at.finite & (np.abs(two) > TOGGLE_SINE) & (np.abs(turning) > PARALLEL)
    with np.errstate(divide="ignore", invalid="ignore"):
        diameter = np.where(circle, at.rate * three**2 * two / turning, np.nan)
    return BresseCircles(at.finite, 0.5 * (at.point + at.inflection_pole), circle, at.point + 0.5 * diameter)


def path_curvature(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN) -> PathCurvature:
    """Curvature of the path of the coupler point, and its centre."""
    x = _vectors(linkage, input_angle, assembly)
    place = (linkage.coupler_point / linkage.coupler)[x.axis]
    two, three, _ = x.rates
    first, second, _ = _accelerations(x)
    velocity = 1j * (two * x.u + three * place * x.v)
    acceleration = (1j * first - two**2) * x.u + (1j * second - three**2) * place * x.v
    speed = np.abs(velocity)
    pace = np.maximum(np.abs(two * x.u), np.abs(three * place * x.v))
    valid = x.valid & (speed > STATIONARY * pace)
    with np.errstate(divide="ignore", invalid="ignore"):
        bend = np.where(valid, _cross(velocity, acceleration) / speed**3, np.nan)
        curved = valid & (np.abs(bend) > STRAIGHT)
        center = np.where(curved, x.at.p + x.unit * 1j * velocity / speed / bend, np.nan)
        sign = np.asarray(assembly)[x.axis]
        return PathCurvature(valid, bend * sign / x.unit, curved, center)


def velocity_ratio(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN) -> Ratio:
    """Angular velocity ratio m_V = ω4/ω2 (Norton 6.10); not finite at toggles of the input."""
    x = _vectors(linkage, input_angle, assembly)
    two, _, four = x.rates
    return _ratio(four, two, x.valid & _crossing(x.v, x.w, TOGGLE_SINE))


def torque_ratio(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN) -> Ratio:
    """Torque ratio T4/T2 = ω2/ω4 of a linkage without losses (Norton 6.12); not finite at dead points of the output."""
    x = _vectors(linkage, input_angle, assembly)
    two, _, four = x.rates
    return _ratio(two, four, x.valid & _crossing(x.u, x.v, TOGGLE_SINE))


def mechanical_advantage(
    linkage: Fourbar,
    input_angle: ArrayLike,
    assembly: ArrayLike = OPEN,
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
    shape = one_shape(positions=found.value.shape, input_radius=inner.shape, output_radius=outer.shape)
    return Ratio(np.broadcast_to(found.finite, shape), found.value * (inner / outer))


def _vectors(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike) -> _Vectors:
    at = positions(linkage, input_angle, assembly)
    theta, axis = with_angle_axis(linkage, input_angle, np.shape(assembly))
    unit = linkage.lengths.sum(axis=-1)[axis]
    u = np.broadcast_to(linkage.input[axis] * np.exp(1j * theta) / unit, at.b.shape)
    v, w = (at.b - at.a) / unit, (at.b - linkage.output_pivot[axis]) / unit
    ground = np.broadcast_to((linkage.output_pivot - linkage.input_pivot)[axis] / unit, at.b.shape)
    moves = _crossing(v, w, TOGGLE_SINE) | _crossing(w, u, TOGGLE_SINE) | _crossing(v, u, TOGGLE_SINE)
    rates = np.stack((_cross(v, w), _cross(w, u), _cross(v, u)))
    valid = at.valid & moves
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.where(valid, 1.0 / np.abs(rates).max(axis=0), np.nan)
        two, three, four = rates * scale
    return _Vectors(at, axis, valid, np.broadcast_to(unit, at.b.shape), u, v, w, ground, (two, three, four), scale)


def _accelerations(x: _Vectors) -> tuple[Real, Real, Real]:
    """Rates of change of the three angular rates along the smooth motion."""
    two, three, four = x.rates
    return (
        (four - three) * _dot(x.v, x.w) * x.scale,
        (two - four) * _dot(x.u, x.w) * x.scale,
        (two - three) * _dot(x.u, x.v) * x.scale,
    )


def _ratio(numerator: Real, denominator: Real, finite: Mask) -> Ratio:
    with np.errstate(divide="ignore", invalid="ignore"):
        return Ratio(finite, np.where(finite, numerator / denominator, np.nan))


def _crossing(one: Complex, other: Complex, least_sine: float = PARALLEL) -> Mask:
    """Whether two directions differ; False for NaN."""
    return np.asarray(np.abs(_cross(one, other)) > least_sine * np.abs(one) * np.abs(other))


def _cross(one: Complex, other: Complex) -> Real:
    """Cross product of vectors written as complex numbers."""
    return np.asarray(one.real * other.imag - one.imag * other.real)


def _dot(one: Complex, other: Complex) -> Real:
    return np.asarray(one.real * other.real + one.imag * other.imag)
