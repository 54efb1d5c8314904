"""Models of a given ordinary gear train: its stages, its idlers, and optionally its ratio."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from kinematics.gear.train import OrdinaryTrain, StageKind
from kinematics.message import compose
from synthesis.model.gears.request import (
    MAX_TEETH,
    MIN_TEETH,
    Addendum,
    PressureAngle,
    ShiftCoefficient,
    ToothNumber,
)
from synthesis.model.gears.stages import MAX_THREADS, StageType, build_train_stage
from synthesis.model.problem import Number, PositiveNumber, Statement

RATIO_TOLERANCE = 1e-9
"""Relative tolerance for the comparison of a ratio's decimal value with its numerator and denominator."""


class GivenShifts(Statement):
    """Profile shifts of a stage, modules, positive outwards; the tips are shortened so that the clearance stays."""

    driver: ShiftCoefficient
    driven: ShiftCoefficient


class GivenAddenda(Statement):
    """Addenda of driver and driven gear of an internal stage, modules."""

    driver: Addendum
    driven: Addendum


class GivenStage(StageType):
    """Two gears that mesh; the driven gear sits on the shaft of the next stage's driver."""

    driver: Annotated[int, Field(strict=True, ge=1, le=MAX_TEETH)] = Field(
        description=f"Teeth of the driving gear, at least {MIN_TEETH}; for a worm the number of its threads."
    )
    driven: ToothNumber
    module: PositiveNumber = Field(
        default=1.0,
        description="Module in length units: for helical teeth in the normal plane, for bevel teeth at the large end, "
        "for a worm the axial module.",
    )
    shift: GivenShifts | None = None
    centre_distance: PositiveNumber | None = Field(
        default=None, description="Centre distance, as in a design; it must be the distance without play."
    )
    face_width: PositiveNumber | None = Field(
        default=None,
        description="Face width, used for `strength`, for the overlap of helical gears, and for the forces of bevel "
        "gears, which then act at the middle of the face. The face of bevel gears must be narrower than the cone "
        "distance, at which the teeth would reach the apex; in practice it is at most 0.3 of that distance, and 10 "
        "modules (Shigley's Mechanical Engineering Design, Tab. 13-3).",
    )
    addendum: GivenAddenda | None = Field(
        default=None,
        description="Addenda of an internal stage; by default the ring has the maximum that the pinion permits.",
    )

    @field_validator("driver")
    @classmethod
    def _validate_driver(cls, driver: int, info: ValidationInfo) -> int:
        worm = info.data.get("type") == "worm"
        if worm and not 1 <= driver <= MAX_THREADS:
            raise ValueError(compose("analyses-thread-count-out-of-range", most=MAX_THREADS))
        if not worm and driver < MIN_TEETH:
            raise ValueError(compose("analyses-too-few-teeth", least=MIN_TEETH))
        return driver

    def find_type_errors(self) -> list[tuple[str, str]]:
        """Return errors of fields and gears that the type does not permit, as pairs (path in the stage, detail)."""
        faults = super().find_type_errors()
        if self.type not in ("external", "helical") and self.shift is not None:
            faults.append(("/shift", compose("analyses-stage-without-shift", type=self.type)))
        if self.type != "internal" and self.addendum is not None:
            faults.append(("/addendum", compose("analyses-addendum-needs-ring")))
        if self.type == "internal" and self.driver == self.driven:
            faults.append(("/driven", compose("analyses-ring-too-small")))
        return faults

    @classmethod
    def list_types_with(cls, name: str) -> tuple[StageKind, ...]:
        """Return the types of stages that have the field ``name``; all types with rated forces have a face width."""
        return ("external", "internal", "helical", "bevel") if name == "face_width" else super().list_types_with(name)


class GivenIdler(Statement):
    """A gear between driver and driven gear of a stage; several of one stage stand in the order of the list."""

    stage: Annotated[int, Field(strict=True, ge=1, le=16)]
    teeth: ToothNumber


class GivenRatio(Statement):
    """A ratio as in a design; it is compared with that of the teeth."""

    numerator: Annotated[int, Field(strict=True)]
    denominator: Annotated[int, Field(strict=True, ge=1)]
    value: Number

    def find_errors(self, ratio: Fraction) -> list[tuple[str, str]]:
        """Return an error if the ratio differs from ``ratio``, that of the teeth."""
        same = self.numerator == ratio * self.denominator
        if same and math.isclose(self.value, float(ratio), rel_tol=RATIO_TOLERANCE):
            return []
        return [("/mechanism/ratio", compose("analyses-ratio-of-teeth-differs", ratio=str(ratio)))]


class GivenGearTrain(Statement):
    """An ordinary gear train as in a design."""

    type: Literal["gear_train"]
    stages: list[GivenStage] = Field(min_length=1, max_length=16)
    idlers: list[GivenIdler] = Field(default=[], max_length=64)
    ratio: GivenRatio | None = None
    pressure_angle: PressureAngle = 20.0

    def build_train(self) -> OrdinaryTrain:
        """Build the train for the analysis core."""
        idlers = {k: tuple(i.teeth for i in self.idlers if i.stage == k) for k in range(1, len(self.stages) + 1)}
        angle = math.radians(self.pressure_angle)
        return OrdinaryTrain(tuple(build_train_stage(s, angle, idlers[k]) for k, s in enumerate(self.stages, 1)), angle)
