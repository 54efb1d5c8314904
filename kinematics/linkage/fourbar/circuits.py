"""Toggles, circuits and branches of the fourbar driven at its input link, and the motion through given input angles.

Glossary (Chase and Mirth, J. Mech. Des. 115 (1993) 223, doi:10.1115/1.2919181; Norton, Sec. 4.13):

circuit  all configurations that can be reached from one another without disassembly;
branch   a part of a circuit between toggles, which the input can drive through;
toggle   a configuration with coupler and output in line, where the input cannot move on.

Let δ be the input angle from the ground line O2 → O4 and f the diagonal, f² = a² + d² − 2 a d cos δ. The linkage
closes for |b − c| ≤ f ≤ b + c; f rises with |δ|, so |δ| runs from a *folded* toggle (f = |b − c|), or 0 without one, to
an *extended* toggle (f = b + c), or π without one. In half-angle form, exact near the ends,

    tan²(δ/2) = (t² − (d − a)²) / ((d + a)² − t²),   t = |b − c| or b + c.

No toggle: the input is a crank, and each assembly is a circuit of one branch. One toggle: a single circuit with the two
assemblies as branches. Both toggles: two circuits, δ > 0 and δ < 0, each with the two assemblies as branches.
A special-case linkage (:mod:`classification`) has its circuits joined at change points, which count as toggles here.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Mask, Real
from kinematics.linkage.batch import broadcast_over_designs
from kinematics.linkage.fourbar import circuit_kernels as kernels
from kinematics.linkage.fourbar.circuit_kernels import FULL_TURN
from kinematics.linkage.fourbar.classification import can_assemble
from kinematics.linkage.fourbar.closed_form import Fourbar, broadcast_shape


class InputLimits(NamedTuple):
    """Range of |δ| in radians, shape designs: from ``lower`` to ``upper``; the masks mark ends that are toggles."""

    lower: Real
    upper: Real
    folded_toggle: Mask
    extended_toggle: Mask


def find_input_limits(linkage: Fourbar) -> InputLimits:
    """Find the limits of the input link from the closed-form toggle angles (Norton 4.37, in half angles).

    NaN for a linkage that cannot be assembled. A change point counts as a toggle at |δ| = 0 or π.
    """
    pivots, lengths = linkage.blocks[0].reshape(3, -1), linkage.blocks[1].reshape(3, -1)
    ends, toggles = np.empty(lengths[:2].shape), np.empty(lengths[:2].shape, np.bool_)
    kernels.find_limits(pivots, lengths, ends, toggles)
    ends, toggles = ends.reshape(2, *linkage.input.shape), toggles.reshape(2, *linkage.input.shape)
    return InputLimits(ends[0, ...], ends[1, ...], toggles[0, ...], toggles[1, ...])


def find_toggle_angles(linkage: Fourbar) -> Real:
    """Find the absolute input angles of all toggles of one design, radians in (−π, π], ascending; none for a crank."""
    limits = find_input_limits(linkage)
    inclinations = [limits.lower] * bool(limits.folded_toggle) + [limits.upper] * bool(limits.extended_toggle)
    # Toggles occur at ±δ, which coincide on the ground line.
    twofold = [(1.0, -1.0) if 0.0 < t < np.pi else (1.0,) for t in inclinations]
    signed = np.array([s * float(t) for t, signs in zip(inclinations, twofold, strict=True) for s in signs])
    # To (−π, π]; np.mod may round to the open end, which is corrected below.
    wrapped = np.pi - np.mod(np.pi - (signed + linkage.ground_angle), FULL_TURN)
    return np.unique(np.where(wrapped <= -np.pi, np.pi, wrapped))


def has_full_rotation(linkage: Fourbar) -> Mask:
    """Return whether the input link is a crank: it rotates fully without a toggle or change point."""
    limits = find_input_limits(linkage)
    return can_assemble(linkage) & ~limits.folded_toggle & ~limits.extended_toggle


def stays_on_branch(linkage: Fourbar, start: ArrayLike, end: ArrayLike) -> Mask:
    """Return whether the input turns from ``start`` to ``end`` without meeting a toggle or a change point.

    Parameters
    ----------
    linkage : Fourbar
        Designs of shape S.
    start, end : float
        Absolute input angles, radians, not reduced by full turns; shape S.

    Raises
    ------
    ShapeError
        For angles that do not broadcast with the designs.
    """
    shape = linkage.input.shape
    start, end = np.asarray(start, np.float64), np.asarray(end, np.float64)
    if not (start.ndim == end.ndim == 0):
        shape = broadcast_shape(designs=shape, start=start.shape, end=end.shape)
    free = np.empty(shape, np.bool_)
    pivots, lengths, (starts, ends) = broadcast_over_designs(linkage.blocks, shape, start, end)
    kernels.check_branch(pivots, lengths, starts, ends, free.reshape(-1))
    return free


def is_same_circuit(
    linkage: Fourbar, angle: ArrayLike, assembly: ArrayLike, other_angle: ArrayLike, other_assembly: ArrayLike
) -> Mask:
    """Return whether two valid configurations (input angle, assembly sign) lie on one circuit; shape S.

    False for a linkage that cannot be assembled. Raises ShapeError for arrays that do not broadcast with the designs.
    """
    angles = {"angle": np.shape(angle), "other_angle": np.shape(other_angle)}
    signs = {"assembly": np.shape(assembly), "other_assembly": np.shape(other_assembly)}
    shape = broadcast_shape(designs=linkage.input.shape, **angles, **signs)
    same = np.empty(shape, np.bool_)
    pivots, lengths, (theta, sign, other, other_sign) = broadcast_over_designs(
        linkage.blocks, shape, angle, assembly, other_angle, other_assembly
    )
    kernels.compare_circuits(pivots, lengths, theta, sign, other, other_sign, same.reshape(-1))
    return same


class Traversal(NamedTuple):
    """The motion of one design through its targets.

    ``angles`` are the targets' input angles, absolute and continuous from the first; ``start`` and ``end`` bound the
    used range, with ``start`` at the first target if they are met in order. ``same_branch``: the input turns over that
    range without a toggle and all targets have one assembly. ``same_circuit``: the linkage reaches all targets without
    disassembly. ``in_order``: the targets are met one after the other with the input turning in one direction or, if
    they lie on both branches of a circuit, going around the circuit in one direction.
    """

    angles: Real
    same_branch: bool
    same_circuit: bool
    in_order: bool
    start: float
    end: float


def traverse(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike) -> Traversal:
    """Determine how one design moves from its first target to the last.

    The direction of the input is the one that meets all targets in order within one turn and without toggles; of two
    such directions the shorter. If there is none, the targets are met out of order, or on both branches, within the
    input's limits around the first target.

    Parameters
    ----------
    linkage : Fourbar
        A single design that can be assembled.
    input_angle : float
        Input angles of the targets, radians, modulo full turns, shape (n,), n ≥ 1.
    assembly : int
        Assembly signs of the targets, shape (n,).
    """
    theta, sign = np.array(input_angle, np.float64), np.array(assembly, np.float64)
    angles = np.empty_like(theta)
    pivots, lengths = linkage.blocks
    found = kernels.traverse(pivots.reshape(3, 1), lengths.reshape(3, 1), theta, sign, angles)
    return Traversal(angles, *found)
