"""Toggles, circuits and branches of the fourbar driven at its input link, and the motion through given input angles.

Glossary (Chase and Mirth, J. Mech. Des. 115 (1993) 223, doi:10.1115/1.2919181; Norton, Sec. 4.13):

circuit  all configurations that can be reached from one another without taking the linkage apart;
branch   a part of a circuit between toggles: what the input can drive through without help;
toggle   a configuration with coupler and output in line, where the input cannot move on.

Let δ be the input angle from the ground line O2 → O4 and f the diagonal, f² = a² + d² − 2 a d cos δ. The linkage
closes for |b − c| ≤ f ≤ b + c; f rises with |δ|, so |δ| runs from a *folded* toggle (f = |b − c|), or from 0 when there
is none, to an *extended* toggle (f = b + c), or to π when there is none. In half-angle form, exact near the ends,

    tan²(δ/2) = (t² − (d − a)²) / ((d + a)² − t²),   t = |b − c| or b + c.

No toggle: the input is a crank, and each assembly is a circuit of one branch. One toggle: a single circuit with the two
assemblies as branches. Both toggles: two circuits, δ > 0 and δ < 0, each with the two assemblies as branches.
A special-case linkage (:mod:`classification`) has its circuits joined at change points, which count as toggles here.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.linkage import circuit_kernels as kernels
from kinematics.linkage.batch import over_designs
from kinematics.linkage.circuit_kernels import FULL_TURN
from kinematics.linkage.classification import can_assemble, grashof_class
from kinematics.linkage.fourbar import Fourbar, Mask, Real, one_shape


class InputLimits(NamedTuple):
    """Range of |δ| in radians, shape designs: from ``lower`` to ``upper``; the masks say which ends are toggles."""

    lower: Real
    upper: Real
    folded_toggle: Mask
    extended_toggle: Mask


def input_limits(linkage: Fourbar) -> InputLimits:
    """Limits of the input link, from the closed-form toggle angles (Norton 4.37, in half angles).

    NaN for a linkage that cannot be assembled. A change point counts as a toggle at |δ| = 0 or π.
    """
    pivots, lengths = linkage.blocks[0].reshape(3, -1), linkage.blocks[1].reshape(3, -1)
    ends, toggles = np.empty(lengths[:2].shape), np.empty(lengths[:2].shape, np.bool_)
    kernels.limits(pivots, lengths, ends, toggles)
    ends, toggles = ends.reshape(2, *linkage.input.shape), toggles.reshape(2, *linkage.input.shape)
    return InputLimits(ends[0, ...], ends[1, ...], toggles[0, ...], toggles[1, ...])


def toggle_angles(linkage: Fourbar) -> Real:
    """Absolute input angles of all toggles of one design, radians in (−π, π], ascending; empty for a crank."""
    limits = input_limits(linkage)
    found = [limits.lower] * bool(limits.folded_toggle) + [limits.upper] * bool(limits.extended_toggle)
    twofold = [(1.0, -1.0) if 0.0 < t < np.pi else (1.0,) for t in found]
    signed = np.array([s * float(t) for t, signs in zip(found, twofold, strict=True) for s in signs])
    wrapped = np.pi - np.mod(np.pi - (signed + linkage.ground_angle), FULL_TURN)
    return np.unique(np.where(wrapped <= -np.pi, np.pi, wrapped))


def full_rotation(linkage: Fourbar) -> Mask:
    """Whether the input link turns through (is a crank) without a toggle or change point."""
    limits = input_limits(linkage)
    return can_assemble(linkage) & ~limits.folded_toggle & ~limits.extended_toggle


class Circuits(NamedTuple):
    """Number of circuits and of branches on each circuit, input driving (Norton, Table 4-1)."""

    circuits: int
    branches: int


def count_circuits(linkage: Fourbar) -> Circuits:
    """Circuits of one design and branches per circuit; a special-case linkage is one circuit of two branches."""
    if not can_assemble(linkage):
        return Circuits(0, 0)
    kind = int(grashof_class(linkage.lengths))
    return Circuits(2 if kind == 1 else 1, 1 if full_rotation(linkage) else 2)


def stays_on_branch(linkage: Fourbar, start: ArrayLike, end: ArrayLike) -> Mask:
    """Whether the input turns from ``start`` to ``end`` without meeting a toggle or a change point.

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
        shape = one_shape(designs=shape, start=start.shape, end=end.shape)
    free = np.empty(shape, np.bool_)
    kernels.stays(*over_designs(linkage.blocks, shape, start, end), free.reshape(-1))
    return free


