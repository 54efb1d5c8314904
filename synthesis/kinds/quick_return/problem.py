"""Problems of quick return: a mechanism whose output moves slowly forward and fast back, at constant crank speed."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.model.dimension import ANGLE
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import (
    MAX_MAGNITUDE,
    Contradiction,
    Coordinate,
    Degrees,
    Point,
    PositiveLength,
    Sizable,
    Statement,
)

QuickReturnType = Literal[
    "fourbar", "drag_link_rocker", "drag_link_slider", "crank_shaper", "whitworth", "offset_slider_crank"
]

ROCKER_TYPES: tuple[QuickReturnType, ...] = ("fourbar", "drag_link_rocker")
"""Types whose output swings."""

SLIDER_TYPES: tuple[QuickReturnType, ...] = ("offset_slider_crank", "crank_shaper", "whitworth", "drag_link_slider")
"""Types whose output slides."""


GRASHOF_CLASSES: dict[QuickReturnType, str] = {
    "fourbar": "crank_rocker",
    "drag_link_rocker": "double_crank",
    "drag_link_slider": "double_crank",
}
"""Grashof's class of the fourbar that the crank drives, for each type that has one."""

CLASS_MESSAGES = {
    frozenset(): "quick_return-mechanism-without-class",
    frozenset({"crank_rocker"}): "quick_return-mechanism-is-crank-rocker",
    frozenset({"double_crank"}): "quick_return-mechanism-is-double-crank",
    frozenset({"crank_rocker", "double_crank"}): "quick_return-mechanism-is-either",
}
"""Messages with the reason why a class is impossible, by the classes of the requested types."""

MIN_ROTATION = 1e-4
"""Minimum rotation of a body, degrees. At this rotation the rotopole is about half a million displacements away."""

POLE_TOLERANCE = 1e-6
"""Maximum distance of a given rotopole from the computed one, as a share of the body's distance from it: the precision
of printed coordinates."""


def compute_stroke_imbalance(time_ratio: float) -> float:
    """Return δ = π (T − 1)/(T + 1): the rotation of the crank beyond half a turn in the slow stroke, radians."""
    return math.pi * (time_ratio - 1.0) / (time_ratio + 1.0)


class RockerPosition(Statement):
    """Position of a body on the rocker at a limit: a point of it, and the angle of its line."""

    x: Coordinate
    y: Coordinate
    angle: Degrees = Field(description="Angle of the body's line, degrees.")

    @property
    def point(self) -> complex:
        """The point as a complex number, in length units."""
        return complex(self.x, self.y)


