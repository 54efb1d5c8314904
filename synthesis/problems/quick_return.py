"""Quick return: a mechanism whose output goes slowly one way and fast the other, the crank at constant speed."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from synthesis.problems.base import ABSURD, Contradiction, Number, Point, PositiveNumber
from synthesis.problems.linkage import LinkageProblem

QuickReturnType = Literal[
    "fourbar", "drag_link_rocker", "drag_link_slider", "crank_shaper", "whitworth", "offset_slider_crank"
]

ROCKERS: tuple[QuickReturnType, ...] = ("fourbar", "drag_link_rocker")
"""Types whose output swings."""

SLIDERS: tuple[QuickReturnType, ...] = ("offset_slider_crank", "crank_shaper", "whitworth", "drag_link_slider")
"""Types whose output slides."""


class QuickReturnProblem(LinkageProblem):
    """Quick return: an output that swings or slides to and fro once in a turn of the crank, with a given time ratio.

    The time ratio is that of the slow stroke to the fast one. For each type the design with the greatest least
    transmission angle is given, and others with shorter links that transmit less well; the time ratio is measured on
    the finished mechanism. Where no design exists the answer says which ratios can be reached.
    """

    model_config = ConfigDict(
        title="Quick return",
        json_schema_extra={
            "examples": [
                {"kind": "quick_return", "time_ratio": 1.25, "swing": 45.0, "mechanism": "fourbar"},
                {"kind": "quick_return", "time_ratio": 1.4, "stroke": 100.0, "mechanism": "auto"},
            ]
        },
    )

    kind: Literal["quick_return"]
    time_ratio: Annotated[float, Field(strict=True, ge=1.0, le=ABSURD, allow_inf_nan=False)] = Field(
        description="Time of the slow stroke over time of the fast one."
    )
    swing: Annotated[float, Field(strict=True, gt=0.0, lt=360.0)] | None = Field(
        default=None, description="Angle between the output's limit positions, degrees; for an output that swings."
    )
    stroke: PositiveNumber | None = Field(
        default=None, description="Distance of the output's limit positions; for an output that slides."
    )
    mechanism: Literal[QuickReturnType, "auto"] = Field(
        default="auto", description="`auto` compares all types that have such an output and can reach the ratio."
    )
    rocker_length: PositiveNumber | None = Field(
        default=None,
        description="Distance from the output's fixed pivot to its pin, for an output that swings; left out it is 1, "
        "or what puts the links within the limits of `link_length`.",
    )
    crank_pivot: Point = Field(default=(0.0, 0.0), description="Where the crank's fixed pivot O2 shall be.")
    ground_angle: Number = Field(
        default=0.0, description="Angle of the line O2 → O4 where the output swings, or of the slide; degrees."
    )
    rank_by: Literal["quality", "accuracy", "size", "transmission_angle"] = "transmission_angle"

    @property
    def types(self) -> tuple[QuickReturnType, ...]:
        """The types that are asked for."""
        if self.mechanism != "auto":
            return (self.mechanism,)
        return ROCKERS if self.swing is not None else SLIDERS

    @property
    def link_ratio_limit(self) -> float | None:
        """Longest link over shortest at most: as stated, or as limits of length imply where the size is free."""
        limits = [self.constraints.max_link_ratio] if self.constraints.max_link_ratio is not None else []
        lengths = self.constraints.link_length
        if lengths is not None and self.rocker_length is None and lengths.max is not None and lengths.min > 0.0:
            limits.append(lengths.max / lengths.min)
        return min(limits, default=None)

    def scaled(self, shortest: float, longest: float, rocker: float) -> float:
        """The scale of a linkage that swings, by its shortest and longest link and its rocker."""
        lengths = self.constraints.link_length
        if self.rocker_length is not None:
            return self.rocker_length / rocker
        if lengths is not None and lengths.max is not None:
            return lengths.max / longest
        return lengths.min / shortest if lengths is not None and lengths.min > 0.0 else 1.0 / rocker

    def contradictions(self) -> list[Contradiction]:
        """An output that is not the type's, and demands that exclude one another."""
        found = []
        if self.mechanism == "auto" and (self.swing is None) == (self.stroke is None):
            which = "neither" if self.swing is None else "both"
            found.append(Contradiction("/swing", f"state the swing or the stroke of the output; {which} is given"))
        if self.mechanism in ROCKERS:
            found += self._one("swing", "stroke", "swings")
        if self.mechanism in SLIDERS:
            found += self._one("stroke", "swing", "slides")
        return [*found, *self.constraints.contradictions()]

    def _one(self, wanted: str, other: str, does: str) -> list[Contradiction]:
        found = []
        if getattr(self, wanted) is None:
            found.append(Contradiction(f"/{wanted}", f"the output of a {self.mechanism} {does}: state its {wanted}"))
        if getattr(self, other) is not None:
            found.append(Contradiction(f"/{other}", f"the output of a {self.mechanism} {does}; leave the {other} out"))
        return found
