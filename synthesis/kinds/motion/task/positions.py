"""Numerical form of the task: positions and rotations of the body.

Solvers work in *task coordinates*: the origin is P in the first position and the unit is the task's size. Tolerances
are therefore relative to the problem.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices, to_complete_point
from synthesis.model.problem import PartialPoint


class MotionTask(NamedTuple):
    """Positions of the body.

    Attributes
    ----------
    points : complex, shape (n,)
        The body's point P in each position; in task coordinates ``points[0]`` is 0.
    turns : complex, shape (n,)
        Rotation e^{iα} of the body from the first position to each; ``turns[0]`` is 1.
    origin, size : complex, float
        P in the first position and the size of the task, in the problem's coordinates and length unit.
    """

    points: Complex
    turns: Complex
    origin: complex
    size: float

    def images(self, points: Complex) -> Complex:
        """Return the images of body points, given in the first position, in each position: shape (..., n)."""
        images: Complex = self.points + self.turns * (np.asarray(points)[..., None] - self.points[0])
        return images

    def to_task(self, z: complex) -> complex:
        """Convert a point from the problem's coordinates to task coordinates."""
        return (z - self.origin) / self.size

    def to_problem(self, z: complex) -> complex:
        """Convert a point from task coordinates to the problem's."""
        return self.origin + z * self.size

    def pivot(self, requested: PartialPoint | None, computed: complex) -> complex:
        """Return a pivot in the problem's coordinates: the given value, to the last digit, or the computed one."""
        whole = to_complete_point(requested)
        # A given pivot must not pick up rounding errors from the conversion.
        return self.to_problem(computed) if whole is None else whole


def find_given_pivot(task: MotionTask, choices: DyadChoices, *, fixed: bool) -> complex | None:
    """Return the given fixed or moving pivot in task coordinates; None if it is open.

    A coupler vector of given length and angle fixes the moving pivot too.
    """
    whole = to_complete_point(choices.fixed_pivot if fixed else choices.moving_pivot)
    vector = choices.coupler_vector
    # A complete coupler vector is another way to give the moving pivot.
    if not fixed and vector is not None and vector.length is not None and vector.angle is not None:
        return complex(task.points[0] - cmath.rect(vector.length / task.size, math.radians(vector.angle)))
    return None if whole is None else task.to_task(whole)


def make_motion_task(problem: MotionProblem) -> MotionTask:
    """Return the problem's positions in task coordinates."""
    points = np.array([p.point for p in problem.positions])
    size = problem.task_size
    turns = np.exp(1j * np.array(problem.turns))
    return MotionTask((points - points[0]) / size, turns, complex(points[0]), size)


def compute_needed_motion(task: MotionTask) -> Real:
    """Return P's path length (task sizes) and the body's rotation (radians) that the target positions need."""
    turns = task.turns[1:] / task.turns[:-1]
    return np.array([np.abs(np.diff(task.points)).sum(), np.abs(np.angle(turns)).sum()])