class QuickReturnProblem(LinkageProblem):
    """Quick return: an output that swings or slides back and forth once in a turn of the crank, with a given time
    ratio.

    The time ratio is that of the slow stroke to the fast one. For each type the design with the maximum of the minimum
    transmission angle is returned, and others with shorter links that transmit less well; the time ratio is measured on
    the finished mechanism. If no design exists the answer reports the ratios that can be reached.

    Instead of a swing two positions of a body can be given, which the rocker carries from one to the other about their
    rotopole, with its limits there (Norton, Example 3-2).
    """

    model_config = ConfigDict(
        title="Quick return",
        json_schema_extra={
            "examples": [
                {"kind": "quick_return", "time_ratio": 1.25, "swing": 45.0, "mechanism": "fourbar"},
                {"kind": "quick_return", "time_ratio": 1.4, "stroke": 100.0, "mechanism": "auto"},
                {
                    "kind": "quick_return",
                    "time_ratio": 1.0,
                    "positions": [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 60.0, "y": 20.0, "angle": 50.0}],
                    "constraints": {"max_link_ratio": 5.0},
                },
                {
                    "kind": "quick_return",
                    "time_ratio": 1.4,
                    "stroke": 100.0,
                    "mechanism": "drag_link_slider",
                    "layout": {
                        "link_width": 10.0,
                        "pin_diameter": 5.0,
                        "thickness": 4.0,
                        "gap": 0.5,
                        "shafts": "both_sides",
                        "max_planes": 4,
                    },
                },
            ]
        },
    )

    kind: Literal["quick_return"]
    time_ratio: Annotated[float, Field(strict=True, ge=1.0, le=MAX_MAGNITUDE, allow_inf_nan=False)] = Field(
        description="Time of the slow stroke over time of the fast one."
    )
    swing: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=360.0), Sizable] | None = Field(
        default=None, description="Angle between the output's limit positions, degrees; for an output that swings."
    )
    stroke: PositiveLength | None = Field(
        default=None, description="Distance of the output's limit positions; for an output that slides."
    )
    positions: tuple[RockerPosition, RockerPosition] | None = Field(
        default=None,
        description="Positions of a body on the rocker of a crank-rocker, at its limits; they determine the swing, and "
        "their rotopole is the rocker's fixed pivot.",
    )
    rotopole: Point | None = Field(
        default=None,
        description="Required place of the rocker's fixed pivot; with positions, their rotopole.",
    )
    mechanism: Literal[QuickReturnType, "auto"] = Field(
        default="auto", description="`auto` compares all types with such an output that can reach the ratio."
    )
    rocker_length: PositiveLength | None = Field(
        default=None,
        description="Distance from the output's fixed pivot to its pin, for an output that swings. By default 1, or a "
        "value that puts links and pivots within `link_length` and regions, or the body's distance from the rotopole.",
    )
    crank_pivot: Point | None = Field(
        default=None,
        description="Required place of the crank's fixed pivot O2; without it and a rotopole, (0, 0) or a place within "
        "the regions.",
    )
    ground_angle: Degrees | None = Field(
        default=None,
        description="Angle of the line O2 → O4 if the output swings, or of the slide; degrees. By default 0; if O2 is "
        "left out too, chosen to satisfy the regions.",
    )

    @property
    def slides(self) -> bool:
        """Whether the output is a slider."""
        return self.stroke is not None

    @property
    def types(self) -> tuple[QuickReturnType, ...]:
        """The requested types."""
        if self.mechanism != "auto":
            return (self.mechanism,)
        if self.positions is not None:
            return ("fourbar",)
        return ROCKER_TYPES if self.swing is not None else SLIDER_TYPES

    @property
    def o2(self) -> complex:
        """The crank's fixed pivot, unless a rotopole determines it."""
        return complex(*(self.crank_pivot or (0.0, 0.0)))

    @property
    def direction(self) -> float:
        """The given angle of the ground line or of the slide, degrees; 0 by default."""
        return 0.0 if self.ground_angle is None else self.ground_angle

    @property
    def is_positioned(self) -> bool:
        """Whether the problem determines the place of the mechanism."""
        return self.crank_pivot is not None or self.rotopole is not None or self.positions is not None

    @property
    def rotation(self) -> float:
        """Rotation of the body from its first position to its second, degrees in [−180, 180]."""
        assert self.positions is not None
        first, second = self.positions
        return math.remainder(second.angle - first.angle, 360.0)

    @property
    def pole(self) -> complex | None:
        """The rotopole: the point that both positions of the body have in common, or the given one."""
        if self.positions is None:
            return None if self.rotopole is None else complex(*self.rotopole)
        first, second = (position.point for position in self.positions)
        turn = math.radians(self.rotation)
        # From the midpoint of both points, perpendicular to their distance by cot(β/2) times half of it.
        return 0.5 * (first + second) + 0.5j * (second - first) / math.tan(0.5 * turn)

    @property
    def swing_angle(self) -> float | None:
        """The swing, given or that of the positions; degrees."""
        return self.swing if self.positions is None else abs(self.rotation)

    @property
    def link_ratio_limit(self) -> float | None:
        """Maximum ratio of the longest to the shortest link, or None.

        It is the given one, or follows from the limits of the lengths if the size is free.
        """
        limits = [self.constraints.max_link_ratio] if self.constraints.max_link_ratio is not None else []
        lengths = self.constraints.link_length
        # With a free size only the ratio of both limits matters.
        if lengths is not None and self.rocker_length is None and lengths.max is not None and lengths.min > 0.0:
            limits.append(lengths.max / lengths.min)
        return min(limits, default=None)

    def compute_scale(self, shortest: float, longest: float, rocker: float) -> float:
        """Return the scale of a linkage that swings, from its shortest and longest link and its rocker."""
        lengths = self.constraints.link_length
        if self.rocker_length is not None:
            return self.rocker_length / rocker
        pole = self.pole
        # The body lies at the rocker's end by default.
        if self.positions is not None and pole is not None and abs(self.positions[0].point - pole) > 0.0:
            return abs(self.positions[0].point - pole) / rocker
        # Make the linkage as large as permitted: smaller links would only violate the minimum.
        if lengths is not None and lengths.max is not None:
            return lengths.max / longest
        return lengths.min / shortest if lengths is not None and lengths.min > 0.0 else 1.0 / rocker

    def find_contradictions(self) -> list[Contradiction]:
        """Return outputs that the requested type does not have, and requests that exclude one another."""
        if self.positions is not None:
            return [*self._find_position_contradictions(), *self._find_class_contradictions()]
        contradictions = []
        if self.rotopole is not None and (self.stroke is not None or self.mechanism in SLIDER_TYPES):
            contradictions.append(Contradiction("/rotopole", compose("quick_return-slider-with-rotopole")))
        elif self.rotopole is not None and self.mechanism != "fourbar":
            contradictions.append(Contradiction("/rotopole", compose("quick_return-rotopole-for-crank-rocker-only")))
        if self.rotopole is not None and self.crank_pivot is not None:
            contradictions.append(Contradiction("/crank_pivot", compose("quick_return-crank-pivot-with-rotopole")))
        if self.mechanism == "auto" and (self.swing is None) == (self.stroke is None):
            message = "quick_return-no-output" if self.swing is None else "quick_return-two-outputs"
            contradictions.append(Contradiction("/swing", compose(message)))
        if self.mechanism in ROCKER_TYPES:
            contradictions += self._check_output(
                "swing", "stroke", "quick_return-swing-missing", "quick_return-stroke-of-rocker"
            )
        if self.mechanism in SLIDER_TYPES:
            contradictions += self._check_output(
                "stroke", "swing", "quick_return-stroke-missing", "quick_return-swing-of-slider"
            )
        return [*contradictions, *self._find_class_contradictions()]

    def _find_class_contradictions(self) -> list[Contradiction]:
        """Return classes of fourbars that the types do not have."""
        classes = {GRASHOF_CLASSES[name] for name in self.types if name in GRASHOF_CLASSES}
        reason = compose(CLASS_MESSAGES[frozenset(classes)])
        return [*self.constraints.find_class_contradictions(classes, reason), *self.find_contradicting_constraints()]

    def _find_position_contradictions(self) -> list[Contradiction]:
        """Return requests that two positions of a body exclude."""
        contradictions = []
        for name in ("swing", "stroke", "crank_pivot"):
            if getattr(self, name) is not None:
                contradictions.append(
                    Contradiction(f"/{name}", compose("quick_return-field-with-positions", field=name))
                )
        if self.mechanism not in ("fourbar", "auto"):
            contradictions.append(Contradiction("/mechanism", compose("quick_return-body-needs-fourbar")))
        if abs(self.rotation) < MIN_ROTATION:
            detail = compose("quick_return-body-does-not-turn")
            return [*contradictions, Contradiction("/positions/1/angle", detail)]
        pole = self.pole
        assert pole is not None
        assert self.positions is not None
        if self.rotopole is not None:
            reach = max(abs(position.point - pole) for position in self.positions)
            if abs(complex(*self.rotopole) - pole) > POLE_TOLERANCE * max(reach, abs(pole)):
                detail = compose("quick_return-rotopole-differs", x=f"{pole.real:.9g}", y=f"{pole.imag:.9g}")
                contradictions.append(Contradiction("/rotopole", detail))
        return contradictions

    def _check_output(self, wanted: str, other: str, missing: str, superfluous: str) -> list[Contradiction]:
        """Return the messages ``missing`` and ``superfluous`` at the field that is wanted and at the other."""
        contradictions = []
        if getattr(self, wanted) is None:
            contradictions.append(Contradiction(f"/{wanted}", compose(missing, mechanism=self.mechanism)))
        if getattr(self, other) is not None:
            contradictions.append(Contradiction(f"/{other}", compose(superfluous, mechanism=self.mechanism)))
        return contradictions
