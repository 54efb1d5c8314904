"""The room that a linkage has: zones for its pivots, a box, obstacles, and how wide its links are."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Field

from synthesis.model.dimension import LENGTH
from synthesis.model.statement import Contradiction, NonNegative, Point, Statement
from synthesis.model.zones import MovingZone, Outline, Zone

Complex = NDArray[np.complex128]

MOST_OBSTACLES = 50
MOST_ZONES = 20


def _corners(box: tuple[Point, Point]) -> tuple[Point, Point]:
    (left, low), (right, high) = box
    if left >= right or low >= high:
        raise ValueError("give the lower left corner and then the upper right one")
    return box


class FixedPivotZones(Statement):
    """Where the fixed pivots may lie; any of several zones."""

    input: Zone | Annotated[list[Zone], Field(min_length=1, max_length=MOST_ZONES)] | None = None
    output: Zone | Annotated[list[Zone], Field(min_length=1, max_length=MOST_ZONES)] | None = None


class MovingPivotZones(Statement):
    """Where the moving pivots may lie in the first position; any of several zones."""

    input: MovingZone | Annotated[list[MovingZone], Field(min_length=1, max_length=MOST_ZONES)] | None = None
    output: MovingZone | Annotated[list[MovingZone], Field(min_length=1, max_length=MOST_ZONES)] | None = None


class Body(Statement):
    """What is carried."""

    outline: Outline = Field(
        description="Corners of the body as it lies in the first position, in the coordinates of the plane."
    )


class Space(Statement):
    """What a linkage must fit into, over the whole motion; lengths and coordinates in length units.

    A link is the hull of its joints, widened by half of ``link_width``; a coupler with the point P is the hull of A, B
    and P, or, where an outline of the body is given, the bar A–B with the outline fixed to it.
    """

    fixed_pivots: FixedPivotZones | None = Field(
        default=None, description="Zones of the input's fixed pivot, and of the output's."
    )
    moving_pivots: MovingPivotZones | None = Field(
        default=None, description="Zones of the input's moving pivot (A), and of the output's (B)."
    )
    box: Annotated[tuple[Point, Point], AfterValidator(_corners)] | None = Field(
        default=None, description="Lower left and upper right corner; it holds every moving part, its width included."
    )
    body: Body | None = None
    obstacles: Annotated[list[Zone], Field(max_length=MOST_OBSTACLES)] = Field(
        default=[], description="What no link and no body may come near."
    )
    clearance: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Least distance of links and body from obstacles."
    )
    link_width: Annotated[NonNegative, LENGTH] = 0.0
    over: Literal["used", "cycle"] = Field(
        default="used",
        description="used: from the first target to the last; cycle: wherever the input can take the linkage.",
    )

    @property
    def swept(self) -> bool:
        """Whether something is demanded of the motion, and not of the pivots alone."""
        return self.box is not None or bool(self.obstacles)

    @property
    def demanding(self) -> bool:
        """Whether something is demanded at all."""
        sides = (self.fixed_pivots, self.moving_pivots)
        zoned = any(side is not None and (side.input or side.output) for side in sides)
        return self.swept or zoned

    @property
    def empty(self) -> bool:
        """Whether there is nothing that a linkage would be held against."""
        return not self.swept and self.fixed_pivots is None and self.moving_pivots is None

    def box_of_joints(self, farther: float = 0.0) -> tuple[float, float, float, float] | None:
        """The box for joints, half a link's width within that of parts: x from, to, y from, to; None without a box.

        It is drawn in by so much ``farther``. The clearance is one of obstacles: links may touch the sides of the box.
        """
        if self.box is None:
            return None
        (left, low), (right, high) = self.box
        inward = 0.5 * self.link_width + farther
        return left + inward, right - inward, low + inward, high - inward

    def carried(self, first: complex, place: complex, turn: complex) -> Self:
        """The same room where the body is elsewhere in its first position: what is drawn on the body goes with it.

        ``first`` is P as it was, ``place`` as it is, ``turn`` the body's rotation e^{iα}.
        """

        def moved(point: tuple[float, float]) -> tuple[float, float]:
            z = place + turn * (complex(*point) - first)
            return z.real, z.imag

        update: dict[str, Any] = {}
        if self.body is not None:
            update["body"] = self.body.model_copy(update={"outline": [moved(corner) for corner in self.body.outline]})
        if self.moving_pivots is not None:
            zones = {
                side: [zone.carried(moved) for zone in (listed if isinstance(listed, list) else [listed])]
                for side, listed in (("input", self.moving_pivots.input), ("output", self.moving_pivots.output))
                if listed is not None
            }
            update["moving_pivots"] = self.moving_pivots.model_copy(update=zones)
        return self.model_copy(update=update)

    def spared_at(self, points: Mapping[int, complex], turns: Mapping[int, complex]) -> float:
        """By how much more than is demanded the body keeps clear of obstacles and sides, in length units.

        Parameters are those of :meth:`without_room_at`.
        """
        spare = math.inf
        for k, point in points.items():
            corners, width = self._body_at(point, turns[k], points[0])
            if self.box is not None:
                (left, low), (right, high) = self.box
                x, y = corners.real, corners.imag
                spare = min(spare, min(x.min() - left, right - x.max(), y.min() - low, high - y.max()) - width)
            for zone in self.obstacles:
                spare = min(spare, zone.distance_from(corners) - self.clearance - width)
        return spare

    def _body_at(self, point: complex, turn: complex, first: complex) -> tuple[Complex, float]:
        """Corners of what is carried, P alone where no outline is given, and by how much they are widened."""
        if self.body is None:
            return np.array([point]), 0.5 * self.link_width
        outline = np.array([complex(*corner) for corner in self.body.outline])
        return point + turn * (outline - first), 0.0

    def without_room_at(self, points: Mapping[int, complex], turns: Mapping[int, complex]) -> list[Contradiction]:
        """What the body meets where it has to be, whatever linkage carries it.

        Parameters
        ----------
        points : mapping of int to complex
            P in the positions that are met exactly, by their numbers; the first one is position 0.
        turns : mapping of int to complex
            Rotation e^{iα} of the body from the first position.
        """
        if not self.swept:
            return []
        found = []
        for k, point in points.items():
            corners, width = self._body_at(point, turns[k], points[0])
            if self.box is not None:
                (left, low), (right, high) = self.box
                x, y = corners.real, corners.imag
                if min(x.min() - left, right - x.max(), y.min() - low, high - y.max()) < width:
                    found.append(Contradiction("/space/box", f"position {k} lies outside the box"))
            for n, zone in enumerate(self.obstacles):
                if zone.distance_from(corners) < self.clearance + width or zone.holds(corners):
                    detail = f"position {k} comes nearer to it than the clearance allows"
                    found.append(Contradiction(f"/space/obstacles/{n}", detail))
        return list({fault.path: fault for fault in reversed(found)}.values())[::-1]
