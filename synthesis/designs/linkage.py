"""Linkages as answers: dimensions that their users know them by, the skeleton, and what was measured on them.

The numbers of a mechanism are dimensions only; what was measured on it stands beside it in ``targets``,
``verification`` and ``metrics``.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.designs.base import Answer, Point, Verification


class Link(Answer):
    """A rigid link and the joints on it."""

    name: str
    joints: list[str]


class Slide(Answer):
    """A joint that stays on a line fixed in a link; the line is given in the reference configuration."""

    joint: str
    link: str
    point: Point
    angle: float


class GearPair(Answer):
    """Rotation of the second link = ratio × rotation of the first, both relative to ground."""

    links: tuple[str, str]
    ratio: float


class Skeleton(Answer):
    """The configuration at the first target, from which the mechanism can be rebuilt with rigid links alone."""

    joints: dict[str, Point]
    links: list[Link]
    slides: list[Slide] = Field(default=[])
    gears: list[GearPair] = Field(default=[])
    input_link: str


class FixedPivots(Answer):
    """Fixed pivots O2 (input) and O4 (output)."""

    input: Point
    output: Point


class FourbarLinks(Answer):
    """Link lengths; Norton's d, a, b, c."""

    ground: float
    input: float
    coupler: float
    output: float


class CouplerPoint(Answer):
    """P on the coupler: distance from A, and angle from the line A → B to the line A → P, degrees."""

    distance: float
    angle: float


class FourbarMechanism(Answer):
    """A pin-jointed fourbar. ``open``: B lies to the left of the directed line from A to O4; ``crossed``: right."""

    type: Literal["fourbar"] = "fourbar"
    fixed_pivots: FixedPivots
    links: FourbarLinks
    coupler_point: CouplerPoint
    assembly: Literal["open", "crossed"]
    reference_input_angle: float = Field(description="Input angle at the first target, absolute, degrees.")
    skeleton: Skeleton


class Target(Answer):
    """One demanded position as the driven mechanism meets it."""

    index: int
    input_angle: float = Field(
        description="Absolute input angle, degrees, continuous along the motion from the first target."
    )
    residual: float = Field(
        description="Larger of the distance to the demanded point, as a share of the task's size, "
        "and the difference to the demanded angle in radians."
    )


class LinkageMetrics(Answer):
    """Measured properties of a linkage that were not demanded."""

    grashof: Literal["double_crank", "crank_rocker", "double_rocker", "rocker_crank", "rocker_rocker", "change_point"]
    barker: str = Field(description="Barker's code, e.g. GCRR.")
    min_transmission_angle: float = Field(description="Over the used range of the input, degrees.")
    same_branch: bool
    visits_in_order: bool
    full_rotation: bool
    input_rotation: float = Field(description="Rotation of the input from the first target to the last, degrees.")
    link_ratio: float = Field(description="Longest link over shortest.")
    size: float = Field(description="Diagonal of the box around all joints and the point P at all targets.")
    quality: float = Field(description="Between 0 and 1; see docs/ranking.md.")


class LinkageDesign(Answer):
    """A mechanism with the proof of what it does."""

    mechanism: FourbarMechanism
    targets: list[Target]
    verification: Verification
    metrics: LinkageMetrics
