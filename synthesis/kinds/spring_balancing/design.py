"""Linkages with their balancing springs as answers."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, Result, Verification, optional_field
from synthesis.model.dimension import TORSION_STIFFNESS, Angle, Force, Length, Stiffness, Torque
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.answer import Skeleton

TorsionStiffness = Annotated[float, TORSION_STIFFNESS]


class SprungLinkage(Answer):
    """A linkage by its skeleton."""

    type: Literal["skeleton"] = "skeleton"
    skeleton: Skeleton


class FoundEnd(Answer):
    """The place of a spring's end."""

    link: str
    point: Point = Field(description="Point in the reference configuration.")


class FoundSpring(Answer):
    """A spring of the answer: between two ends, or a torsion spring between two links."""

    number: int = Field(description="Number of the spring in the problem, from 0.")
    ends: tuple[FoundEnd, FoundEnd] | None = optional_field()
    rate: Stiffness | None = optional_field()
    free_length: Length | None = optional_field()
    preload: Force | None = optional_field("Tension at the free length.")
    min_length: Length | None = optional_field("Minimum length over the motion.")
    max_length: Length | None = optional_field("Maximum length over the motion.")
    max_force: Force | None = optional_field("Maximum magnitude of the force over the motion.")
    links: tuple[str, str] | None = optional_field()
    torsion: TorsionStiffness | None = optional_field()
    free_angle: Angle | None = optional_field(
        "Rotation of the second link relative to the first at which there is no torque."
    )
    max_torque: Torque | None = optional_field("Maximum torque over the motion.")


class SpringMetrics(Answer):
    """The drive with the springs and without; a force if the input slides."""

    value: float = Field(description="Remaining share of the unbalanced drive: of its peak, or its rms.")
    bound: float | None = optional_field("Lower bound for all springs within the limits. Omitted if it is unknown.")
    gap: float | None = optional_field("Excess of the value over the bound, as a share of the value.")
    exact: bool = Field(
        description="Whether the drive vanishes, to rounding; at rest with steady loads the energy is then constant."
    )
    drive: Torque = Field(description="Peak drive with the springs.")
    unbalanced_drive: Torque = Field(description="Peak drive without springs.")
    rms_drive: Torque = Field(description="Root mean square of the drive over the motion, with the springs.")
    unbalanced_rms_drive: Torque
    energy_variation: float | None = optional_field(
        "Variation of the potential energy of all bodies, steady loads and springs over the motion, as a share of that "
        "without the requested springs. Omitted if loads have no potential or the linkage moves."
    )


class SprungDesign(Answer):
    """A linkage with its springs and its verification."""

    mechanism: SprungLinkage
    dynamics: JsonObject = Field(
        description="The whole block `dynamics` including the springs, in the form of `POST /v1/analyses`."
    )
    springs: list[FoundSpring] = Field(description="The springs; those that would not improve the balance are omitted.")
    warnings: list[str]
    verification: Verification
    metrics: SpringMetrics


class SpringBalancingResult(Result[SprungDesign]):
    """Springs that balance a linkage, the smallest remaining drive first.

    If the search is complete, no springs within the limits leave less than the bound of the first design.
    """
