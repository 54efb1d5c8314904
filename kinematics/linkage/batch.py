"""Batches: broadcasting of designs, assemblies and input angles, and their layout for the kernels.

The *designs* of a linkage have a shape S; input angles have their own last axis, so results have the shape S + (N,). A
kernel sees D designs in a row and N angles; a single design, or a single row of angles, is used for all.
"""

from __future__ import annotations

import math
from types import ModuleType
from typing import ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Mask, Real, Scalar
from kinematics.errors import DimensionError, ShapeError

Shape = tuple[int, ...]

OPEN_ASSEMBLY, CROSSED_ASSEMBLY = 1, -1
"""Assembly signs. Fourbar: B to the left (open) or to the right (crossed) of the directed line from A to O4.
Slider-crank: B at the far end of the slide (open), or at the near end (crossed)."""


def broadcast_shape(**shapes: Shape) -> Shape:
    """Return the shape that the named shapes broadcast to, or raise an error that names them."""
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        raise ShapeError(**shapes) from None


def require(
    name: str, expected: str, value: NDArray[np.generic], good: Mask | np.bool_, /, **values: str | int
) -> None:
    """Raise :class:`DimensionError` with the first bad value, unless all are good; other arguments as for the error."""
    if not np.all(good):
        raise DimensionError(name, expected, np.asarray(value)[~np.asarray(good)].flat[0].item(), **values)


def build_block(rows: tuple[NDArray[Scalar], ...], designs: Shape) -> NDArray[Scalar]:
    """Build a read-only copy of fields of a linkage, broadcast to one shape, as rows of one array."""
    whole = np.empty((len(rows), *designs), rows[0].dtype)
    for row, field in enumerate(rows):
        whole[row] = field
    # Views of the block are shared, and must not be modified.
    whole.flags.writeable = False
    return whole


class DesignBatch:
    """A batch of designs as a value: its fields are read-only views of the two blocks that kernels use."""

    _FIELDS: ClassVar[tuple[str, str, str, str, str, str]]
    """Names of the fields: three points and three lengths."""

    def _store_fields(self, *fields: ArrayLike) -> tuple[Complex, Real]:
        """Copy the fields, three points and three lengths, into blocks of one shape; the blocks with designs in a row.

        Raises
        ------
        ShapeError
            For fields that do not broadcast.
        """
        p, q, r = (np.asarray(value, np.complex128) for value in fields[:3])
        a, b, c = (np.asarray(value, np.float64) for value in fields[3:])
        # Equal shapes are the common case and need no broadcasting.
        if p.shape == q.shape == r.shape == a.shape == b.shape == c.shape:
            designs = a.shape
        else:
            named = zip(self._FIELDS, (p, q, r, a, b, c), strict=True)
            designs = broadcast_shape(**{name: field.shape for name, field in named})
        at, long = build_block((p, q, r), designs), build_block((a, b, c), designs)
        # Written out, because a loop over the six fields would take a tenth of the constructor's time.
        point_1, point_2, point_3, length_1, length_2, length_3 = self._FIELDS
        attributes = self.__dict__
        attributes[point_1], attributes[point_2], attributes[point_3] = at[0, ...], at[1, ...], at[2, ...]
        attributes[length_1], attributes[length_2], attributes[length_3] = long[0, ...], long[1, ...], long[2, ...]
        attributes["_blocks"] = at, long
        return at.reshape(3, -1), long.reshape(3, -1)

    @property
    def blocks(self) -> tuple[Complex, Real]:
        """The three points and the three lengths in the kernels' layout, shape (3,) + S each."""
        blocks: tuple[Complex, Real] = self.__dict__["_blocks"]
        return blocks

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), tuple(self.__dict__[field] for field in self.__annotations__)


class CouplerPoints(NamedTuple):
    """Coupler points over designs × input angles; NaN where not ``valid``."""

    valid: Mask
    p: Complex


