"""Problems of dwells: a sixbar whose output rests, once or more often in a turn, while its crank continues to turn."""

from __future__ import annotations

from itertools import combinations
from typing import Annotated, Literal, NamedTuple, Self

from pydantic import ConfigDict, Discriminator, Field, Tag

from kinematics.message import compose
from synthesis.model.dimension import ANGLE, OUTPUT
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.linkage.type_choice import UNCLASSED_SIXBAR, refuse_class
from synthesis.model.problem import (
    CANCELLATION_TOLERANCE,
    Contradiction,
    Count,
    Point,
    PositiveLength,
    PositiveNumber,
    Sizable,
    Statement,
)

DEFAULT_TOLERANCE = 0.01
"""Default of the maximum movement of the output during a dwell, as a share of its swing or stroke."""

DEFAULT_CRANK = 10.0
"""Length of the crank, in length units, if nothing else determines the linkage's size."""


MIN_PLACE_SEPARATION = 0.1
"""Minimum separation of the places of two dwells, as a share of the output's range. It is twice
:data:`PLACE_TOLERANCE`, so that the dwells are distinct."""

PLACE_TOLERANCE = 0.05
"""Maximum distance of a dwell's mean from its place in the output's range, as a share of the range."""

LOW_PLACE, HIGH_PLACE = 0.0, 1.0
"""Places of a dwell at the ends of the output's range, as shares of it."""


SixbarType = Literal["pseudo_arc", "straight_slot", "watt_2", "stephenson_2"]
"""Ways to keep an output at rest."""

Turning = Literal["crank_rocker", "double_crank"]
"""Classes of the fourbar O2 A B O4 whose crank turns through; a Stephenson II has no such fourbar."""


class RequestedDwell(NamedTuple):
    """A requested dwell: rotation of the crank, degrees, and share of the range; None for either end."""

    angle: float
    place: float | None


class RockerOutput(Statement):
    """The output swings about a fixed pivot."""

    type: Literal["rocker"] = "rocker"
    swing: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=180.0), Sizable] = Field(
        description="Angle of the swing, degrees."
    )


class SliderOutput(Statement):
    """The output slides back and forth."""

    type: Literal["slider"]
    stroke: PositiveLength = Field(description="Stroke of the output, length units.")


def _get_tag(statement: object) -> str | None:
    kind = statement.get("type", "rocker") if isinstance(statement, dict) else getattr(statement, "type", None)
    return f"<{kind}>" if kind in ("rocker", "slider") else None


Output = Annotated[
    Annotated[RockerOutput, Tag("<rocker>")] | Annotated[SliderOutput, Tag("<slider>")],
    Discriminator(
        _get_tag, custom_error_type="unknown_output", custom_error_message="type must be one of: rocker, slider"
    ),
]
"""The output of a dwell mechanism; the field ``type`` selects it, a rocker by default."""


class DwellRequest(Statement):
    """A dwell of a given length at a given place."""

    angle: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=360.0), Sizable] = Field(
        description="Rotation of the crank during the dwell, degrees."
    )
    at: Literal["low", "high"] | Annotated[float, Field(strict=True, ge=0.0, le=1.0), Sizable] = Field(
        description="Place in the output's range: low, its minimum; high, its maximum; or a share of the range."
    )

    @property
    def place(self) -> float:
        """Share of the range."""
        return {"low": LOW_PLACE, "high": HIGH_PLACE}[self.at] if isinstance(self.at, str) else self.at


