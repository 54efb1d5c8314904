"""What a simulation is asked for."""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_args

from pydantic import BaseModel, ConfigDict, Field

from synthesis.model.bodies import Material

Form = Literal["mjcf", "urdf", "mo", "sim.py"]
"""What a design's simulation is had as."""

FORMS: tuple[Form, ...] = get_args(Form)

TRAINS = ("gear_train", "planetary_train", "train_series", "gearbox", "layshaft_gearbox")
"""Types of mechanisms that are simulated beside the linkages."""

SMALLEST, LARGEST = 1e-9, 1e9
"""Of what a query may state."""


class SimulationQuery(BaseModel):
    """What the bodies are made of where the problem does not say what they weigh, and how the input is driven.

    Lengths are in the unit of the problem.
    """

    model_config = ConfigDict(extra="forbid")

    material: Material | None = Field(
        default=None,
        description="Of all bodies; steel if left out. What links weigh by the problem's `dynamics` comes before it.",
    )
    width: Annotated[float, Field(ge=SMALLEST, le=LARGEST)] | None = Field(
        default=None,
        description="Of links between their round ends; that of the problem's `layout`, or a tenth of the mechanism's "
        "size, and not more than 0.875 of its shortest link, if left out.",
    )
    thickness: Annotated[float, Field(ge=SMALLEST, le=LARGEST)] | None = Field(
        default=None,
        description="Of links; that of the `layout` or 0.28 of their width if left out. Of gears: the face width of "
        "those that have none of their own; 10 modules if left out.",
    )
    speed_rpm: Annotated[float, Field(ge=-1e6, le=1e6)] | None = Field(
        default=None,
        description="Of an input that turns; that of the problem's `dynamics`, or 60, if left out. Not 0.",
    )
    speed: Annotated[float, Field(ge=-LARGEST, le=LARGEST)] | None = Field(
        default=None,
        description="Of an input that slides, length units a second; that of the problem's `dynamics`, or the whole "
        "way in a second, if left out. Not 0.",
    )
    scale: Annotated[float, Field(ge=SMALLEST, le=LARGEST)] | None = Field(
        default=None,
        description="How much larger than the design it is built; `width` and `thickness` are as built. 1 if left out, "
        "or the power of ten that makes a mechanism of unit size as heavy as MuJoCo needs. Not where the problem's "
        "`dynamics` says what links weigh.",
    )
    gear: Annotated[int, Field(ge=1, le=100)] | None = Field(
        default=None,
        description="Of a gearbox: which of its speeds is engaged, from 1, in the order of `metrics.speeds`; of a "
        "layshaft gearbox the gear, and reverse after the last. 1 if left out.",
    )

    @property
    def built(self) -> float:
        """How much larger than the design it is built."""
        return 1.0 if self.scale is None else self.scale


class NotSimulated(ValueError):
    """A design that no simulation is made of; ``path`` is the field of the query that is against it, if one is."""

    def __init__(self, detail: str, path: str = "") -> None:
        self.path = path
        super().__init__(detail)


class NoSimulation(LookupError):
    """A type of mechanism of which no simulations are made."""


def unused(query: SimulationQuery, of: str, *fields: str) -> None:
    """Refuse fields that say nothing of a mechanism.

    Raises
    ------
    NotSimulated
        For the first that is stated.
    """
    for field in fields:
        value: Any = getattr(query, field)
        if value is not None:
            raise NotSimulated(f"This says nothing of {of}; leave it out.", f"/query/{field}")


def nonzero(value: float | None, field: str) -> float | None:
    """A stated speed.

    Raises
    ------
    NotSimulated
        Where it is 0, or next to it.
    """
    if value is not None and abs(value) < SMALLEST:
        raise NotSimulated(f"A simulation needs a speed of {SMALLEST:g} at least, either way.", f"/query/{field}")
    return value
