"""The linkage of a design for all its files: rebuilt once from its dimensions, and driven over its range."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.planar.branches import Branch
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from service.render import NotBuilt
from synthesis.analyses.linkages.cycle import find_branch, find_cycle_along
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.design_interface import AnyDesign
from synthesis.model.linkage.answer import TargetInput
from synthesis.model.problem import ProblemBase
from synthesis.verification.reconstruction import rebuild_mechanism


class DrivenLinkage:
    """A mechanism and those parts of its motion that drawings need.

    Inputs are in radians, or lengths along the input slide.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism = mechanism

    @classmethod
    def from_design(cls, design: AnyDesign) -> DrivenLinkage:
        """Rebuild the linkage of a design from its dimensions and its skeleton alone.

        Raises
        ------
        NotBuilt
            If the analysis core accepts no such mechanism.
        """
        mechanism = rebuild_mechanism(design.mechanism, from_skeleton=True)
        if mechanism is None:
            raise NotBuilt(design.mechanism.type)
        return cls(mechanism)

    @cached_property
    def branch(self) -> Branch | None:
        """Branch of the reference configuration; None if it is unknown."""
        return find_branch(self.mechanism)

    @cached_property
    def cycle(self) -> tuple[float, float]:
        """First and last input of the cycle."""
        return find_cycle_along(self.mechanism, self.branch)

    @property
    def limits(self) -> tuple[float, float] | None:
        """Inputs at which the linkage locks; None if the input turns fully, or the branch is unknown."""
        return None if self.branch is None or self.branch.full else self.cycle

    @property
    def moving(self) -> list[str]:
        """Joints that are not fixed."""
        return [joint for joint in self.mechanism.joints if joint not in self.mechanism.links[GROUND]]

    def drive_over(self, inputs: Real, order: int = 0) -> MechanismMotion:
        """Return the linkage at inputs, with derivatives by the input up to an order."""
        return drive(self.mechanism, inputs, order=order)

    def trace_path(self, joint: str, first: float, last: float, count: int) -> Complex:
        """Return the path of a joint between two inputs; NaN where the linkage cannot be assembled."""
        return np.asarray(self.drive_over(np.linspace(first, last, count)).joints[joint][0])

    def convert_inputs(self, degrees: Sequence[float] | Real) -> Real:
        """Convert inputs from the units of the answer (degrees, or lengths of an input slide)."""
        stated = np.asarray(degrees, dtype=np.float64)
        return stated if self.mechanism.has_slide_input else np.radians(stated)

    def find_target_inputs(self, design: AnyDesign) -> Real:
        """Return the inputs at the targets of a design; without targets, the input of the reference configuration."""
        targets = getattr(design, "targets", None) or []
        # Kinds name the input of a target differently.
        stated = [target.position if isinstance(target, TargetInput) else target.input_angle for target in targets]
        return self.convert_inputs(stated) if stated else np.atleast_1d(self.mechanism.reference_input)


@dataclass(frozen=True)
class Demand:
    """A target point, and the direction of the body there (radians) if it is required; counted from 0."""

    index: int
    point: complex
    angle: float | None


def list_demands(problem: ProblemBase) -> list[Demand]:
    """Return the targets of point P in a problem, in order; an empty list if there are none."""
    places = getattr(problem, "positions", None) or getattr(problem, "points", None) or []
    angles = [getattr(place, "angle", None) for place in places]
    return [
        Demand(k, place.point, None if angle is None else math.radians(angle))
        for k, (place, angle) in enumerate(zip(places, angles, strict=True))
    ]


def get_target_curve(problem: ProblemBase) -> Complex | None:
    """Return the curve that is required as a whole, closed if it is; None for separate target points."""
    if not (isinstance(problem, PathProblem) and problem.is_matched):
        return None
    points = np.array([place.point for place in problem.points])
    return np.append(points, points[0]) if problem.closed else points


def get_stance_curve(problem: ProblemBase) -> Complex | None:
    """Return the required points of a stance, in order; None without a stance."""
    if not isinstance(problem, PathProblem) or problem.stance is None:
        return None
    stance = problem.stance
    (first, last), points = stance.points, np.array([place.point for place in problem.points])
    # A stance of a closed path may pass its last point.
    return np.concatenate([points[first:], points[: last + 1]]) if stance.wraps_around else points[first : last + 1]
