"""The pin-jointed fourbar: position, velocity, acceleration and jerk in closed form.

Joints: O2 and O4 are the fixed pivots of input and output, A and B the moving pivots, P the coupler point.
Link lengths are Norton's a (input), b (coupler), c (output), d (ground).

Position. With A = O2 + a e^{iθ2}, the pin B lies on a circle of radius b about A and one of radius c about O4. On the
axis from A to O4 (length f) it lies at x = (f² + b² − c²) / 2f with height h = ±√(b² − x²):

    B = A + (O4 − A)/f · (x + i σ h),        σ = +1 open, −1 crossed

which is the half-angle solution of Norton 4.10 and 4.13 without its divisions by zero. The product under the root is
factored, 4 f² h² = (b + c + f)(b + c − f)(f + b − c)(f − b + c), so that it is accurate near the toggles. The
sweeps over designs × angles are compiled (:mod:`kinematics.linkage.fourbar.kernels`).

Derivatives. The loop A + b e^{iθ3} = O4 + c e^{iθ4} is differentiated with respect to time; each order is a real 2×2
linear system with the same matrix (Norton 6.18, 7.12), solved by cross products. Its determinant is
b c sin(θ4 − θ3): at a toggle the derivatives do not exist and are marked invalid.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from types import EllipsisType
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Mask, Real
from kinematics.linkage.batch import (
    CROSSED_ASSEMBLY,
    OPEN_ASSEMBLY,
    CouplerPoints,
    DesignBatch,
    broadcast_shape,
    build_rated_sweep,
    require,
    sweep_coupler_points,
    sweep_motion,
    sweep_positions,
)
from kinematics.linkage.fourbar import kernels
from kinematics.linkage.kernels import TOGGLE_SINE, TOGGLE_SLACK

__all__ = [
    "CROSSED_ASSEMBLY",
    "OPEN_ASSEMBLY",
    "TOGGLE_SINE",
    "TOGGLE_SLACK",
    "AngleAxis",
    "Complex",
    "CouplerMotion",
    "CouplerPoints",
    "Derivatives",
    "Fourbar",
    "Mask",
    "Motion",
    "Positions",
    "Real",
    "broadcast_shape",
    "coupler_motion",
    "coupler_points",
    "is_closed",
    "motion",
    "positions",
    "require",
    "with_angle_axis",
]

AngleAxis = tuple[EllipsisType] | tuple[EllipsisType, None]
"""Index that gives an array over designs its trailing axis of input angles."""


@dataclass(frozen=True, eq=False)
class Fourbar(DesignBatch):
    """A batch of fourbars; all fields have one shape, the *designs*. A single design has shape ``()``.

    A value: the arrays are read-only copies of the arguments. Two batches compare by identity.

    Parameters
    ----------
    input_pivot, output_pivot : complex
        Fixed pivots O2 and O4.
    input, coupler, output : float
        Link lengths a, b, c; positive. The ground length d = |O4 − O2| must be positive too.
    coupler_point : complex
        P in the coupler's frame: origin at A, real axis towards B. Default: A itself.

    Raises
    ------
    DimensionError
        For a length that is not positive and finite.
    ShapeError
        For fields that do not broadcast.
    """

    _FIELDS = "input_pivot", "output_pivot", "coupler_point", "input", "coupler", "output"

    input_pivot: Complex
    output_pivot: Complex
    input: Real
    coupler: Real
    output: Real
    coupler_point: Complex

    def __init__(
        self,
        input_pivot: ArrayLike,
        output_pivot: ArrayLike,
        input: ArrayLike,
        coupler: ArrayLike,
        output: ArrayLike,
        coupler_point: ArrayLike = 0.0,
    ) -> None:
        # One compiled check for all fields; the slow diagnosis only runs on failure.
        if not kernels.has_sound_dimensions(
            *self._store_fields(input_pivot, output_pivot, coupler_point, input, coupler, output)
        ):
            self._refuse()

    def _refuse(self) -> None:
        """Raise the error that names the first unsound field."""
        for name in ("input", "coupler", "output"):
            length = getattr(self, name)
            require(name, "kinematics-positive-and-finite", length, np.isfinite(length) & (length > 0.0))
        for name in ("input_pivot", "output_pivot", "coupler_point"):
            require(name, "kinematics-finite", getattr(self, name), np.isfinite(getattr(self, name)))
        # Pivots near the largest double overflow here and are reported below.
        with np.errstate(over="ignore"):
            ground = self.ground
        require("ground", "kinematics-positive-and-finite", ground, np.isfinite(ground) & (ground > 0.0))

    @classmethod
    def from_lengths(
        cls,
        input: ArrayLike,
        coupler: ArrayLike,
        output: ArrayLike,
        ground: ArrayLike,
        coupler_point: ArrayLike = 0.0,
    ) -> Fourbar:
        """Build a fourbar from Norton's a, b, c, d, with O2 at the origin and the ground link along +x."""
        length = np.asarray(ground, np.float64)
        require("ground", "kinematics-positive-and-finite", length, np.isfinite(length) & (length > 0.0))
        return cls(np.zeros_like(length), length, input, coupler, output, coupler_point)

    @cached_property
    def ground(self) -> Real:
        """Ground length d, shape designs."""
        return np.asarray(np.abs(self.output_pivot - self.input_pivot))

    @cached_property
    def lengths(self) -> Real:
        """Link lengths in Barker's order ground, input, coupler, output; shape designs + (4,)."""
        return np.stack((self.ground, self.input, self.coupler, self.output), axis=-1)

    @cached_property
    def ground_angle(self) -> Real:
        """Angle of the line O2 → O4, radians, shape designs."""
        return np.asarray(np.angle(self.output_pivot - self.input_pivot))


