"""The options of a simulation request."""

from __future__ import annotations

from typing import Annotated, Literal, get_args

from pydantic import BaseModel, ConfigDict, Field

from kinematics.message import compose
from synthesis.model.dynamics.bodies import Material

Form = Literal["mjcf", "urdf", "mo", "sim.py"]
"""Output formats of a simulation."""

FORMS: tuple[Form, ...] = get_args(Form)

TRAIN_TYPES = ("gear_train", "planetary_train", "train_series", "gearbox", "layshaft_gearbox")
"""Types of mechanisms other than linkages that can be simulated."""

MIN_VALUE, MAX_VALUE = 1e-9, 1e9
"""Bounds of the values in a query."""


class SimulationQuery(BaseModel):
    """Material of the bodies, if the problem gives no masses, and the speed of the input.

    Lengths are in the unit of the problem.
    """

    model_config = ConfigDict(extra="forbid")

    material: Material | None = Field(
        default=None,
        description="Material of all bodies; steel by default. Masses in the problem's `dynamics` take precedence.",
    )
    width: Annotated[float, Field(ge=MIN_VALUE, le=MAX_VALUE)] | None = Field(
        default=None,
        description="Width of links between their round ends. Default: that of the problem's `layout`, or a tenth of "
        "the mechanism's size, but at most 0.875 of its shortest link.",
    )
    thickness: Annotated[float, Field(ge=MIN_VALUE, le=MAX_VALUE)] | None = Field(
        default=None,
        description="Thickness of links. Default: that of the `layout`, or 0.28 of their width. For gears: the face "
        "width of those that have none of their own, 10 modules by default.",
    )
    speed_rpm: Annotated[float, Field(ge=-1e6, le=1e6)] | None = Field(
        default=None,
        description="Speed of a rotating input. Default: that of the problem's `dynamics`, or 60. Not 0.",
    )
    speed: Annotated[float, Field(ge=-MAX_VALUE, le=MAX_VALUE)] | None = Field(
        default=None,
        description="Speed of a sliding input, length units per second. Default: that of the problem's `dynamics`, or "
        "the whole stroke in one second. Not 0.",
    )
    scale: Annotated[float, Field(ge=MIN_VALUE, le=MAX_VALUE)] | None = Field(
        default=None,
        description="Built size relative to the design; `width` and `thickness` are as built. Default: 1, or the "
        "power of ten that makes a mechanism of unit size heavy enough for MuJoCo. Not available if the problem's "
        "`dynamics` gives masses.",
    )
    gear: Annotated[int, Field(ge=1, le=100)] | None = Field(
        default=None,
        description="Engaged speed of a gearbox, from 1, in the order of `metrics.speeds`. For a layshaft gearbox: the "
        "engaged gear; reverse comes after the last. Default: 1.",
    )

    @property
    def built(self) -> float:
        """Ratio of the built size to that of the design."""
        return 1.0 if self.scale is None else self.scale


class NotSimulated(ValueError):
    """A design that cannot be simulated; ``path`` is the field of the query that prevents it, if any."""

    def __init__(self, detail: str, path: str = "") -> None:
        self.path = path
        super().__init__(detail)


class NoSimulation(LookupError):
    """A type of mechanism for which no simulation exists."""


def refuse_unused(query: SimulationQuery, message_id: str, *fields: str) -> None:
    """Refuse fields of a query that have no meaning for a mechanism, with a message.

    Raises
    ------
    NotSimulated
        If one of the fields is given.
    """
    for field in fields:
        if getattr(query, field) is not None:
            raise NotSimulated(compose(message_id), f"/query/{field}")


def check_nonzero(value: float | None, field: str) -> float | None:
    """Return a speed after checking that it is not 0; None stays None.

    Raises
    ------
    NotSimulated
        If the speed is 0, or its magnitude is below the minimum.
    """
    if value is not None and abs(value) < MIN_VALUE:
        raise NotSimulated(compose("simulation-speed-too-small", least=f"{MIN_VALUE:g}"), f"/query/{field}")
    return value
