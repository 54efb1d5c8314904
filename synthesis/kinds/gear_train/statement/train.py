"""Requirements on a gear train: the fields of its problem, and the values that follow from them.

The problem of the kind adds its name, its examples, and its contradictions.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field

from synthesis.kinds.gear_train.statement.stages import RequestedStage
from synthesis.model.dimension import INVERSE_LENGTH
from synthesis.model.gears.ratio_target import RatioTarget, parse_decimal, parse_target
from synthesis.model.gears.request import (
    MAX_TEETH,
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
from synthesis.model.gears.strength import CarriedPower
from synthesis.model.problem import Count, Flag, PositiveLength, ProblemBase, Range, Statement

MAX_PITCH_MULTIPLE = 10**9
"""Modules are compared as whole multiples of their common measure; this is the largest multiple."""

ROUNDING_MARGIN = 1e-12
"""Share by which a minimum number of teeth is lowered before it is rounded up. At 30° it is 8, whereas the rounded sine
would give 9."""

DEFAULT_TOLERANCE = Fraction(1, 100)
"""Maximum relative error of trains in the Pareto set, and of the smallest trains, if no tolerance is given. Without
this limit the smallest trains would ignore the requested ratio."""

DEFAULT_MAX_TEETH = 100
"""Maximum number of teeth if none is given."""

DEFAULT_MAX_STAGES = 3
"""Maximum number of stages of a train if none is given."""

DEFAULT_SHIFT_LIMITS = (-0.5, 1.0)
"""Profile shifts, in modules, permitted for a given centre distance if no limits are given."""

DEFAULT_MIN_CONTACT_RATIO, DEFAULT_MIN_TIP_THICKNESS = 1.2, 0.25
"""Minimum contact ratio, and minimum tip thickness in modules, of teeth that are fitted to a distance."""


class TeethRange(Range):
    """Fewest and most teeth of a gear."""

    min: ToothNumber | None = Field(
        default=None,
        description="Default: the fewest teeth that no mate can undercut at the pressure angle (18 at 20°).",
    )
    max: ToothNumber = DEFAULT_MAX_TEETH


class StockedGear(Statement):
    """A gear in stock, and the number of such gears."""

    teeth: ToothNumber
    count: Annotated[Count, Field(ge=1, le=100)] = 1


class GearTrainBase(ProblemBase):
    """The constraints on an ordinary gear train of one to four stages for a speed ratio."""

    ratio: ExactRatio = Field(
        description="Input speed over output speed; negative: opposite directions. A number is interpreted as the "
        "decimal that is written; text is exact: 127/50, pi, e, sqrt(2), products and quotients of them."
    )
    direction: Literal["any", "same", "opposite"] = Field(
        default="any",
        description="Relative direction of input and output. With `any` a positive ratio only gives the magnitude and "
        "no idler is used. An idler has teeth within the ranges of the other gears, or is one more gear of the "
        "stock; in its stage the two meshes with it satisfy the mesh constraints, and driver and driven gear the "
        "stage ratio limit.",
    )
    max_stages: Annotated[Count, Field(ge=1, le=4)] | None = Field(
        default=None, description=f"Maximum number of stages; default {DEFAULT_MAX_STAGES}. Not together with `stages`."
    )
    stages: list[RequestedStage] | None = Field(
        default=None,
        min_length=1,
        max_length=4,
        description="The stages from the input on, each with its type, in place of `max_stages`: a train has all of "
        "them, in this order, and no idlers. Only trains of parallel shafts have a direction. If `teeth` has no `min`, "
        "helical gears have at least the teeth that no rack undercuts in their normal plane.",
    )
    teeth: TeethRange | Annotated[list[TeethRange], Field(min_length=2, max_length=8)] | None = Field(
        default=None,
        description="Range of tooth numbers; or one range for each position: driver and driven gear of stage 1, 2, ... "
        "Gears given by a stage are unchanged; the range of their position must contain them. Default without a "
        f"stock: from the fewest teeth that no mate can undercut to {DEFAULT_MAX_TEETH}.",
    )
    stock: list[ToothNumber | StockedGear] | None = Field(
        default=None,
        min_length=1,
        max_length=500,
        description="The available gears, in place of `teeth`; a number listed twice means two gears.",
    )
    max_stage_ratio: Annotated[float, Field(strict=True, ge=1.0, le=1e6)] | None = Field(
        default=None, description="Maximum ratio of larger over smaller gear in every stage."
    )
    max_total_teeth: Annotated[Count, Field(ge=6, le=8 * MAX_TEETH)] | None = Field(
        default=None, description="Maximum sum of the teeth of all drivers and driven gears."
    )
    hunting_tooth: Literal["any", "prefer", "require"] = Field(
        default="any",
        description="Whether the teeth of every mesh must have no common divisor, so that each tooth meets every "
        "other; `prefer` ranks such trains first among those of equal error (or equal size and error).",
    )
    reverted: Flag = Field(
        default=False, description="Every stage has the same centre distance, so that output and input can be coaxial."
    )
    module: Module | Annotated[list[Module], Field(min_length=1, max_length=8)] | None = Field(
        default=None,
        description="Module in length units, default 1; a list: for a reverted train the choices of every stage, "
        "otherwise the modules of stage 1, 2, ...",
    )
    diametral_pitch: Annotated[Pitch, INVERSE_LENGTH] | None = Field(
        default=None, description="Teeth per length unit of pitch diameter, in place of the module."
    )
    modules: list[Module] | None = Field(
        default=None,
        min_length=1,
        max_length=8,
        description="Modules from which every stage may choose, reverted or not, in place of `module`. With this field "
        "or one of the next four, the teeth of every mesh are fitted: only meshes count that a profile shift "
        "within its limits makes sound.",
    )
    centre_distance: PositiveLength | DistanceRange | Annotated[list[PositiveLength], Field(max_length=4)] | None = (
        Field(
            default=None,
            description="Centre distance of every stage: one distance, or a minimum and a maximum; or a list of the "
            "distances of stage 1, 2, ... The profile shifts make the distance free of play. Such trains have no "
            "idlers.",
        )
    )
    shift: ShiftRange | None = Field(
        default=None,
        description=f"Profile shift of every gear, in modules. Default: {DEFAULT_SHIFT_LIMITS[0]} to "
        f"{DEFAULT_SHIFT_LIMITS[1]} with a given centre distance, none without.",
    )
    min_contact_ratio: ContactRatio | None = Field(
        default=None,
        description=f"Minimum contact ratio of every mesh; default {DEFAULT_MIN_CONTACT_RATIO} if teeth are fitted.",
    )
    min_tip_thickness: TipThickness | None = Field(
        default=None,
        description=f"Minimum tip thickness of every gear, in modules; default {DEFAULT_MIN_TIP_THICKNESS} if teeth "
        "are fitted.",
    )
    pressure_angle: PressureAngle = Field(default=20.0, description="Pressure angle, degrees.")
    strength: CarriedPower | None = Field(
        default=None,
        description="Power that every mesh must carry, at the torque and speed of its stage. Each stage gets the "
        "smallest of its modules for which a face of at most `max_face_width` modules suffices, and the smallest such "
        "face; trains that fail are not returned. A first estimate.",
    )
    interference: Literal["report", "refuse"] = Field(
        default="report",
        description="Whether interfering meshes are only reported (with the profile shift that would avoid the "
        "interference) or not used at all.",
    )
    tolerance: Annotated[float, Field(strict=True, ge=0.0, lt=1.0)] | None = Field(
        default=None,
        description="Maximum relative error of the ratio. Default: the nearest trains with any error, for a ratio "
        "within reach.",
    )
    rank_by: Literal["error", "size"] = Field(
        default="error",
        description="`error`: the nearest first; of equally near ones those without undercut teeth, and the smallest "
        "of these. `size`: the smallest first, of the trains within the tolerance, or within 1 % by default.",
    )
    size: Literal["total_teeth", "largest_gear"] = "total_teeth"

    @property
    def target(self) -> RatioTarget:
        """Magnitude of the requested ratio, exact."""
        return parse_target(self.ratio)[1]

    @property
    def required_sign(self) -> int:
        """Required direction: +1 same, −1 opposite, 0 any."""
        if parse_target(self.ratio)[0] < 0:
            return -1
        return {"any": 0, "same": 1, "opposite": -1}[self.direction]

    @property
    def exact_tolerance(self) -> Fraction | None:
        """The tolerance as the decimal that was written; by default :data:`DEFAULT_TOLERANCE` for the smallest
        trains."""
        if self.tolerance is None:
            return DEFAULT_TOLERANCE if self.rank_by == "size" else None
        return parse_decimal(self.tolerance)

    @property
    def fewest_teeth(self) -> int:
        """Fewest teeth that a rack of the pressure angle does not undercut: 2 / sin² φ, rounded up."""
        return math.ceil(2.0 / math.sin(math.radians(self.pressure_angle)) ** 2 * (1.0 - ROUNDING_MARGIN))

    @property
    def ranges(self) -> list[TeethRange]:
        """The ranges of tooth numbers: one for each position, or one for all of them."""
        return self.teeth if isinstance(self.teeth, list) else [self.teeth or TeethRange()]

    @property
    def most_stages(self) -> int:
        """Maximum number of stages of a train; the exact number if they are given one by one."""
        if self.stages is not None:
            return len(self.stages)
        return DEFAULT_MAX_STAGES if self.max_stages is None else self.max_stages

    @property
    def are_parallel(self) -> bool:
        """True if all shafts are parallel."""
        return all(stage.is_parallel for stage in self.stages or [])

    def list_position_ranges(self) -> list[tuple[int, int]]:
        """Return the fewest and most teeth of driver and driven gear of each stage up to ``most_stages``."""
        # A single range holds for the drivers and driven gears of all stages.
        stated = self.ranges if isinstance(self.teeth, list) else self.ranges * (2 * self.most_stages)
        if self.stages is None:
            return [(self.fewest_teeth if r.min is None else r.min, r.max) for r in stated]
        limits = []
        for stage, (one, two) in zip(self.stages, zip(stated[0::2], stated[1::2], strict=True), strict=True):
            # Limits of the stage take precedence over the ranges of the problem.
            fewest = stage.fewest_teeth(self.pressure_angle, ROUNDING_MARGIN)
            usual = [(fewest if r.min is None else r.min, r.max) for r in (one, two)]
            limits += [stage.limits("driver") or usual[0], stage.limits("driven") or usual[1]]
        return limits

    def count_stock(self) -> dict[int, int]:
        """Count the gears of each tooth number in stock."""
        counts: dict[int, int] = {}
        for gear in self.stock or []:
            teeth, count = (gear.teeth, gear.count) if isinstance(gear, StockedGear) else (gear, 1)
            counts[teeth] = counts.get(teeth, 0) + count
        return counts

    @property
    def fitting_fields(self) -> list[str]:
        """The given fields that require fitted teeth."""
        names = "modules", "centre_distance", "shift", "min_contact_ratio", "min_tip_thickness"
        return [name for name in names if getattr(self, name) is not None]

    @property
    def is_fitted(self) -> bool:
        """True if the teeth of every mesh are fitted to a distance, or must be sound without one."""
        return bool(self.fitting_fields)

    @property
    def shift_limits(self) -> tuple[float, float]:
        """Minimum and maximum profile shift, modules."""
        if self.shift is not None:
            return self.shift.min, self.shift.max
        return DEFAULT_SHIFT_LIMITS if self.centre_distance is not None else (0.0, 0.0)

    @property
    def least_contact_ratio(self) -> float:
        """Minimum contact ratio of a fitted mesh."""
        return DEFAULT_MIN_CONTACT_RATIO if self.min_contact_ratio is None else self.min_contact_ratio

    @property
    def least_tip_thickness(self) -> float:
        """Minimum tip thickness of a fitted mesh, modules."""
        return DEFAULT_MIN_TIP_THICKNESS if self.min_tip_thickness is None else self.min_tip_thickness

    def get_distance_limits(self, stage: int) -> tuple[float, float]:
        """Return the minimum and maximum centre distance of a stage, counted from 0; 0 and infinity by default."""
        stated = self.centre_distance
        if isinstance(stated, DistanceRange):
            return stated.min, stated.max
        if stated is None:
            return 0.0, math.inf
        distance = stated[stage] if isinstance(stated, list) else stated
        return distance, distance

    @property
    def has_own_modules(self) -> bool:
        """True if the list of modules is one for each stage, not a choice."""
        return isinstance(self.module, list) and not self.reverted

    def list_modules(self, stage: int) -> list[float]:
        """List the modules that a stage, counted from 0, may have."""
        listed = [float(module) for module in self.list_exact_modules()]
        return [listed[stage]] if self.has_own_modules else listed

    @property
    def shares_distance(self) -> bool:
        """True if fitted stages must agree on a distance that is not given as one number."""
        return self.is_fitted and self.reverted and not isinstance(self.centre_distance, float)

    @property
    def searches_distances(self) -> bool:
        """True if the sums of shifts that suit a pair are searched in steps: no single distance is given.

        At a given distance, or without shift, a pair has one sum, and its suitability is decided exactly.
        """
        # A range leaves the distance open.
        open_distance = self.centre_distance is None or isinstance(self.centre_distance, DistanceRange)
        return self.is_fitted and open_distance and self.shift_limits != (0.0, 0.0)

    def list_exact_modules(self) -> list[Fraction]:
        """List the given modules, exact."""
        if self.modules is not None:
            return [parse_decimal(module) for module in self.modules]
        if self.diametral_pitch is not None:
            return [1 / parse_decimal(self.diametral_pitch)]
        stated = [1.0] if self.module is None else self.module if isinstance(self.module, list) else [self.module]
        return [parse_decimal(module) for module in stated]

    def pitches(self) -> list[int]:
        """Return the modules as the smallest whole numbers in the same proportion."""
        modules = self.list_exact_modules()
        # Bring all modules to a common denominator, then reduce.
        unit = math.lcm(*(module.denominator for module in modules))
        whole = [int(module * unit) for module in modules]
        return [pitch // math.gcd(*whole) for pitch in whole]
