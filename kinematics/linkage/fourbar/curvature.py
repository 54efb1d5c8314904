"""Instantaneous kinematics of the fourbar: the coupler's pole, the centrodes, the curvature of its point's path.

With the link vectors u = A − O2, v = B − A and w = B − O4 the derivative of the closed loop gives the angular
rates ω2 u + ω3 v = ω4 w up to a common factor by cross products, without a division:

    ω2 : ω3 : ω4 = v×w : w×u : v×u.

Used directly as rates they define a motion that passes smoothly through toggles (ω2 = 0) and through instants without
rotation of the coupler (ω3 = 0); only a change point (all zero) stops it. Its accelerations are

    ω2' = (ω4 − ω3) v·w,    ω3' = (ω2 − ω4) u·w,    ω4' = (ω2 − ω3) u·v,

from u' = iω2 u and so on. Purely geometric quantities are computed from this motion.

Pole (Norton, Sec. 6.4, 6.5; J. J. Uicker, G. R. Pennock, J. E. Shigley, *Theory of Machines and Mechanisms*, 3rd ed.,
ch. 4). With the coupler angle φ = θ3 as the parameter, h = (v×w)/(u×w) and k = dθ4/dφ = (u×v)/(u×w), the pole
I = A + h u moves at

    I' = dI/dφ = u (h' − i h (1 + h)),    h' = [(k − 1) v·w − h (h + k) u·w] / (u×w)

along the common tangent of the centrodes. A point X = I + r of the coupler has X' = i r and X'' = −r − i I', so that

    inflection pole  J = I − i I',  diameter of the inflection circle |I'|,
    centre of curvature  I − r Im(r̄ I') / (|r|² − Im(r̄ I'))          (Euler and Savary).

The path's curvature itself is Im(X̄' X'') / |X'|³ of the smooth motion above, which needs no finite pole.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Mask, Real
from kinematics.linkage.fourbar.closed_form import (
    OPEN_ASSEMBLY,
    TOGGLE_SINE,
    AngleAxis,
    Fourbar,
    Positions,
    positions,
    with_angle_axis,
)

PARALLEL_SINE = 1e-12
"""Sine below which two lines are parallel: their intersection, 1e12 lengths away, has no correct digit."""

MIN_CURVATURE = 1e-12
"""Curvature, per size of the linkage, below which the path is straight: the centre of curvature has no correct
digit."""

STATIONARY_SPEED = 1e-9
"""Speed of the coupler point, as a share of the speeds of its components, below which it is at rest: a cusp of its
path, where rounding of the position determines the direction."""


class Pole(NamedTuple):
    """The coupler's pole over designs × input angles.

    ``valid`` is False at change points and where the linkage does not close, ``finite`` where the coupler only
    translates; all points are NaN there. ``point`` is the pole, and ``rate`` its velocity dI/dθ3 (complex length per
    radian of the coupler's rotation) along the tangent of the centrodes. ``moving`` is the pole in the coupler's frame
    (that of ``Fourbar.coupler_point``). ``inflection_pole`` is the point opposite to the pole on the inflection circle,
    whose diameter is ``inflection_diameter``.
    """

    valid: Mask
    finite: Mask
    point: Complex
    moving: Complex
    rate: Complex
    inflection_pole: Complex
    inflection_diameter: Real


class PathCurvature(NamedTuple):
    """Curvature of the coupler point's path over designs × input angles.

    ``curvature`` is positive where the path bends to the left for a rising input angle; NaN where ``valid`` is False:
    no position, a change point, or a cusp. ``curved`` is False at inflections, where ``center`` is NaN.
    """

    valid: Mask
    curvature: Real
    curved: Mask
    center: Complex


class _Vectors(NamedTuple):
    """Link vectors in units of the linkage's size, and the rates ω2 : ω3 : ω4.

    The rates are ``scale`` × the cross products, and the largest has the absolute value 1.
    """

    at: Positions
    axis: AngleAxis
    valid: Mask
    unit: Real
    u: Complex
    v: Complex
    w: Complex
    rates: tuple[Real, Real, Real]
    scale: Real


def find_pole(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> Pole:
    """Compute the coupler's pole with its velocity and the inflection circle.

    Over a range of input angles ``point`` is the fixed centrode and ``moving`` the moving centrode (Norton, Sec. 6.5).
    """
    x = _build_vectors(linkage, input_angle, assembly)
    u, v, w = x.u, x.v, x.w
    finite = x.valid & _is_crossing(u, w)
    with np.errstate(divide="ignore", invalid="ignore"):
        over = np.where(finite, 1.0 / _cross(u, w), np.nan)
        h, k = _cross(v, w) * over, _cross(u, v) * over
        slope = ((k - 1.0) * _dot(v, w) - h * (h + k) * _dot(u, w)) * over
        rate = u * (slope - 1j * h * (1.0 + h)) * x.unit
        point = x.at.a + x.unit * h * u
        moving = h * u / v * linkage.coupler[x.axis]
    return Pole(x.valid, finite, point, moving, rate, point - 1j * rate, np.abs(rate))


def compute_path_curvature(
    linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY
) -> PathCurvature:
    """Compute the curvature of the path of the coupler point, and its centre."""
    x = _build_vectors(linkage, input_angle, assembly)
    place = (linkage.coupler_point / linkage.coupler)[x.axis]
    two, three, _ = x.rates
    first, second, _ = _compute_accelerations(x)
    velocity = 1j * (two * x.u + three * place * x.v)
    acceleration = (1j * first - two**2) * x.u + (1j * second - three**2) * place * x.v
    speed = np.abs(velocity)
    pace = np.maximum(np.abs(two * x.u), np.abs(three * place * x.v))
    valid = x.valid & (speed > STATIONARY_SPEED * pace)
    with np.errstate(divide="ignore", invalid="ignore"):
        bend = np.where(valid, _cross(velocity, acceleration) / speed**3, np.nan)
        curved = valid & (np.abs(bend) > MIN_CURVATURE)
        center = np.where(curved, x.at.p + x.unit * 1j * velocity / speed / bend, np.nan)
        # The smooth motion turns the input backwards in the crossed assembly, which reverses the curvature's sign.
        sign = np.asarray(assembly)[x.axis]
        return PathCurvature(valid, bend * sign / x.unit, curved, center)


def _build_vectors(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike) -> _Vectors:
    """Build the link vectors and the rates of the smooth motion."""
    at = positions(linkage, input_angle, assembly)
    theta, axis = with_angle_axis(linkage, input_angle, np.shape(assembly))
    # Dimensionless vectors keep the tolerances independent of the unit.
    unit = linkage.lengths.sum(axis=-1)[axis]
    u = np.broadcast_to(linkage.input[axis] * np.exp(1j * theta) / unit, at.b.shape)
    v, w = (at.b - at.a) / unit, (at.b - linkage.output_pivot[axis]) / unit
    moves = _is_crossing(v, w, TOGGLE_SINE) | _is_crossing(w, u, TOGGLE_SINE) | _is_crossing(v, u, TOGGLE_SINE)
    rates = np.stack((_cross(v, w), _cross(w, u), _cross(v, u)))
    valid = at.valid & moves
    with np.errstate(divide="ignore", invalid="ignore"):
        # The rates have a common factor; normalize the largest to 1.
        scale = np.where(valid, 1.0 / np.abs(rates).max(axis=0), np.nan)
        two, three, four = rates * scale
    return _Vectors(at, axis, valid, np.broadcast_to(unit, at.b.shape), u, v, w, (two, three, four), scale)


def _compute_accelerations(x: _Vectors) -> tuple[Real, Real, Real]:
    """Compute the derivatives of the three angular rates along the smooth motion."""
    two, three, four = x.rates
    return (
        (four - three) * _dot(x.v, x.w) * x.scale,
        (two - four) * _dot(x.u, x.w) * x.scale,
        (two - three) * _dot(x.u, x.v) * x.scale,
    )


def _is_crossing(one: Complex, other: Complex, least_sine: float = PARALLEL_SINE) -> Mask:
    """Return whether two directions differ; False for NaN."""
    return np.asarray(np.abs(_cross(one, other)) > least_sine * np.abs(one) * np.abs(other))


def _cross(one: Complex, other: Complex) -> Real:
    """Return the cross product of vectors given as complex numbers."""
    return np.asarray(one.real * other.imag - one.imag * other.real)


def _dot(one: Complex, other: Complex) -> Real:
    return np.asarray(one.real * other.real + one.imag * other.imag)
