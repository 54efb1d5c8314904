"""Strokes of an output that reciprocates while the input turns: its limit positions, as roots of its rate.

An output that reverses twice in a turn has two strokes. At constant input speed their times are proportional to the
input rotations α and β between the limit positions, α + β = 2π, and the *time ratio* is the longer over the shorter
(Norton, eq. 3.1, inverted so that it is at least 1).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.errors import DimensionError
from kinematics.linkage.planar.drive import drive_one
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.linkage.planar.program import build_program
from kinematics.linkage.planar.roots import find_roots, find_sign_changes

GRID_SIZE = 1440
"""Number of inputs at which reversals are searched, spaced by a quarter of a degree."""


EQUAL_TOLERANCE = 1e-10
"""Radians by which the rotations of equal strokes may differ: rounding."""


class Reversals(NamedTuple):
    """Limit positions of an output over one turn of the input, in the order of the input.

    Attributes
    ----------
    inputs : float, shape (n,)
        Input angles in the turn that begins at the reference, radians.
    outputs : float, shape (n,)
        The output there: angle of a link, radians, or position along a slide.
    full : bool
        Whether the mechanism can be assembled at every sampled input.
    """

    inputs: Real
    outputs: Real
    full: bool


class Strokes(NamedTuple):
    """The two strokes of an output that reverses twice in a turn.

    Attributes
    ----------
    inputs, outputs : float, shape (2,)
        Limit positions: the slow stroke leads from the first to the second while the input turns counter-clockwise;
        ``inputs`` ascend.
    slow, fast : float
        Input rotations of the strokes, radians; together a full turn.
    travel : float
        Distance between the limits: swing, radians, or length of the stroke.
    """

    inputs: Real
    outputs: Real
    slow: float
    fast: float
    travel: float

    @property
    def time_ratio(self) -> float:
        """Time of the slow stroke over that of the fast one, the input at constant speed."""
        return max(self.slow, self.fast) / min(self.slow, self.fast)


def find_reversals(mechanism: Mechanism, output: str) -> Reversals:
    """Find the reversals of an output while the input link turns once, in the reference's assemblies.

    Parameters
    ----------
    mechanism : Mechanism
        One design, driven by a link, that closes by dyads.
    output : str
        A link, or the joint of a slide as :class:`kinematics.linkage.planar.drive.MechanismMotion` names it.

    Raises
    ------
    DimensionError
        For a mechanism driven by a slide.
    """
    if mechanism.has_slide_input:
        raise DimensionError("input", "kinematics-turning-link", mechanism.input)
    program = build_program(mechanism)
    own = program.signs or [1] * len(program.code.rows)
    signs = np.array(own, np.int64).reshape(-1, 1)

    def evaluate_jets(inputs: Real, order: int) -> Real:
        motion = drive_one(mechanism, inputs[None], signs, order)
        jet = motion.angles[output] if output in motion.angles else motion.slides[output]
        return np.asarray(jet[:, 0])

    start = float(mechanism.reference_input)
    grid = start + np.linspace(0.0, 2.0 * np.pi, GRID_SIZE + 1)
    outputs, rate = evaluate_jets(grid, 1)
    # The turn is closed: rounding at its end must not add or hide a reversal at the reference.
    rate[-1] = rate[0]
    full = bool(np.all(np.isfinite(rate)))
    left = find_sign_changes(rate)
    inputs = np.empty(0)
    if len(left):
        inputs = find_roots(lambda at: evaluate_jets(at, 1)[1], grid[left], grid[left + 1], rate[left], rate[left + 1])[
            0
        ]
    turned = evaluate_jets(inputs, 0)[0] if len(left) else inputs
    if output in mechanism.links:
        # Angles are known modulo full turns; the unwrapped grid selects the turn.
        turned = turned + 2.0 * np.pi * np.round((np.unwrap(outputs)[left] - turned) / (2.0 * np.pi))
    return Reversals(inputs, turned, full)


def find_strokes(mechanism: Mechanism, output: str) -> Strokes | None:
    """Find the strokes of an output; None if it does not reverse exactly twice, or the input cannot rotate fully.

    Parameters and errors are those of :func:`find_reversals`.
    """
    inputs, outputs, full = find_reversals(mechanism, output)
    if not full or len(inputs) != 2:
        return None
    between = float(inputs[1] - inputs[0])
    travel = float(abs(outputs[1] - outputs[0]))
    # The slow stroke comes first.
    order = between >= np.pi
    if abs(between - np.pi) <= EQUAL_TOLERANCE:
        # Equal strokes: start with the one that begins nearer to the reference, so that rounding does not decide.
        near = np.abs(np.exp(1j * (inputs - float(mechanism.reference_input))) - 1.0)
        order = bool(near[0] <= near[1])
    if not order:
        inputs, outputs, between = (
            np.array([inputs[1], inputs[0] + 2.0 * np.pi]),
            outputs[::-1].copy(),
            2.0 * np.pi - between,
        )
    return Strokes(inputs, outputs, between, 2.0 * np.pi - between, travel)
