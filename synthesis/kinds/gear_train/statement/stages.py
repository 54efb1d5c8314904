"""Stages that are given one by one: the type of each, and its given gears."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field

from kinematics.gear.train import CROSSED_KINDS, StageKind
from kinematics.message import compose
from synthesis.model.gears.request import MAX_TEETH, MIN_TEETH
from synthesis.model.gears.stages import FIELD_STAGE_TYPES, MAX_THREADS, StageType
from synthesis.model.problem import Count, Range

MAX_GIVEN_PAIRS = 12_000
"""Maximum number of gear pairs of a bevel or worm stage; each pair is constructed."""

NEUTRAL_FIELDS = ("face_width",)
"""Fields that, like the gears, do not make stages unlike: like stages may exchange their gears."""

GEARS: tuple[Literal["driver"], Literal["driven"]] = ("driver", "driven")
"""The gears of a stage, in the order of the power."""

StageTeeth = Annotated[Count, Field(ge=1, le=MAX_TEETH)]
"""Teeth of a gear, or the threads of a worm."""


class StageTeethRange(Range):
    """Fewest and most teeth of a gear of a stage, or threads of its worm."""

    min: StageTeeth
    max: StageTeeth


class RequestedStage(StageType):
    """One stage of a train: its type, the values of that type, and its given gears."""

    type: StageKind = Field(description=StageType.model_fields["type"].description)
    ring: Literal["driver", "driven"] | None = Field(
        default=None, description="The gear of an internal stage that is the ring; by default the driven one."
    )
    driver: StageTeeth | StageTeethRange | None = Field(
        default=None,
        description="Teeth of the driving gear, or a range of them, in place of `teeth`; for a worm its threads, 1 to "
        f"{MAX_THREADS}. Required for bevel and worm stages.",
    )
    driven: StageTeeth | StageTeethRange | None = Field(
        default=None,
        description="Teeth of the driven gear, or a range of them, in place of `teeth`. Required for bevel and worm "
        "stages.",
    )

    @property
    def is_parallel(self) -> bool:
        """True if its shafts are parallel."""
        return self.type not in CROSSED_KINDS

    @property
    def sense(self) -> int:
        """Relative sense of its shafts: +1 same, −1 opposite; 0 if they are not parallel."""
        if not self.is_parallel:
            return 0
        return 1 if self.type == "internal" else -1

    @property
    def likeness(self) -> tuple[object, ...]:
        """Common values of stages whose gears may change places; explicit and default values are equal."""
        ring = (self.ring or "driven") if self.type == "internal" else None
        return (
            self.type,
            ring,
            *(self.get_or_default(name) for name in FIELD_STAGE_TYPES if name not in NEUTRAL_FIELDS),
        )

    def limits(self, name: Literal["driver", "driven"]) -> tuple[int, int] | None:
        """Return the fewest and most teeth of a gear, if they are given here."""
        stated = getattr(self, name)
        if stated is None:
            return None
        return (stated.min, stated.max) if isinstance(stated, StageTeethRange) else (stated, stated)

    def fewest_teeth(self, pressure_angle: float, rounding: float) -> int:
        """Return the fewest teeth without undercut by a rack, 2 cos β / sin² φ_t rounded up; degrees."""
        beta = math.radians(self.helix_angle or 0.0)
        transverse = math.atan(math.tan(math.radians(pressure_angle)) / math.cos(beta))
        return math.ceil(2.0 * math.cos(beta) / math.sin(transverse) ** 2 * (1.0 - rounding))

    def find_errors(self) -> list[tuple[str, str]]:
        """Return contradictions, by the path below the stage."""
        faults = self.find_type_errors()
        if self.ring is not None and self.type != "internal":
            faults.append(("/ring", compose("gear_train-ring-in-other-stage")))
        if self.type == "internal":
            faults += self._check_ring()
        for name, least, most in self._list_bounds():
            limits = self.limits(name)
            if limits is None:
                if not self.is_parallel:
                    faults.append((f"/{name}", compose("gear_train-required-for-type", type=self.type)))
                continue
            if limits[0] < least or limits[1] > most:
                outside = "gear_train-threads-out-of-range" if most == MAX_THREADS else "gear_train-teeth-out-of-range"
                faults.append((f"/{name}", compose(outside, least=least, most=most)))
        if not self.is_parallel and self._count_pairs() > MAX_GIVEN_PAIRS:
            detail = compose("gear_train-too-many-given-pairs", limit=MAX_GIVEN_PAIRS, type=self.type)
            faults.append(("/driven", detail))
        return faults

    def _check_ring(self) -> list[tuple[str, str]]:
        """Check that some given ring has more teeth than some given pinion."""
        pinion, ring = self.limits("driver"), self.limits("driven")
        if self.ring == "driver":
            pinion, ring = ring, pinion
        if pinion is None or ring is None or ring[1] > pinion[0]:
            return []
        return [("", compose("gear_train-ring-too-small", gear=self.ring or "driven"))]

    def list_given_pairs(self) -> list[tuple[int, int]]:
        """List the pairs of driver and driven gear, if both are given here and they are few; otherwise none."""
        one, two = self.limits("driver"), self.limits("driven")
        if one is None or two is None or self._count_pairs() > MAX_GIVEN_PAIRS:
            return []
        return [(a, b) for a in range(one[0], one[1] + 1) for b in range(two[0], two[1] + 1)]

    def _count_pairs(self) -> int:
        """Return the number of pairs within the ranges given here."""
        limits = self.limits("driver"), self.limits("driven")
        return math.prod(high - low + 1 for low, high in (one for one in limits if one is not None))

    def _list_bounds(self) -> list[tuple[Literal["driver", "driven"], int, int]]:
        worm = self.type == "worm"
        return [
            ("driver", 1 if worm else MIN_TEETH, MAX_THREADS if worm else MAX_TEETH),
            ("driven", MIN_TEETH, MAX_TEETH),
        ]


def compute_sense(stages: list[RequestedStage]) -> int:
    """Return the relative sense of input and output: +1 same, −1 opposite; 0 if not all shafts are parallel."""
    return math.prod(stage.sense for stage in stages)
