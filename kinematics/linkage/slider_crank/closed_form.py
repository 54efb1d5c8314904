"""The slider-crank driven at its crank: position, velocity, acceleration and jerk in closed form.

O2 is the fixed pivot of the crank, A the pin between crank and coupler, B the pin of the slider on the *slide*, a fixed
line with a direction, P the coupler point. Lengths are Norton's a (crank), b (coupler) and c, the offset: the distance
by which the slide passes to the left of the pivot, looking along the slide.

Position. In the frame of the slide, x along it, the crank is k = a e^{i(θ2 − φ)} and the coupler u = B − A reaches from
height k_y to the slide (Norton 4.16 and 4.17 without their angles):

    u_y = c − k_y,        u_x = σ √((b − u_y)(b + u_y)),        σ = +1 open, −1 crossed

Derivatives. B moves only along the slide: the component of each derivative of k + u across the slide vanishes, which
gives the coupler's rates, and the component along it is the slider's (Norton 6.20 ff., 7.15 ff.). The divisor is u_x:
at a toggle, with the coupler normal to the slide, the derivatives do not exist and are marked invalid.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Mask, Real
from kinematics.linkage.batch import (
    OPEN_ASSEMBLY,
    CouplerPoints,
    DesignBatch,
    require,
    sweep_coupler_points,
    sweep_motion,
    sweep_positions,
)
from kinematics.linkage.slider_crank import kernels


@dataclass(frozen=True, eq=False)
class SliderCrank(DesignBatch):
    """A batch of slider-cranks; all fields have one shape, the *designs*. A single design has shape ``()``.

    A value: the arrays are read-only copies of the arguments. Two batches compare by identity.

    Parameters
    ----------
    pivot : complex
        Fixed pivot O2 of the crank.
    slide_point : complex
        Point of the slide at which the slider's travel is zero.
    slide_angle : float
        Direction of the slide, radians.
    crank, coupler : float
        Lengths a and b; positive.
    coupler_point : complex
        P in the coupler's frame: origin at A, real axis towards B. Default: A itself.

    Raises
    ------
    DimensionError
        For a length that is not positive and finite, or a point or angle that is not finite.
    ShapeError
        For fields that do not broadcast.
    """

    _FIELDS = "pivot", "slide_point", "coupler_point", "crank", "coupler", "slide_angle"

    pivot: Complex
    slide_point: Complex
    slide_angle: Real
    crank: Real
    coupler: Real
    coupler_point: Complex

    def __init__(
        self,
        pivot: ArrayLike,
        slide_point: ArrayLike,
        slide_angle: ArrayLike,
        crank: ArrayLike,
        coupler: ArrayLike,
        coupler_point: ArrayLike = 0.0,
    ) -> None:
        blocks = self._store_fields(pivot, slide_point, coupler_point, crank, coupler, slide_angle)
        if not kernels.has_sound_dimensions(*blocks):
            for name, length in (("crank", self.crank), ("coupler", self.coupler)):
                require(name, "kinematics-positive-and-finite", length, np.isfinite(length) & (length > 0.0))
            for name in ("pivot", "slide_point", "coupler_point", "slide_angle"):
                require(name, "kinematics-finite", getattr(self, name), np.isfinite(getattr(self, name)))

    @classmethod
    def from_lengths(
        cls, crank: ArrayLike, coupler: ArrayLike, offset: ArrayLike = 0.0, coupler_point: ArrayLike = 0.0
    ) -> SliderCrank:
        """Build a slider-crank from Norton's a, b, c: O2 at the origin, slide along +x, travel counted from x = 0."""
        return cls(0.0, 1j * np.asarray(offset, np.float64), 0.0, crank, coupler, coupler_point)

    @cached_property
    def offset(self) -> Real:
        """Norton's c, shape designs: signed distance from the pivot to the slide, positive to its left."""
        return np.asarray(((self.slide_point - self.pivot) * np.exp(-1j * self.slide_angle)).imag)


class SliderPositions(NamedTuple):
    """Configuration over designs × crank angles; NaN where ``valid`` is False.

    ``coupler_angle`` (of A → B) is absolute, radians in (−π, π]; ``travel`` is the position of B along the slide from
    the slide's point.
    """

    valid: Mask
    a: Complex
    b: Complex
    p: Complex
    coupler_angle: Real
    travel: Real


class SliderDerivatives(NamedTuple):
    """One time derivative of the motion: rates of the coupler in rad/s^n, points and travel in length/s^n."""

    valid: Mask
    a: Complex
    b: Complex
    p: Complex
    coupler: Real
    travel: Real