class Sweep(NamedTuple):
    """Input of a kernel: designs and assemblies in a row, angles in rows; and the shape of the results."""

    pivots: Complex
    lengths: Real
    sign: Real
    theta: Real
    shape: Shape

    @property
    def flat(self) -> tuple[int, int]:
        """The shape as designs × angles."""
        return flatten_shape(self.shape)


def build_sweep(blocks: tuple[Complex, Real], input_angle: ArrayLike, assembly: ArrayLike, shape: Shape = ()) -> Sweep:
    """Bring designs, input angles and assemblies to one shape.

    Parameters
    ----------
    blocks : complex, float
        Points and lengths of the designs, shape (3,) + S.
    input_angle, assembly
        As for :func:`kinematics.linkage.positions`.
    shape
        Shape that the results must broadcast to, if given.

    Raises
    ------
    DimensionError
        For an assembly that is neither +1 nor −1.
    ShapeError
        For angles or assemblies that do not broadcast with the designs.
    """
    sign, theta = np.asarray(assembly), np.asarray(input_angle, np.float64)
    if not (abs(float(sign)) == 1.0 if sign.ndim == 0 else np.all(np.abs(sign) == 1)):
        require("assembly", "kinematics-assembly-sign", sign, np.abs(sign) == 1)
    pivots, lengths = blocks
    designs = lengths.shape[1:]
    # The common case, without the cost of broadcasting.
    if not shape and sign.ndim == 0 and (theta.ndim == 1 or not designs):
        shape = (*designs, *theta.shape)
    elif theta.ndim or designs or sign.ndim:
        found = broadcast_shape(designs=(*designs, 1), assembly=(*sign.shape, 1), input_angle=theta.shape)
        shape = broadcast_shape(found=found, shape=shape) if shape else found
    batch = shape[:-1]
    if designs not in (batch, ()):
        pivots, lengths = (build_block(tuple(rows), batch) for rows in (pivots, lengths))
    # A single sign is not repeated; the kernels use it for every design.
    signs = np.empty(1 if sign.size == 1 else batch)
    signs[...] = sign.reshape(1) if sign.size == 1 else sign
    return Sweep(
        pivots.reshape(3, -1), lengths.reshape(3, -1), signs.reshape(-1), build_angle_rows(theta, shape), shape
    )


Fields = tuple[Mask, Complex, Complex, Complex, Real, Real]
"""Mask, points A, B and P, and two angles (or an angle and the slider's travel) of a configuration, or of its rates."""


def sweep_positions(
    kernels: ModuleType, blocks: tuple[Complex, Real], input_angle: ArrayLike, assembly: ArrayLike
) -> Fields:
    """Compute configurations by a linkage's kernel ``whole_positions``.

    The parameters and errors are those of :func:`build_sweep`.
    """
    at = build_sweep(blocks, input_angle, assembly)
    points, angles, valid = np.empty((3, *at.flat), np.complex128), np.empty((2, *at.flat)), np.empty(at.flat, np.bool_)
    kernels.whole_positions(*at[:4], points, angles, valid)
    return _split_fields(valid.reshape(at.shape), points.reshape(3, *at.shape), angles.reshape(2, *at.shape))


def sweep_coupler_points(
    kernels: ModuleType, blocks: tuple[Complex, Real], input_angle: ArrayLike, assembly: ArrayLike
) -> CouplerPoints:
    """Compute coupler points by a linkage's kernel ``coupler_points``.

    The parameters and errors are those of :func:`build_sweep`.
    """
    at = build_sweep(blocks, input_angle, assembly)
    points, valid = np.empty(at.flat, np.complex128), np.empty(at.flat, np.bool_)
    kernels.coupler_points(*at[:4], points, valid)
    return CouplerPoints(valid.reshape(at.shape), points.reshape(at.shape))


