"""Types of stages of a gear train, and their conversion to the analysis core."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from kinematics.errors import DimensionError
from kinematics.gear.bevel import BevelCones
from kinematics.gear.train import USUAL_FRICTION, USUAL_QUOTIENT, StageKind, TrainStage
from kinematics.message import compose
from synthesis.model.dimension import ANGLE
from synthesis.model.gears import mesh_limits
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import PositiveLength, Statement

RIGHT_ANGLE = 90.0

MAX_THREADS = 6
"""Maximum number of threads of a worm."""

RATIO_DECIMALS = 6
"""Decimals of a shortened addendum, which is a multiple of :data:`mesh_limits.ADDENDUM_STEP`."""

FIELD_STAGE_TYPES: dict[str, tuple[StageKind, ...]] = {
    "helix_angle": ("helical",),
    "face_width": ("helical",),
    "shaft_angle": ("bevel",),
    "diameter_quotient": ("worm",),
    "hand": ("worm",),
    "friction": ("worm",),
}
"""Types of stages that have each field."""

DEFAULT_VALUES: JsonObject = {
    "shaft_angle": RIGHT_ANGLE,
    "diameter_quotient": USUAL_QUOTIENT,
    "hand": "right",
    "friction": USUAL_FRICTION,
}
"""Default values of these fields, for the types of stages that have them."""

HelixAngle = Annotated[float, ANGLE, Field(strict=True, ge=-45.0, le=45.0)]

ShaftAngle = Annotated[float, ANGLE, Field(strict=True, ge=10.0, le=170.0)]

Quotient = Annotated[float, Field(strict=True, ge=4.0, le=30.0)]

Friction = Annotated[float, Field(strict=True, ge=0.0, le=1.0)]

Hand = Literal["right", "left"]


class StageType(Statement):
    """Type of a stage and the fields of that type; fields of other types are refused."""

    type: StageKind = Field(
        default="external",
        description="external: two spur gears that turn in opposite directions. internal: a pinion in a ring, both "
        "turning in the same direction; "
        "the ring's teeth are shortened to suit the pinion's flank. helical: two helical gears on parallel shafts. "
        "bevel: two straight bevel gears whose shafts intersect. worm: a worm that drives its gear; the shafts cross "
        "at a right angle.",
    )
    helix_angle: HelixAngle | None = Field(
        default=None,
        description="Helix angle of the driver of a helical pair, degrees, positive if right-handed; the driven gear "
        "has the opposite hand. The module is then that of the normal plane.",
    )
    face_width: PositiveLength | None = Field(
        default=None, description="Face width of helical gears, for the overlap of their teeth."
    )
    shaft_angle: ShaftAngle | None = Field(
        default=None, description=f"Angle between the shafts of bevel gears, degrees; {RIGHT_ANGLE:g} by default."
    )
    diameter_quotient: Quotient | None = Field(
        default=None,
        description=f"Pitch diameter of a worm over its axial module; {USUAL_QUOTIENT:g} by default.",
    )
    hand: Hand | None = Field(default=None, description="Hand of a worm's threads; right by default.")
    friction: Friction | None = Field(
        default=None,
        description=f"Coefficient of friction between a worm and its gear, {USUAL_FRICTION:g} by default. It "
        "determines the efficiency and whether the gear can drive the worm.",
    )

    @classmethod
    def list_types_with(cls, name: str) -> tuple[StageKind, ...]:
        """Return the types of stages that have the field ``name``."""
        return FIELD_STAGE_TYPES[name]

    def get_or_default(self, name: str) -> Any:
        """Return the value of a field, or its default for this type of stage; None if the type has no such field."""
        stated = getattr(self, name)
        return DEFAULT_VALUES.get(name) if stated is None and self.type in self.list_types_with(name) else stated

    def has_meeting_cones(self, driver: int, driven: int) -> bool:
        """Return whether bevel gears with these tooth numbers have pitch cones with half angles below 90°."""
        try:
            BevelCones(driver, driven, 1.0, math.radians(self.get_or_default("shaft_angle")))
        except DimensionError as error:
            return error.name != "shaft_angle"
        return True

    def find_type_errors(self) -> list[tuple[str, str]]:
        """Return errors of fields that the type lacks or that are missing, as pairs (path in the stage, detail)."""
        faults = [
            (f"/{name}", compose("model-stage-field-foreign", type=self.type))
            for name in FIELD_STAGE_TYPES
            if self.type not in self.list_types_with(name) and getattr(self, name) is not None
        ]
        if self.type == "helical" and not self.helix_angle:
            faults.append(("/helix_angle", compose("model-stage-needs-helix-angle")))
        driver, driven = getattr(self, "driver", None), getattr(self, "driven", None)
        if (
            self.type == "bevel"
            and isinstance(driver, int)
            and isinstance(driven, int)
            and not self.has_meeting_cones(driver, driven)
        ):
            faults.append(
                ("/shaft_angle", compose("model-bevel-gears-cannot-mesh", driver=str(driver), driven=str(driven)))
            )
        return faults


def build_train_stage(stage: Any, pressure_angle: float, idlers: tuple[int, ...] = ()) -> TrainStage:
    """Convert a requested stage, or a stage of a design, for the analysis core.

    Parameters
    ----------
    stage : object
        A model with teeth, module and the fields of all types; fields that are left out are None.
    pressure_angle : float
        Pressure angle, radians.
    idlers : tuple of int
        Tooth numbers of the idlers of the stage, in order.
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
        shaft_angle=math.radians(_choose_value(stage.shaft_angle, RIGHT_ANGLE)),
        helix_angle=math.radians(_choose_value(stage.helix_angle, 0.0)),
        quotient=_choose_value(stage.diameter_quotient, USUAL_QUOTIENT),
        left_handed=stage.hand == "left",
        friction=_choose_value(stage.friction, USUAL_FRICTION),
    )
    if kind != "internal":
        return made
    addenda = compute_ring_addenda(stage.driver, stage.driven, pressure_angle)
    if stage.addendum is not None:
        addenda = stage.addendum.driver, stage.addendum.driven
    return TrainStage(stage.driver, stage.driven, stage.module, idlers, shifts, kind, addenda=addenda)


def _choose_value(given: float | None, usual: float) -> float:
    return usual if given is None else given


def compute_ring_addenda(driver: int, driven: int, pressure_angle: float) -> tuple[float, float]:
    """Return the addenda of driver and driven gear of an internal stage, modules; the ring's addendum is shortened."""
    pinion, ring = (np.array([float(teeth)]) for teeth in sorted((driver, driven)))
    short = round(
        float(mesh_limits.compute_ring_addendum(pinion, ring, pressure_angle, fillets=True)[0]), RATIO_DECIMALS
    )
    return (1.0, short) if driver <= driven else (short, 1.0)
