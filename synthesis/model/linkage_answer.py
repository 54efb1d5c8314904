"""Linkages as answers: dimensions that their users know them by, the skeleton, and what was measured on them.

The numbers of a mechanism are dimensions only; what was measured on it stands beside it in ``targets``,
``verification`` and ``metrics``.
"""

from __future__ import annotations

from typing import Annotated, Generic, Literal, TypeVar

from pydantic import ConfigDict, Discriminator, Field

from synthesis.model.answer import Answer, Point, Result, Verification, optional
from synthesis.model.dimension import Angle, Length
from synthesis.model.forces_answer import DesignForces
from synthesis.model.manufacture_answer import MANUFACTURE, Manufactured, Yield

_BODY_ANGLE = optional(
    "Angle of the body's line at the first target, absolute, degrees; left out where it is the demanded one exactly."
)
"""The same field of every mechanism that carries a body."""


class Link(Answer):
    """A rigid link and the joints on it."""

    name: str
    joints: list[str]


class Slide(Answer):
    """A joint that stays on a line fixed in a link; the line is given in the reference configuration."""

    joint: str
    link: str
    point: Point
    angle: Angle


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

    ground: Length
    input: Length
    coupler: Length
    output: Length


class CouplerPoint(Answer):
    """P on the coupler: distance from A, and angle from the line A → B to the line A → P, degrees."""

    distance: Length
    angle: Angle


class FourbarMechanism(Answer):
    """A pin-jointed fourbar. ``open``: B lies to the left of the directed line from A to O4; ``crossed``: right."""

    type: Literal["fourbar"] = "fourbar"
    fixed_pivots: FixedPivots
    links: FourbarLinks
    coupler_point: CouplerPoint
    assembly: Literal["open", "crossed"]
    reference_input_angle: Angle = Field(description="Input angle at the first target, absolute, degrees.")
    reference_body_angle: Angle | None = _BODY_ANGLE
    skeleton: Skeleton


class Line(Answer):
    """A line in the plane: a point of it and its angle, degrees."""

    point: Point
    angle: Angle


class SliderCrankLinks(Answer):
    """Link lengths of a slider-crank."""

    crank: Length
    coupler: Length


class SliderCrankMechanism(Answer):
    """A slider-crank whose coupler carries the body: pin A on the crank, pin B on the slide.

    ``open``: B is the farther along the slide's direction of the two places that the coupler reaches.
    """

    type: Literal["slider_crank"] = "slider_crank"
    fixed_pivot: Point
    links: SliderCrankLinks
    slide: Line = Field(description="The line of pin B on the ground.")
    offset: Length = Field(
        description="Distance of the fixed pivot from the slide's line, positive where the pivot is to the line's left."
    )
    coupler_point: CouplerPoint
    assembly: Literal["open", "crossed"]
    driven_by: Literal["crank", "slider"]
    reference_input_angle: Angle = Field(description="Crank angle at the first target, absolute, degrees.")
    reference_body_angle: Angle | None = _BODY_ANGLE
    skeleton: Skeleton


class InvertedLinks(Answer):
    """Link lengths of an inverted slider-crank; ``output`` is from O4 to B, the foot of O4 on the line of pin A."""

    ground: Length
    input: Length
    output: Length


class BlockSlide(Answer):
    """The line on which pin A moves in the block: through B, parallel to the body's line that the block guides."""

    link: Literal["output"] = "output"
    angle: Angle = Field(description="Angle of the line from the line O4 → B, degrees.")


class InvertedSliderCrankMechanism(Answer):
    """An inverted slider-crank whose coupler carries the body: pin A on the input, and a line through a block at O4.

    ``coupler_point`` is P: its distance from A, and the angle from the line A → O4 to the line A → P at the first
    target. ``open``: A lies ahead of B in the line's direction, ``crossed``: behind.
    """

    type: Literal["inverted_slider_crank"] = "inverted_slider_crank"
    fixed_pivots: FixedPivots
    links: InvertedLinks
    slide: BlockSlide
    coupler_point: CouplerPoint
    assembly: Literal["open", "crossed"]
    reference_input_angle: Angle = Field(description="Input angle at the first target, absolute, degrees.")
    reference_body_angle: Angle | None = _BODY_ANGLE
    skeleton: Skeleton


class FivebarLinks(Answer):
    """Link lengths of a geared fivebar; ``output`` is the geared crank at the other fixed pivot."""

    ground: Length
    input: Length
    coupler_1: Length
    coupler_2: Length
    output: Length


class GearedFivebarMechanism(Answer):
    """A geared fivebar: cranks O2–A and O5–B, geared to one another, and couplers A–C (with P) and B–C.

    ``open``: C lies to the left of the directed line from A to B.
    """

    type: Literal["geared_fivebar"] = "geared_fivebar"
    fixed_pivots: FixedPivots = Field(description="O2 (input) and O5 (output).")
    links: FivebarLinks
    gear_ratio: float = Field(description="Rotation of the output over that of the input.")
    phase: Angle = Field(description="Output angle from the ground line when the input lies along it, degrees.")
    coupler_point: CouplerPoint = Field(description="P on coupler 1: its angle is from the line A → C.")
    assembly: Literal["open", "crossed"]
    reference_input_angle: Angle = Field(description="Input angle at the first target, absolute, degrees.")
    reference_body_angle: Angle | None = _BODY_ANGLE
    skeleton: Skeleton