def sweep_motion(
    kernels: ModuleType,
    blocks: tuple[Complex, Real],
    input_angle: ArrayLike,
    assembly: ArrayLike,
    *rates: ArrayLike,
) -> tuple[Fields, Fields, Fields, Fields]:
    """Compute configurations and three time derivatives by a linkage's kernel ``whole_motion``.

    ``rates`` are the speed, acceleration and jerk of the input.
    """
    positions_shape, at, rows = build_rated_sweep(blocks, input_angle, assembly, *rates)
    points, angles = np.empty((4, 3, *at.flat), np.complex128), np.empty((4, 2, *at.flat))
    valid = np.empty((2, *at.flat), np.bool_)
    kernels.whole_motion(*at[:4], rows, points, angles, valid)
    points, angles = points.reshape(4, 3, *at.shape), angles.reshape(4, 2, *at.shape)
    valid = valid.reshape(2, *at.shape)
    # Rates may have more axes than the positions; the positions keep their own shape.
    if at.shape == positions_shape:
        position = _split_fields(valid[0, ...], points[0], angles[0])
    else:
        position = sweep_positions(kernels, blocks, input_angle, assembly)
    sound = valid[1, ...]
    velocity, acceleration, jerk = (_split_fields(sound, points[k], angles[k]) for k in (1, 2, 3))
    return position, velocity, acceleration, jerk


def build_rated_sweep(
    blocks: tuple[Complex, Real], input_angle: ArrayLike, assembly: ArrayLike, *rates: ArrayLike
) -> tuple[Shape, Sweep, Real]:
    """Return the shape of the positions, the sweep broadcast with the rates, and the rates as rows."""
    narrow = build_sweep(blocks, input_angle, assembly)
    speed, acceleration, jerk = (np.asarray(rate, np.float64) for rate in rates)
    if speed.ndim == acceleration.ndim == jerk.ndim == 0:
        return narrow.shape, narrow, build_rate_rows(speed, acceleration, jerk, narrow.shape)
    shape = broadcast_shape(positions=narrow.shape, speed=speed.shape, acceleration=acceleration.shape, jerk=jerk.shape)
    at = narrow if shape == narrow.shape else build_sweep(blocks, input_angle, assembly, shape)
    return narrow.shape, at, build_rate_rows(speed, acceleration, jerk, shape)


def _split_fields(valid: Mask, points: Complex, angles: Real) -> Fields:
    return valid, points[0, ...], points[1, ...], points[2, ...], angles[0, ...], angles[1, ...]


def broadcast_over_designs(
    blocks: tuple[Complex, Real], shape: Shape, *values: ArrayLike
) -> tuple[Complex, Real, Real]:
    """Put designs and values in rows: blocks of shape (3, D) or (3, 1), values of shape (values, M) for M designs."""
    designs = blocks[1].shape[1:]
    pivots, lengths = blocks
    if designs not in (shape, ()):
        pivots, lengths = (build_block(tuple(rows), shape) for rows in blocks)
    rows = np.empty((len(values), *shape))
    for row, value in enumerate(values):
        rows[row] = value
    return pivots.reshape(3, -1), lengths.reshape(3, -1), rows.reshape(len(values), math.prod(shape))


def flatten_shape(shape: Shape) -> tuple[int, int]:
    """Return a shape of results as designs × angles; a scalar is one design at one angle."""
    return math.prod(shape[:-1]), shape[-1] if shape else 1


def build_angle_rows(values: Real, shape: Shape) -> Real:
    """Copy values over designs × angles into a row per design, or one row for all: shape (D, N) or (1, N)."""
    designs, n = flatten_shape(shape)
    # One row of angles serves all designs.
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


def build_rate_rows(speed: Real, acceleration: Real, jerk: Real, shape: Shape) -> Real:
    """Copy input rates into rows per design, or one row for all: shape (3, D, N) or (3, 1, N)."""
    rates = speed, acceleration, jerk
    if speed.ndim == acceleration.ndim == jerk.ndim == 0:
        together = np.empty((3, 1, flatten_shape(shape)[1]))
        together[0], together[1], together[2] = rates
        return together
    rows = [build_angle_rows(rate, shape) for rate in rates]
    together = np.empty((3, 1 if all(len(row) == 1 for row in rows) else flatten_shape(shape)[0], rows[0].shape[-1]))
    for k, row in enumerate(rows):
        together[k] = row
    return together
