"""Batches: how designs, assemblies and input angles make one shape, and how they are handed to the kernels.

The *designs* of a linkage have a shape S; input angles have a last axis of their own, so that results have the shape
S + (N,). A kernel sees D designs in a row and N angles, and takes one design, or one row of angles, for all.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.errors import DimensionError, ShapeError

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Mask = NDArray[np.bool_]
Shape = tuple[int, ...]

OPEN, CROSSED = 1, -1
"""Assembly signs. Fourbar: B to the left (open) or to the right (crossed) of the directed line from A to O4.
Slider-crank: B as far along the slide as it can be (open), or as far back."""


def one_shape(**shapes: Shape) -> Shape:
    """Shape that the named shapes broadcast to, or the error that names them."""
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        raise ShapeError(**shapes) from None


def require(name: str, expected: str, value: NDArray[Any], good: Mask | np.bool_) -> None:
    """Raise the error that names the field and its first bad value, unless all are good."""
    if not np.all(good):
        raise DimensionError(name, expected, np.asarray(value)[~np.asarray(good)].flat[0].item())


def block(rows: tuple[NDArray[Any], ...], designs: Shape, dtype: Any) -> NDArray[Any]:
    """A read-only copy of some fields of a linkage, each of one shape, as rows of one array."""
    whole = np.empty((len(rows), *designs), dtype)
    for row, field in enumerate(rows):
        whole[row] = field
    whole.flags.writeable = False
    return whole


class CouplerPoints(NamedTuple):
    """Coupler points over designs × input angles; NaN where not ``valid``."""

    valid: Mask
    p: Complex


class Sweep(NamedTuple):
    """What a kernel takes in: designs and assemblies in a row, angles in rows; and the shape of the results."""

    pivots: Complex
    lengths: Real
    sign: Real
    theta: Real
    shape: Shape

    @property
    def flat(self) -> tuple[int, int]:
        """The shape as designs × angles."""
        return flat(self.shape)


def sweep(blocks: tuple[Complex, Real], input_angle: ArrayLike, assembly: ArrayLike, shape: Shape = ()) -> Sweep:
    """Designs, input angles and assemblies of one shape.

    Parameters
    ----------
    blocks : complex, float
        Points and lengths of the designs, shape (3,) + S.
    input_angle, assembly
        As for :func:`kinematics.linkage.positions`.
    shape
        What the results shall have at least.

    Raises
    ------
    DimensionError
        For an assembly that is neither +1 nor −1.
    ShapeError
        For angles or assemblies that do not broadcast with the designs.
    """
    sign, theta = np.asarray(assembly), np.asarray(input_angle, np.float64)
    if not (abs(float(sign)) == 1.0 if sign.ndim == 0 else np.all(np.abs(sign) == 1)):
        require("assembly", "+1 (open) or −1 (crossed)", sign, np.abs(sign) == 1)
    pivots, lengths = blocks
    designs = lengths.shape[1:]
    if not shape and sign.ndim == 0 and (theta.ndim == 1 or not designs):
        shape = (*designs, *theta.shape)
    elif theta.ndim or designs or sign.ndim:
        found = one_shape(designs=(*designs, 1), assembly=(*sign.shape, 1), input_angle=theta.shape)
        shape = one_shape(found=found, shape=shape) if shape else found
    batch = shape[:-1]
    if designs not in (batch, ()):
        pivots, lengths = (block(tuple(rows), batch, rows.dtype) for rows in (pivots, lengths))
    signs = np.empty(1 if sign.size == 1 else batch)
    signs[...] = sign.reshape(1) if sign.size == 1 else sign
    return Sweep(pivots.reshape(3, -1), lengths.reshape(3, -1), signs.reshape(-1), angle_rows(theta, shape), shape)


def over_designs(
    blocks: tuple[Complex, Real], shape: Shape, *values: ArrayLike
) -> tuple[Complex, Real, *tuple[Real, ...]]:
    """Designs in a row, and values with them or for all of them: blocks (3, D) or (3, 1), values (M,), M designs."""
    designs = blocks[1].shape[1:]
    pivots, lengths = blocks
    if designs not in (shape, ()):
        pivots, lengths = (block(tuple(rows), shape, rows.dtype) for rows in blocks)
    rows = np.empty((len(values), *shape))
    for row, value in enumerate(values):
        rows[row] = value
    return pivots.reshape(3, -1), lengths.reshape(3, -1), *rows.reshape(len(values), math.prod(shape))


def fields(valid: Mask, points: Complex, angles: Real) -> tuple[Mask, Complex, Complex, Complex, Real, Real]:
    """Mask, three points and two angles, each of its own, of blocks of points and angles."""
    return valid, points[0, ...], points[1, ...], points[2, ...], angles[0, ...], angles[1, ...]


def flat(shape: Shape) -> tuple[int, int]:
    """A shape of results as designs × angles; a scalar is one design at one angle."""
    return math.prod(shape[:-1]), shape[-1] if shape else 1


def angle_rows(values: Real, shape: Shape) -> Real:
    """Values over designs × angles as a row for each design, or one for all: shape (D, N) or (1, N), a copy."""
    designs, n = flat(shape)
    if values.ndim < 2:
        row = np.empty((1, n))
        row[0] = values
        return row
    alike = values.size == values.shape[-1]
    rows = np.empty((1 if alike else designs, n))
    if alike:
        rows[0] = values.reshape(-1)
    else:
        rows.reshape(shape)[...] = values
    return rows


def rate_rows(speed: Real, acceleration: Real, jerk: Real, shape: Shape) -> Real:
    """Input rates as rows for each design, or one for all: shape (3, D, N) or (3, 1, N)."""
    rates = speed, acceleration, jerk
    if speed.ndim == acceleration.ndim == jerk.ndim == 0:
        together = np.empty((3, 1, flat(shape)[1]))
        together[0], together[1], together[2] = rates
        return together
    rows = [angle_rows(rate, shape) for rate in rates]
    together = np.empty((3, 1 if all(len(row) == 1 for row in rows) else flat(shape)[0], rows[0].shape[-1]))
    for k, row in enumerate(rows):
        together[k] = row
    return together
