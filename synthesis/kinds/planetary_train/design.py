"""Planetary trains as answers: tooth numbers, members and places of the planets, and what was measured on them."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Result, Search, Verification, optional
from synthesis.model.dimension import Angle, Length
from synthesis.model.gear_answer import Ratio
from synthesis.model.gear_strength import PairStrength


class PlanetPlaces(Answer):
    """Where the copies of a planet stand: ``steps`` times 1/``divisions`` of a turn after the first one."""

    divisions: int
    steps: list[int]


class PlanetaryMechanism(Answer):
    """A planetary train; gears and members have the names of the arrangement."""

    type: Literal["planetary_train"] = "planetary_train"
    arrangement: str
    teeth: dict[str, int]
    planets: int = Field(description="Copies of each planet.")
    places: dict[str, PlanetPlaces] = Field(description="By planet.")
    module: Length
    pressure_angle: Angle = Field(description="Degrees.")
    addendum: dict[str, float] = Field(
        description="Addendum by gear, in modules: 1, or less for a ring whose full teeth would dig into its planets."
    )
    input: str
    output: str
    fixed: str
    ratio: Ratio
    face_widths: list[Length | None] | None = optional(
        "The least with which the gears of each plane carry a stated power; null of a plane that carries nothing."
    )


class MeshContact(Answer):
    """Two gears in mesh and their contact ratio."""

    gears: tuple[str, str]
    contact_ratio: float
    centre_distance: Length
    fillet_interference: bool = Field(
        description="Whether contact goes below an involute as rack and cutter leave it: into a fillet, or, of an "
        "undercut gear, to where nothing is left of it."
    )
    tip_depth: Length = Field(
        description="How deep a tip digs into its mate, found by putting it where it comes to and trying all positions "
        "of the tools that cut the mate; 0 of tips that run free."
    )
    strength: PairStrength | None = optional(
        "Stresses of one copy under a stated power; left out of a mesh that carries nothing."
    )


class PlanetaryMetrics(Answer):
    """Measured properties that were not demanded; powers are shares of the input power."""

    error: float = Field(description="Relative error of the ratio, with its sign.")
    size: Length = Field(description="Largest pitch diameter around the axis, planets included.")
    total_teeth: int = Field(description="Of one copy of every gear.")
    speeds: dict[str, float] = Field(description="Speed of every body where the input has 1; planets absolute too.")
    efficiency: float = Field(description="With the stated efficiency of each mesh; 0 where the train locks itself.")
    self_locking: bool = Field(description="The input cannot drive the output, whatever its torque.")
    rolling_power: float = Field(description="Largest power of a mesh relative to its carrier, without losses.")
    branch_power: float = Field(description="Largest power between a row and a member, without losses.")
    circulating_power: bool = Field(description="A warning: a member carries more power than is put in.")
    least_room: Length | None = Field(description="Least room between tips of gears that do not mesh.")
    meshes: list[MeshContact]
    undercut: list[str] = Field(description="Gears whose flanks a generating rack would undercut.")


class PlanetaryDesign(Answer):
    """A planetary train with the proof of what it does."""

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
    module: Length | None = optional("With `strength`: that with which it carries the power.")
    face_widths: list[Length | None] | None = optional("With `strength`: of each plane.")


class PlanetarySearch(Search):
    """The search of a finite set of trains; with `strength` `complete` is false where better trains may be unjudged."""

    judged: int | None = optional("With `strength`: how many trains were judged, the first of the ranking.")
    every_judged: bool | None = optional(
        "Whether the search has no others within the tolerance: `ties` and `pareto` are then those of all trains that "
        "carry the power, otherwise of the judged that do."
    )


class PlanetaryResult(Result[PlanetaryDesign]):
    """Planetary trains, best first.

    ``ties`` counts the trains that have the least error of all, whatever their size; with `strength` of the judged that
    carry the power.
    """

    search: PlanetarySearch
    ties: int
    pareto: list[ParetoPlanetaryTrain] = Field(
        description="The Pareto set of error against size, smallest first; with `strength` of the trains judged that "
        "carry the power."
    )
