"""Parts of ordinary trains in series: all stages between two plates, each train driven by the one before."""

from __future__ import annotations

import math
from typing import Any

from service.parts.gears.ordinary import OrdinaryParts, backlash_of
from service.parts.model import Assembly
from service.parts.sizes import NotMade, PartsQuery
from synthesis.kinds.gear_train.design import GearTrainMechanism
from synthesis.kinds.gear_train.verification import driven_train


def series_parts(design: Any, problem: Any, query: PartsQuery) -> Assembly:
    """The parts of a series of ordinary trains.

    Parameters
    ----------
    design : TrainSeriesDesign
    problem : TrainSeriesProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        Where a train is a planetary or a reverted one, or there is no room.
    """
    units = design.mechanism.units
    if not all(isinstance(unit, GearTrainMechanism) for unit in units):
        raise NotMade(
            "Parts are made of series of ordinary trains; this one has a planetary train, whose shafts end where its "
            "carrier and its ring stand. Each of its trains has parts where it is asked for by itself."
        )
    if any(unit.reverted for unit in problem.units):
        raise NotMade(
            "Parts are made of series of trains that are not reverted: stages in a row leave no two shafts in line. A "
            "reverted train has parts where it is asked for by itself."
        )
    if len({unit.pressure_angle for unit in units}) > 1:
        raise NotMade("Parts are made of trains of one pressure angle.")
    stages = [stage for unit in units for stage in driven_train(unit).stages]
    plays = [
        play
        for unit, metrics in zip(units, design.metrics.units, strict=True)
        for play in backlash_of(driven_train(unit).stages, metrics.meshes)
    ]
    widths = [stage.face_width for unit in units for stage in unit.stages]
    angle = math.radians(units[0].pressure_angle)
    return OrdinaryParts(stages, angle, plays, widths, False, problem.length_unit).assembly(query)
