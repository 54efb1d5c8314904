"""What problems of linkages share: constraints, the order of the answers, and the shapes that regions have."""

from __future__ import annotations

from collections.abc import Collection
from typing import Annotated, Any, Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PrivateAttr, model_validator

from synthesis.model.dimension import ANGLE, FORCE, LENGTH, POWER, TORQUE
from synthesis.model.dynamics import DesignDynamics
from synthesis.model.layout import StatedLayout
from synthesis.model.manufacture import Held, Made, Manufacture
from synthesis.model.space import Space
from synthesis.model.statement import (
    ABSURD,
    Contradiction,
    Flag,
    Interval,
    PositiveLength,
    PositiveNumber,
    Sizable,
    StatedProblem,
    Statement,
)
from synthesis.model.zones import ON_EDGE, MovingZone

Force = Literal["drive_torque", "joint_force", "shaking_force", "shaking_moment", "power", "joint_force_index"]
"""What may be demanded of a linkage's forces (docs/dynamics.md)."""

FORCES: tuple[Force, ...] = get_args(Force)

RankBy = Literal["quality", "accuracy", "size", "transmission_angle", "planes", "yield"] | Force
"""What designs of linkages are ordered by (docs/ranking.md)."""


class Region(Statement):
    """A rectangle with sides along the axes, in length units."""

    x: Annotated[Interval, LENGTH]
    y: Annotated[Interval, LENGTH]

    def contains(self, point: complex) -> bool:
        """Whether a point lies in the region, its edges (to rounding) included."""
        (left, right), (low, high) = self.x, self.y
        slack = ON_EDGE * max(abs(left), abs(right), abs(low), abs(high))
        return bool(left - slack <= point.real <= right + slack and low - slack <= point.imag <= high + slack)

    def contains_each(self, points: NDArray[np.complex128]) -> NDArray[np.bool_]:
        """The same of points of any shape."""
        (left, right), (low, high) = self.x, self.y
        slack = ON_EDGE * max(abs(left), abs(right), abs(low), abs(high))
        across = (left - slack <= points.real) & (points.real <= right + slack)
        return np.asarray(across & (low - slack <= points.imag) & (points.imag <= high + slack))

    def distance_each(self, points: NDArray[np.complex128]) -> NDArray[np.float64]:
        """How far points of any shape lie outside; 0 within."""
        (left, right), (low, high) = self.x, self.y
        across = np.maximum(np.maximum(left - points.real, points.real - right), 0.0)
        along = np.maximum(np.maximum(low - points.imag, points.imag - high), 0.0)
        return np.where(self.contains_each(points), 0.0, np.hypot(across, along))

    def sampled(self, rng: np.random.Generator, count: int) -> NDArray[np.complex128]:
        """Points spread evenly over the region, shape (count,)."""
        return np.asarray(rng.uniform(*self.x, count) + 1j * rng.uniform(*self.y, count))

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The region itself: x from, to, y from, to."""
        return *self.x, *self.y

    def widened(self, margin: float) -> Self:
        """The region with a margin on all sides, in length units."""
        (left, right), (low, high) = self.x, self.y
        return self.model_copy(update={"x": (left - margin, right + margin), "y": (low - margin, high + margin)})

    def distance(self, point: complex) -> float:
        """How far a point lies outside the region; 0 within."""
        if self.contains(point):
            return 0.0
        (left, right), (low, high) = self.x, self.y
        across = max(left - point.real, point.real - right, 0.0)
        return float(np.hypot(across, max(low - point.imag, point.imag - high, 0.0)))


class LengthLimits(Statement):
    """Shortest and longest link allowed, in length units."""

    min: Annotated[float, LENGTH, Field(strict=True, ge=0.0, le=ABSURD, allow_inf_nan=False), Sizable] = 0.0
    max: PositiveLength | None = None

    @model_validator(mode="after")
    def _min_below_max(self) -> Self:
        if self.max is not None and self.min >= self.max:
            raise ValueError("min must be below max")
        return self


class Constraints(Statement):
    """What a usable linkage must satisfy; everything has a default that demands nothing beyond a sound motion."""

    min_transmission_angle: Annotated[float, ANGLE, Field(strict=True, ge=0.0, lt=90.0)] | None = Field(
        default=None, description="Least transmission angle over the used range of the input, degrees."
    )
    grashof: Literal["any", "crank_rocker", "double_crank", "double_rocker", "non_grashof"] = "any"
    full_rotation: Flag = Field(default=False, description="The input link must be able to turn through.")
    same_branch: Flag = Field(default=True, description="No toggle position between the targets.")
    in_order: Flag = Field(default=True, description="The input, turning one way, visits the targets in order.")
    link_length: LengthLimits | None = None
    max_link_ratio: Annotated[float, Field(strict=True, ge=1.0, le=ABSURD)] | None = Field(
        default=None, description="Longest link over shortest link, at most."
    )
    fixed_pivot_region: Region | None = None
    moving_pivot_region: Region | None = Field(default=None, description="For the moving pivots in the first position.")

    max_drive_torque: Annotated[PositiveNumber, TORQUE] | None = Field(
        default=None, description="Greatest torque of the drive, either way; needs `dynamics`, like the following."
    )
    max_joint_force: Annotated[PositiveNumber, FORCE] | None = Field(
        default=None, description="Greatest force of any pin on a link."
    )
    max_shaking_force: Annotated[PositiveNumber, FORCE] | None = Field(
        default=None, description="Greatest force on the frame."
    )
    max_shaking_moment: Annotated[PositiveNumber, TORQUE] | None = Field(
        default=None, description="Greatest moment on the frame."
    )
    max_power: Annotated[PositiveNumber, POWER] | None = Field(
        default=None, description="Greatest power of the drive, either way."
    )
    max_joint_force_index: PositiveNumber | None = Field(
        default=None, description="Largest joint force over the first of the loads, without masses."
    )

    @property
    def of_forces(self) -> dict[Force, float]:
        """The limits on forces that are stated."""
        limits = {name: getattr(self, f"max_{name}") for name in FORCES}
        return {name: limit for name, limit in limits.items() if limit is not None}

    def contradictions(self) -> list[Contradiction]:
        """Demands that exclude one another, with paths below the problem."""
        if self.full_rotation and self.grashof in ("double_rocker", "non_grashof"):
            detail = f"the input of a {self.grashof} linkage does not turn through; drop one of the demands"
            return [Contradiction("/constraints/full_rotation", detail)]
        return []

    def of_another_class(self, classes: Collection[str], reason: str) -> list[Contradiction]:
        """The refusal of a class that no linkage of a problem can have: all of them are of ``classes``."""
        if self.grashof == "any" or self.grashof in classes:
            return []
        return [Contradiction("/constraints/grashof", f"{reason}; drop the demand")]


class LinkageProblem(StatedProblem):
    """Fields that all linkage problems share."""

    constraints: Constraints = Constraints()
    layout: StatedLayout | None = Field(
        default=None, description="Lay each design out in the fewest planes in which it can be built."
    )
    space: Space | None = Field(default=None, description="The room that the linkage must fit into, with its motion.")
    dynamics: DesignDynamics | None = Field(
        default=None, description="What each design weighs and carries, and how fast it is driven: its forces."
    )
    manufacture: Manufacture | None = Field(
        default=None, description="How exactly a shop makes each design, and what it must then still do."
    )
    rank_by: RankBy = "quality"

    _listed_later: bool = PrivateAttr(default=False)

    @model_validator(mode="after")
    def _links_of_the_layout(self) -> Self:
        """Links whose sizes `dynamics` leaves out are the plates of the layout."""
        if self.dynamics is not None:
            self.dynamics.laid_out(self.layout)
        return self

    @property
    def listed_later(self) -> bool:
        """Whether more designs are looked for than are listed: what is found is ordered anew, and then cut."""
        return self._listed_later

    def listing_later(self, order: str, most: int) -> Self:
        """The statement with an order, and with so many designs at least, which are not all listed."""
        asked = self.model_copy(update={"rank_by": order, "max_designs": max(self.max_designs, most)})
        asked._listed_later = True
        return asked

    @property
    def force_units(self) -> Literal["si", "consistent"]:
        """Those of the block `dynamics`, by default SI."""
        return "si" if self.dynamics is None else self.dynamics.units

    @property
    def input_slides(self) -> bool:
        """Whether the input of every linkage for the task slides, so that a force drives it and no torque."""
        return False

    @property
    def made(self) -> Made | str:
        """What is demanded at the targets of the task, for the block ``manufacture``; or why that is not built."""
        return f"is built for motion, path and function; {self.kind} does not take it"

    @property
    def guides_a_point(self) -> bool:
        """Whether P is a dimension of its linkages."""
        return True

    def held_to(self, _design: Any) -> Held:
        """What a design of this task is held to at its targets, where :attr:`made` says that there is such."""
        raise NotImplementedError(f"{self.kind} says nothing of its targets")

    @property
    def first_pose(self) -> tuple[complex, float] | None:
        """Where a body that is carried is first: its point P, and its angle in degrees. None where none is."""
        return None

    def contradicting_demands(self) -> list[Contradiction]:
        """Demands that exclude one another, or that no linkage for the task can be asked for."""
        listed = self.constraints.contradictions()
        if self.rank_by == "planes" and self.layout is None:
            listed.append(Contradiction("/rank_by", "planes are counted where a layout is stated; state one"))
        missing = None if self.dynamics is None else self.dynamics.laid_out(self.layout)
        if missing is not None:
            listed.append(Contradiction("/dynamics/links", missing))
        listed += self._forces_without_loads()
        if self.rank_by == "yield" and (self.manufacture is None or not self.manufacture.sampled):
            detail = "a yield is sampled where manufacture has tolerances and a quality; state them"
            listed.append(Contradiction("/rank_by", detail))
        listed += self._faults_of_manufacture()
        if self.space is None or self.first_pose is not None:
            return listed
        if self.space.body is not None:
            listed.append(Contradiction("/space/body", "only a body that is carried through positions has an outline"))
        for side in ("input", "output"):
            zones = getattr(self.space.moving_pivots, side, None)
            if any(zone.frame == "body" for zone in ([zones] if isinstance(zones, MovingZone) else zones or [])):
                detail = "only a body that is carried through positions has places of its own; leave the frame out"
                listed.append(Contradiction(f"/space/moving_pivots/{side}", detail))
        return listed

    def _forces_without_loads(self) -> list[Contradiction]:
        """Demands on forces that nothing is stated for."""
        demanded = {f"/constraints/max_{name}": name for name in self.constraints.of_forces}
        if self.rank_by in FORCES:
            demanded["/rank_by"] = self.rank_by
        if self.dynamics is None:
            detail = "forces are known where `dynamics` states masses, loads and a speed; state it"
            return [Contradiction(path, detail) for path in demanded]
        missing: dict[str, str] = {}
        if not self.dynamics.loads:
            missing["joint_force_index"] = "the joint force index is that of the first of the loads; state one"
        if self.input_slides:
            missing["drive_torque"] = "the input slides, and a force drives it; demand joint_force or power"
        return [Contradiction(path, missing[name]) for path, name in demanded.items() if name in missing]

    def _faults_of_manufacture(self) -> list[Contradiction]:
        if self.manufacture is None:
            return []
        made = self.made
        if isinstance(made, str):
            return [Contradiction("/manufacture", made)]
        return [Contradiction(f"/manufacture{path}", detail) for path, detail in self.manufacture.faults(made)]

    @property
    def error_measure(self) -> str | None:
        """The field of the metrics that tells how near a design is to this task, where the task chooses it."""
        return None