class DwellProblem(LinkageProblem):
    """Dwell: a sixbar whose output swings or slides through a given range and rests in it, at its ends or between them.

    A fourbar's coupler point follows a circular arc, and a link of the arc's radius leaves the output at rest
    (`pseudo_arc`); or it follows a straight line in a slot of the output (`straight_slot`); or the fourbar's rocker
    drives another one that rests near its dead points (`watt_2`); or two links from the crank carry a third, which
    turns about the pin of the resting output (`stephenson_2`). `dwell_angle` and `count` request one dwell, or two of
    equal length at the ends of the range; `dwells` requests each by its length and place. Swing, dwells and
    accelerations are measured over the full turn.
    """

    model_config = ConfigDict(
        title="Dwell",
        json_schema_extra={
            "examples": [
                {
                    "kind": "dwell",
                    "dwell_angle": 60.0,
                    "output": {"type": "rocker", "swing": 90.0},
                    "count": 1,
                    "mechanism": "pseudo_arc",
                    "max_designs": 3,
                },
                {
                    "kind": "dwell",
                    "dwell_angle": 40.0,
                    "output": {"type": "rocker", "swing": 50.0},
                    "count": 2,
                    "mechanism": "straight_slot",
                    "tolerance": 2.0,
                    "max_designs": 2,
                },
                {
                    "kind": "dwell",
                    "dwells": [{"angle": 70.0, "at": "low"}, {"angle": 40.0, "at": "high"}],
                    "output": {"type": "rocker", "swing": 50.0},
                    "mechanism": "straight_slot",
                    "tolerance": 1.0,
                    "max_designs": 2,
                },
            ]
        },
    )

    kind: Literal["dwell"]
    dwell_angle: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=360.0), Sizable] | None = Field(
        default=None, description="Rotation of the crank during a dwell, or each of two, degrees. Or give `dwells`."
    )
    dwells: Annotated[list[DwellRequest], Field(min_length=1, max_length=3)] | None = Field(
        default=None, description="Each dwell by its length and its place in the range, instead of `dwell_angle`."
    )
    output: Output = Field(description="Type of the output, and its swing or stroke.")
    count: Annotated[Count, Field(ge=1, le=2)] = Field(
        default=1, description="Number of dwells of `dwell_angle` in a turn."
    )
    mechanism: Literal["auto", "pseudo_arc", "straight_slot", "watt_2", "stephenson_2"] = Field(
        default="auto",
        description="How the output is kept at rest. `auto` compares arc and slot for a rocker, and with `dwells` also "
        "`watt_2`; `stephenson_2`, for a rocker only, must be chosen explicitly.",
    )
    tolerance: Annotated[PositiveNumber, OUTPUT] | None = Field(
        default=None,
        description="Maximum movement of the output during a dwell: degrees, or length units of a slider. By default a "
        "hundredth of the swing or stroke.",
    )
    crank: PositiveLength | None = Field(
        default=None, description="Length of the crank of a linkage with a rocker, in length units; 10 by default."
    )
    pivot: Point | None = Field(
        default=None,
        description="Place of the crank's fixed pivot; by default (0, 0). If it is left out, regions and limits of "
        "length may move the linkage, rotate it and, with a rocker and no `crank`, scale it.",
    )

    @property
    def way(self) -> float:
        """Swing, degrees, or stroke."""
        return self.output.swing if isinstance(self.output, RockerOutput) else self.output.stroke

    @property
    def max_movement(self) -> float:
        """Maximum movement of the output during a dwell, in units of the output."""
        return DEFAULT_TOLERANCE * self.way if self.tolerance is None else self.tolerance

    @property
    def slides(self) -> bool:
        """Whether the output is a slider."""
        return self.output.type == "slider"

    @property
    def dwell_requests(self) -> tuple[RequestedDwell, ...]:
        """The requested dwells; two of equal length without places lie one at each end."""
        if self.dwells is not None:
            return tuple(RequestedDwell(dwell.angle, dwell.place) for dwell in self.dwells)
        return self.count * (RequestedDwell(self.dwell_angle or 0.0, None),)

    @property
    def has_placed_dwells(self) -> bool:
        """Whether outputs are searched by the place and length of each dwell."""
        return self.dwells is not None or self.mechanism in ("watt_2", UNCLASSED_SIXBAR)

    @property
    def types(self) -> tuple[SixbarType, ...]:
        """The types to be tried."""
        if self.mechanism != "auto":
            return (self.mechanism,)
        # A slotted link swings and cannot slide.
        slot: tuple[SixbarType, ...] = ("straight_slot",) if self.output.type == "rocker" else ()
        pair: tuple[SixbarType, ...] = ("watt_2",) if self.has_placed_dwells else ()
        return ("pseudo_arc", *slot, *pair)

    @property
    def searches(self) -> tuple[tuple[SixbarType, Turning | None], ...]:
        """The types to be tried, each with a possible class of its fourbar, regardless of the required class."""
        if self.mechanism == UNCLASSED_SIXBAR:
            return ((UNCLASSED_SIXBAR, None),)
        classes: tuple[Turning, ...] = ("crank_rocker", "double_crank") if self.has_placed_dwells else ("crank_rocker",)
        return tuple(
            (name, turning)
            for name in self.types
            for turning in classes
            # In a double crank P comes too close to the pivot of a slotted link.
            if turning == "crank_rocker" or name != "straight_slot"
        )

    def with_shorter_dwells(self, share: float) -> Self:
        """Return the problem with each dwell shortened to a share of its length."""
        if self.dwells is None:
            return self.model_copy(update={"dwell_angle": share * self.dwell_requests[0].angle})
        return self.model_copy(
            update={"dwells": [dwell.model_copy(update={"angle": share * dwell.angle}) for dwell in self.dwells]}
        )

    def find_contradictions(self) -> list[Contradiction]:
        """Return requests that exclude one another."""
        found = [*self.find_contradicting_constraints(), *self._find_dwell_contradictions()]
        if self.output.type == "slider" and self.mechanism == "straight_slot":
            found.append(Contradiction("/mechanism", compose("dwell-slot-does-not-slide")))
        if self.output.type == "slider" and self.mechanism == UNCLASSED_SIXBAR:
            found.append(Contradiction("/mechanism", compose("dwell-stephenson-does-not-slide")))
        if self.output.type == "slider" and self.crank is not None:
            found.append(Contradiction("/crank", compose("dwell-crank-with-stroke")))
        size, field = (
            (self.way, "/output/stroke") if self.output.type == "slider" else (self.crank or DEFAULT_CRANK, "/crank")
        )
        # Differences of large coordinates would lose the digits of the crank.
        if self.pivot is not None and size < CANCELLATION_TOLERANCE * max(map(abs, self.pivot)):
            found.append(Contradiction(field, compose("dwell-size-lost-in-coordinates")))
        if self.tolerance is not None and self.tolerance >= self.way:
            found.append(Contradiction("/tolerance", compose("dwell-tolerance-covers-range")))
        classes = {turning for _, turning in self.searches if turning is not None}
        if not classes:
            return [*found, *refuse_class(self.constraints)]
        reason = compose("dwell-turning-cranks-only" if "double_crank" in classes else "dwell-crank-rockers-only")
        return [*found, *self.constraints.find_class_contradictions(classes, reason)]

    def _find_dwell_contradictions(self) -> list[Contradiction]:
        """Return contradictory dwell requests."""
        if self.dwells is None:
            if self.dwell_angle is None:
                return [Contradiction("/dwell_angle", compose("dwell-angle-missing"))]
            if self.count * self.dwell_angle < 360.0:
                return []
            detail = compose("dwell-angles-fill-turn", count=self.count, angle=f"{self.dwell_angle:g}")
            return [Contradiction("/dwell_angle", detail)]
        found = []
        if self.dwell_angle is not None:
            found.append(Contradiction("/dwell_angle", compose("dwell-angle-with-dwells")))
        if self.count not in (1, len(self.dwells)):
            found.append(Contradiction("/count", compose("dwell-count-with-dwells")))
        total = sum(dwell.angle for dwell in self.dwells)
        if total >= 360.0:
            found.append(Contradiction("/dwells", compose("dwell-dwells-fill-turn", angle=f"{total:g}")))
        for (n, one), (k, other) in combinations(enumerate(self.dwells), 2):
            apart = abs(one.place - other.place)
            if apart < MIN_PLACE_SEPARATION:
                message = "dwell-places-too-near" if apart else "dwell-places-equal"
                found.append(Contradiction(f"/dwells/{k}/at", compose(message, dwell=n + 1)))
            # An output that may move from one place to the other would satisfy both with one dwell.
            elif apart * self.way <= self.max_movement:
                found.append(Contradiction(f"/dwells/{k}/at", compose("dwell-places-within-tolerance", dwell=n + 1)))
        return found
