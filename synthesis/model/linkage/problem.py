"""Fields that all linkage problems share: constraints, order of the designs, and regions."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Annotated, Any, Literal, Protocol, Self, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PrivateAttr, model_validator

from kinematics.message import compose
from synthesis.model.dimension import ANGLE, FORCE, LENGTH, POWER, TORQUE
from synthesis.model.dynamics.request import DesignDynamics, ForceQuantity
from synthesis.model.layout import LayoutSpec
from synthesis.model.linkage.workspace import Space
from synthesis.model.linkage.zones import EDGE_TOLERANCE, MovingZone
from synthesis.model.manufacture.request import Manufacture, ManufactureTask, RequiredTargets
from synthesis.model.problem import (
    MAX_MAGNITUDE,
    Contradiction,
    Flag,
    Interval,
    PositiveLength,
    PositiveNumber,
    ProblemBase,
    Sizable,
    Statement,
)

FORCE_NAMES: tuple[ForceQuantity, ...] = get_args(ForceQuantity)

RankBy = Literal["quality", "accuracy", "size", "transmission_angle", "planes", "yield"] | ForceQuantity
"""Criteria by which designs of linkages can be ordered (docs/methods/ranking.md)."""


class Region(Statement):
    """A rectangle with sides along the axes, in length units."""

    x: Annotated[Interval, LENGTH]
    y: Annotated[Interval, LENGTH]

    def contains(self, point: complex) -> bool:
        """Return whether a point lies in the region or, to rounding, on its edge."""
        (left, right), (low, high) = self.x, self.y
        # The slack is relative to the coordinates, because rounding is coarser far from the origin.
        slack = EDGE_TOLERANCE * max(abs(left), abs(right), abs(low), abs(high))
        return bool(left - slack <= point.real <= right + slack and low - slack <= point.imag <= high + slack)

    def mark_contained(self, points: NDArray[np.complex128]) -> NDArray[np.bool_]:
        """Return a mask of the points (any shape) that lie in the region or, to rounding, on its edge."""
        (left, right), (low, high) = self.x, self.y
        slack = EDGE_TOLERANCE * max(abs(left), abs(right), abs(low), abs(high))
        across = (left - slack <= points.real) & (points.real <= right + slack)
        return np.asarray(across & (low - slack <= points.imag) & (points.imag <= high + slack))

    def compute_distances(self, points: NDArray[np.complex128]) -> NDArray[np.float64]:
        """Compute the distance of points (any shape) from the region, length units; 0 inside."""
        (left, right), (low, high) = self.x, self.y
        across = np.maximum(np.maximum(left - points.real, points.real - right), 0.0)
        along = np.maximum(np.maximum(low - points.imag, points.imag - high), 0.0)
        # The distance is exactly 0 on the edge, where rounding might give a tiny distance.
        return np.where(self.mark_contained(points), 0.0, np.hypot(across, along))

    def sample_points(self, rng: np.random.Generator, count: int) -> NDArray[np.complex128]:
        """Sample points uniformly from the region, complex, shape (count,)."""
        return np.asarray(rng.uniform(*self.x, count) + 1j * rng.uniform(*self.y, count))

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Bounds of the region: minimum and maximum x, minimum and maximum y."""
        return *self.x, *self.y

    def widen(self, margin: float) -> Self:
        """Return the region with a margin (length units) added on all sides."""
        (left, right), (low, high) = self.x, self.y
        return self.model_copy(update={"x": (left - margin, right + margin), "y": (low - margin, high + margin)})

    def compute_distance(self, point: complex) -> float:
        """Compute the distance of a point from the region, length units; 0 inside."""
        if self.contains(point):
            return 0.0
        (left, right), (low, high) = self.x, self.y
        across = max(left - point.real, point.real - right, 0.0)
        return float(np.hypot(across, max(low - point.imag, point.imag - high, 0.0)))


class LengthLimits(Statement):
    """Minimum and maximum length of a link, in length units."""

    min: Annotated[float, LENGTH, Field(strict=True, ge=0.0, le=MAX_MAGNITUDE, allow_inf_nan=False), Sizable] = 0.0
    max: PositiveLength | None = None

    @model_validator(mode="after")
    def _validate_order(self) -> Self:
        if self.max is not None and self.min >= self.max:
            raise ValueError(compose("model-min-not-below-max"))
        return self


