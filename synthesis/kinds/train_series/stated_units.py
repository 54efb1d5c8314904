"""The units of a series: the statements of their kinds, without what the series states for all of them.

The fields are those of the problems of the kinds themselves, so that whatever a train of one of them may be asked, a
unit may be asked too.
"""

from __future__ import annotations

import copy
import math
from fractions import Fraction
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, create_model

from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.model.statement import Contradiction, StatedProblem, Statement

OF_THE_SERIES = {*StatedProblem.model_fields, "ratio", "tolerance", "rank_by", "size", "strength"}
"""Fields of a problem that no unit has: what the series is asked, how its answers are ordered, and a power, as it
reaches a unit through those before it."""

OF_A_POWER = {"planetary_train": {"modules"}}
"""Fields of a kind that no unit of it has, as only a power decides what they leave open."""

USUAL_STAGES = 1
"""Stages of a unit of ordinary gears, where they are not stated: more of them are more units."""

Trains = GearTrainProblem | PlanetaryProblem
"""The problems of which units are made."""

PROBLEMS: dict[str, type[Trains]] = {"planetary_train": PlanetaryProblem, "gear_train": GearTrainProblem}


def _unit(name: str, kind: str, words: str) -> Any:
    """The statement of a unit: the fields of the problem of its kind that are its own."""
    fields: dict[str, Any] = {"type": (Literal[kind], ...)}
    for field, info in PROBLEMS[kind].model_fields.items():
        if field not in OF_THE_SERIES | OF_A_POWER.get(kind, set()):
            info = copy.copy(info)
            if field == "max_stages":
                info.description = f"{USUAL_STAGES} where left out; not beside `stages`."
            fields[field] = (info.annotation, info)
    return create_model(name, __base__=Statement, __module__=__name__, __doc__=words, **fields)


if TYPE_CHECKING:
    Unit = Any
else:
    PlanetaryUnit = _unit(
        "PlanetaryUnit", "planetary_train", "A planetary train of a series, with the demands of its kind."
    )
    GearTrainUnit = _unit(
        "GearTrainUnit",
        "gear_train",
        "An ordinary gear train of a series, with the demands of its kind; of one stage where `max_stages` is left "
        "out. Without a direction it has no idler: its number of stages decides which way it turns.",
    )

    def _tag(statement: Any) -> str | None:
        kind = statement.get("type") if isinstance(statement, dict) else getattr(statement, "type", None)
        return f"<{kind}>" if isinstance(kind, str) and kind in PROBLEMS else None

    Unit = Annotated[
        Annotated[PlanetaryUnit, Tag("<planetary_train>")] | Annotated[GearTrainUnit, Tag("<gear_train>")],
        Discriminator(
            _tag,
            custom_error_type="unknown_unit",
            custom_error_message=f"type must be given and be one of: {', '.join(PROBLEMS)}",
        ),
    ]
    """A unit of a series; the field ``type`` tells of which kind."""

Units = Annotated[list[Unit], Field(min_length=2, max_length=4)]


def problem_of(unit: Any, ratio: Fraction, length_unit: str) -> Any:
    """The problem of a unit's kind for exactly this ratio, a :data:`Trains`; of ordinary gears for its size.

    The direction of ordinary gears is demanded by a field of its own.
    """
    asked = abs(ratio) if unit.type == "gear_train" else ratio
    stated = {field: getattr(unit, field) for field in type(unit).model_fields if field != "type"}
    if unit.type == "gear_train" and unit.stages is None and unit.max_stages is None:
        stated["max_stages"] = USUAL_STAGES
    return PROBLEMS[unit.type].model_validate(
        {**stated, "kind": unit.type, "ratio": str(asked), "tolerance": 0.0, "length_unit": length_unit}
    )


def contradictions_of(unit: Any, length_unit: str) -> list[Contradiction]:
    """What contradicts itself in a unit, by field of it."""
    faults: list[Contradiction] = problem_of(unit, Fraction(1), length_unit).contradictions()
    if unit.type == "gear_train" and unit.hunting_tooth == "prefer":
        detail = "a series has no trains of equal error to choose from in a unit; state any or require"
        faults.append(Contradiction("/hunting_tooth", detail))
    if unit.type == "gear_train":
        faults += [
            Contradiction(f"/stages/{number}/type", f"a series has parallel shafts; a {stage.type} stage has not")
            for number, stage in enumerate(unit.stages or [])
            if not stage.is_parallel
        ]
    return faults


def trains_of(unit: Any, length_unit: str) -> int:
    """About how many trains a consistent unit can be, at most."""
    problem: Trains = problem_of(unit, Fraction(1), length_unit)
    if isinstance(problem, GearTrainProblem):
        return _ordinary_trains(problem)
    total = 0
    for row in problem.arrangements:
        one = len(problem.roles(row))
        for planets in row.planet_sets:
            for gear in row.independent_gears(planets):
                low, high = problem.teeth.limits(gear, row.places[gear].internal)
                one *= max(0, high - low + 1)
        total += one
    return total


def _ordinary_trains(problem: GearTrainProblem) -> int:
    """Choices of drivers times choices of driven gears; of coaxial trains those of the meshes of equal distance."""
    total = 0
    for k in range(1 if problem.stages is None else problem.most_stages, problem.most_stages + 1):
        if problem.stock is not None:
            n = len(problem.stocked())
            widths = [n] * (2 * k)
        else:
            widths = [high - low + 1 for low, high in problem.position_ranges()[: 2 * k]]
        if problem.reverted:
            # Of the meshes of one distance there are as many as tooth numbers, of every module.
            one = widths[0] if problem.stages is None else max(widths)
            total += one ** (k + 1) * len(problem.exact_modules()) ** k if k > 1 else 0
        elif isinstance(problem.teeth, list) or problem.stages is not None:
            total += math.prod(widths)
        else:
            total += math.comb(widths[0] + k - 1, k) ** 2
    return total
