"""The pin-jointed fourbar: position, velocity, acceleration and jerk in closed form.

Joints: O2 and O4 are the fixed pivots of input and output, A and B the moving pivots, P the coupler point.
Link lengths are Norton's a (input), b (coupler), c (output), d (ground).

Position. With A = O2 + a e^{iθ2}, the pin B lies on a circle of radius b about A and one of radius c about O4. On the
axis from A to O4 (length f) it stands at x = (f² + b² − c²) / 2f with height h = ±√(b² − x²):

    B = A + (O4 − A)/f · (x + i σ h),        σ = +1 open, −1 crossed

which is the half-angle solution of Norton 4.10 and 4.13 without its divisions by zero. The product under the root is
kept in factors, 4 f² h² = (b + c + f)(b + c − f)(f + b − c)(f − b + c), so that it is exact near the toggles.

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
from numpy.typing import ArrayLike, NDArray

from kinematics.errors import DimensionError, ShapeError

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Mask = NDArray[np.bool_]

AngleAxis = tuple[EllipsisType] | tuple[EllipsisType, None]
"""Index that gives an array over designs its trailing axis of input angles."""

OPEN, CROSSED = 1, -1
"""Assembly signs: B to the left (open) or to the right (crossed) of the directed line from A to O4."""

TOGGLE_SINE = 1e-7
"""Derivatives count as undefined where |sin(θ4 − θ3)| is below this: near a toggle the sine goes with the root of the
input angle's distance from it, so that rounding of that angle alone makes a sine of some 1e-8."""

ON_TOGGLE = 16 * float(np.finfo(np.float64).eps)
"""h² may be below zero by this share of b c, which lengthens no link by more than that share: a toggle or change point
is a configuration, and rounding must not take it away."""


@dataclass(frozen=True, eq=False)
class Fourbar:
    """A batch of fourbars; all fields are kept with one shape, the *designs*. One design has shape ``()``.

    A value: the arrays are copies of what was given and cannot be written to. Two batches compare by identity.

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
        points = {
            "input_pivot": np.asarray(input_pivot, np.complex128),
            "output_pivot": np.asarray(output_pivot, np.complex128),
            "coupler_point": np.asarray(coupler_point, np.complex128),
        }
        lengths = {
            "input": np.asarray(input, np.float64),
            "coupler": np.asarray(coupler, np.float64),
            "output": np.asarray(output, np.float64),
        }
        designs = one_shape(**{name: value.shape for name, value in (points | lengths).items()})
        for name, length in lengths.items():
            require(name, "positive and finite", length, np.isfinite(length) & (length > 0.0))
        for name, point in points.items():
            require(name, "finite", point, np.isfinite(point))
        with np.errstate(over="ignore"):
            ground = np.abs(points["output_pivot"] - points["input_pivot"])
        require("ground", "positive and finite", ground, np.isfinite(ground) & (ground > 0.0))
        for name, value in (points | lengths).items():
            own = value.copy()
            own.flags.writeable = False
            object.__setattr__(self, name, np.broadcast_to(own, designs))

    @classmethod
    def from_lengths(
        cls,
        input: ArrayLike,
        coupler: ArrayLike,
        output: ArrayLike,
        ground: ArrayLike,
        coupler_point: ArrayLike = 0.0,
    ) -> Fourbar:
        """Fourbar of Norton's a, b, c, d with O2 at the origin and the ground link along +x."""
        length = np.asarray(ground, np.float64)
        require("ground", "positive and finite", length, np.isfinite(length) & (length > 0.0))
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


def one_shape(**shapes: tuple[int, ...]) -> tuple[int, ...]:
    """Shape that the named shapes broadcast to, or the error that names them."""
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        raise ShapeError(**shapes) from None


def require(name: str, expected: str, value: NDArray[np.generic], good: Mask | np.bool_) -> None:
    """Raise the error that names the field and its first bad value, unless all are good."""
    if not np.all(good):
        raise DimensionError(name, expected, np.asarray(value)[~np.asarray(good)].flat[0].item())


class Positions(NamedTuple):
    """Configuration over designs × input angles. Where ``valid`` is False the numbers are NaN.

    ``coupler_angle`` and ``output_angle`` (θ3 of A → B, θ4 of O4 → B) are absolute, radians in (−π, π].
    """

    valid: Mask
    a: Complex
    b: Complex
    p: Complex
    coupler_angle: Real
    output_angle: Real


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


