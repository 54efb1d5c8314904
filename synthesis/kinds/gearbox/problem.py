"""Gearboxes of machine tools: spindle speeds in geometric progression."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import ConfigDict, Field, model_validator

from kinematics.gear.gearbox import preferred_numbers, preferred_ratio, progression
from synthesis.model.dimension import ROTATIONAL_SPEED
from synthesis.model.gear_statement import MOST_TOOTH_SUM, CommonPressureAngle, Module, ToothRange, tooth_faults
from synthesis.model.statement import Contradiction, Count, Flag, PositiveNumber, Sizable, StatedProblem, Statement

STRICTLY = 1e-9
"""Share by which a deviation stays below a quarter of a step, up to which alone every gearbox has a structure."""

MAX_SPEED_RANGE = 1e6
"""Highest over lowest speed, beyond which a progression is a typing error."""

MAX_SPEEDS = 36

MAX_PAIRS = 16_000
"""Pairs of gears that a stage may be made of. The search of a stage rises with their number, that of all stages with
its square at worst: three stages of so many take some seconds for each structure, five some ten."""

STANDARD_TOLERANCE = 0.1
"""Speeds of machine tools may be off by 10 (φ − 1) %, a tenth of a step (Acherkan, Machine Tool Design, vol. 3)."""


class SpindleSpeeds(Statement):
    """Speeds in geometric progression: the lowest, how many, and one of highest, ratio of neighbours, or series."""

    min: Annotated[PositiveNumber, ROTATIONAL_SPEED] = Field(description="Lowest speed, revolutions a minute.")
    count: Annotated[Count, Field(ge=2, le=MAX_SPEEDS)]
    max: Annotated[PositiveNumber, ROTATIONAL_SPEED] | None = Field(default=None, description="Highest speed.")
    ratio: Annotated[float, Field(strict=True, gt=1.0, le=10.0)] | None = Field(
        default=None, description="Each speed over the one below it, φ."
    )
    series: Literal["R5", "R10", "R20", "R40"] | None = Field(default=None, description="Preferred numbers of ISO 3.")
    step: Annotated[Count, Field(ge=1, le=40)] = Field(default=1, description="Take every so many-th preferred number.")

    @model_validator(mode="after")
    def _one_progression(self) -> Self:
        if sum(stated is not None for stated in (self.max, self.ratio, self.series)) != 1:
            raise ValueError("give exactly one of max, ratio and series")
        if self.max is not None and self.max <= self.min:
            raise ValueError("max must be above min")
        if self.series is not None and preferred_numbers(self.series, self.min, self.count, self.step) is None:
            raise ValueError(f"min must be a number of the series {self.series}")
        return self

    @property
    def progression_ratio(self) -> float:
        """φ."""
        if self.max is not None:
            return progression(self.min, self.max, self.count)[0]
        return self.ratio or preferred_ratio(self.series or "R40", self.step)

    @property
    def nominal(self) -> list[float]:
        """The speeds, exactly in progression."""
        return [self.min * self.progression_ratio**k for k in range(self.count)]


class StageRatio(Statement):
    """Least and greatest driven speed over driving speed of a pair; 1/4 to 2 is usual in machine tools."""

    min: Annotated[float, Field(strict=True, gt=0.0, le=1e3), Sizable] = 0.25
    max: Annotated[float, Field(strict=True, gt=0.0, le=1e3), Sizable] = 2.0

    @model_validator(mode="after")
    def _min_below_max(self) -> Self:
        if self.min >= self.max:
            raise ValueError("min must be below max")
        return self


class GearboxProblem(StatedProblem):
    """Machine-tool gearbox: tooth numbers for spindle speeds in geometric progression.

    All structural formulas, orders and tooth numbers within the limits are covered; the answer is proven to have the
    least largest deviation for its size.
    """

    model_config = ConfigDict(
        title="Machine-tool gearbox",
        json_schema_extra={
            "examples": [
                {
                    "kind": "gearbox",
                    "input_speed": 200.0,
                    "speeds": {"min": 25.0, "max": 800.0, "count": 6},
                    "stage_ratio": {"min": 0.25, "max": 2.0},
                    "tooth_sum": {"min": 80, "max": 120},
                    "max_designs": 5,
                }
            ]
        },
    )

    kind: Literal["gearbox"]
    input_speed: Annotated[PositiveNumber, ROTATIONAL_SPEED] = Field(
        description="Speed of the first shaft, revolutions a minute."
    )
    speeds: SpindleSpeeds
    structure: list[Annotated[Count, Field(ge=1, le=6)]] | None = Field(
        default=None,
        min_length=1,
        max_length=5,
        description="Pairs of each stage in the order of the shafts, e.g. [3, 2]; 1 is a fixed stage. Null tries all.",
    )
    max_pairs: Annotated[Count, Field(ge=2, le=4)] = Field(default=3, description="Most pairs in one stage.")
    fixed_stage: Flag = Field(default=False, description="Add a stage of one pair before the others.")
    teeth: ToothRange = ToothRange(min=18, max=96)
    tooth_sum: ToothRange = Field(default=ToothRange(min=60, max=120), description="Of the two gears of a pair.")
    stage_ratio: StageRatio = StageRatio()
    cluster_difference: Annotated[Count, Field(ge=0, le=20)] = Field(
        default=0,
        description="Least difference between the largest and the next driver of a stage of three or more pairs; "
        "4 lets a sliding cluster pass.",
    )
    tolerance: Annotated[float, Field(strict=True, gt=0.0, lt=0.5)] | None = Field(
        default=None,
        description="Largest |ln(speed/nominal)|, below half of ln φ. Left open: a tenth of a step, 0.1 (φ − 1), "
        "or a quarter of ln φ where that is less.",
    )
    module: Module = Field(default=1.0, description="Of all gears, in the length unit.")
    pressure_angle: CommonPressureAngle = Field(default=20.0, description="Degrees.")
    rank_by: Literal["error", "size"] = Field(
        default="error", description="error: least deviation first. size: least sum of tooth sums first."
    )

    @property
    def widest(self) -> float:
        """Largest |ln(speed/nominal)| that is tolerated."""
        if self.tolerance is not None:
            return self.tolerance
        return min(STANDARD_TOLERANCE * (self.speeds.progression_ratio - 1.0), self.structured)

    @property
    def structured(self) -> float:
        """Largest |ln(speed/nominal)|, just below a quarter of ln φ, with which every gearbox has a structure.

        Let the pairs of two stages add up to logarithms that lie within E of whole steps. The steps from one pair to
        another then differ by 4 E at most over what else is engaged, and as they are whole they are equal where 4 E is
        below a step: every pair has a number of steps of its own.
        """
        return 0.25 * math.log(self.speeds.progression_ratio) * (1.0 - STRICTLY)

    def contradictions(self) -> list[Contradiction]:
        """Limits the wrong way round or too wide, a structure with another number of speeds, a progression too wide."""
        contradictions = []
        half = 0.5 * math.log(self.speeds.progression_ratio)
        if self.widest >= half:
            detail = f"must be below half a step, {half:.4g}, beyond which a speed is nearer to another nominal one"
            contradictions.append(Contradiction("/tolerance", detail))
        contradictions += tooth_faults(self.teeth, self.tooth_sum)
        if self.structure is not None and math.prod(self.structure) != self.speeds.count:
            detail = f"gives {math.prod(self.structure)} speeds, but speeds.count is {self.speeds.count}"
            contradictions.append(Contradiction("/structure", detail))
        if self.structure is not None and self.structure.count(1) > 1:
            # Every ratio of one fixed stage goes with every ratio of the other: minutes, and more than the memory.
            contradictions.append(Contradiction("/structure", "at most one fixed stage; join the others to it"))
        if self.structure is not None and self.fixed_stage:
            contradictions.append(Contradiction("/fixed_stage", "write a fixed stage as 1 in structure"))
        if self.speeds.progression_ratio ** (self.speeds.count - 1) > MAX_SPEED_RANGE:
            contradictions.append(Contradiction("/speeds", "the highest speed is more than a million times the lowest"))
        if self.tooth_sum.max > MOST_TOOTH_SUM:
            contradictions.append(Contradiction("/tooth_sum/max", f"at most {MOST_TOOTH_SUM}"))
        elif (pairs := self.pairs_of_a_stage) > MAX_PAIRS:
            detail = f"leaves {pairs} pairs of gears for a stage, of which at most {MAX_PAIRS} are searched; "
            contradictions.append(Contradiction("/tooth_sum/max", detail + "narrow tooth_sum, teeth or stage_ratio"))
        return contradictions

    @property
    def pairs_of_a_stage(self) -> int:
        """Pairs of gears that teeth, tooth sum and stage ratio allow, whether they interfere or not."""
        slow, fast = (ratio / (1.0 + ratio) for ratio in (self.stage_ratio.min, self.stage_ratio.max))
        low, high = self.teeth.min, self.teeth.max
        pairs = 0
        for total in range(self.tooth_sum.min, self.tooth_sum.max + 1):
            least, most = math.ceil(total * slow), math.floor(total * fast)
            pairs += max(0, min(high, total - low, most) - max(low, total - high, least) + 1)
        return pairs
