"""The units of a series: the problems of their kinds, without the fields that the series gives for all of them.

The fields are those of the problems of the kinds themselves, so that a unit may have every constraint of its kind.
"""

from __future__ import annotations

import copy
import math
from fractions import Fraction
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, create_model

from kinematics.message import compose
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.statement.stages import RequestedStage
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.model.problem import Contradiction, ProblemBase, Statement

SERIES_FIELDS = {*ProblemBase.model_fields, "ratio", "tolerance", "rank_by", "size", "strength"}
"""Fields of a problem that no unit has: the ratio and ranking of the series, and a power, which reaches a unit through
the units before it."""

POWER_FIELDS = {"planetary_train": {"modules", "min_efficiency"}}
"""Fields of a kind that its units lack: only a power decides between modules, and a unit is not judged by its own
efficiency."""

DEFAULT_STAGE_COUNT = 1
"""Default number of stages of a unit of ordinary gears: further stages are further units."""

Trains = GearTrainProblem | PlanetaryProblem
"""The problems that units consist of."""

PROBLEM_TYPES: dict[str, type[Trains]] = {"planetary_train": PlanetaryProblem, "gear_train": GearTrainProblem}


def _create_unit_model(name: str, kind: str, words: str) -> type[Statement]:
    """Create the model of a unit: the fields of its kind's problem without those of the series."""
    fields: dict[str, Any] = {"type": (Literal[kind], ...)}
    for field, info in PROBLEM_TYPES[kind].model_fields.items():
        if field not in SERIES_FIELDS | POWER_FIELDS.get(kind, set()):
            # A shallow copy, so that the description of the kind's own field stays unchanged.
            info = copy.copy(info)
            if field == "max_stages":
                default = DEFAULT_STAGE_COUNT
                info.description = f"Maximum number of stages; default {default}. Not together with `stages`."
            fields[field] = (info.annotation, info)
    return create_model(name, __base__=Statement, __module__=__name__, __doc__=words, **fields)


if TYPE_CHECKING:

    class Unit(Statement):
        """The fields that are read by name, all but ``type`` from units of ordinary gears only."""

        type: Literal["planetary_train", "gear_train"]
        stages: list[RequestedStage] | None
        max_stages: int | None
        hunting_tooth: str
        reverted: bool

else:
    PlanetaryUnit = _create_unit_model(
        "PlanetaryUnit", "planetary_train", "A planetary train of a series, with the constraints of its kind."
    )
    GearTrainUnit = _create_unit_model(
        "GearTrainUnit",
        "gear_train",
        "An ordinary gear train of a series, with the constraints of its kind; by default of one stage. Without a "
        "direction it has no idler: its number of stages determines its direction.",
    )

    def _get_tag(statement: object) -> str | None:
        kind = statement.get("type") if isinstance(statement, dict) else getattr(statement, "type", None)
        return f"<{kind}>" if isinstance(kind, str) and kind in PROBLEM_TYPES else None

    def _require_type(statement: object) -> object:
        # A message of the discriminator would be composed once for all, and its translation could be forgotten.
        if _get_tag(statement) is None:
            raise ValueError(compose("train_series-unknown-type", types=", ".join(PROBLEM_TYPES)))
        return statement

    Unit = Annotated[
        Annotated[PlanetaryUnit, Tag("<planetary_train>")] | Annotated[GearTrainUnit, Tag("<gear_train>")],
        Discriminator(_get_tag),
        BeforeValidator(_require_type),
    ]
    """A unit of a series; the field ``type`` is its kind."""

Units = Annotated[list[Unit], Field(min_length=2, max_length=4)]


def build_unit_problem(unit: Unit, ratio: Fraction, length_unit: str) -> Trains:
    """Build the problem of a unit's kind for exactly this ratio; for ordinary gears its magnitude.

    The direction of ordinary gears is given by a field of its own.
    """
    magnitude = abs(ratio) if unit.type == "gear_train" else ratio
    stated = {field: getattr(unit, field) for field in type(unit).model_fields if field != "type"}
    if unit.type == "gear_train" and unit.stages is None and unit.max_stages is None:
        stated["max_stages"] = DEFAULT_STAGE_COUNT
    return PROBLEM_TYPES[unit.type].model_validate(
        {**stated, "kind": unit.type, "ratio": str(magnitude), "tolerance": 0.0, "length_unit": length_unit}
    )


def find_unit_contradictions(unit: Unit, length_unit: str) -> list[Contradiction]:
    """Return the contradictions of a unit, by its fields."""
    faults = build_unit_problem(unit, Fraction(1), length_unit).find_contradictions()
    if unit.type == "gear_train" and unit.hunting_tooth == "prefer":
        detail = compose("train_series-hunting-teeth-not-preferable")
        faults.append(Contradiction("/hunting_tooth", detail))
    if unit.type == "gear_train":
        faults += [
            Contradiction(f"/stages/{number}/type", compose("train_series-shafts-not-parallel", type=stage.type))
            for number, stage in enumerate(unit.stages or [])
            if not stage.is_parallel
        ]
    return faults


def estimate_train_count(unit: Unit, length_unit: str) -> int:
    """Estimate the maximum number of trains of a consistent unit."""
    problem = build_unit_problem(unit, Fraction(1), length_unit)
    if isinstance(problem, GearTrainProblem):
        return _estimate_ordinary_count(problem)
    total = 0
    for row in problem.arrangements:
        one = len(problem.list_roles(row))
        for planets in row.planet_sets:
            for gear in row.list_independent_gears(planets):
                low, high = problem.compute_tooth_limits(gear, row.places[gear].internal)
                one *= max(0, high - low + 1)
        total += one
    return total


def _estimate_ordinary_count(problem: GearTrainProblem) -> int:
    """Estimate the choices of drivers times those of driven gears; for coaxial trains, meshes of equal distance."""
    total = 0
    for k in range(1 if problem.stages is None else problem.most_stages, problem.most_stages + 1):
        if problem.stock is not None:
            n = len(problem.count_stock())
            widths = [n] * (2 * k)
        else:
            widths = [high - low + 1 for low, high in problem.list_position_ranges()[: 2 * k]]
        if problem.reverted:
            # Each distance has about as many meshes as there are tooth numbers, for every module.
            one = widths[0] if problem.stages is None else max(widths)
            total += one ** (k + 1) * len(problem.list_exact_modules()) ** k if k > 1 else 0
        elif isinstance(problem.teeth, list) or problem.stages is not None:
            total += math.prod(widths)
        else:
            total += math.comb(widths[0] + k - 1, k) ** 2
    return total
