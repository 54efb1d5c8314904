"""Interfaces of verified designs and of their mechanisms, for code that treats the designs of several kinds alike."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, Protocol, Self, runtime_checkable

from pydantic import BaseModel

from synthesis.model.answer import Verification
from synthesis.model.dynamics.peak_forces import DesignForces
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.answer import ExactDesign, Layout, LinkageMechanism, LinkageMetrics, Skeleton
from synthesis.model.manufacture.answer import ManufactureReport


class VerifiedDesign(Protocol):
    """A design of any kind with its checks."""

    @property
    def verification(self) -> Verification:
        """Checks of the design."""

    def model_copy(self, *, update: Mapping[str, object] | None = None, deep: bool = False) -> Self:
        """Return a copy with other values of some fields."""


@runtime_checkable
class HasTolerance(Protocol):
    """A problem with a tolerance of its result."""

    @property
    def tolerance(self) -> float | None:
        """Maximum error of a design; None if any error is permitted."""


class SkeletonMechanism(Protocol):
    """The mechanism of a linkage in an answer: its dimensions and its skeleton."""

    @property
    def links(self) -> Mapping[str, float] | BaseModel:
        """Lengths of the links."""

    @property
    def skeleton(self) -> Skeleton:
        """Joints and links at the first target."""

    def model_dump(
        self, *, mode: Literal["json", "python"] = "python", by_alias: bool | None = None, exclude_none: bool = False
    ) -> JsonObject:
        """Return the fields by name."""


@runtime_checkable
class HasReferenceAngle(Protocol):
    """A mechanism whose dimensions contain the input angle of its skeleton; for others the skeleton determines it."""

    @property
    def reference_input_angle(self) -> float:
        """Input angle at the first target, degrees."""


class VerifiedRange(Protocol):
    """The motion over which a linkage was verified."""

    @property
    def used_range(self) -> tuple[float, float] | None:
        """First and last input angle, degrees; None if the input slides."""

    @property
    def used_stroke(self) -> tuple[float, float] | None:
        """First and last position of a sliding input, length units; None if it rotates."""


class LinkageMeasures(VerifiedRange, Protocol):
    """Measured properties that linkages of all kinds have."""

    @property
    def min_transmission_angle(self) -> float:
        """Minimum over the verified motion, degrees."""

    @property
    def link_ratio(self) -> float:
        """Longest link over shortest link."""

    @property
    def size(self) -> float:
        """Diagonal of the box around all joints, length units."""

    def model_dump(self, *, include: set[str] | None = None) -> JsonObject:
        """Return the fields by name."""


@runtime_checkable
class DrivenDesign(VerifiedDesign, Protocol):
    """A linkage that was driven, with the results that its problem may request."""

    @property
    def mechanism(self) -> SkeletonMechanism:
        """The linkage."""

    @property
    def metrics(self) -> LinkageMeasures:
        """Its measured properties."""

    @property
    def layout(self) -> Layout | None:
        """Its arrangement in planes, if known."""

    @property
    def forces(self) -> DesignForces | None:
        """Its peak forces, if known."""


@runtime_checkable
class ManufacturableDesign(DrivenDesign, Protocol):
    """A linkage whose manufacture can be analysed."""

    @property
    def mechanism(self) -> LinkageMechanism:
        """The linkage."""

    @property
    def metrics(self) -> LinkageMetrics:
        """Its measured properties."""

    @property
    def manufacture(self) -> ManufactureReport | None:
        """Its manufacturing results, if known."""

    @property
    def exact(self) -> ExactDesign | None:
        """The design before rounding, if it is rounded to a grid."""