class SixbarMechanism(Answer):
    """A sixbar of Watt's or Stephenson's chain, by its skeleton.

    A fourbar with a driver dyad: crank O6–D and link D–C, where C is a point of the driven link; a Watt II sixbar, two
    fourbars in series, where input or output is driven, a Stephenson III sixbar where the coupler is. Or a linkage that
    carries the body by a link that is joined neither to the ground nor to the fourbar alone: the one with P. Or a
    function generator, which has no P. ``links`` are lengths by name; the skeleton says all.
    """

    type: Literal["watt_1", "watt_2", "stephenson_1", "stephenson_2", "stephenson_3"]
    fixed_pivots: dict[str, Point] = Field(description="By the names of the joints: O2, O4, O6.")
    links: dict[str, Length] = Field(
        description="ground, input, coupler and output of the fourbar; crank and driver_coupler of the driver; "
        "driver_ground, its fixed pivot's distance from the driven link's (from O2 where the coupler is driven); "
        "driver_arm, C's distance from that pivot (from A where the coupler is driven). Without a driver: each link by "
        "its name, from its first pin to its second, and of links with three pins the distances from these to the "
        "third, with _arm and _side."
    )
    reference_body_angle: Angle | None = _BODY_ANGLE
    skeleton: Skeleton


LinkageMechanism = Annotated[
    FourbarMechanism | SliderCrankMechanism | InvertedSliderCrankMechanism | GearedFivebarMechanism | SixbarMechanism,
    Discriminator("type"),
]
"""Any linkage that an answer may hold; the field ``type`` tells which."""


class DrivenTo(Answer):
    """Where the input stands at a target: an input that turns at an angle, one that slides at a place of its line."""

    index: int
    input_angle: Angle | None = optional(
        "Absolute input angle, degrees, continuous along the motion from the first target; "
        "left out where the input slides."
    )
    input_place: Length | None = optional(
        "Place of an input that slides, along its line from the line's point, length units; "
        "left out where the input turns."
    )

    @property
    def at(self) -> float:
        """The input as an analysis takes it: degrees, or length units."""
        stated = self.input_place if self.input_angle is None else self.input_angle
        assert stated is not None
        return stated


class Target(DrivenTo):
    """One demanded position as the driven mechanism meets it."""

    residual: float = Field(
        description="Larger of the distance to the demanded point, as a share of the task's size, "
        "and the difference to the demanded angle in radians."
    )
    point_residual: Length = Field(description="Distance of P from the demanded point, length units.")
    angle_residual: Angle | None = optional(
        "Difference of the body's angle to the demanded angle, degrees, where an angle is demanded."
    )


class UsedRange(Answer):
    """The motion that a linkage was verified along, by its input."""

    used_range: tuple[Angle, Angle] | None = optional(
        "First and last input of the verified motion, absolute, degrees, continuous; left out where the input slides, "
        "and where no motion leads through the targets."
    )
    used_stroke: tuple[Length, Length] | None = optional(
        "The same of an input that slides: places along its line, length units; left out where it turns."
    )


class MotionMetrics(UsedRange):
    """What is measured of every driven linkage (:class:`synthesis.proof.measures.Measures`), whatever it is for.

    Angles are those of the motion that the design was verified along: from the first target to the last, or the whole
    turn of a crank that turns through. The size is that at the targets, where there are any.
    """

    grashof: (
        Literal["double_crank", "crank_rocker", "double_rocker", "rocker_crank", "rocker_rocker", "change_point"] | None
    ) = Field(description="Of the fourbar that the linkage is or contains; null for others.")
    barker: str | None = Field(description="Barker's code of that fourbar, e.g. GCRR.")
    min_transmission_angle: Angle = Field(description="Over the verified motion, degrees.")
    transmission_angles: dict[str, Angle] = Field(
        description="The least over that motion, degrees: at each dyad of links by the name of its first link, and at "
        "each leg of a triad (Stephenson II, and a fourbar driven at its coupler) by its name."
    )
    full_rotation: bool
    link_ratio: float = Field(description="Longest link over shortest.")
    reach: float | None = optional(
        "Greatest distance between two joints of one link, in sizes of the task (docs/ranking.md); left out where a "
        "task has no size."
    )
    size: Length = Field(
        description="Diagonal of the box around all joints and the point P at all targets; where there are none, over "
        "the verified motion."
    )
    quality: float = Field(description="Between 0 and 1; see docs/ranking.md.")