class Constraints(Statement):
    """Constraints on a linkage; the defaults require only a sound motion."""

    min_transmission_angle: Annotated[float, ANGLE, Field(strict=True, ge=0.0, lt=90.0)] | None = Field(
        default=None, description="Minimum transmission angle over the used range of the input, degrees."
    )
    grashof: Literal["any", "crank_rocker", "double_crank", "double_rocker", "non_grashof"] = "any"
    full_rotation: Flag = Field(default=False, description="The input link must be able to make a full turn.")
    same_branch: Flag = Field(default=True, description="No toggle position between the targets.")
    in_order: Flag = Field(default=True, description="The input visits the targets in order while turning one way.")
    link_length: LengthLimits | None = None
    max_link_ratio: Annotated[float, Field(strict=True, ge=1.0, le=MAX_MAGNITUDE)] | None = Field(
        default=None, description="Maximum ratio of the longest link to the shortest."
    )
    fixed_pivot_region: Region | None = None
    moving_pivot_region: Region | None = Field(
        default=None, description="Region of the moving pivots in the first position."
    )

    max_drive_torque: Annotated[PositiveNumber, TORQUE] | None = Field(
        default=None,
        description="Maximum drive torque in either direction; this and the following limits need `dynamics`.",
    )
    max_joint_force: Annotated[PositiveNumber, FORCE] | None = Field(
        default=None, description="Maximum force of any pin on a link."
    )
    max_shaking_force: Annotated[PositiveNumber, FORCE] | None = Field(
        default=None, description="Maximum force on the frame."
    )
    max_shaking_moment: Annotated[PositiveNumber, TORQUE] | None = Field(
        default=None, description="Maximum moment on the frame."
    )
    max_power: Annotated[PositiveNumber, POWER] | None = Field(
        default=None, description="Maximum power of the drive in either direction."
    )
    max_joint_force_index: PositiveNumber | None = Field(
        default=None, description="Maximum joint force divided by the first load, without masses."
    )

    @property
    def force_limits(self) -> dict[ForceQuantity, float]:
        """The given limits on forces."""
        limits = {name: getattr(self, f"max_{name}") for name in FORCE_NAMES}
        return {name: limit for name, limit in limits.items() if limit is not None}

    def find_contradictions(self) -> list[Contradiction]:
        """Return constraints that exclude one another, with paths below the problem."""
        if self.full_rotation and self.grashof in ("double_rocker", "non_grashof"):
            detail = compose("model-full-rotation-excluded", grashof=self.grashof)
            return [Contradiction("/constraints/full_rotation", detail)]
        return []

    def find_class_contradictions(self, classes: Collection[str], reason: str) -> list[Contradiction]:
        """Return a contradiction if the required Grashof class is not among the possible ``classes``."""
        if self.grashof == "any" or self.grashof in classes:
            return []
        return [Contradiction("/constraints/grashof", compose("model-constraint-impossible", reason=reason))]


class RequestedDriver(Protocol):
    """A driver dyad as requested: a crank and a link that drive the linkage."""

    @property
    def pivot_region(self) -> Region | None:
        """Region of the crank's fixed pivot."""

    def model_copy(self, *, update: Mapping[str, object] | None = None, deep: bool = False) -> Self:
        """Return a copy with other values of some fields."""


