"""Planetary trains as answers: tooth numbers, members and places of the planets, and the measurements on them."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Result, Search, Verification, optional_field
from synthesis.model.dimension import Angle, Length
from synthesis.model.gears.answer import Ratio
from synthesis.model.gears.strength import PairStrength


class PlanetPlaces(Answer):
    """Places of the copies of a planet: ``steps`` times 1/``divisions`` of a turn after the first one."""

    divisions: int
    steps: list[int]


class PlanetaryMechanism(Answer):
    """A planetary train; gears and members have the names of the arrangement."""

    type: Literal["planetary_train"] = "planetary_train"
    arrangement: str
    teeth: dict[str, int]
    planets: int = Field(description="Number of copies of each planet.")
    places: dict[str, PlanetPlaces] = Field(description="Places of the copies, by planet.")
    module: Length
    pressure_angle: Angle = Field(description="Pressure angle, degrees.")
    addendum: dict[str, float] = Field(
        description="Addendum by gear, in modules: 1, or less for a ring whose full teeth would interfere with its "
        "planets."
    )
    input: str
    output: str
    fixed: str
    ratio: Ratio
    face_widths: list[Length | None] | None = optional_field(
        "Smallest face width of each plane that carries the given power; null for an unloaded plane."
    )


class MeshContact(Answer):
    """Two gears in mesh and their contact ratio."""

    gears: tuple[str, str]
    contact_ratio: float
    centre_distance: Length
    fillet_interference: bool = Field(
        description="Whether contact leaves the involute that rack and cutter produce: into a fillet or, for an "
        "undercut gear, into the region without flank."
    )
    tip_depth: Length = Field(
        description="Depth of tip interference with the mating teeth, found by trying all positions of the tools that "
        "cut the mate; 0 for tips that run free."
    )
    strength: PairStrength | None = optional_field(
        "Stresses of one copy under the given power; omitted for an unloaded mesh."
    )


class PlanetaryMetrics(Answer):
    """Measured properties that were not requested; powers are shares of the input power."""

    error: float = Field(description="Relative error of the ratio, with its sign.")
    size: Length = Field(description="Largest pitch diameter around the axis, planets included.")
    total_teeth: int = Field(description="Teeth of one copy of every gear.")
    speeds: dict[str, float] = Field(
        description="Speed of every body relative to the input's; absolute for planets too."
    )
    efficiency: float = Field(
        description="Efficiency with the given efficiency of each mesh; 0 if the train is self-locking."
    )
    self_locking: bool = Field(description="Whether no input torque can drive the output.")
    rolling_power: float = Field(description="Largest power of a mesh relative to its carrier, without losses.")
    branch_power: float = Field(description="Largest power between a row and a member, without losses.")
    circulating_power: bool = Field(description="Warning: a member carries more power than the input.")
    least_room: Length | None = Field(description="Minimum clearance between tips of gears that do not mesh.")
    meshes: list[MeshContact]
    undercut: list[str] = Field(description="Gears whose flanks a generating rack undercuts.")


class PlanetaryDesign(Answer):
    """A planetary train with its verification."""

    mechanism: PlanetaryMechanism
    verification: Verification
    metrics: PlanetaryMetrics


class ParetoPlanetaryTrain(Answer):
    """A train that is the smallest for its error, and the most exact for its size."""

    arrangement: str
    input: str
    output: str
    fixed: str
    teeth: dict[str, int]
    ratio: Ratio
    error: float = Field(description="Relative error of the ratio, with its sign.")
    size: Length
    module: Length | None = optional_field("With `strength`: module with which the train carries the power.")
    face_widths: list[Length | None] | None = optional_field("With `strength`: face width of each plane.")


class PlanetarySearch(Search):
    """The search of a finite set of trains.

    With `strength` or an efficiency, `complete` is false if better trains may be unjudged.
    """

    judged: int | None = optional_field(
        "With `strength` or an efficiency: number of trains judged, in the order of the ranking."
    )
    every_judged: bool | None = optional_field(
        "Whether all trains within the tolerance were judged, so that `ties` and `pareto` refer to all trains that "
        "carry the power; otherwise they refer to the judged ones only."
    )


class PlanetaryResult(Result[PlanetaryDesign]):
    """Planetary trains, best first.

    ``ties`` counts the trains of any size that have the minimum error; with `strength`, among the judged ones that
    carry the power.
    """

    search: PlanetarySearch
    ties: int
    pareto: list[ParetoPlanetaryTrain] = Field(
        description="Pareto set of error against size, smallest first; with `strength`, of the judged trains that "
        "carry the power."
    )
