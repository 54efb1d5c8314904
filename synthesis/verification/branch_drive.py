"""A mechanism driven on one of its branches, over inputs that are continuous with the reference."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.planar.branches import Branch, compute_cycle, compute_cycle_on_branch
from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import Mechanism


class MechanismOnBranch:
    """A mechanism on one of its branches, which need not be that of the reference.

    Inputs are radians, or lengths along the input slide.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism; its reference configuration may be on any branch.
    branch : Branch
        The branch on which to drive it. If it has no assembly signs, those of the reference are used.
    """

    def __init__(self, mechanism: Mechanism, branch: Branch) -> None:
        self.mechanism, self.branch = mechanism, branch
        signs = iter(branch.signs)
        # Steps with one solution need no sign. Without any signs the drive uses those of the reference.
        steps = decompose(mechanism).steps if branch.signs else ()
        self._signs = tuple(np.asarray(next(signs) if step.has_two_solutions else 1) for step in steps) or None

    @property
    def range(self) -> tuple[float, float]:
        """First and last input of the branch, around the reference; half a cycle to either side for full turns."""
        # Inputs of a slide are lengths, which do not repeat.
        low, high = self.branch.low, self.branch.high
        if self.mechanism.has_slide_input:
            return low, high
        at, period = float(self.mechanism.reference_input), compute_cycle(self.mechanism)
        if self.branch.full:
            whole = compute_cycle_on_branch(self.mechanism, self.branch)
            # Centre the cycle on the reference, so that the reference is not at an end.
            return at - 0.5 * whole, at + 0.5 * whole
        # The ends of a branch are known up to whole periods: shift them to the period that contains the reference.
        first = low + period * round((at - 0.5 * (low + high)) / period)
        return first, first + high - low

    def evaluate_motion(self, inputs: Real) -> MechanismMotion:
        """Drive the mechanism to inputs of shape (n,)."""
        # Order 0 computes positions only, without velocities and accelerations.
        return drive(self.mechanism, inputs, signs=self._signs, order=0)

    def locate_joint(self, name: str, inputs: Real) -> Complex:
        """Return the positions of a joint at inputs of any shape; NaN where the mechanism cannot be assembled."""
        motion = self.evaluate_motion(inputs.ravel())
        return np.asarray(np.where(motion.valid, motion.joints[name][0], np.nan).reshape(inputs.shape))
