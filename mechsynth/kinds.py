"""The kinds of problems as classes: each is the problem model of its kind, with the field ``kind`` set."""

from __future__ import annotations

from typing import Literal

from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.dwell.problem import DwellProblem
from synthesis.kinds.engine.problem import EngineProblem
from synthesis.kinds.flywheel.problem import FlywheelProblem
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.parallel_motion.problem import ParallelMotionProblem
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.quick_return.problem import QuickReturnProblem
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.kinds.straight_line.problem import StraightLineProblem
from synthesis.kinds.train_series.problem import TrainSeriesProblem


class Motion(MotionProblem):
    """Motion generation; the fields are those of the kind ``motion``."""

    kind: Literal["motion"] = "motion"


class Path(PathProblem):
    """Path generation; the fields are those of the kind ``path``."""

    kind: Literal["path"] = "path"


class QuickReturn(QuickReturnProblem):
    """Quick return; the fields are those of the kind ``quick_return``."""

    kind: Literal["quick_return"] = "quick_return"


class StraightLine(StraightLineProblem):
    """Straight line; the fields are those of the kind ``straight_line``."""

    kind: Literal["straight_line"] = "straight_line"


class Steering(SteeringProblem):
    """Steering; the fields are those of the kind ``steering``."""

    kind: Literal["steering"] = "steering"


class Dwell(DwellProblem):
    """Dwell; the fields are those of the kind ``dwell``."""

    kind: Literal["dwell"] = "dwell"


class ParallelMotion(ParallelMotionProblem):
    """Parallel motion; the fields are those of the kind ``parallel_motion``."""

    kind: Literal["parallel_motion"] = "parallel_motion"


class GearTrain(GearTrainProblem):
    """Gear train; the fields are those of the kind ``gear_train``."""

    kind: Literal["gear_train"] = "gear_train"


class PlanetaryTrain(PlanetaryProblem):
    """Planetary train; the fields are those of the kind ``planetary_train``."""

    kind: Literal["planetary_train"] = "planetary_train"


class TrainSeries(TrainSeriesProblem):
    """Trains in series; the fields are those of the kind ``train_series``."""

    kind: Literal["train_series"] = "train_series"


class Gearbox(GearboxProblem):
    """Machine-tool gearbox; the fields are those of the kind ``gearbox``."""

    kind: Literal["gearbox"] = "gearbox"


class LayshaftGearbox(LayshaftProblem):
    """Layshaft gearbox; the fields are those of the kind ``layshaft_gearbox``."""

    kind: Literal["layshaft_gearbox"] = "layshaft_gearbox"


class Function(FunctionProblem):
    """Function generation; the fields are those of the kind ``function``."""

    kind: Literal["function"] = "function"


class Cam(CamProblem):
    """Cam; the fields are those of the kind ``cam``."""

    kind: Literal["cam"] = "cam"


class Balancing(BalancingProblem):
    """Balancing; the fields are those of the kind ``balancing``."""

    kind: Literal["balancing"] = "balancing"


class SpringBalancing(SpringBalancingProblem):
    """Spring balancing; the fields are those of the kind ``spring_balancing``."""

    kind: Literal["spring_balancing"] = "spring_balancing"


class Flywheel(FlywheelProblem):
    """Flywheel; the fields are those of the kind ``flywheel``."""

    kind: Literal["flywheel"] = "flywheel"


class Engine(EngineProblem):
    """Piston engine; the fields are those of the kind ``engine``."""

    kind: Literal["engine"] = "engine"


class Indexing(IndexingProblem):
    """Indexing drive; the fields are those of the kind ``indexing``."""

    kind: Literal["indexing"] = "indexing"


__all__ = [
    "Balancing",
    "Cam",
    "Dwell",
    "Engine",
    "Flywheel",
    "Function",
    "GearTrain",
    "Gearbox",
    "Indexing",
    "LayshaftGearbox",
    "Motion",
    "ParallelMotion",
    "Path",
    "PlanetaryTrain",
    "QuickReturn",
    "SpringBalancing",
    "Steering",
    "StraightLine",
    "TrainSeries",
]
