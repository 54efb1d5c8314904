"""A mechanism on one of its branches: driven in that assembly, over inputs continuous with the reference."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.planar.branches import Branch, compute_cycle, compute_cycle_on_branch
from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import Mechanism


class MechanismOnBranch:
    """A mechanism on any of its branches, the reference's or another.

    Inputs are radians, or lengths along the input slide.

    Parameters
    ----------
    mechanism : Mechanism
        With its reference configuration on any branch.
    branch : Branch
        One of its branches; if it has no signs, those of the reference are used.
    """

    def __init__(self, mechanism: Mechanism, branch: Branch) -> None:
        self.mechanism, self.branch = mechanism, branch
        signs = iter(branch.signs)
        # Steps without a second solution use no sign; without signs the drive takes those of the reference.
        steps = decompose(mechanism).steps if branch.signs else ()
        self._signs = tuple(np.asarray(next(signs) if step.has_two_solutions else 1) for step in steps) or None

    @property
    def range(self) -> tuple[float, float]:
        """First and last input around the reference; half a cycle to either side of it for full turns."""
        # A slide's inputs are lengths and do not repeat.
        low, high = self.branch.low, self.branch.high
        if self.mechanism.has_slide_input:
            return low, high
        at, period = float(self.mechanism.reference_input), compute_cycle(self.mechanism)
        if self.branch.full:
            whole = compute_cycle_on_branch(self.mechanism, self.branch)
            # One cycle around the reference, so that it is not at a boundary.
            return at - 0.5 * whole, at + 0.5 * whole
        # Branches are defined up to full turns: shift to the turn that contains the reference.
        first = low + period * round((at - 0.5 * (low + high)) / period)
        return first, first + high - low

    def evaluate_motion(self, inputs: Real) -> MechanismMotion:
        """Drive the mechanism to inputs of shape (n,)."""
        # Positions suffice: order 0 skips velocities and accelerations.
        return drive(self.mechanism, inputs, signs=self._signs, order=0)

    def locate_joint(self, name: str, inputs: Real) -> Complex:
        """Return the positions of a joint at inputs of any shape; NaN without a position."""
        motion = self.evaluate_motion(inputs.ravel())
        return np.asarray(np.where(motion.valid, motion.joints[name][0], np.nan).reshape(inputs.shape))
