"""Planetary trains: the tooth numbers of an epicyclic arrangement for a speed ratio."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from kinematics.message import compose
from synthesis.model.dimension import LENGTH
from synthesis.model.gears.planet_strength import PAIRS_NOTE, PlanetPower
from synthesis.model.gears.ratio_target import parse_target
from synthesis.model.gears.request import CommonPressureAngle, ExactRatio, Module, RangedTeeth, ToothRange
from synthesis.model.problem import Contradiction, Count, PositiveLength, ProblemBase, Statement

MAX_COMBINATIONS = 2 * 10**8
"""Maximum number of combinations of independent tooth numbers in one planet set: a search of minutes."""

ENCLOSURE_BITS = 512
"""Bits of precision of an irrational ratio. Two ratios of planetary trains differ by more than 2^-100, so that this
ranks them like the number itself."""

DIAMETER_SLACK = 1e-12
"""Relative rounding of the diameter of a ring."""

CLEARANCE_TOLERANCE = 1e-9
"""Clearance in modules that is attributed to rounding: less is contact, and a shortfall by less passes."""


class PlanetaryTeeth(Statement):
    """Tooth numbers to choose from."""

    min: RangedTeeth = Field(default=17, description="Minimum number of teeth of any gear.")
    max: RangedTeeth = Field(default=100, description="Maximum number of teeth of an external gear.")
    ring_max: RangedTeeth = Field(default=200, description="Maximum number of teeth of a ring.")
    gears: dict[str, ToothRange] = Field(
        default={}, description="Separate limits for single gears by name, e.g. sun, planet, ring; see the arrangement."
    )

    def limits(self, gear: str, internal: bool) -> tuple[int, int]:
        """Return the fewest and most teeth of a gear."""
        own = self.gears.get(gear)
        if own is not None:
            return own.min, own.max
        return self.min, self.ring_max if internal else self.max


class PlanetaryProblem(ProblemBase):
    """Planetary train: the best tooth numbers of an epicyclic arrangement for a speed ratio, proven to be the best.

    Every design is coaxial, can be assembled with its planets in their places, and has clearance between all gears and
    teeth without interference. Members that are not given are tried in every role.
    """

    model_config = ConfigDict(
        title="Planetary train",
        json_schema_extra={
            "examples": [
                {
                    "kind": "planetary_train",
                    "ratio": 5.5,
                    "arrangement": "simple",
                    "planets": 3,
                    "input": "sun",
                    "output": "carrier",
                    "fixed": "ring",
                    "teeth": {"min": 17, "max": 60, "ring_max": 130},
                    "module": 1.5,
                    "max_designs": 5,
                },
                {
                    "kind": "planetary_train",
                    "ratio": 5.5,
                    "arrangement": "simple",
                    "input": "sun",
                    "output": "carrier",
                    "fixed": "ring",
                    "teeth": {"min": 17, "max": 60, "ring_max": 130},
                    "modules": [1.0, 1.5, 2.0, 2.5],
                    "tolerance": 0.01,
                    "strength": {
                        "power_kw": 5.0,
                        "speed_rpm": 1450.0,
                        "allowable_bending": [200.0, 200.0],
                        "allowable_contact": [800.0, 800.0],
                        "max_face_width": 12.0,
                    },
                },
            ]
        },
    )

    kind: Literal["planetary_train"]
    ratio: ExactRatio = Field(
        description="Input speed over output speed, negative for opposite directions: a number or an exact expression "
        'such as "127/50", "pi", "-sqrt(2)".'
    )
    arrangement: Literal[
        "auto",
        "simple",
        "double_planet",
        "stepped",
        "stepped_suns",
        "stepped_rings",
        "wolfrom",
        "ravigneaux",
        "two_stage",
        "simpson",
        "bevel_differential",
    ] = Field(default="auto", description="Arrangement of gears and meshes; auto compares all of them.")
    planets: Annotated[Count, Field(ge=1, le=12)] = Field(
        default=3, description="Number of planets of each kind around the axis."
    )
    spacing: Literal["equal", "nearest"] = Field(
        default="equal",
        description="equal: planets at equal angles. nearest: as close to equal angles as assembly permits.",
    )
    input: str | None = Field(
        default=None, description="Driving member, e.g. sun, ring, carrier. Default: all are tried."
    )
    output: str | None = Field(default=None, description="Output member. Default: all are tried.")
    fixed: str | None = Field(default=None, description="Fixed member. Default: all are tried.")
    teeth: PlanetaryTeeth = PlanetaryTeeth()
    module: Module = Field(default=1.0, description="Module of all gears, in the length unit.")
    modules: list[Module] | None = Field(
        default=None,
        min_length=1,
        max_length=20,
        description=(
            "Modules to choose from, in place of `module`; only with `strength`. Each train gets the smallest that "
            "carries the power."
        ),
    )
    pressure_angle: CommonPressureAngle = Field(default=20.0, description="Pressure angle, degrees.")
    tolerance: Annotated[float, Field(strict=True, ge=0.0, lt=1.0)] | None = Field(
        default=None, description="Maximum relative error of the ratio. Default: the best possible."
    )
    max_size: PositiveLength | None = Field(
        default=None, description="Maximum pitch diameter around the axis, planets included, in the length unit."
    )
    max_ring_diameter: PositiveLength | None = Field(
        default=None, description="Maximum pitch diameter of any ring, in the length unit; needs one module."
    )
    min_efficiency: Annotated[float, Field(strict=True, gt=0.0, lt=1.0)] | None = Field(
        default=None, description="Minimum efficiency of the train, with `mesh_efficiency`."
    )
    min_clearance: Annotated[float, LENGTH, Field(strict=True, ge=0.0, le=1e9)] = Field(
        default=0.0, description="Minimum clearance between the tips of gears that do not mesh, in the length unit."
    )
    min_contact_ratio: Annotated[float, Field(strict=True, ge=1.0, lt=2.0)] = Field(
        default=1.2, description="Minimum contact ratio of a mesh."
    )
    fillets: Literal["shorten", "report", "refuse"] = Field(
        default="shorten",
        description="Contact in the fillets that a rack (ISO 53, profile A) leaves on external gears, and the usual "
        "cutter of 20 teeth on rings; every mesh reports it. shorten: the teeth of rings are shortened until they "
        "clear "
        "the fillets of their planets, if the contact ratio permits it. report: teeth are as long as flanks without "
        "fillets permit. refuse: as shorten, but trains with any remaining fillet contact, or with rings that the "
        "cutter "
        "trims, are rejected.",
    )
    strength: PlanetPower | None = Field(
        default=None,
        description="Power that every mesh must carry, by a first estimate. Each train gets the smallest of its "
        "modules "
        "for which a face of at most `max_face_width` modules suffices, and each plane the smallest such face; trains "
        f"that fail are rejected. Losses are not included. Spur gears only. {PAIRS_NOTE}",
    )
    mesh_efficiency: Annotated[float, Field(strict=True, gt=0.5, le=1.0)] = Field(
        default=0.99, description="Efficiency of one mesh on fixed axes, for the efficiency of the train."
    )
    rank_by: Literal["error", "size", "efficiency"] = Field(
        default="error",
        description="error: smallest error, then smallest size. size: for each size the smallest error within the "
        "tolerance. efficiency: greatest efficiency within the tolerance, then smallest error.",
    )

    @property
    def judges_efficiency(self) -> bool:
        """Whether trains are selected or ranked by their efficiency."""
        return self.min_efficiency is not None or self.rank_by == "efficiency"

    def compute_tooth_limits(self, gear: str, internal: bool) -> tuple[int, int]:
        """Return the fewest and most teeth of a gear, with the limit on the diameter of rings."""
        low, high = self.teeth.limits(gear, internal)
        if internal and self.max_ring_diameter is not None:
            # A diameter that rounding makes a little smaller still permits its number of teeth.
            high = min(high, math.floor(self.max_ring_diameter / self.module * (1.0 + DIAMETER_SLACK)))
        return low, high

    @property
    def target(self) -> Fraction:
        """The requested ratio; an irrational one to :data:`ENCLOSURE_BITS` bits."""
        # An irrational target is replaced by the middle of its enclosure.
        sign, target = parse_target(self.ratio)
        low, high = target.enclose(ENCLOSURE_BITS)
        return sign * (target.rational or (low + high) / 2)

    @property
    def arrangements(self) -> list[Arrangement]:
        """The arrangements to compare: those that have the given members."""
        if self.arrangement != "auto":
            return [ARRANGEMENTS[self.arrangement]]
        stated = {member for member in (self.input, self.output, self.fixed) if member is not None}
        return [row for row in self._list_arrangements() if stated <= set(row.members)]

    def _list_arrangements(self) -> list[Arrangement]:
        """List the arrangements of `auto`: with a power only those of spur gears."""
        return [row for row in ARRANGEMENTS.values() if self.strength is None or not row.bevel]

    @property
    def module_choices(self) -> list[float]:
        """The permitted modules, the smallest first."""
        return [self.module] if self.modules is None else sorted(self.modules)

    def compute_min_clearance(self, module: float) -> float:
        """Return the minimum clearance between gears of a module that do not mesh, in modules."""
        return max(self.min_clearance / module - CLEARANCE_TOLERANCE, CLEARANCE_TOLERANCE)

    def list_roles(self, arrangement: Arrangement) -> list[tuple[str, str, str]]:
        """List every choice of input, output and fixed member that the problem permits."""
        stated = self.input, self.output, self.fixed
        members = arrangement.members
        return [
            (one, two, three)
            for one in members
            for two in members
            for three in members
            if len({one, two, three}) == 3
            and all(want in (None, got) for want, got in zip(stated, (one, two, three), strict=True))
        ]

    def find_contradictions(self) -> list[Contradiction]:
        """Return unknown members and gears, members with two roles, and reversed limits."""
        return [*self._check_members(), *self._check_limits(), *self._check_extent(), *self._check_power()]

    def _check_power(self) -> list[Contradiction]:
        """Check the power, and that it decides between several modules."""
        contradictions = []
        if self.modules is not None:
            if self.strength is None:
                detail = compose("planetary_train-modules-need-power")
                contradictions.append(Contradiction("/modules", detail))
            if self.module != 1.0:
                contradictions.append(Contradiction("/modules", compose("planetary_train-module-and-modules")))
            if len(set(self.modules)) < len(self.modules):
                contradictions.append(Contradiction("/modules", compose("planetary_train-modules-repeat")))
        if self.strength is None:
            return contradictions
        wrong = [*self.strength.find_errors(), *self.strength.find_planet_errors(self.planets)]
        contradictions += [Contradiction(f"/strength{path}", detail) for path, detail in wrong]
        if self.arrangement == "bevel_differential":
            contradictions.append(Contradiction("/strength", compose("planetary_train-strength-of-bevel-gears")))
        return contradictions

    def _check_members(self) -> list[Contradiction]:
        contradictions = []
        parts = {"input": self.input, "output": self.output, "fixed": self.fixed}
        rows = list(ARRANGEMENTS.values()) if self.arrangement == "auto" else [ARRANGEMENTS[self.arrangement]]
        known = sorted({member for row in rows for member in row.members})
        for k, (part, member) in enumerate(parts.items()):
            if member is not None and member not in known:
                detail = compose("planetary_train-unknown-member", members=", ".join(known), member=f"{member!r}")
                contradictions.append(Contradiction(f"/{part}", detail))
            elif member is not None and member in list(parts.values())[:k]:
                detail = compose("planetary_train-member-repeats", member=member)
                contradictions.append(Contradiction(f"/{part}", detail))
        if not contradictions and not self.arrangements:
            contradictions.append(Contradiction("/input", compose("planetary_train-no-arrangement-fits")))
        return contradictions

    def _check_limits(self) -> list[Contradiction]:
        contradictions = []
        teeth = self.teeth
        if teeth.min > teeth.max:
            contradictions.append(Contradiction("/teeth/max", compose("planetary_train-max-below-min")))
        rows = list(ARRANGEMENTS.values()) if self.arrangement == "auto" else [ARRANGEMENTS[self.arrangement]]
        known = sorted({gear for row in rows for gear in row.gear_names})
        for gear, own in teeth.gears.items():
            if gear not in known:
                detail = compose("planetary_train-unknown-gear", gears=", ".join(known))
                contradictions.append(Contradiction(f"/teeth/gears/{gear}", detail))
            elif own.min > own.max:
                detail = compose("planetary_train-max-below-min")
                contradictions.append(Contradiction(f"/teeth/gears/{gear}/max", detail))
        if self.rank_by != "error" and self.tolerance is None:
            detail = compose("planetary_train-order-needs-tolerance", order=self.rank_by)
            contradictions.append(Contradiction("/tolerance", detail))
        if self.max_ring_diameter is not None and self.modules is not None:
            detail = compose("planetary_train-ring-diameter-needs-module")
            contradictions.append(Contradiction("/max_ring_diameter", detail))
        if self.judges_efficiency and self.strength is not None:
            path = "/rank_by" if self.min_efficiency is None else "/min_efficiency"
            contradictions.append(Contradiction(path, compose("planetary_train-efficiency-without-strength")))
        return contradictions

    def _check_extent(self) -> list[Contradiction]:
        """Refuse a search that would take hours."""
        for row in self.arrangements:
            for members in row.planet_sets:
                count = 1
                for gear in row.list_independent_gears(members):
                    low, high = self.compute_tooth_limits(gear, row.places[gear].internal)
                    count *= max(0, high - low + 1)
                if count > MAX_COMBINATIONS:
                    detail = compose(
                        "planetary_train-too-many-combinations",
                        arrangement=row.name,
                        combinations=f"{count:.2g}",
                        limit=f"{MAX_COMBINATIONS:.0e}",
                    )
                    return [Contradiction("/teeth", detail)]
        return []
