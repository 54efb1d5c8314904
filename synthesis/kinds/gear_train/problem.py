"""The problem of an ordinary gear train: tooth numbers for a speed ratio."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from synthesis.kinds.gear_train.rings import no_ring_runs
from synthesis.kinds.gear_train.stated_stages import StatedStage, sense_of
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
from synthesis.model.statement import Contradiction, Count, Flag, PositiveLength, Range, StatedProblem, Statement

MOST_HALVES = 10_000_000
"""Choices of the drivers (or of the driven gears) of all stages that a search holds at most; 0.8 GB for both."""

FEW_TRAINS = 20_000_000
"""Trains that are gone through one by one, where they are no more than so many."""

MOST_COAXIAL = 3_000_000_000
"""Combinations of all stages but one that a search of coaxial trains goes through at most; a minute or two."""

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

GEARS: tuple[Literal["driver"], Literal["driven"]] = ("driver", "driven")

FITTED_TYPES, CARRYING_TYPES = ("external", "helical"), ("external", "internal")
"""Types of stages whose teeth can be fitted, and those whose strength is estimated."""

USUAL_SHIFT = (-0.5, 1.0)
"""Profile shifts, in modules, that a stated centre distance may call for where no limits are stated."""

USUAL_CONTACT_RATIO, USUAL_TIP_THICKNESS = 1.2, 0.25
"""Least contact ratio, and least thickness of the tips in modules, of teeth that are fitted to a distance."""

MOST_FITTED = 500
"""Tooth numbers of which pairs are fitted to a range of distances; some 10⁵ pairs."""


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


class GearTrainProblem(StatedProblem):
    """An ordinary gear train of one to four stages for a speed ratio, proven to be the best.

    Every train within the ranges, or of the gears in stock, is covered in exact arithmetic. The answer is the trains in
    the order of the ranking, the number of ties, and the Pareto set of error against size. Stages are of external spur
    gears, or stated one by one: external, internal, helical, bevel, worm.
    """

    model_config = ConfigDict(
        title="Gear train",
        json_schema_extra={
            "examples": [
                {
                    "kind": "gear_train",
                    "ratio": "pi",
                    "max_stages": 2,
                    "teeth": {"min": 15, "max": 100},
                    "max_designs": 5,
                },
                {
                    "kind": "gear_train",
                    "ratio": "12",
                    "max_stages": 2,
                    "teeth": {"min": 12, "max": 60},
                    "reverted": True,
                    "tolerance": 0.0,
                },
                {
                    "kind": "gear_train",
                    "ratio": "pi",
                    "max_stages": 2,
                    "teeth": {"min": 17, "max": 100},
                    "reverted": True,
                    "modules": [1.0, 1.25, 1.5, 2.0],
                    "centre_distance": 120.0,
                    "tolerance": 1e-5,
                    "max_designs": 3,
                },
                {
                    "kind": "gear_train",
                    "ratio": "12",
                    "max_stages": 2,
                    "teeth": {"min": 18, "max": 90},
                    "modules": [1.5, 2.0, 2.5, 3.0],
                    "tolerance": 0.001,
                    "strength": {
                        "power_kw": 3.0,
                        "speed_rpm": 1450.0,
                        "allowable_bending": [200.0, 180.0],
                        "allowable_contact": [800.0, 750.0],
                        "max_face_width": 12.0,
                    },
                    "max_designs": 3,
                },
                {
                    "kind": "gear_train",
                    "ratio": "47",
                    "stages": [
                        {"type": "helical", "helix_angle": 15.0, "face_width": 40.0},
                        {"type": "internal"},
                        {"type": "external"},
                    ],
                    "teeth": {"min": 18, "max": 90},
                    "module": 2.0,
                    "max_designs": 3,
                },
                {
                    "kind": "gear_train",
                    "ratio": "100",
                    "stages": [
                        {"type": "bevel", "driver": 20, "driven": 30},
                        {"type": "worm", "driver": 2, "driven": {"min": 30, "max": 60}, "friction": 0.04},
                        {"type": "external"},
                    ],
                    "teeth": {"min": 18, "max": 60},
                    "module": [3.0, 4.0, 2.5],
                    "max_designs": 3,
                },
            ]
        },
    )

    kind: Literal["gear_train"]
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
    def _fitting_fields(self) -> list[str]:
        """The fields that are stated of those with which teeth are fitted."""
        names = "modules", "centre_distance", "shift", "min_contact_ratio", "min_tip_thickness"
        return [name for name in names if getattr(self, name) is not None]

    @property
    def is_fitted(self) -> bool:
        """Whether the teeth of every mesh are fitted to a distance, or have to be sound without."""
        return bool(self._fitting_fields)

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

    def contradictions(self) -> list[Contradiction]:
        """Faults that no single field shows."""
        wrong = [] if self.strength is None else self.strength.faults()
        return [
            *self._wrong_stages(),
            *self._contradicting_fields(),
            *self._wrong_lists(),
            *self._wrong_fit(),
            *self._too_much(),
            *(Contradiction(f"/strength{path}", detail) for path, detail in wrong),
        ]

    def _contradicting_fields(self) -> list[Contradiction]:
        contradictions = []
        if self.direction == "same" and parse_target(self.ratio)[0] < 0:
            contradictions.append(
                Contradiction("/direction", "a negative ratio states opposite directions; drop one of them")
            )
        if self.module is not None and self.diametral_pitch is not None:
            contradictions.append(
                Contradiction("/diametral_pitch", "the module already states the pitch; give one of them")
            )
        if self.stock is not None and self.teeth is not None:
            contradictions.append(
                Contradiction("/stock", "the stock already states the tooth numbers; drop teeth or stock")
            )
        if self.reverted and self.most_stages < 2:
            contradictions.append(
                Contradiction("/reverted", "a reverted train has at least two stages; raise max_stages")
            )
        return contradictions

    def _wrong_stages(self) -> list[Contradiction]:
        """Faults of stages that are stated one by one, and of what is asked of them together."""
        if self.stages is None:
            return []
        faults = [
            Contradiction(f"/stages/{number}{path}", detail)
            for number, stage in enumerate(self.stages)
            for path, detail in stage.faults()
        ]
        if not faults:
            faults += self._impossible_gears(self.stages)
        if self.max_stages is not None:
            detail = f"{len(self.stages)} stages are stated one by one; leave max_stages out"
            faults.append(Contradiction("/max_stages", detail))
        if self.stock is not None:
            detail = "a stock does not tell of which type its gears are; state driver and driven of the stages"
            faults.append(Contradiction("/stock", detail))
        faults += self._wrong_direction(self.stages)
        for number, stage in enumerate(self.stages):
            path = f"/stages/{number}/type"
            if self.reverted and not stage.is_parallel:
                faults.append(Contradiction(path, f"a {stage.type} stage has no parallel shafts; drop reverted"))
            if self.is_fitted and stage.type not in FITTED_TYPES:
                detail = f"teeth of a stage that is {stage.type} are not fitted; drop {', '.join(self._fitting_fields)}"
                faults.append(Contradiction(path, detail))
            if self.strength is not None and stage.type not in CARRYING_TYPES:
                detail = f"the strength of a stage that is {stage.type} is not estimated; drop strength"
                faults.append(Contradiction(path, detail))
        if self.strength is not None and any(stage.type == "internal" for stage in self.stages):
            wrong = self.strength.faults_of_ring()
            faults += [Contradiction(f"/strength{path}", detail) for path, detail in wrong]
        return faults

    def _impossible_gears(self, stages: list[StatedStage]) -> list[Contradiction]:
        """Stages whose gears are given, and none of which can be made or run."""
        faults = []
        for number, stage in enumerate(stages):
            path, pairs = f"/stages/{number}", stage.given_pairs()
            if stage.type == "bevel" and not any(stage.meeting_cones(*pair) for pair in pairs):
                faults.append(Contradiction(f"{path}/shaft_angle", "these bevel gears have no cones at this angle"))
            if stage.type == "internal" and no_ring_runs(stage, math.radians(self.pressure_angle)):
                detail = "the pinion does not run in the ring: their tips, or the fillets, foul one another"
                faults.append(Contradiction(path, f"{detail}; state more teeth of the ring, or fewer of the pinion"))
        return faults

    def _wrong_direction(self, stages: list[StatedStage]) -> list[Contradiction]:
        wanted, sense = self.demanded_sign, sense_of(stages)
        if not wanted or wanted == sense:
            return []
        field = "/ratio" if self.direction == "any" else "/direction"
        if not sense:
            detail = "has no meaning where shafts meet or cross: it depends on the side on which the gears stand"
            return [Contradiction(field, f"a direction {detail}; state the size of the ratio only")]
        turning = "alike" if sense > 0 else "in opposite directions"
        detail = f"these stages turn input and output {turning}; make one more of them internal, or one less"
        return [Contradiction(field, detail)]

    def _wrong_lists(self) -> list[Contradiction]:
        contradictions = []
        if isinstance(self.teeth, list) and len(self.teeth) != 2 * self.most_stages:
            contradictions.append(
                Contradiction(
                    "/teeth",
                    f"expected {2 * self.most_stages} ranges, driver and driven gear of {self.most_stages} stages, "
                    f"got {len(self.teeth)}",
                )
            )
        elif isinstance(self.teeth, list) and self.stages is not None:
            contradictions += self._contradicting_places(self.teeth, self.stages)
        for place, one in enumerate(self.ranges):
            if one.min is None and self._fewest_at(place) > one.max:
                path = f"/teeth/{place}/max" if isinstance(self.teeth, list) else "/teeth/max"
                detail = f"below the least sound tooth number {self._fewest_at(place)}; state min as well"
                contradictions.append(Contradiction(path, detail))
        if isinstance(self.module, list):
            if len(set(self.module)) < len(self.module) and self.reverted:
                contradictions.append(
                    Contradiction("/module", "lists a module twice; each is a choice for every stage")
                )
            elif max(self.pitches()) > FINEST_PITCHES:
                contradictions.append(Contradiction("/module", "the modules have no common measure; round them"))
            elif not self.reverted and len(self.module) != self.most_stages:
                contradictions.append(
                    Contradiction(
                        "/module", f"expected the modules of {self.most_stages} stages, got {len(self.module)}"
                    )
                )
        return contradictions

    def _contradicting_places(self, ranges: list[TeethRange], stages: list[StatedStage]) -> list[Contradiction]:
        """Ranges of places whose gears a stage states, where they do not hold these gears."""
        faults = []
        for place, one in enumerate(ranges):
            stage, name = stages[place // 2], GEARS[place % 2]
            limits = stage.limits(name)
            if limits is None:
                continue
            if not ((one.min or 0) <= limits[0] and limits[1] <= one.max):
                detail = f"does not hold the {name} gear that stage {place // 2 + 1} states; drop one of them"
                faults.append(Contradiction(f"/teeth/{place}", detail))
        return faults

    def _fewest_at(self, place: int) -> int:
        """Fewest teeth that are not undercut, of a place in the list of ranges or of all."""
        if self.stages is None:
            return self.fewest_teeth
        rows = self.stages[place // 2 : place // 2 + 1] if isinstance(self.teeth, list) else self.stages
        free = [stage for stage in rows if stage.driver is None or stage.driven is None]
        return max((stage.fewest_teeth(self.pressure_angle, ROUNDING) for stage in free), default=0)

    def _wrong_fit(self) -> list[Contradiction]:
        contradictions = []
        if self.modules is not None:
            for name, stated in (("module", self.module), ("diametral_pitch", self.diametral_pitch)):
                if stated is not None:
                    contradictions.append(Contradiction("/modules", f"drop {name}, or state it alone"))
            if len(set(self.modules)) < len(self.modules):
                contradictions.append(Contradiction("/modules", "lists a module twice; each is a choice"))
        if isinstance(self.centre_distance, list):
            if self.reverted:
                contradictions.append(
                    Contradiction(
                        "/centre_distance", "a reverted train has one distance for all stages; state a number"
                    )
                )
            elif len(self.centre_distance) != self.most_stages:
                expected = f"expected the distances of {self.most_stages} stages, got {len(self.centre_distance)}"
                contradictions.append(Contradiction("/centre_distance", expected))
        return contradictions

    @property
    def _is_given(self) -> bool:
        """Whether the stages state all of their gears."""
        return all(stage.limits(name) is not None for stage in self.stages or [] for name in GEARS)

    def _are_alike(self, stages: list[StatedStage]) -> bool:
        """Whether gears may stand in any of the stages, so that each choice of them is met in one order only."""
        ranges = self.position_ranges()
        own = self.is_fitted and (self.has_own_modules or isinstance(self.centre_distance, list))
        return not own and len(set(ranges[0::2])) == len(set(ranges[1::2])) == len({s.likeness for s in stages}) == 1

    def _unlike(self, widths: list[int]) -> int:
        """About what a search of stages that are not alike holds or goes through: every stage's own choices.

        ``widths`` are the numbers of tooth numbers of driver and driven gear of each stage.
        """
        modules, pairs = len(self.exact_modules()), list(zip(widths[0::2], widths[1::2], strict=True))
        low, high = self.shift_limits
        shifted = math.ceil(4.0 * (high - low)) + 1 if self.is_fitted else 1
        meshes = [min(pair) * modules * shifted for pair in pairs]
        if self.shares_distance:
            meshes = [one * two * modules for one, two in pairs]
        choices = math.prod(meshes[:-1])
        if self.reverted:
            # Each distance has its own choices of all stages but one; it is one that every stage has.
            return choices if self.is_fitted else choices * min(sum(pair) for pair in pairs) * modules
        halves = max(math.prod(widths[0::2]), math.prod(widths[1::2]))
        # Few fitted meshes are combined instead.
        return min(halves, MOST_HALVES) if self.is_fitted and choices <= FEW_TRAINS else halves

    def _too_much(self) -> list[Contradiction]:
        if self._wrong_lists() or self._wrong_fit():
            return []
        k = self.most_stages
        field = "/teeth" if self.teeth is not None or not self._is_given else "/stages"
        if self.stock is not None:
            widths, field = [len(self.stocked())] * (2 * k), "/stock"
        else:
            widths = [high - low + 1 for low, high in self.position_ranges()]
        if self.shares_distance and max(widths) > MOST_FITTED:
            detail = f"{max(widths)} tooth numbers are more than the {MOST_FITTED} whose pairs are fitted to a distance"
            return [Contradiction(field, f"{detail} that is left open; narrow them or state the distance")]
        if self.stages is not None and not self._are_alike(self.stages):
            half = self._unlike(widths)
            most, what = (
                (MOST_COAXIAL, "combinations of meshes")
                if self.reverted
                else (MOST_HALVES, "choices of drivers or driven gears")
            )
        elif self.reverted:
            meshes = max(widths) * len(self.exact_modules())
            if self.is_fitted:
                # At one distance the sums of teeth that a shift takes up; at an open one all pairs.
                low, high = self.shift_limits
                meshes *= max(widths) if self.shares_distance else math.ceil(4.0 * (high - low)) + 1
                half = math.comb(meshes + k - 2, k - 1)
            else:
                half = 2 * max(widths) * len(self.exact_modules()) * math.comb(meshes + k - 2, k - 1)
            most, what = MOST_COAXIAL, "combinations of meshes"
        else:
            most, what = MOST_HALVES, "choices of drivers or driven gears"
            if isinstance(self.teeth, list):
                half = max(math.prod(widths[0::2]), math.prod(widths[1::2]))
            else:
                half = math.comb(max(widths[:2]) + k - 1, k)
        if half <= most:
            return []
        detail = f"about {float(half):.0e} {what} in {k} stages are more than the {most:.0e} that a search covers"
        return [Contradiction(field, f"{detail}; narrow the tooth numbers or allow fewer stages")]
