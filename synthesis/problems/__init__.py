"""Statements of problems: what a client asks for.

These pydantic models are the API schema, the stored form and the solver's input; nothing repeats them.
Angles are degrees and lengths are numbers in the problem's ``length_unit`` here and in :mod:`synthesis.designs`;
solvers and verification turn them into radians and complex numbers when they take a statement in.

One module a kind; :mod:`synthesis.kinds` joins each to its answers and its solver.
"""

from synthesis.problems.base import (
    ABSURD,
    Contradiction,
    ContradictionError,
    Count,
    Flag,
    Interval,
    NonNegative,
    Number,
    PartialPoint,
    Point,
    PositiveNumber,
    Sizable,
    StatedProblem,
    Statement,
)
from synthesis.problems.cam import CamProblem
from synthesis.problems.dwell import DwellProblem
from synthesis.problems.function import FunctionProblem
from synthesis.problems.gear_train import GearTrainProblem, StockedGear, TeethRange
from synthesis.problems.gearbox import (
    GearboxProblem,
    LayshaftProblem,
)
from synthesis.problems.linkage import Constraints, LengthLimits, LinkageProblem, Region
from synthesis.problems.motion import (
    CouplerVector,
    DriverDyad,
    DyadChoices,
    GroundLine,
    MotionProblem,
    Position,
    Tolerance,
    whole_point,
)
from synthesis.problems.parallel_motion import ParallelMotionProblem
from synthesis.problems.path import CouplerPointLimits, PathConstraints, PathPivots, PathPoint, PathProblem
from synthesis.problems.planetary_train import (
    PlanetaryProblem,
    PlanetaryTeeth,
    ToothRange,
)
from synthesis.problems.quick_return import QuickReturnProblem, RockerPosition
from synthesis.problems.steering import ArmLimits, SteeringProblem
from synthesis.problems.straight_line import StraightLineProblem

__all__ = [
    "ABSURD",
    "ArmLimits",
    "CamProblem",
    "Constraints",
    "Contradiction",
    "ContradictionError",
    "Count",
    "CouplerPointLimits",
    "CouplerVector",
    "DriverDyad",
    "DwellProblem",
    "DyadChoices",
    "Flag",
    "FunctionProblem",
    "GearTrainProblem",
    "GearboxProblem",
    "GroundLine",
    "Interval",
    "LayshaftProblem",
    "LengthLimits",
    "LinkageProblem",
    "MotionProblem",
    "NonNegative",
    "Number",
    "ParallelMotionProblem",
    "PartialPoint",
    "PathConstraints",
    "PathPivots",
    "PathPoint",
    "PathProblem",
    "PlanetaryProblem",
    "PlanetaryTeeth",
    "Point",
    "Position",
    "PositiveNumber",
    "QuickReturnProblem",
    "Region",
    "RockerPosition",
    "Sizable",
    "StatedProblem",
    "Statement",
    "SteeringProblem",
    "StockedGear",
    "StraightLineProblem",
    "TeethRange",
    "Tolerance",
    "ToothRange",
    "whole_point",
]