def same_circuit(
    linkage: Fourbar, angle: ArrayLike, assembly: ArrayLike, other_angle: ArrayLike, other_assembly: ArrayLike
) -> Mask:
    """Whether two configurations (input angle, assembly sign), both of which close, lie on one circuit; shape S.

    False for a linkage that cannot be assembled. Raises ShapeError for arrays that do not broadcast with the designs.
    """
    angles = {"angle": np.shape(angle), "other_angle": np.shape(other_angle)}
    signs = {"assembly": np.shape(assembly), "other_assembly": np.shape(other_assembly)}
    one_shape(designs=linkage.input.shape, **angles, **signs)
    limits = input_limits(linkage)

    def side(theta: ArrayLike) -> Real:
        return np.sign(np.sin(np.asarray(theta, np.float64) - linkage.ground_angle))

    joined = np.asarray(grashof_class(linkage.lengths) == 3)
    crank = ~limits.folded_toggle & ~limits.extended_toggle
    two_sided = limits.folded_toggle & limits.extended_toggle
    same_assembly = np.asarray(assembly) == np.asarray(other_assembly)
    same_side = side(angle) == side(other_angle)
    on_one = joined | np.where(crank, same_assembly, ~two_sided | same_side)
    return np.asarray(can_assemble(linkage) & on_one)


class Traversal(NamedTuple):
    """The motion of one design through its targets.

    ``angles`` are the targets' input angles, absolute and continuous from the first; ``start`` and ``end`` bound the
    range that is used, ``start`` being the first target where they are met in order. ``same_branch`` says that the
    input turns over that range without a toggle and every target has one assembly; ``in_order`` that the targets are
    met one after the other with the input turning one way, or, where they lie on both branches of a circuit, going
    round the circuit one way.
    """

    angles: Real
    same_branch: bool
    in_order: bool
    start: float
    end: float


def traverse(linkage: Fourbar, input_angle: ArrayLike, assembly: ArrayLike) -> Traversal:
    """How one design moves from its first target to the last.

    Of the two directions of the input the one is taken that meets all targets in their order within one turn and free
    of toggles; of two such directions the shorter. When there is none the targets are met out of order, or on both
    branches, within the input's limits around the first target.

    Parameters
    ----------
    linkage : Fourbar
        A single design that can be assembled.
    input_angle : float
        Input angles of the targets, radians, modulo full turns, shape (n,), n ≥ 1.
    assembly : int
        Assembly signs of the targets, shape (n,).
    """
    theta, sign = np.asarray(input_angle, np.float64), np.asarray(assembly)
    first = float(theta[0])
    onward = np.mod(theta - first, FULL_TURN)
    onward[0] = 0.0
    one_assembly = bool(np.all(sign == sign[0])) and bool(can_assemble(linkage))
    if one_assembly:
        backward = np.where(onward > 0.0, onward - FULL_TURN, 0.0)
        ways = [
            turned
            for turned in (onward, backward)
            if _monotone(turned) and bool(stays_on_branch(linkage, first, first + turned[-1]))
        ]
        if ways:
            turned = min(ways, key=lambda way: abs(float(way[-1])))
            return Traversal(first + turned, True, True, first, first + float(turned[-1]))
    limits = input_limits(linkage)
    if not (limits.folded_toggle or limits.extended_toggle):
        turned = _covering(onward)
        return Traversal(first + turned, one_assembly, False, first + float(turned.min()), first + float(turned.max()))
    low, high = _limits_around(linkage, limits, first)
    angles = low + np.mod(theta - low, FULL_TURN)
    angles = np.where(angles - high > low + FULL_TURN - angles, angles - FULL_TURN, angles)
    start, end = float(angles.min()), float(angles.max())
    if one_assembly:
        return Traversal(angles, bool(stays_on_branch(linkage, start, end)), False, start, end)
    round_circuit = np.where(sign == sign[0], angles - low, 2.0 * (high - low) - (angles - low))
    ahead = np.mod(round_circuit - round_circuit[0], 2.0 * (high - low))
    one_way = _monotone(ahead) or _monotone(np.where(ahead > 0.0, ahead - 2.0 * (high - low), 0.0))
    one_circuit = bool(np.all(same_circuit(linkage, first, sign[0], theta, sign)))
    return Traversal(angles, False, one_way and one_circuit, start, end)


def _covering(onward: Real) -> Real:
    """Rotations 0 ≤ ρ < 2π shifted by full turns into the shortest range that covers them and the first."""
    around = np.sort(onward)
    gaps = np.diff(around, append=around[0] + FULL_TURN)
    end = around[int(gaps.argmax())]
    return np.asarray(np.where(onward > end, onward - FULL_TURN, onward))


def _monotone(values: Real) -> bool:
    steps = np.diff(values)
    return bool(np.all(steps > 0.0) or np.all(steps < 0.0))


def _limits_around(linkage: Fourbar, limits: InputLimits, angle: float) -> tuple[float, float]:
    """Ends, absolute radians, of the range of input angles that holds ``angle``, for an input that has toggles."""
    ground, lower, upper = float(linkage.ground_angle), float(limits.lower), float(limits.upper)
    if not limits.folded_toggle:
        return ground - upper, ground + upper
    if not limits.extended_toggle:
        return ground + lower, ground + FULL_TURN - lower
    return (ground + lower, ground + upper) if np.sin(angle - ground) >= 0.0 else (ground - upper, ground - lower)
