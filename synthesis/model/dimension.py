"""Physical dimensions of numbers, declared on the field that holds the number or on the check that compares it.

``Annotated[float, LENGTH]`` is a number in length units. The annotation may occur anywhere in a field's type, so that
``list[Length]`` and ``Point | None`` have a dimension, too. A number without a dimension is a pure number, such as a
ratio, a count or a share.
Two dimensions depend on the problem: a *displacement* of a cam's follower is a length, or degrees of its arm; an
*output* is the angle of a link or the position of a slider.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum
from functools import cache
from typing import Annotated, get_args

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema


class Dimension(StrEnum):
    """Dimension of a number; its unit follows from the units of the problem."""

    LENGTH = "length"
    AREA = "area"
    INVERSE_LENGTH = "inverse length"
    ANGLE = "angle"
    DISPLACEMENT = "displacement"
    VELOCITY = "velocity"
    ACCELERATION = "acceleration"
    JERK = "jerk"
    ACCELERATION_SQUARED = "acceleration squared"
    OUTPUT = "output"
    OUTPUT_PER_RADIAN = "output per radian"
    OUTPUT_PER_RADIAN_SQUARED = "output per radian squared"
    LENGTH_PER_RADIAN = "length per radian"
    ANGLE_PER_LENGTH = "angle per length"
    ROTATIONAL_SPEED = "rotational speed"
    RADIAN_FREQUENCY = "radian frequency"
    FORCE = "force"
    STIFFNESS = "stiffness"
    MASS = "mass"
    TORQUE = "torque"
    POWER = "power"
    DENSITY = "density"
    INERTIA = "inertia"
    TORSION_STIFFNESS = "torsion stiffness"
    GRAVITY = "gravity"
    UNBALANCE = "unbalance"
    GRADE = "balance grade"
    SPEED = "speed"
    ENERGY = "energy"
    PERCENT = "percent"


LENGTH = Dimension.LENGTH
AREA = Dimension.AREA
INVERSE_LENGTH = Dimension.INVERSE_LENGTH
ANGLE = Dimension.ANGLE
DISPLACEMENT = Dimension.DISPLACEMENT
VELOCITY = Dimension.VELOCITY
ACCELERATION = Dimension.ACCELERATION
JERK = Dimension.JERK
ACCELERATION_SQUARED = Dimension.ACCELERATION_SQUARED
OUTPUT = Dimension.OUTPUT
OUTPUT_PER_RADIAN = Dimension.OUTPUT_PER_RADIAN
OUTPUT_PER_RADIAN_SQUARED = Dimension.OUTPUT_PER_RADIAN_SQUARED
LENGTH_PER_RADIAN = Dimension.LENGTH_PER_RADIAN
ANGLE_PER_LENGTH = Dimension.ANGLE_PER_LENGTH
ROTATIONAL_SPEED = Dimension.ROTATIONAL_SPEED
RADIAN_FREQUENCY = Dimension.RADIAN_FREQUENCY
FORCE = Dimension.FORCE
STIFFNESS = Dimension.STIFFNESS
MASS = Dimension.MASS
TORQUE = Dimension.TORQUE
POWER = Dimension.POWER
DENSITY = Dimension.DENSITY
INERTIA = Dimension.INERTIA
TORSION_STIFFNESS = Dimension.TORSION_STIFFNESS
GRAVITY = Dimension.GRAVITY
UNBALANCE = Dimension.UNBALANCE
GRADE = Dimension.GRADE
SPEED = Dimension.SPEED
ENERGY = Dimension.ENERGY
PERCENT = Dimension.PERCENT

Length = Annotated[float, LENGTH]
Area = Annotated[float, AREA]
Angle = Annotated[float, ANGLE]
"""Degrees."""
Displacement = Annotated[float, DISPLACEMENT]
Velocity = Annotated[float, VELOCITY]
Acceleration = Annotated[float, ACCELERATION]
Jerk = Annotated[float, JERK]
AccelerationSquared = Annotated[float, ACCELERATION_SQUARED]
Output = Annotated[float, OUTPUT]
OutputPerRadian = Annotated[float, OUTPUT_PER_RADIAN]
OutputPerRadianSquared = Annotated[float, OUTPUT_PER_RADIAN_SQUARED]
LengthPerRadian = Annotated[float, LENGTH_PER_RADIAN]
RotationalSpeed = Annotated[float, ROTATIONAL_SPEED]
RadianFrequency = Annotated[float, RADIAN_FREQUENCY]
Force = Annotated[float, FORCE]
Stiffness = Annotated[float, STIFFNESS]
Torque = Annotated[float, TORQUE]
Mass = Annotated[float, MASS]
Unbalance = Annotated[float, UNBALANCE]
"""Mass times its distance from the axis, g·mm or in the consistent units."""
Grade = Annotated[float, GRADE]
"""Balance quality grade G of ISO 21940, the product e ω of eccentricity and speed; mm/s with any units."""
Percent = Annotated[float, PERCENT]


class DimensionedModel(BaseModel):
    """Base of every model whose numbers have dimensions: its JSON schema gives them as ``x-dimension``."""

    # Deferred, because building the validators of all kinds would lengthen the start of a worker by a fifth.
    model_config = ConfigDict(defer_build=True)

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        schema = handler(core_schema)
        properties = handler.resolve_ref_schema(schema).get("properties", {})
        for name, dimension in collect_dimensions(cls).items():
            # A schema uses the alias of a field, the model its Python name.
            properties[cls.model_fields[name].alias or name]["x-dimension"] = dimension.value
        return schema


@cache
def collect_dimensions(model: type[BaseModel]) -> dict[str, Dimension]:
    """Return the dimensions of a model's fields by name, without fields that have none or that hold models.

    Raises
    ------
    TypeError
        If a field holds numbers of two dimensions, so that it must be split.
    """
    measured = {}
    for name, field in model.model_fields.items():
        of_field = {entry for entry in field.metadata if isinstance(entry, Dimension)} | set(
            _find_in_annotation(field.annotation)
        )
        # A field with several dimensions could not be converted to other units.
        if len(of_field) > 1:
            raise TypeError(f"{model.__name__}.{name} measures {' and '.join(sorted(of_field))}: make two fields of it")
        for dimension in of_field:
            measured[name] = dimension
    return measured


def _find_in_annotation(annotation: object) -> Iterator[Dimension]:
    """Yield the dimensions in a type annotation: in its metadata, and in the members of unions and containers."""
    for part in (*getattr(annotation, "__metadata__", ()), *get_args(annotation)):
        if isinstance(part, Dimension):
            yield part
        else:
            yield from _find_in_annotation(part)
