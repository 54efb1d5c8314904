"""Models of the workspace of a linkage: zones for its pivots, a box, obstacles, and the width of its links."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import AfterValidator, Field

from kinematics.arrays import Complex
from kinematics.message import compose
from synthesis.model.dimension import LENGTH
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.zones import MovingZone, Outline, Zone
from synthesis.model.problem import Contradiction, NonNegative, Point, Statement

MAX_OBSTACLES = 50
MAX_ZONES = 20


def _list_corners(box: tuple[Point, Point]) -> tuple[Point, Point]:
    (left, low), (right, high) = box
    if left >= right or low >= high:
        raise ValueError(compose("model-box-corners-swapped"))
    return box


class FixedPivotZones(Statement):
    """Permitted zones of the fixed pivots; a pivot may lie in any of several zones."""

    input: Zone | Annotated[list[Zone], Field(min_length=1, max_length=MAX_ZONES)] | None = None
    output: Zone | Annotated[list[Zone], Field(min_length=1, max_length=MAX_ZONES)] | None = None


class MovingPivotZones(Statement):
    """Permitted zones of the moving pivots in the first position; a pivot may lie in any of several zones."""

    input: MovingZone | Annotated[list[MovingZone], Field(min_length=1, max_length=MAX_ZONES)] | None = None
    output: MovingZone | Annotated[list[MovingZone], Field(min_length=1, max_length=MAX_ZONES)] | None = None


class Body(Statement):
    """The carried body."""

    outline: Outline = Field(
        description="Corners of the body as it lies in the first position, in the coordinates of the plane."
    )


class Space(Statement):
    """Workspace into which a linkage must fit over its whole motion; lengths and coordinates in length units.

    A link is the hull of its joints, widened by half of ``link_width``. A coupler with the point P is the hull of A, B
    and P; if an outline of the body is given, it is the bar A–B with the outline fixed to it.
    """

    fixed_pivots: FixedPivotZones | None = Field(
        default=None, description="Zones of the fixed pivots of input and output."
    )
    moving_pivots: MovingPivotZones | None = Field(
        default=None, description="Zones of the moving pivots of input (A) and output (B)."
    )
    box: Annotated[tuple[Point, Point], AfterValidator(_list_corners)] | None = Field(
        default=None,
        description="Lower left and upper right corner of a box that contains every moving part including its width.",
    )
    body: Body | None = None
    obstacles: Annotated[list[Zone], Field(max_length=MAX_OBSTACLES)] = Field(
        default=[], description="Obstacles that links and body must avoid."
    )
    clearance: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Minimum distance of links and body from obstacles."
    )
    link_width: Annotated[NonNegative, LENGTH] = 0.0
    over: Literal["used", "cycle"] = Field(
        default="used",
        description="used: from the first target to the last; cycle: the whole range of the input.",
    )

    @property
    def has_swept_constraints(self) -> bool:
        """Whether the workspace constrains the motion, not only the pivots."""
        return self.box is not None or bool(self.obstacles)

    @property
    def has_constraints(self) -> bool:
        """Whether the workspace contains any constraint."""
        sides = (self.fixed_pivots, self.moving_pivots)
        zoned = any(side is not None and (side.input or side.output) for side in sides)
        return self.has_swept_constraints or zoned

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to check."""
        return not self.has_swept_constraints and self.fixed_pivots is None and self.moving_pivots is None

    def shrink_box_for_joints(self, farther: float = 0.0) -> tuple[float, float, float, float] | None:
        """Return the box for joints: minimum and maximum x, minimum and maximum y; None if there is no box.

        On every side it is smaller than the box for parts, by half a link's width plus ``farther``. The clearance
        applies to obstacles only: links may touch the sides of the box.
        """
        if self.box is None:
            return None
        (left, low), (right, high) = self.box
        inward = 0.5 * self.link_width + farther
        return left + inward, right - inward, low + inward, high - inward

    def move_with_body(self, first: complex, place: complex, turn: complex) -> Self:
        """Return the workspace for another first position of the body, with its outline and the zones on it moved.

        ``first`` is the old position of P, ``place`` the new one, and ``turn`` the rotation e^{iα} of the body.
        """

        def move_point(point: tuple[float, float]) -> tuple[float, float]:
            z = place + turn * (complex(*point) - first)
            return z.real, z.imag

        update: JsonObject = {}
        if self.body is not None:
            update["body"] = self.body.model_copy(
                update={"outline": [move_point(corner) for corner in self.body.outline]}
            )
        if self.moving_pivots is not None:
            zones = {
                side: [zone.move_with_body(move_point) for zone in (listed if isinstance(listed, list) else [listed])]
                for side, listed in (("input", self.moving_pivots.input), ("output", self.moving_pivots.output))
                if listed is not None
            }
            update["moving_pivots"] = self.moving_pivots.model_copy(update=zones)
        return self.model_copy(update=update)

    def compute_spare_clearance(self, points: Mapping[int, complex], turns: Mapping[int, complex]) -> float:
        """Compute the minimum of the body's distances from obstacles and sides of the box, minus the required ones.

        The result is in length units. Parameters are those of :meth:`find_body_collisions`.
        """
        spare = math.inf
        for k, point in points.items():
            corners, width = self._place_body(point, turns[k], points[0])
            if self.box is not None:
                (left, low), (right, high) = self.box
                x, y = corners.real, corners.imag
                spare = min(spare, min(x.min() - left, right - x.max(), y.min() - low, high - y.max()) - width)
            for zone in self.obstacles:
                spare = min(spare, zone.compute_distance_from(corners) - self.clearance - width)
        return spare

    def _place_body(self, point: complex, turn: complex, first: complex) -> tuple[Complex, float]:
        """Return the corners of the body and the radius by which they are widened; without an outline, only P."""
        if self.body is None:
            return np.array([point]), 0.5 * self.link_width
        outline = np.array([complex(*corner) for corner in self.body.outline])
        return point + turn * (outline - first), 0.0

    def find_body_collisions(self, points: Mapping[int, complex], turns: Mapping[int, complex]) -> list[Contradiction]:
        """Return collisions of the body at its required positions, which no linkage can avoid.

        Parameters
        ----------
        points : mapping of int to complex
            P in the positions that are required exactly, by their numbers; the first one is position 0.
        turns : mapping of int to complex
            Rotation e^{iα} of the body from the first position, by the same numbers.
        """
        if not self.has_swept_constraints:
            return []
        found = []
        for k, point in points.items():
            corners, width = self._place_body(point, turns[k], points[0])
            if self.box is not None:
                (left, low), (right, high) = self.box
                x, y = corners.real, corners.imag
                if min(x.min() - left, right - x.max(), y.min() - low, high - y.max()) < width:
                    found.append(Contradiction("/space/box", compose("model-position-outside-box", position=str(k))))
            for n, zone in enumerate(self.obstacles):
                if zone.compute_distance_from(corners) < self.clearance + width or zone.is_entered_by(corners):
                    detail = compose("model-body-near-obstacle", position=str(k))
                    found.append(Contradiction(f"/space/obstacles/{n}", detail))
        # Report one message for each obstacle or box: that of the first position that collides.
        return list({fault.path: fault for fault in reversed(found)}.values())[::-1]