class LinkageMetrics(MotionMetrics):
    """Measured properties of a linkage that were not demanded."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True, serialize_by_alias=True)

    same_branch: bool
    visits_in_order: bool
    input_rotation: Angle | None = optional(
        "Rotation of the input from the first target to the last, degrees; left out where it slides."
    )
    input_stroke: Length | None = optional("The same of an input that slides, length units; left out where it turns.")
    input_travel: Angle | None = optional(
        "What the input turns over the used range, either way, degrees; of linkages that carry a body, where it turns."
    )
    body_travel_ratio: float | None = optional(
        "Length of P's path over the used range over that of the straight ways between its positions; of linkages that "
        "carry a body, where P moves."
    )
    body_turn_ratio: float | None = optional(
        "All that the body turns over the used range, to and fro, over the sum of the turns that are needed; of "
        "linkages that carry a body, where it is to turn."
    )
    rms_residual: float = Field(
        description="Root mean square over the targets of P's distance as a share of the task's size and, where an "
        "angle is demanded, its difference in radians, added in squares."
    )
    yield_: Yield | None = optional(
        "Share of the linkages made that are good, where the problem states tolerances and a quality.", alias="yield"
    )


class LayoutClash(Answer):
    """Two parts that meet in the planes of a layout, and where they come nearest."""

    parts: tuple[str, str] = Field(description="Links and gears by their names, a pin as `pin O2`, by its joint.")
    distance: Length = Field(description="Of the two, there; less than 0 where they overlap.")
    input_angle: Angle | None = optional("Degrees; left out where the input slides.")
    input_place: Length | None = optional("Of an input that slides, length units.")


class Layout(Answer):
    """A linkage laid out in planes (docs/layout.md)."""

    buildable: bool = Field(description="Whether nothing clashes over the whole motion.")
    planes: dict[str, int] = Field(
        description="Of each link and gear, from 1; the base is plane 0. Where not all of the motion is free, for the "
        "free part of it."
    )
    count: int = Field(description="The number of planes.")
    least: bool = Field(description="Whether it is proved that there is no way with fewer.")
    height: Length = Field(description="Of all planes, each with a gap below it.")
    pins: dict[str, tuple[int, int]] = Field(
        description="The lowest and the highest plane that each pin joins, by its joint; 0 is the base, and one more "
        "than there are planes the second base."
    )
    stub_shafts: list[str] = Field(
        description="Joints at which a shaft cannot pass all planes, because a link meets it."
    )
    crossings: list[tuple[str, str]] = Field(
        description="Links and gears that cross in the motion, and those that pass over pins, as far as no pin joins "
        "them."
    )
    clashes: list[LayoutClash] = Field(description="What these planes do not keep apart; empty where it is buildable.")
    free_range: tuple[Angle, Angle] | None = optional(
        "Inputs, degrees, between which nothing clashes, the longest such range: all of the motion where it is "
        "buildable. Left out where there is none, and where the input slides."
    )
    free_stroke: tuple[Length, Length] | None = optional("The same of an input that slides, places along its line.")
    remark: str | None = optional("Why there is no layout.")


LAYOUT = optional("The planes in which it can be built; left out where the problem states no `layout`.")
"""The same field of every design."""

PEAKS = optional("Its forces; left out where the problem states no `dynamics`.")
"""The same field of every design."""


class ExactDesign(Answer):
    """The design that a linkage on the grid of a shop stands for, as it was found."""

    mechanism: LinkageMechanism
    rms_residual: float = Field(description="As that of the metrics.")
    max_error: Length | None = optional("Greatest distance from a target.")
    max_angle_error: Angle | None = optional("Greatest difference of an angle at a target, degrees.")
    min_transmission_angle: Angle


EXACT = optional("The design before it was rounded; left out where `manufacture` states neither `round` nor `stock`.")
"""The same field of every design."""


class LinkageDesign(Answer):
    """A mechanism with the proof of what it does."""

    mechanism: LinkageMechanism
    targets: list[Target]
    verification: Verification
    metrics: LinkageMetrics
    layout: Layout | None = LAYOUT
    forces: DesignForces | None = PEAKS
    manufacture: Manufactured | None = MANUFACTURE
    exact: ExactDesign | None = EXACT


ERRORS = {
    "rms_structural_error": "rms_structural_error",
    "straightness_error": "straightness_error",
    "jitter": "jitter",
    "steering_error": "steering_error",
    "rms_residual": "rms",
}
"""How the error of a design is told: its field in the metrics, the first that there is, and its name in the front."""


class Front(Answer):
    """The trade-off between designs as data: those that no other beats.

    A design beats another that it is no worse than in any of the quantities and better than in one.
    """

    quantities: list[str] = Field(
        description="What is weighed up, by its field in the metrics: the error of the kind (rms for rms_residual) "
        "and the size, less is better; the least transmission angle, more is better."
    )
    designs: list[int] = Field(description="Indices of the designs that no other of the answer beats.")


Linkage = TypeVar("Linkage", bound=Answer)


class LinkageResult(Result[Linkage], Generic[Linkage]):
    """The answer to a problem of linkages, with the trade-off among its designs."""

    front: Front | None = optional(
        "Which of the designs nothing beats in all of these quantities; left out for fewer than two."
    )