class SliderMotion(NamedTuple):
    """Positions with velocities, accelerations and jerks."""

    position: SliderPositions
    velocity: SliderDerivatives
    acceleration: SliderDerivatives
    jerk: SliderDerivatives


def positions(linkage: SliderCrank, crank_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> SliderPositions:
    """Compute closed-form positions for every design at every crank angle (Norton 4.16, 4.17).

    Parameters
    ----------
    linkage : SliderCrank
        Designs of shape S.
    crank_angle : float
        Absolute crank angles θ2, radians, as for :func:`kinematics.linkage.positions`.
    assembly : int
        +1 open (B farther along the slide) or −1 crossed, shape S or scalar.

    Returns
    -------
    SliderPositions
        Arrays of shape S + (N,).

    Raises
    ------
    DimensionError
        For an assembly that is neither +1 nor −1.
    ShapeError
        For angles or assemblies that do not broadcast with the designs.

    Examples
    --------
    Norton, Table P4-2, row a:

    >>> at = positions(SliderCrank.from_lengths(1.4, 4.0, 1.0), np.radians(45.0))
    >>> round(float(at.travel), 4)
    4.9899
    """
    return SliderPositions(*sweep_positions(kernels, linkage.blocks, crank_angle, assembly))


def coupler_points(linkage: SliderCrank, crank_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> CouplerPoints:
    """Compute only coupler points, for large sweeps; parameters, shapes and errors as for :func:`positions`."""
    return sweep_coupler_points(kernels, linkage.blocks, crank_angle, assembly)


def motion(
    linkage: SliderCrank,
    crank_angle: ArrayLike,
    assembly: ArrayLike = OPEN_ASSEMBLY,
    *,
    speed: ArrayLike = 1.0,
    acceleration: ArrayLike = 0.0,
    jerk: ArrayLike = 0.0,
) -> SliderMotion:
    """Compute positions and their first three time derivatives.

    Parameters
    ----------
    linkage, crank_angle, assembly
        As for :func:`positions`.
    speed, acceleration, jerk : float
        Crank θ2', θ2'', θ2''' in rad/s, rad/s², rad/s³, broadcasting with the positions. With the defaults
        the results are derivatives with respect to the crank angle.

    Returns
    -------
    SliderMotion
        Derivatives are invalid (NaN) where the position is, and at toggles.

    Raises
    ------
    DimensionError, ShapeError
        As for :func:`positions`; ShapeError also for rates that do not broadcast with them.
    """
    position, *rates = sweep_motion(kernels, linkage.blocks, crank_angle, assembly, speed, acceleration, jerk)
    return SliderMotion(SliderPositions(*position), *(SliderDerivatives(*rate) for rate in rates))


class CrankLimits(NamedTuple):
    """Range of the heights k_y = a sin(θ2 − φ) of A over the slide's direction, shape designs.

    The coupler requires heights between c − b and c + b. The masks mark ends that the crank reaches, toggles with the
    coupler normal to the slide; NaN without any position.
    """

    lower: Real
    upper: Real
    lower_toggle: Mask
    upper_toggle: Mask


def find_crank_limits(linkage: SliderCrank) -> CrankLimits:
    """Find the range of heights of A: those of the crank circle from which the coupler reaches the slide."""
    a, b, c = linkage.crank, linkage.coupler, linkage.offset
    sound = np.abs(c) <= a + b
    lower, upper = np.maximum(c - b, -a), np.minimum(c + b, a)
    return CrankLimits(
        np.where(sound, lower, np.nan), np.where(sound, upper, np.nan), sound & (c - b >= -a), sound & (c + b <= a)
    )


def has_full_rotation(linkage: SliderCrank) -> Mask:
    """Return whether the crank rotates fully without a toggle: a + |c| < b."""
    return np.asarray(linkage.crank + np.abs(linkage.offset) < linkage.coupler)


def find_toggle_angles(linkage: SliderCrank) -> Real:
    """Find the absolute crank angles of all toggles of one design, radians in (−π, π], ascending; none for a full
    crank.

    The coupler is normal to the slide there: a sin(θ2 − φ) = c ∓ b.
    """
    limits, a = find_crank_limits(linkage), float(linkage.crank)
    heights = [float(limits.lower)] * bool(limits.lower_toggle) + [float(limits.upper)] * bool(limits.upper_toggle)
    # arcsin(y/a) without loss of digits near ±a.
    first = np.array([np.arctan2(y, np.sqrt((a - y) * (a + y))) for y in heights])
    angles = np.concatenate([first, np.pi - first]) + linkage.slide_angle
    wrapped = np.pi - np.mod(np.pi - angles, 2.0 * np.pi)
    return np.unique(np.where(wrapped <= -np.pi, np.pi, wrapped))
