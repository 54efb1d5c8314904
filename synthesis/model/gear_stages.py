"""What tells one stage of a gear train from another, as a client states it and as the analysis core takes it."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from kinematics.errors import DimensionError
from kinematics.gear.bevel import BevelCones
from kinematics.gear.train import USUAL_FRICTION, USUAL_QUOTIENT, StageKind, TrainStage
from synthesis.model import mesh_limits
from synthesis.model.dimension import ANGLE
from synthesis.model.statement import PositiveLength, Statement

RIGHT_ANGLE = 90.0

MOST_THREADS = 6
"""Threads of a worm."""

ROUND = 6
"""Digits to which a shortened addendum is written; whole multiples of :data:`mesh_limits.ADDENDUM_STEP`."""

OF_TYPES: dict[str, tuple[StageKind, ...]] = {
    "helix_angle": ("helical",),
    "face_width": ("helical",),
    "shaft_angle": ("bevel",),
    "diameter_quotient": ("worm",),
    "hand": ("worm",),
    "friction": ("worm",),
}
"""Which types of stages have these fields."""

USUAL: dict[str, Any] = {
    "shaft_angle": RIGHT_ANGLE,
    "diameter_quotient": USUAL_QUOTIENT,
    "hand": "right",
    "friction": USUAL_FRICTION,
}
"""What those fields are where they are left out."""

HelixAngle = Annotated[float, ANGLE, Field(strict=True, ge=-45.0, le=45.0)]

ShaftAngle = Annotated[float, ANGLE, Field(strict=True, ge=10.0, le=170.0)]

Quotient = Annotated[float, Field(strict=True, ge=4.0, le=30.0)]

Friction = Annotated[float, Field(strict=True, ge=0.0, le=1.0)]

Hand = Literal["right", "left"]


class StageForm(Statement):
    """The type of a stage and what belongs to it; what another type has is refused."""

    type: StageKind = Field(
        default="external",
        description="external: two spur gears, which turn opposite ways. internal: a pinion in a ring, which turn "
        "alike; "
        "the ring's teeth are as short as the pinion's flank demands. helical: two helical gears on parallel shafts. "
        "bevel: two straight bevel gears, the shafts meet. worm: a worm that drives its gear, the shafts cross at a "
        "right angle.",
    )
    helix_angle: HelixAngle | None = Field(
        default=None,
        description="Of helical gears, degrees: of the driver, positive for a right-handed one; the driven gear has "
        "the other hand. The module is then that of the normal plane.",
    )
    face_width: PositiveLength | None = Field(
        default=None, description="Of helical gears, for the overlap of their teeth."
    )
    shaft_angle: ShaftAngle | None = Field(
        default=None, description=f"Of bevel gears, degrees between the shafts; {RIGHT_ANGLE:g} where left out."
    )
    diameter_quotient: Quotient | None = Field(
        default=None,
        description=f"Of a worm: its pitch diameter over its axial module; {USUAL_QUOTIENT:g} where left out.",
    )
    hand: Hand | None = Field(default=None, description="Of a worm's threads; right where left out.")
    friction: Friction | None = Field(
        default=None,
        description=f"Coefficient between a worm and its gear, {USUAL_FRICTION:g} where left out: for the efficiency, "
        "and whether the gear can drive the worm.",
    )

    @classmethod
    def types_with(cls, name: str) -> tuple[StageKind, ...]:
        """Which types of stages have a field."""
        return OF_TYPES[name]

    def or_usual(self, name: str) -> Any:
        """What a field says, or what it is of such a stage where it is left out; None where it has none."""
        stated = getattr(self, name)
        return USUAL.get(name) if stated is None and self.type in self.types_with(name) else stated

    def meeting_cones(self, driver: int, driven: int) -> bool:
        """Whether bevel gears of so many teeth have pitch cones that are less than flat."""
        try:
            BevelCones(driver, driven, 1.0, math.radians(self.or_usual("shaft_angle")))
        except DimensionError as error:
            return error.name != "shaft_angle"
        return True

    def faults_of_type(self) -> list[tuple[str, str]]:
        """Fields that another type has, and those that are missing, by their path below the stage."""
        faults = [
            (f"/{name}", f"a stage that is {self.type} has none; leave it out")
            for name in OF_TYPES
            if self.type not in self.types_with(name) and getattr(self, name) is not None
        ]
        if self.type == "helical" and not self.helix_angle:
            faults.append(("/helix_angle", "state the helix angle of the driver, other than 0"))
        driver, driven = getattr(self, "driver", None), getattr(self, "driven", None)
        if (
            self.type == "bevel"
            and isinstance(driver, int)
            and isinstance(driven, int)
            and not self.meeting_cones(driver, driven)
        ):
            faults.append(("/shaft_angle", f"bevel gears of {driver} and {driven} teeth have no cones at this angle"))
        return faults


def train_stage(stage: Any, pressure_angle: float, idlers: tuple[int, ...] = ()) -> TrainStage:
    """A stage as it is stated, or as it stands in a design, for the analysis core.

    Parameters
    ----------
    stage : object
        With teeth, module, and whatever else tells stages apart; None where nothing is said.
    pressure_angle : float
        Radians.
    """
    kind: StageKind = stage.type or "external"
    shifts = (0.0, 0.0) if stage.shift is None else (stage.shift.driver, stage.shift.driven)
    if kind == "external":
        return TrainStage(stage.driver, stage.driven, stage.module, idlers, shifts)
    made = TrainStage(
        stage.driver,
        stage.driven,
        stage.module,
        idlers,
        shifts,
        kind,
        face_width=stage.face_width,
        shaft_angle=math.radians(_or(stage.shaft_angle, RIGHT_ANGLE)),
        helix_angle=math.radians(_or(stage.helix_angle, 0.0)),
        quotient=_or(stage.diameter_quotient, USUAL_QUOTIENT),
        left_handed=stage.hand == "left",
        friction=_or(stage.friction, USUAL_FRICTION),
    )
    if kind != "internal":
        return made
    addenda = ring_addenda(stage.driver, stage.driven, pressure_angle)
    if stage.addendum is not None:
        addenda = stage.addendum.driver, stage.addendum.driven
    return TrainStage(stage.driver, stage.driven, stage.module, idlers, shifts, kind, addenda=addenda)


def _or(stated: float | None, usual: float) -> float:
    return usual if stated is None else stated


def ring_addenda(driver: int, driven: int, pressure_angle: float) -> tuple[float, float]:
    """Addenda of driver and driven gear of an internal stage, modules: the ring's is cut short for its pinion."""
    pinion, ring = (np.array([float(teeth)]) for teeth in sorted((driver, driven)))
    short = round(float(mesh_limits.ring_addendum(pinion, ring, pressure_angle, fillets=True)[0]), ROUND)
    return (1.0, short) if driver <= driven else (short, 1.0)
