"""Grashof's condition and Barker's fourteen classes of the pin-jointed fourbar (Norton, Sec. 2.12 and Table 2-4).

With S the shortest and L the longest link, P and Q the others: S + L < P + Q is Grashof (class I), > is non-Grashof
(class II), = is the special case (class III) whose links can all lie in one line, the change points.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Mask, Real
from kinematics.errors import DimensionError
from kinematics.linkage.batch import broadcast_over_designs
from kinematics.linkage.fourbar import circuit_kernels as kernels
from kinematics.linkage.fourbar.circuit_kernels import CHANGE_POINT_TOLERANCE
from kinematics.linkage.fourbar.closed_form import Fourbar, require


class BarkerClass(NamedTuple):
    """One row of Barker's table; ``motion`` names the behaviour of input and output."""

    type: int
    name: str
    code: str
    motion: str


BARKER = (
    BarkerClass(1, "I-1", "GCCC", "double_crank"),
    BarkerClass(2, "I-2", "GCRR", "crank_rocker"),
    BarkerClass(3, "I-3", "GRCR", "double_rocker"),
    BarkerClass(4, "I-4", "GRRC", "rocker_crank"),
    BarkerClass(5, "II-1", "RRR1", "rocker_rocker"),
    BarkerClass(6, "II-2", "RRR2", "rocker_rocker"),
    BarkerClass(7, "II-3", "RRR3", "rocker_rocker"),
    BarkerClass(8, "II-4", "RRR4", "rocker_rocker"),
    BarkerClass(9, "III-1", "SCCC", "change_point"),
    BarkerClass(10, "III-2", "SCRR", "change_point"),
    BarkerClass(11, "III-3", "SRCR", "change_point"),
    BarkerClass(12, "III-4", "SRRC", "change_point"),
    BarkerClass(13, "III-5", "S2X", "change_point"),
    BarkerClass(14, "III-6", "S3X", "change_point"),
)
"""Barker's classes in the order of their type numbers 1 to 14."""


def grashof_excess(lengths: ArrayLike) -> Real:
    """Return S + L − P − Q: negative for Grashof linkages, zero at change points.

    Parameters
    ----------
    lengths : float
        Four link lengths in any order on the last axis.

    Raises
    ------
    DimensionError
        For a last axis that does not hold four lengths, or a length that is not positive and finite.
    """
    lengths = np.asarray(lengths, np.float64)
    if lengths.shape[-1:] != (4,):
        raise DimensionError("lengths", "kinematics-four-on-last-axis", list(lengths.shape))
    require("lengths", "kinematics-positive-and-finite", lengths, np.isfinite(lengths) & (lengths > 0.0))
    s, p, q, longest = np.moveaxis(np.sort(lengths, axis=-1), -1, 0)
    # Differences first: the sums of nearly equal lengths would cancel.
    return np.asarray((longest - q) - (p - s))


def grashof_class(lengths: ArrayLike) -> NDArray[np.int64]:
    """Return class 1 (Grashof), 2 (non-Grashof) or 3 (special case) of four lengths on the last axis (Norton 2.8).

    It raises the same errors as :func:`grashof_excess`.
    """
    lengths = np.asarray(lengths, np.float64)
    excess = grashof_excess(lengths)
    # Relative to the perimeter, so that the class does not depend on the unit.
    special = np.abs(excess) <= CHANGE_POINT_TOLERANCE * lengths.sum(axis=-1)
    return np.where(special, 3, np.where(excess < 0.0, 1, 2))


def barker_type(linkage: Fourbar) -> NDArray[np.int64]:
    """Return Barker's type number 1 to 14 of each design; its row is in :data:`BARKER`.

    A linkage that cannot be assembled (one link longer than the other three together) has no class: type 0.
    """
    types = np.empty(linkage.input.shape, np.int64)
    pivots, lengths, _ = broadcast_over_designs(linkage.blocks, types.shape)
    kernels.classify_barker(pivots, lengths, types.reshape(-1))
    return types


def barker_class(linkage: Fourbar) -> BarkerClass:
    """Return Barker's row of a single design.

    Raises
    ------
    DimensionError
        For a linkage that cannot be assembled, which has no class.
    """
    number = int(barker_type(linkage))
    if number == 0:
        raise DimensionError("lengths", "kinematics-longest-within-sum", _list_lengths(linkage))
    return BARKER[number - 1]


def _list_lengths(linkage: Fourbar) -> list[float]:
    return [float(length) for length in linkage.lengths]


def can_assemble(linkage: Fourbar) -> Mask:
    """Return whether any position exists: no link is longer than the other three together."""
    return np.asarray(2.0 * linkage.lengths.max(axis=-1) <= linkage.lengths.sum(axis=-1))
