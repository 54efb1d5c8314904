"""The linkage of a design for all its files: rebuilt once from its dimensions, and driven over its range."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.branches import Branch
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from service.render import NotBuilt
from service.render.page.svg import Points
from synthesis.analyses.cycle import branch_of, cycle_along
from synthesis.model.linkage_answer import DrivenTo
from synthesis.proof.rebuilt import rebuilt

Real = NDArray[np.float64]


class DrivenLinkage:
    """A mechanism and those parts of its motion that drawings need.

    Inputs are in radians, or lengths along the input slide.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism = mechanism

    @classmethod
    def of(cls, design: Any) -> DrivenLinkage:
        """Rebuild the linkage of a design from its dimensions and its skeleton alone.

        Raises
        ------
        NotBuilt
            The analysis core accepts no such mechanism.
        """
        mechanism = rebuilt(design.mechanism, from_skeleton=True)
        if mechanism is None:
            raise NotBuilt(design.mechanism.type)
        return cls(mechanism)

    @cached_property
    def branch(self) -> Branch | None:
        """Branch of the reference configuration; None if it is unknown."""
        return branch_of(self.mechanism)

    @cached_property
    def cycle(self) -> tuple[float, float]:
        """First and last input of the cycle."""
        return cycle_along(self.mechanism, self.branch)

    @property
    def limits(self) -> tuple[float, float] | None:
        """Inputs at which the linkage locks; None if the input turns fully, or the branch is unknown."""
        return None if self.branch is None or self.branch.full else self.cycle

    @property
    def moving(self) -> list[str]:
        """Joints that are not fixed."""
        return [joint for joint in self.mechanism.joints if joint not in self.mechanism.links[GROUND]]

    def driven(self, inputs: Real, order: int = 0) -> MechanismMotion:
        """Return the linkage at inputs, with derivatives by the input up to an order."""
        return drive(self.mechanism, inputs, order=order)

    def path(self, joint: str, first: float, last: float, count: int) -> Points:
        """Return the path of a joint between two inputs; NaN where the linkage cannot be assembled."""
        return np.asarray(self.driven(np.linspace(first, last, count)).joints[joint][0])

    def inputs(self, degrees: Any) -> Real:
        """Convert inputs from the units of the answer (degrees, or lengths of an input slide)."""
        stated = np.asarray(degrees, dtype=np.float64)
        return stated if self.mechanism.driven_by_slide else np.radians(stated)

    def targets(self, design: Any) -> Real:
        """Return the inputs at the targets of a design; without targets, the input of the reference configuration."""
        targets = getattr(design, "targets", None) or []
        # Kinds name the input of a target differently.
        stated = [target.at if isinstance(target, DrivenTo) else target.input_angle for target in targets]
        return self.inputs(stated) if stated else np.atleast_1d(self.mechanism.reference_input)


@dataclass(frozen=True)
class Demand:
    """A target point, and the direction of the body there (radians) if it is required; counted from 0."""

    index: int
    point: complex
    angle: float | None


def demands_of(problem: Any) -> list[Demand]:
    """Return the targets of point P in a problem, in order; an empty list if there are none."""
    places = getattr(problem, "positions", None) or getattr(problem, "points", None) or []
    angles = [getattr(place, "angle", None) for place in places]
    return [
        Demand(k, place.point, None if angle is None else math.radians(angle))
        for k, (place, angle) in enumerate(zip(places, angles, strict=True))
    ]


def target_curve(problem: Any) -> Points | None:
    """Return the curve that is required as a whole, closed if it is; None for separate target points."""
    if not getattr(problem, "matched", False):
        return None
    points = np.array([place.point for place in problem.points])
    return np.append(points, points[0]) if problem.closed else points


def stance_curve(problem: Any) -> Points | None:
    """Return the required points of a stance, in order; None without a stance."""
    stance = getattr(problem, "stance", None)
    if stance is None:
        return None
    (first, last), points = stance.points, np.array([place.point for place in problem.points])
    # A stance of a closed path may pass its last point.
    return np.concatenate([points[first:], points[: last + 1]]) if stance.around else points[first : last + 1]