class LinkageProblem(ProblemBase):
    """Fields that all linkage problems share."""

    constraints: Constraints = Constraints()
    layout: LayoutSpec | None = Field(
        default=None, description="Arrange each design in the fewest planes in which it can be built."
    )
    space: Space | None = Field(
        default=None, description="The workspace into which the linkage must fit during its whole motion."
    )
    dynamics: DesignDynamics | None = Field(
        default=None, description="Masses, loads and speed of each design, from which its forces are computed."
    )
    manufacture: Manufacture | None = Field(
        default=None, description="Manufacturing accuracy of each design, and the quality that it must keep."
    )
    rank_by: RankBy = "quality"

    _listed_later: bool = PrivateAttr(default=False)

    @model_validator(mode="after")
    def _fill_link_sizes(self) -> Self:
        """Take link sizes that `dynamics` leaves out from the layout."""
        if self.dynamics is not None:
            self.dynamics.fill_from_layout(self.layout)
        return self

    @property
    def is_listed_later(self) -> bool:
        """Whether more designs are searched than listed: the designs are sorted again and then cut off."""
        return self._listed_later

    def list_later(self, order: str, most: int) -> Self:
        """Return the statement with another order and at least ``most`` designs; surplus designs are cut off later."""
        asked = self.model_copy(update={"rank_by": order, "max_designs": max(self.max_designs, most)})
        # This is a private field: the client cannot set it, and it is not part of the answer.
        asked._listed_later = True
        return asked

    @property
    def force_units(self) -> Literal["si", "consistent"]:
        """Units of the block `dynamics`, SI by default."""
        return "si" if self.dynamics is None else self.dynamics.units

    @property
    def input_slides(self) -> bool:
        """Whether all linkages for the task have a sliding input, which is driven by a force instead of a torque."""
        return False

    @property
    def manufacture_task(self) -> ManufactureTask | str:
        """Requirements at the targets of the task, for the block ``manufacture``, or a message if not supported."""
        return compose("model-manufacture-unsupported", kind=self.kind)

    @property
    def guides_a_point(self) -> bool:
        """Whether P is a dimension of its linkages."""
        return True

    def build_required_targets(self, _design: Any) -> RequiredTargets:
        """Return the requirements on a design at its targets, for kinds that support :attr:`manufacture_task`."""
        raise NotImplementedError(f"{self.kind} has no requirements at targets")

    def measure_target_errors(
        self, design: Any, counted: NDArray[np.bool_] | None = None
    ) -> tuple[float | None, float | None]:
        """Return the maximum distance and the maximum angle, degrees, by which a design misses its targets.

        A maximum is None if no target has such an error. ``counted`` is a mask of the targets that count; by default
        all of them do.
        """
        targets = [target for n, target in enumerate(design.targets) if counted is None or counted[n]]
        angles = [target.angle_residual for target in targets if target.angle_residual is not None]
        return max((target.point_residual for target in targets), default=None), max(angles, default=None)

    @property
    def task_size(self) -> float | None:
        """Size of the task in length units, with which distances are compared; None if the task has no size."""
        return None

    @property
    def driver(self) -> RequestedDriver | None:
        """The requested driver dyad; None if none is requested."""
        return None

    @property
    def first_pose(self) -> tuple[complex, float] | None:
        """First pose of the carried body: position of P, and angle in degrees. None for tasks without a body."""
        return None

    def find_contradicting_constraints(self) -> list[Contradiction]:
        """Return constraints that exclude one another, or that no linkage for the task can satisfy."""
        listed = self.constraints.find_contradictions()
        if self.rank_by == "planes" and self.layout is None:
            listed.append(Contradiction("/rank_by", compose("model-rank-by-planes-needs-layout")))
        missing = None if self.dynamics is None else self.dynamics.fill_from_layout(self.layout)
        if missing is not None:
            listed.append(Contradiction("/dynamics/links", missing))
        listed += self._find_forces_without_loads()
        if self.rank_by == "yield" and (self.manufacture is None or not self.manufacture.is_sampled):
            detail = compose("model-rank-by-yield-needs-manufacture")
            listed.append(Contradiction("/rank_by", detail))
        listed += self._find_manufacture_errors()
        # The remaining checks concern only tasks without a body.
        if self.space is None or self.first_pose is not None:
            return listed
        if self.space.body is not None:
            listed.append(Contradiction("/space/body", compose("model-space-body-without-positions")))
        moving = self.space.moving_pivots
        for side, zones in (("input", moving.input), ("output", moving.output)) if moving is not None else ():
            if any(zone.frame == "body" for zone in ([zones] if isinstance(zones, MovingZone) else zones or [])):
                detail = compose("model-body-frame-without-positions")
                listed.append(Contradiction(f"/space/moving_pivots/{side}", detail))
        return listed

    def _find_forces_without_loads(self) -> list[Contradiction]:
        """Return errors of force limits and orders that lack `dynamics` or loads, or do not suit the type of input."""
        demanded = {f"/constraints/max_{name}": name for name in self.constraints.force_limits}
        if self.rank_by in FORCE_NAMES:
            demanded["/rank_by"] = self.rank_by
        if self.dynamics is None:
            detail = compose("model-forces-need-dynamics")
            return [Contradiction(path, detail) for path in demanded]
        missing: dict[str, str] = {}
        if not self.dynamics.loads:
            missing["joint_force_index"] = compose("model-joint-force-index-needs-load")
        # Tasks whose input may rotate or slide are checked per design instead.
        if self.input_slides:
            missing["drive_torque"] = compose("model-sliding-input-without-torque")
        return [Contradiction(path, missing[name]) for path, name in demanded.items() if name in missing]

    def _find_manufacture_errors(self) -> list[Contradiction]:
        if self.manufacture is None:
            return []
        made = self.manufacture_task
        if isinstance(made, str):
            return [Contradiction("/manufacture", made)]
        return [Contradiction(f"/manufacture{path}", detail) for path, detail in self.manufacture.find_errors(made)]

    def measure_error(self, _design: Any) -> float:
        """Return the error of a design as a share of the task's size, or in radians.

        It is 0 if errors do not matter: for exact tasks, and within tolerances.
        """
        return 0.0

    @property
    def error_unit(self) -> tuple[float, str]:
        """Factor that converts an error to the unit in which summaries write it, and that unit."""
        return 100.0, " %"

    def classify_design(self, _design: Any) -> int:
        """Return a class of the design: in the default order, smaller classes precede larger ones."""
        return 0

    def is_astray(self, _design: Any) -> bool:
        """Return whether a design leaves its task between the targets, so that all others precede it."""
        return False
