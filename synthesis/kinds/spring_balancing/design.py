"""Linkages with the springs that balance them as answers."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, Result, Verification, optional
from synthesis.model.dimension import TORSION_STIFFNESS, Angle, Force, Length, Stiffness, Torque
from synthesis.model.linkage_answer import Skeleton

TorsionStiffness = Annotated[float, TORSION_STIFFNESS]


class SprungLinkage(Answer):
    """A linkage by its skeleton."""

    type: Literal["skeleton"] = "skeleton"
    skeleton: Skeleton


class FoundEnd(Answer):
    """Where a spring holds."""

    link: str
    point: Point = Field(description="In the reference configuration.")


class FoundSpring(Answer):
    """A spring of the answer: between two ends, or a torsion spring between two links."""

    number: int = Field(description="Of the spring in the statement, from 0.")
    ends: tuple[FoundEnd, FoundEnd] | None = optional()
    rate: Stiffness | None = optional()
    free_length: Length | None = optional()
    preload: Force | None = optional("Tension at the free length.")
    min_length: Length | None = optional("Over the motion.")
    max_length: Length | None = optional("Over the motion.")
    max_force: Force | None = optional("Over the motion, of pull or push.")
    links: tuple[str, str] | None = optional()
    torsion: TorsionStiffness | None = optional()
    free_angle: Angle | None = optional("Rotation of the second link against the first, without torque.")
    max_torque: Torque | None = optional("Over the motion.")


class SpringMetrics(Answer):
    """What the drive has to do with the springs and without; a force where the input slides."""

    value: float = Field(description="What is left of the drive, as a share of what it was: of its peak, or its rms.")
    bound: float | None = optional("No springs that are asked for leave less. Left out where that is not known.")
    gap: float | None = optional("How far the value is above the bound, as a share of it.")
    exact: bool = Field(
        description="Whether the drive vanishes, but for rounding; at rest with steady loads the energy is constant."
    )
    drive: Torque = Field(description="Greatest, with the springs.")
    unbalanced_drive: Torque = Field(description="Greatest, without.")
    rms_drive: Torque = Field(description="Root of the mean square over the motion, with the springs.")
    unbalanced_rms_drive: Torque
    energy_variation: float | None = optional(
        "Of the potential energy of all bodies, steady loads and springs over the motion, as a share of what it is "
        "without the springs sought. Left out where loads have no potential or the linkage moves."
    )


class SprungDesign(Answer):
    """A linkage with its springs, and the proof of what they do."""

    mechanism: SprungLinkage
    dynamics: dict[str, Any] = Field(
        description="The whole block `dynamics` with the springs in it, as `POST /v1/analyses` takes it."
    )
    springs: list[FoundSpring] = Field(description="Springs that do better not to be there are left out.")
    warnings: list[str]
    verification: Verification
    metrics: SpringMetrics


class SpringBalancingResult(Result[SprungDesign]):
    """Springs that balance a linkage, those that leave the least drive first.

    Where the search is complete no springs that are asked for leave less than the bound of the first design.
    """
