"""Gearboxes of machine tools: spindle speeds in geometric progression."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import ConfigDict, Field, model_validator

from kinematics.gear.gearbox import compute_progression, list_preferred_numbers, series_ratio
from kinematics.message import compose
from synthesis.model.dimension import ROTATIONAL_SPEED
from synthesis.model.gears.request import MAX_TOOTH_SUM, CommonPressureAngle, Module, ToothRange, find_tooth_errors
from synthesis.model.problem import Contradiction, Count, Flag, PositiveNumber, ProblemBase, Sizable, Statement

STRUCTURE_MARGIN = 1e-9
"""Share by which a deviation stays below a quarter of a step: below that limit every gearbox has a structure."""

MAX_SPEED_RANGE = 1e6
"""Highest over lowest speed above which a progression is assumed to be a typing error."""

MAX_SPEEDS = 36
"""Maximum number of spindle speeds."""

MAX_PAIRS = 16_000
"""Maximum number of gear pairs for a stage. The search of a stage grows with their number, that of all stages with
its square at worst: three stages at this limit take some seconds for each structure, five about ten."""

STANDARD_TOLERANCE = 0.1
"""Permitted deviation of machine tool speeds: 10 (φ − 1) %, a tenth of a step (Acherkan, vol. 3)."""


class SpindleSpeeds(Statement):
    """Speeds in geometric progression: the lowest, their number, and one of highest, ratio of neighbours, or series."""

    min: Annotated[PositiveNumber, ROTATIONAL_SPEED] = Field(description="Lowest speed, revolutions per minute.")
    count: Annotated[Count, Field(ge=2, le=MAX_SPEEDS)]
    max: Annotated[PositiveNumber, ROTATIONAL_SPEED] | None = Field(default=None, description="Highest speed.")
    ratio: Annotated[float, Field(strict=True, gt=1.0, le=10.0)] | None = Field(
        default=None, description="Ratio φ of each speed to the one below it."
    )
    series: Literal["R5", "R10", "R20", "R40"] | None = Field(default=None, description="Preferred numbers of ISO 3.")
    step: Annotated[Count, Field(ge=1, le=40)] = Field(default=1, description="Use every n-th preferred number.")

    @model_validator(mode="after")
    def _validate_progression(self) -> Self:
        if sum(stated is not None for stated in (self.max, self.ratio, self.series)) != 1:
            raise ValueError(compose("gearbox-one-of-max-ratio-series"))
        if self.max is not None and self.max <= self.min:
            raise ValueError(compose("gearbox-max-not-above-min"))
        if self.series is not None and list_preferred_numbers(self.series, self.min, self.count, self.step) is None:
            raise ValueError(compose("gearbox-min-outside-series", series=self.series))
        return self

    @property
    def progression_ratio(self) -> float:
        """Progression ratio φ."""
        if self.max is not None:
            return compute_progression(self.min, self.max, self.count)[0]
        return self.ratio or series_ratio(self.series or "R40", self.step)

    @property
    def nominal(self) -> list[float]:
        """The speeds, exactly in progression."""
        return [self.min * self.progression_ratio**k for k in range(self.count)]


class StageRatio(Statement):
    """Minimum and maximum driven speed over driving speed of a pair; 1/4 to 2 is usual in machine tools."""

    min: Annotated[float, Field(strict=True, gt=0.0, le=1e3), Sizable] = 0.25
    max: Annotated[float, Field(strict=True, gt=0.0, le=1e3), Sizable] = 2.0

    @model_validator(mode="after")
    def _validate_order(self) -> Self:
        if self.min >= self.max:
            raise ValueError(compose("gearbox-min-not-below-max"))
        return self


class GearboxProblem(ProblemBase):
    """Machine-tool gearbox: tooth numbers for spindle speeds in geometric progression.

    All structural formulas, orders and tooth numbers within the limits are covered; the answer is proven to have the
    smallest maximum deviation for its size.
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
        description="Speed of the first shaft, revolutions per minute."
    )
    speeds: SpindleSpeeds
    structure: list[Annotated[Count, Field(ge=1, le=6)]] | None = Field(
        default=None,
        min_length=1,
        max_length=5,
        description="Number of pairs of each stage in the order of the shafts, e.g. [3, 2]; 1 is a fixed stage. "
        "Default: all are tried.",
    )
    max_pairs: Annotated[Count, Field(ge=2, le=4)] = Field(
        default=3, description="Maximum number of pairs in one stage."
    )
    fixed_stage: Flag = Field(default=False, description="Add a stage of one pair before the others.")
    teeth: ToothRange = ToothRange(min=18, max=96)
    tooth_sum: ToothRange = Field(
        default=ToothRange(min=60, max=120), description="Tooth sum of the two gears of a pair."
    )
    stage_ratio: StageRatio = StageRatio()
    cluster_difference: Annotated[Count, Field(ge=0, le=20)] = Field(
        default=0,
        description="Minimum difference between the largest and the next driver of a stage of three or more pairs; "
        "4 lets a sliding cluster pass.",
    )
    tolerance: Annotated[float, Field(strict=True, gt=0.0, lt=0.5)] | None = Field(
        default=None,
        description="Maximum |ln(speed/nominal)|, below half of ln φ. Default: a tenth of a step, 0.1 (φ − 1), "
        "or a quarter of ln φ if that is less.",
    )
    module: Module = Field(default=1.0, description="Module of all gears, in the length unit.")
    pressure_angle: CommonPressureAngle = Field(default=20.0, description="Pressure angle, degrees.")
    rank_by: Literal["error", "size"] = Field(
        default="error", description="error: smallest deviation first. size: smallest sum of tooth sums first."
    )

    @property
    def widest(self) -> float:
        """Maximum tolerated |ln(speed/nominal)|."""
        if self.tolerance is not None:
            return self.tolerance
        return min(STANDARD_TOLERANCE * (self.speeds.progression_ratio - 1.0), self.structure_tolerance)

    @property
    def structure_tolerance(self) -> float:
        """Maximum |ln(speed/nominal)|, just below a quarter of ln φ, up to which every gearbox has a structure.

        Let the pairs of two stages add up to logarithms that lie within E of whole steps. The steps from one pair to
        another then differ by at most 4 E over the other engaged pairs, and as they are integers they are equal if 4 E
        is below a step: every pair has a number of steps of its own.
        """
        return 0.25 * math.log(self.speeds.progression_ratio) * (1.0 - STRUCTURE_MARGIN)

    def find_contradictions(self) -> list[Contradiction]:
        """Return reversed or too wide limits, a structure with another number of speeds, and too wide progressions."""
        contradictions = []
        # Beyond half a step speeds and nominal values can no longer be assigned.
        half = 0.5 * math.log(self.speeds.progression_ratio)
        if self.widest >= half:
            detail = compose("gearbox-tolerance-exceeds-half-step", half=f"{half:.4g}")
            contradictions.append(Contradiction("/tolerance", detail))
        contradictions += find_tooth_errors(self.teeth, self.tooth_sum)
        if self.structure is not None and math.prod(self.structure) != self.speeds.count:
            detail = compose("gearbox-structure-count-wrong", count=math.prod(self.structure), stated=self.speeds.count)
            contradictions.append(Contradiction("/structure", detail))
        if self.structure is not None and self.structure.count(1) > 1:
            # Every ratio of one fixed stage is combined with every ratio of the other, which takes too much memory.
            contradictions.append(Contradiction("/structure", compose("gearbox-several-fixed-stages")))
        if self.structure is not None and self.fixed_stage:
            contradictions.append(Contradiction("/fixed_stage", compose("gearbox-fixed-stage-and-structure")))
        if self.speeds.progression_ratio ** (self.speeds.count - 1) > MAX_SPEED_RANGE:
            contradictions.append(Contradiction("/speeds", compose("gearbox-speed-range-too-wide")))
        if self.tooth_sum.max > MAX_TOOTH_SUM:
            contradictions.append(
                Contradiction("/tooth_sum/max", compose("gearbox-tooth-sum-too-large", limit=MAX_TOOTH_SUM))
            )
        elif (pairs := self.pairs_of_a_stage) > MAX_PAIRS:
            detail = compose("gearbox-too-many-pairs", count=pairs, limit=MAX_PAIRS)
            contradictions.append(Contradiction("/tooth_sum/max", detail))
        return contradictions

    @property
    def pairs_of_a_stage(self) -> int:
        """Number of gear pairs within teeth, tooth sum and stage ratio, including interfering ones."""
        slow, fast = (ratio / (1.0 + ratio) for ratio in (self.stage_ratio.min, self.stage_ratio.max))
        low, high = self.teeth.min, self.teeth.max
        pairs = 0
        for total in range(self.tooth_sum.min, self.tooth_sum.max + 1):
            least, most = math.ceil(total * slow), math.floor(total * fast)
            pairs += max(0, min(high, total - low, most) - max(low, total - high, least) + 1)
        return pairs
