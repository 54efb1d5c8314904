"""Parts of ordinary trains in series: all stages between two plates, each train driven by the previous one."""

from __future__ import annotations

import math

from kinematics.message import compose
from service.parts.assembly.model import Assembly
from service.parts.assembly.sizes import NotMade, PartsQuery
from service.parts.gears.ordinary import OrdinaryParts, find_backlash
from synthesis.kinds.gear_train.design import GearTrainMechanism, GearTrainMetrics
from synthesis.kinds.gear_train.verification import build_train
from synthesis.kinds.train_series.design import TrainSeriesDesign
from synthesis.kinds.train_series.problem import TrainSeriesProblem


def make_series_parts(design: TrainSeriesDesign, problem: TrainSeriesProblem, query: PartsQuery) -> Assembly:
    """Make the parts of a series of ordinary trains.

    Parameters
    ----------
    design : TrainSeriesDesign
    problem : TrainSeriesProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If a train is planetary or reverted, or the parts do not fit.
    """
    units = [unit for unit in design.mechanism.units if isinstance(unit, GearTrainMechanism)]
    if len(units) < len(design.mechanism.units):
        raise NotMade(compose("parts-series-with-planetary"))
    if any(unit.reverted for unit in problem.units):
        raise NotMade(compose("parts-series-with-reverted"))
    if len({unit.pressure_angle for unit in units}) > 1:
        raise NotMade(compose("parts-series-pressure-angles"))
    stages = [stage for unit in units for stage in build_train(unit).stages]
    measured = [metrics for metrics in design.metrics.units if isinstance(metrics, GearTrainMetrics)]
    plays = [
        play
        for unit, metrics in zip(units, measured, strict=True)
        for play in find_backlash(build_train(unit).stages, metrics.meshes)
    ]
    widths = [stage.face_width for unit in units for stage in unit.stages]
    angle = math.radians(units[0].pressure_angle)
    return OrdinaryParts(stages, angle, plays, widths, False, problem.length_unit).build_assembly(query)