def positions(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike = OPEN) -> Positions:
    """Closed-form positions for every design at every input angle (Norton 4.10, 4.13).

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
    """
    sign = np.asarray(assembly)
    require("assembly", "+1 (open) or −1 (crossed)", sign, np.abs(sign) == 1)
    theta, axis = with_angle_axis(linkage, input_angle, sign.shape)
    b, c, sigma = linkage.coupler[axis], linkage.output[axis], sign[axis]
    crank = linkage.input[axis] * np.exp(1j * theta)
    pin_a = linkage.input_pivot[axis] + crank
    diagonal = (linkage.output_pivot - linkage.input_pivot)[axis] - crank
    f = np.abs(diagonal)
    product = (b + c + f) * (b + c - f) * (f + (b - c)) * (f - (b - c))
    valid = closes(product, b, c, f) & (f > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (f * f + (b - c) * (b + c)) / (2.0 * f)
        height = np.sqrt(np.where(valid, np.maximum(product, 0.0), np.nan)) / (2.0 * f)
        pin_b = pin_a + diagonal / f * (along + 1j * sigma * height)
    arm = pin_b - pin_a
    point = pin_a + linkage.coupler_point[axis] * arm / b
    pin_a, valid = np.broadcast_to(pin_a, point.shape), np.broadcast_to(valid, point.shape)
    return Positions(
        valid,
        np.where(valid, pin_a, np.nan),
        pin_b,
        point,
        np.asarray(np.angle(arm)),
        np.asarray(np.angle(pin_b - linkage.output_pivot[axis])),
    )


def motion(
    linkage: Fourbar,
    input_angle: ArrayLike,
    assembly: ArrayLike = OPEN,
    *,
    speed: ArrayLike = 1.0,
    acceleration: ArrayLike = 0.0,
    jerk: ArrayLike = 0.0,
) -> Motion:
    """Positions and their first three time derivatives (Norton 6.18, 7.12, and once more differentiated).

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
    at = positions(linkage, input_angle, assembly)
    theta, axis = with_angle_axis(linkage, input_angle)
    b, c = linkage.coupler[axis], linkage.output[axis]
    rates_in = {"speed": speed, "acceleration": acceleration, "jerk": jerk}
    given = {name: np.asarray(rate, np.float64) for name, rate in rates_in.items()}
    shape = one_shape(positions=at.b.shape, **{name: rate.shape for name, rate in given.items()})
    w2, a2, j2 = (np.broadcast_to(rate, shape) for rate in given.values())
    crank = linkage.input[axis] * np.exp(1j * theta)
    coupler: Complex = at.b - at.a
    output: Complex = at.b - linkage.output_pivot[axis]
    arm = at.p - at.a
    determinant = _cross(output, coupler)
    sound = np.broadcast_to(at.valid & (np.abs(determinant) > TOGGLE_SINE * b * c), shape)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.where(sound, 1.0 / determinant, np.nan)

        def rates(right: Complex) -> tuple[Real, Real]:
            """Solve i·coupler·x3 − i·output·x4 = right for real x3, x4."""
            rotated = -1j * right
            return _cross(output, rotated) * scale, _cross(coupler, rotated) * scale

        crank = np.asarray(np.where(sound, crank, np.nan), np.complex128)
        va = 1j * w2 * crank
        w3, w4 = rates(-va)
        aa = (1j * a2 - w2**2) * crank
        a3, a4 = rates(-aa + w3**2 * coupler - w4**2 * output)
        ja = _third(w2, a2, j2) * crank
        j3, j4 = rates(-ja - _third(w3, a3, 0.0) * coupler + _third(w4, a4, 0.0) * output)

        velocity = Derivatives(sound, va, va + 1j * w3 * coupler, va + 1j * w3 * arm, w3, w4)
        second = 1j * a3 - w3**2
        accelerations = Derivatives(sound, aa, aa + second * coupler, aa + second * arm, a3, a4)
        third = _third(w3, a3, j3)
        jerks = Derivatives(sound, ja, ja + third * coupler, ja + third * arm, j3, j4)
    return Motion(at, velocity, accelerations, jerks)


def with_angle_axis(linkage: Fourbar, input_angle: ArrayLike, assembly: tuple[int, ...] = ()) -> tuple[Real, AngleAxis]:
    """Input angles, and the index that gives every field of the linkage its trailing angle axis."""
    theta = np.asarray(input_angle, np.float64)
    designs = linkage.input.shape
    if theta.ndim == 0 and designs == assembly == ():
        return theta, (...,)
    one_shape(designs=(*designs, 1), assembly=(*assembly, 1), input_angle=theta.shape)
    return theta, (..., None)


def closes(product: Real, b: Real, c: Real, f: Real) -> Mask:
    """Whether sides b and c meet over the base f, a triangle folded flat (to rounding) included.

    ``product`` is 4 f² h² = (b + c + f)(b + c − f)(f + b − c)(f − b + c).
    """
    return np.asarray(product >= -4.0 * ON_TOGGLE * f * f * b * c)


def _cross(u: Complex, v: Complex) -> Real:
    """Cross product u × v of vectors written as complex numbers."""
    return u.real * v.imag - u.imag * v.real


def _third(w: ArrayLike, alpha: ArrayLike, jerk: ArrayLike) -> Complex:
    """Factor of e^{iθ} in its third time derivative: i(θ''' − θ'³) − 3 θ' θ''."""
    w, alpha, jerk = np.asarray(w), np.asarray(alpha), np.asarray(jerk)
    return np.asarray(1j * (jerk - w**3) - 3.0 * w * alpha, np.complex128)
