"""What is asked of a gear train: the fields of its problem, and what follows from them.

The problem of the kind adds its name, its examples, and what contradicts itself.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field

from synthesis.kinds.gear_train.stated_stages import StatedStage
from synthesis.model.dimension import INVERSE_LENGTH
from synthesis.model.gear_statement import (
    MOST_TEETH,
    ContactRatio,
    DistanceRange,
    ExactRatio,
    Module,
    Pitch,
    PressureAngle,
    ShiftRange,
    TipThickness,
    ToothNumber,
)
from synthesis.model.gear_strength import CarriedPower
from synthesis.model.ratio_target import Target, decimal, parse_target
from synthesis.model.statement import Count, Flag, PositiveLength, Range, StatedProblem, Statement

FINEST_PITCHES = 10**9
"""Modules are compared as whole multiples of their common measure, at most so many of it."""

ROUNDING = 1e-12
"""Share by which a limit of teeth is lowered before it is rounded up: at 30° it is 8, not the 9 of a rounded sine."""

NEAR = Fraction(1, 100)
"""Relative error up to which trains are of interest where no tolerance is stated: those of the Pareto set, and those
among which the smallest are sought. Of all trains whatever their error the smallest would be no answer to a ratio."""

DEFAULT_MOST_TEETH = 100

USUAL_STAGES = 3
"""Stages of a train at most, where nothing is said of them."""

USUAL_SHIFT = (-0.5, 1.0)
"""Profile shifts, in modules, that a stated centre distance may call for where no limits are stated."""

USUAL_CONTACT_RATIO, USUAL_TIP_THICKNESS = 1.2, 0.25
"""Least contact ratio, and least thickness of the tips in modules, of teeth that are fitted to a distance."""


class TeethRange(Range):
    """Fewest and most teeth of a gear."""

    min: ToothNumber | None = Field(
        default=None, description="Left out: the fewest that no mate can undercut at the pressure angle (18 at 20°)."
    )
    max: ToothNumber = DEFAULT_MOST_TEETH


class StockedGear(Statement):
    """A gear in stock, and how many there are of it."""

    teeth: ToothNumber
    count: Annotated[Count, Field(ge=1, le=100)] = 1


class StatedTrain(StatedProblem):
    """The demands on an ordinary gear train of one to four stages for a speed ratio."""

    ratio: ExactRatio = Field(
        description="Input speed over output speed; negative: they turn in opposite directions. A number is taken as "
        "the decimal that is written; a text is kept exact: 127/50, pi, e, sqrt(2), products and quotients of them."
    )
    direction: Literal["any", "same", "opposite"] = Field(
        default="any",
        description="How input and output turn. With `any` a positive ratio states the size only and no idler is used. "
        "An idler has teeth within the ranges of the other gears, or is one more gear of the stock; of its stage the "
        "two meshes with it keep the demands on meshes, and driver and driven gear the limit of the stage ratio.",
    )
    max_stages: Annotated[Count, Field(ge=1, le=4)] | None = Field(
        default=None, description=f"{USUAL_STAGES} where left out; not beside `stages`."
    )
    stages: list[StatedStage] | None = Field(
        default=None,
        min_length=1,
        max_length=4,
        description="The stages from the input on, each with its type, in place of `max_stages`: a train has all of "
        "them, "
        "in this order, and no idlers. Only trains of parallel shafts have a direction. Where `teeth` has no `min`, "
        "helical gears have the fewest that no rack undercuts in their normal plane.",
    )
    teeth: TeethRange | Annotated[list[TeethRange], Field(min_length=2, max_length=8)] | None = Field(
        default=None,
        description="Range of tooth numbers; or one range for each position: driver and driven gear of stage 1, 2, ... "
        "Gears that a stage states stand as they are; the range of their position has to hold them. "
        f"Left out, without a stock: the fewest that no mate can undercut to {DEFAULT_MOST_TEETH}.",
    )
    stock: list[ToothNumber | StockedGear] | None = Field(
        default=None,
        min_length=1,
        max_length=500,
        description="The gears that there are, in place of `teeth`; a number that stands twice is two gears.",
    )
    max_stage_ratio: Annotated[float, Field(strict=True, ge=1.0, le=1e6)] | None = Field(
        default=None, description="Larger over smaller gear of every stage, at most."
    )
    max_total_teeth: Annotated[Count, Field(ge=6, le=8 * MOST_TEETH)] | None = Field(
        default=None, description="Sum of the teeth of all drivers and driven gears, at most."
    )
    hunting_tooth: Literal["any", "prefer", "require"] = Field(
        default="any",
        description="Whether the teeth of every mesh shall have no common divisor, so that each tooth meets every "
        "other; `prefer` puts such trains first among those of equal error (or equal size and error).",
    )
    reverted: Flag = Field(
        default=False, description="Every stage has the same centre distance, so that output and input can be coaxial."
    )
    module: Module | Annotated[list[Module], Field(min_length=1, max_length=8)] | None = Field(
        default=None,
        description="Module in length units, 1 if left out; a list: for a reverted train what every stage may choose "
        "from, otherwise the modules of stage 1, 2, ...",
    )
    diametral_pitch: Annotated[Pitch, INVERSE_LENGTH] | None = Field(
        default=None, description="Teeth per length unit of pitch diameter, in place of the module."
    )
    modules: list[Module] | None = Field(
        default=None,
        min_length=1,
        max_length=8,
        description="Modules from which every stage may choose, reverted or not, in place of `module`. With this field "
        "or one of the four that follow, the teeth of every mesh are fitted: only meshes count that a profile shift "
        "within its limits makes sound.",
    )
    centre_distance: PositiveLength | DistanceRange | Annotated[list[PositiveLength], Field(max_length=4)] | None = (
        Field(
            default=None,
            description="Of every stage: one distance, or the least and the greatest; or a list of the distances of "
            "stage 1, 2, ... The profile shifts give it without play. Such trains have no idlers.",
        )
    )
    shift: ShiftRange | None = Field(
        default=None,
        description=f"Profile shift of every gear, in modules. Left out: {USUAL_SHIFT[0]} to {USUAL_SHIFT[1]} with a "
        "stated centre distance, none without.",
    )
    min_contact_ratio: ContactRatio | None = Field(
        default=None, description=f"Of every mesh; {USUAL_CONTACT_RATIO} where teeth are fitted."
    )
    min_tip_thickness: TipThickness | None = Field(
        default=None, description=f"Of every gear, in modules; {USUAL_TIP_THICKNESS} where teeth are fitted."
    )
    pressure_angle: PressureAngle = Field(default=20.0, description="Degrees.")
    strength: CarriedPower | None = Field(
        default=None,
        description="What every mesh has to carry, under the torque and at the speed of its stage: each stage has the "
        "least of its modules with which a face of at most `max_face_width` modules does, and the least such face; "
        "trains that do not are not returned. A first estimate.",
    )
    interference: Literal["report", "refuse"] = Field(
        default="report",
        description="Whether meshes in which one gear would dig into the other are only told (with the profile shift "
        "that would save them) or not used at all.",
    )
    tolerance: Annotated[float, Field(strict=True, ge=0.0, lt=1.0)] | None = Field(
        default=None,
        description="Relative error of the ratio, at most. Left out: the nearest trains, whatever their error, for a "
        "ratio within reach.",
    )
    rank_by: Literal["error", "size"] = Field(
        default="error",
        description="`error`: the nearest first, of equally near ones the smallest. `size`: of the trains within the "
        "tolerance, or within 1 % where none is stated, the smallest first.",
    )
    size: Literal["total_teeth", "largest_gear"] = "total_teeth"

    @property
    def target(self) -> Target:
        """Size of the demanded ratio, exact."""
        return parse_target(self.ratio)[1]

    @property
    def demanded_sign(self) -> int:
        """+1: input and output turn alike; −1: opposite; 0: any."""
        if parse_target(self.ratio)[0] < 0:
            return -1
        return {"any": 0, "same": 1, "opposite": -1}[self.direction]

    @property
    def exact_tolerance(self) -> Fraction | None:
        """The tolerance as the decimal that was written; :data:`NEAR` for the smallest trains if none was."""
        if self.tolerance is None:
            return NEAR if self.rank_by == "size" else None
        return decimal(self.tolerance)

    @property
    def fewest_teeth(self) -> int:
        """Fewest teeth that a rack of the pressure angle does not undercut: 2 / sin² φ, rounded up."""
        return math.ceil(2.0 / math.sin(math.radians(self.pressure_angle)) ** 2 * (1.0 - ROUNDING))

    @property
    def ranges(self) -> list[TeethRange]:
        """The ranges of tooth numbers: one for each position, or one for all of them."""
        return self.teeth if isinstance(self.teeth, list) else [self.teeth or TeethRange()]

    @property
    def most_stages(self) -> int:
        """Stages of a train at most; exactly so many where they are stated one by one."""
        if self.stages is not None:
            return len(self.stages)
        return USUAL_STAGES if self.max_stages is None else self.max_stages

    @property
    def are_parallel(self) -> bool:
        """Whether all shafts are parallel."""
        return all(stage.is_parallel for stage in self.stages or [])

    def position_ranges(self) -> list[tuple[int, int]]:
        """Fewest and most teeth of driver and driven gear of each stage up to ``most_stages``."""
        stated = self.ranges if isinstance(self.teeth, list) else self.ranges * (2 * self.most_stages)
        if self.stages is None:
            return [(self.fewest_teeth if r.min is None else r.min, r.max) for r in stated]
        limits = []
        for stage, (one, two) in zip(self.stages, zip(stated[0::2], stated[1::2], strict=True), strict=True):
            fewest = stage.fewest_teeth(self.pressure_angle, ROUNDING)
            usual = [(fewest if r.min is None else r.min, r.max) for r in (one, two)]
            limits += [stage.limits("driver") or usual[0], stage.limits("driven") or usual[1]]
        return limits

    def stocked(self) -> dict[int, int]:
        """How many gears of each tooth number are in stock."""
        counts: dict[int, int] = {}
        for gear in self.stock or []:
            teeth, count = (gear.teeth, gear.count) if isinstance(gear, StockedGear) else (gear, 1)
            counts[teeth] = counts.get(teeth, 0) + count
        return counts

    @property
    def fitting_fields(self) -> list[str]:
        """The fields that are stated of those with which teeth are fitted."""
        names = "modules", "centre_distance", "shift", "min_contact_ratio", "min_tip_thickness"
        return [name for name in names if getattr(self, name) is not None]

    @property
    def is_fitted(self) -> bool:
        """Whether the teeth of every mesh are fitted to a distance, or have to be sound without."""
        return bool(self.fitting_fields)

    @property
    def shift_limits(self) -> tuple[float, float]:
        """Least and greatest profile shift, modules."""
        if self.shift is not None:
            return self.shift.min, self.shift.max
        return USUAL_SHIFT if self.centre_distance is not None else (0.0, 0.0)

    @property
    def least_contact_ratio(self) -> float:
        """The contact ratio that a fitted mesh has at least."""
        return USUAL_CONTACT_RATIO if self.min_contact_ratio is None else self.min_contact_ratio

    @property
    def least_tip_thickness(self) -> float:
        """The thickness that the tips of a fitted mesh have at least, modules."""
        return USUAL_TIP_THICKNESS if self.min_tip_thickness is None else self.min_tip_thickness

    def distance_limits(self, stage: int) -> tuple[float, float]:
        """Least and greatest centre distance of a stage, counted from 0; 0 and infinity where none is stated."""
        stated = self.centre_distance
        if isinstance(stated, DistanceRange):
            return stated.min, stated.max
        if stated is None:
            return 0.0, math.inf
        distance = stated[stage] if isinstance(stated, list) else stated
        return distance, distance

    @property
    def has_own_modules(self) -> bool:
        """Whether the list of modules is one for each stage, not a choice."""
        return isinstance(self.module, list) and not self.reverted

    def modules_of(self, stage: int) -> list[float]:
        """The modules that a stage, counted from 0, may have."""
        listed = [float(module) for module in self.exact_modules()]
        return [listed[stage]] if self.has_own_modules else listed

    @property
    def shares_distance(self) -> bool:
        """Whether fitted stages have to agree on a distance that is not stated as one number."""
        return self.is_fitted and self.reverted and not isinstance(self.centre_distance, float)

    @property
    def searches_distances(self) -> bool:
        """Whether the sums of shifts that suit a pair are searched in steps, not decided: no distance is given.

        At a stated distance, or without shift, a pair has one sum, and whether it suits is decided.
        """
        open_distance = self.centre_distance is None or isinstance(self.centre_distance, DistanceRange)
        return self.is_fitted and open_distance and self.shift_limits != (0.0, 0.0)

    def exact_modules(self) -> list[Fraction]:
        """The stated modules, exact."""
        if self.modules is not None:
            return [decimal(module) for module in self.modules]
        if self.diametral_pitch is not None:
            return [1 / decimal(self.diametral_pitch)]
        stated = [1.0] if self.module is None else self.module if isinstance(self.module, list) else [self.module]
        return [decimal(module) for module in stated]

    def pitches(self) -> list[int]:
        """The modules as the smallest whole numbers that are in proportion to them."""
        modules = self.exact_modules()
        unit = math.lcm(*(module.denominator for module in modules))
        whole = [int(module * unit) for module in modules]
        return [pitch // math.gcd(*whole) for pitch in whole]