class Positions(NamedTuple):
    """Configuration over designs × input angles; NaN where ``valid`` is False.

    ``coupler_angle`` and ``output_angle`` (θ3 of A → B, θ4 of O4 → B) are absolute, radians in (−π, π].
    """

    valid: Mask
    a: Complex
    b: Complex
    p: Complex
    coupler_angle: Real
    output_angle: Real


class CouplerMotion(NamedTuple):
    """Coupler points with velocity and acceleration over designs × input angles.

    The position is NaN where ``valid`` is False, the derivatives where ``moves`` is False, which includes toggles.
    """

    valid: Mask
    moves: Mask
    p: Complex
    velocity: Complex
    acceleration: Complex


class Derivatives(NamedTuple):
    """One time derivative of the motion over designs × input angles; rates in rad/s^n, points in length/s^n."""

    valid: Mask
    a: Complex
    b: Complex
    p: Complex
    coupler: Real
    output: Real


class Motion(NamedTuple):
    """Positions with velocities, accelerations and jerks."""

    position: Positions
    velocity: Derivatives
    acceleration: Derivatives
    jerk: Derivatives


def positions(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> Positions:
    """Compute closed-form positions for every design at every input angle (Norton 4.10, 4.13).

    Parameters
    ----------
    linkage : Fourbar
        Designs of shape S.
    input_angle : float
        Absolute input angles θ2, radians; shape (N,) for the same angles in every design, or S + (N,), or any shape
        that broadcasts with S + (1,). For a single design a scalar gives results without the last axis.
    assembly : int
        +1 open or −1 crossed, shape S or scalar.

    Returns
    -------
    Positions
        Arrays of shape S + (N,).

    Raises
    ------
    DimensionError
        For an assembly that is neither +1 nor −1.
    ShapeError
        For angles or assemblies that do not broadcast with the designs.

    Examples
    --------
    Norton, Table P4-1, row a, open:

    >>> at = positions(Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0), np.radians(30.0))
    >>> [round(float(np.degrees(angle)), 1) for angle in (at.coupler_angle, at.output_angle)]
    [88.8, 117.3]
    """
    return Positions(*sweep_positions(kernels, linkage.blocks, input_angle, assembly))


def coupler_points(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN_ASSEMBLY) -> CouplerPoints:
    """Compute only coupler points, for large sweeps; parameters, shapes and errors as for :func:`positions`."""
    return sweep_coupler_points(kernels, linkage.blocks, input_angle, assembly)


def coupler_motion(
    linkage: Fourbar,
    input_angle: ArrayLike,
    assembly: ArrayLike = OPEN_ASSEMBLY,
    *,
    speed: ArrayLike = 1.0,
    acceleration: ArrayLike = 0.0,
) -> CouplerMotion:
    """Compute only position, velocity and acceleration of the coupler point, for large sweeps.

    Parameters, shapes and errors are those of :func:`motion`.
    """
    # The jerk is not needed, but the rates have three rows.
    _, at, rates = build_rated_sweep(linkage.blocks, input_angle, assembly, speed, acceleration, 0.0)
    points, valid = np.empty((3, *at.flat), np.complex128), np.empty((2, *at.flat), np.bool_)
    kernels.coupler_motion(*at[:4], rates, points, valid)
    points, valid = points.reshape(3, *at.shape), valid.reshape(2, *at.shape)
    return CouplerMotion(valid[0, ...], valid[1, ...], points[0, ...], points[1, ...], points[2, ...])


def motion(
    linkage: Fourbar,
    input_angle: ArrayLike,
    assembly: ArrayLike = OPEN_ASSEMBLY,
    *,
    speed: ArrayLike = 1.0,
    acceleration: ArrayLike = 0.0,
    jerk: ArrayLike = 0.0,
) -> Motion:
    """Compute positions and their first three time derivatives (Norton 6.18, 7.12, and one more differentiation).

    Parameters
    ----------
    linkage, input_angle, assembly
        As for :func:`positions`.
    speed, acceleration, jerk : float
        Input θ2', θ2'', θ2''' in rad/s, rad/s², rad/s³, broadcasting with the positions, shape S + (N,). With the
        defaults the results are derivatives with respect to the input angle.

    Returns
    -------
    Motion
        Derivatives are invalid (NaN) where the position is, and at toggles.

    Raises
    ------
    DimensionError, ShapeError
        As for :func:`positions`; ShapeError also for rates that do not broadcast with the positions.
    """
    position, *rates = sweep_motion(kernels, linkage.blocks, input_angle, assembly, speed, acceleration, jerk)
    return Motion(Positions(*position), *(Derivatives(*rate) for rate in rates))


def with_angle_axis(linkage: Fourbar, input_angle: ArrayLike, assembly: tuple[int, ...] = ()) -> tuple[Real, AngleAxis]:
    """Return input angles, and the index that gives every field of the linkage its trailing angle axis."""
    theta = np.asarray(input_angle, np.float64)
    designs = linkage.input.shape
    if theta.ndim == 0 and designs == assembly == ():
        return theta, (...,)
    broadcast_shape(designs=(*designs, 1), assembly=(*assembly, 1), input_angle=theta.shape)
    return theta, (..., None)


def is_closed(product: Real, b: Real, c: Real, f: Real) -> Mask:
    """Return whether sides b and c meet over the base f, including a triangle folded flat (to rounding).

    ``product`` is 4 f² h² = (b + c + f)(b + c − f)(f + b − c)(f − b + c).
    """
    return np.asarray(product >= -4.0 * TOGGLE_SLACK * f * f * b * c)
