"""Mechanisms designed from Python: ``from mechsynth import solve, Motion, Position``.

This package contains only names and the few classes needed at a Python prompt. The work is done by :mod:`synthesis`,
:mod:`kinematics` and the parts of :mod:`service` that need no server. See docs/start/library.md for examples.
"""

from mechsynth.answers import Design, Result
from mechsynth.cycle import Cycle
from mechsynth.kinds import (
    Balancing,
    Cam,
    Dwell,
    Engine,
    Flywheel,
    Function,
    Gearbox,
    GearTrain,
    Indexing,
    LayshaftGearbox,
    Motion,
    ParallelMotion,
    Path,
    PlanetaryTrain,
    QuickReturn,
    SpringBalancing,
    Steering,
    StraightLine,
    TrainSeries,
)
from mechsynth.parts import Constraints, Pair, PathPoint, Position, RockerPosition, Tolerance
from mechsynth.solving import AsyncClient, Cancelled, Client, solve
from mechsynth.statements import InvalidProblem
from service.client import ClientError, JobFailed, Refused, Unreachable
from service.render import NoSuchExport, NotBuilt

__all__ = [
    "AsyncClient",
    "Balancing",
    "Cam",
    "Cancelled",
    "Client",
    "ClientError",
    "Constraints",
    "Cycle",
    "Design",
    "Dwell",
    "Engine",
    "Flywheel",
    "Function",
    "GearTrain",
    "Gearbox",
    "Indexing",
    "InvalidProblem",
    "JobFailed",
    "LayshaftGearbox",
    "Motion",
    "NoSuchExport",
    "NotBuilt",
    "Pair",
    "ParallelMotion",
    "Path",
    "PathPoint",
    "PlanetaryTrain",
    "Position",
    "QuickReturn",
    "Refused",
    "Result",
    "RockerPosition",
    "SpringBalancing",
    "Steering",
    "StraightLine",
    "Tolerance",
    "TrainSeries",
    "Unreachable",
    "solve",
]
