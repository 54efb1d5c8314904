"""Models of linkages in answers: usual dimensions, skeleton, and measured properties.

A mechanism contains dimensions only. Its measured properties are in ``targets``, ``verification`` and ``metrics``.
"""

from __future__ import annotations

from typing import Annotated, Generic, Literal, TypeVar

from pydantic import ConfigDict, Discriminator, Field

from synthesis.model.answer import Answer, Point, Result, Verification, optional_field
from synthesis.model.dimension import Angle, Length
from synthesis.model.dynamics.peak_forces import DesignForces
from synthesis.model.manufacture.answer import MANUFACTURE_FIELD, ManufactureReport, Yield

PARALLEL_TOLERANCE = 1e-6
"""Difference of two opposite links, as a share of their length, below which they count as equal and parallel."""

_BODY_ANGLE_FIELD = optional_field(
    "Absolute angle of the body's line at the first target, degrees; left out if it equals the requested angle exactly."
)
"""Field that all mechanisms that carry a body share."""


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
    """Configuration at the first target, from which the mechanism can be rebuilt with rigid links alone."""

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
    reference_body_angle: Angle | None = _BODY_ANGLE_FIELD
    skeleton: Skeleton

    @property
    def is_parallelogram(self) -> bool:
        """Whether opposite links are equal and parallel, so that the coupler does not turn."""
        o2, a, b, o4 = (complex(*self.skeleton.joints[name]) for name in ("O2", "A", "B", "O4"))
        return abs((b - a) - (o4 - o2)) <= PARALLEL_TOLERANCE * abs(o4 - o2)


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

    ``open``: of the two positions that the coupler reaches, B is the one farther along the slide's direction.
    """

    type: Literal["slider_crank"] = "slider_crank"
    fixed_pivot: Point
    links: SliderCrankLinks
    slide: Line = Field(description="The line of pin B on the ground.")
    offset: Length = Field(
        description="Distance of the fixed pivot from the slide's line, positive if the pivot lies left of the line."
    )
    coupler_point: CouplerPoint
    assembly: Literal["open", "crossed"]
    driven_by: Literal["crank", "slider"]
    reference_input_angle: Angle = Field(description="Crank angle at the first target, absolute, degrees.")
    reference_body_angle: Angle | None = _BODY_ANGLE_FIELD
    skeleton: Skeleton


class InvertedLinks(Answer):
    """Link lengths of an inverted slider-crank; ``output`` is from O4 to B, the foot of O4 on the line of pin A."""

    ground: Length
    input: Length
    output: Length


class BlockSlide(Answer):
    """Line on which pin A moves in the block: through B, parallel to the line of the body that the block guides."""

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
    reference_body_angle: Angle | None = _BODY_ANGLE_FIELD
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
    gear_ratio: float = Field(description="Rotation of the output over rotation of the input.")
    phase: Angle = Field(description="Output angle from the ground line when the input lies along it, degrees.")
    coupler_point: CouplerPoint = Field(description="P on coupler 1: its angle is from the line A → C.")
    assembly: Literal["open", "crossed"]
    reference_input_angle: Angle = Field(description="Input angle at the first target, absolute, degrees.")
    reference_body_angle: Angle | None = _BODY_ANGLE_FIELD
    skeleton: Skeleton


class MultiloopMechanism(Answer):
    """A linkage of several loops, which only its skeleton describes completely."""

    type: str
    fixed_pivots: dict[str, Point] = Field(description="By the names of the joints: O2, O4, O6, O8.")
    links: dict[str, Length] = Field(
        description="The length of each link between its first two pins, by its name; for further pins also their "
        "distances from the first and from the second, by names ending in _arm and _side, or _arm_2 and _side_2."
    )
    reference_body_angle: Angle | None = _BODY_ANGLE_FIELD
    skeleton: Skeleton


class EightbarMechanism(MultiloopMechanism):
    """An eightbar: a fourbar O2 A B O4 and two dyads, each joined to two earlier links; one of these may be ground."""

    type: Literal["eightbar"] = "eightbar"


class SixbarMechanism(MultiloopMechanism):
    """A sixbar of Watt's or Stephenson's chain, described by its skeleton.

    It is one of three designs. First, a fourbar with a driver dyad: crank O6–D and link D–C, where C is a point of the
    driven link. This is a Watt II sixbar (two fourbars in series) if the input or output is driven, and a Stephenson
    III sixbar if the coupler is driven. Second, a linkage in which a link that is joined neither to the ground nor to
    the fourbar alone carries the body; this link has P. Third, a function generator, which has no P. ``links`` holds
    lengths by name; only the skeleton is a complete description.
    """

    type: Literal["watt_1", "watt_2", "stephenson_1", "stephenson_2", "stephenson_3"]
    fixed_pivots: dict[str, Point] = Field(description="By the names of the joints: O2, O4, O6.")
    links: dict[str, Length] = Field(
        description="ground, input, coupler and output of the fourbar; crank and driver_coupler of the driver; "
        "driver_ground, the distance of its fixed pivot from the driven link's (from O2 if the coupler is driven); "
        "driver_arm, the distance of C from that pivot (from A if the coupler is driven). Without a driver: the length "
        "of each link between its first two pins, by its name; for links with three pins also their distances from the "
        "third, by names ending in _arm and _side."
    )


LinkageMechanism = Annotated[
    FourbarMechanism
    | SliderCrankMechanism
    | InvertedSliderCrankMechanism
    | GearedFivebarMechanism
    | SixbarMechanism
    | EightbarMechanism,
    Discriminator("type"),
]
"""Any linkage that an answer may contain, identified by its field ``type``."""


class TargetInput(Answer):
    """Input at a target: an angle if the input rotates, a position along its line if it slides."""

    index: int
    input_angle: Angle | None = optional_field(
        "Absolute input angle, degrees, continuous along the motion from the first target; "
        "left out if the input slides."
    )
    input_place: Length | None = optional_field(
        "Position of a sliding input along its line, from the line's point, length units; "
        "left out if the input rotates."
    )

    @property
    def position(self) -> float:
        """The input, degrees or length units."""
        stated = self.input_place if self.input_angle is None else self.input_angle
        assert stated is not None
        return stated


class Target(TargetInput):
    """Input and errors of the driven mechanism at one requested position."""

    residual: float = Field(
        description="Larger of two errors: the distance from the requested point as a share of the task's size, "
        "and the difference from the requested angle in radians."
    )
    point_residual: Length = Field(description="Distance of P from the requested point, length units.")
    angle_residual: Angle | None = optional_field(
        "Difference between the body's angle and the requested angle, degrees, if an angle is requested."
    )


class UsedRange(Answer):
    """Range of the input over which a linkage was verified."""

    used_range: tuple[Angle, Angle] | None = optional_field(
        "First and last input angle of the verified motion, absolute, degrees, continuous; left out if the input "
        "slides or if no motion passes through the targets."
    )
    used_stroke: tuple[Length, Length] | None = optional_field(
        "First and last position of a sliding input along its line, length units; left out if the input rotates."
    )


class BuildMetrics(UsedRange):
    """Measures of whether a linkage can be built (docs/methods/ranking.md), and the motion over which it was verified.

    They hold for the motion for which parts are made: the full cycle of an input that turns through, otherwise the
    verified motion, unless `layout.over` requests one of the two.
    """

    min_pin_distance: Length | None = optional_field(
        "Minimum distance of two different pins of one link or of the ground, length units."
    )
    max_link_width: Length | None = optional_field(
        "Maximum width of the links, with pins as wide, for which the linkage can be arranged in planes, length units; "
        "0 if no arrangement in planes exists. Left out if the linkage has too many plates to arrange."
    )
    relative_link_width: float | None = optional_field(
        "`max_link_width` divided by the longest distance of two joints of one link. Below 0.02 a design counts as one "
        "that cannot be built."
    )


class MotionMetrics(BuildMetrics):
    """Measured properties of every driven linkage (:class:`synthesis.verification.measures.Measures`), for every task.

    Angles refer to the motion over which the design was verified: from the first target to the last, or the whole turn
    of a crank that rotates fully. The size is measured at the targets, if there are any.
    """

    grashof: (
        Literal["double_crank", "crank_rocker", "double_rocker", "rocker_crank", "rocker_rocker", "change_point"] | None
    ) = Field(description="Class of the fourbar that the linkage is or contains; null for other linkages.")
    barker: str | None = Field(description="Barker's code of that fourbar, e.g. GCRR.")
    min_transmission_angle: Angle = Field(description="Minimum transmission angle over the verified motion, degrees.")
    transmission_angles: dict[str, Angle] = Field(
        description="Minimum over that motion, degrees, at each dyad by the name of its first link, and at "
        "each leg of a triad (Stephenson II, and a fourbar driven at its coupler) by its name."
    )
    full_rotation: bool
    link_ratio: float = Field(description="Longest link over shortest link.")
    reach: float | None = optional_field(
        "Maximum distance between two joints of one link, in sizes of the task (docs/methods/ranking.md); left out if "
        "the task has no size."
    )
    size: Length = Field(
        description="Diagonal of the box around all joints and the point P at all targets; without targets, over "
        "the verified motion."
    )
    quality: float = Field(description="Between 0 and 1; see docs/methods/ranking.md.")


class LinkageMetrics(MotionMetrics):
    """Measured properties of a linkage beyond its checks."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True, serialize_by_alias=True)

    same_branch: bool
    visits_in_order: bool
    input_rotation: Angle | None = optional_field(
        "Rotation of the input from the first target to the last, degrees; left out if the input slides."
    )
    input_stroke: Length | None = optional_field(
        "Displacement of a sliding input from the first target to the last, length units; left out if it rotates."
    )
    input_travel: Angle | None = optional_field(
        "Total rotation of the input over the used range, degrees; only for linkages that carry a body and have a "
        "rotating input."
    )
    body_travel_ratio: float | None = optional_field(
        "Length of P's path over the used range, divided by the sum of the straight distances between its positions; "
        "only for linkages that carry a body whose P moves."
    )
    body_turn_ratio: float | None = optional_field(
        "Total rotation of the body over the used range, back and forth, divided by the sum of the required rotations; "
        "only for linkages that carry a body that has to rotate."
    )
    rms_residual: float = Field(
        description="Root mean square residual over the targets. A target's residual combines in squares the distance "
        "of P as a share of the task's size and, if an angle is requested, its error in radians."
    )
    yield_: Yield | None = optional_field(
        "Share of manufactured linkages that are good, if the problem gives tolerances and a quality.", alias="yield"
    )


class LayoutClash(Answer):
    """Two parts that collide in the planes of a layout, and the input at which they are closest."""

    parts: tuple[str, str] = Field(description="Names of links or gears; a pin is named by its joint, as in `pin O2`.")
    distance: Length = Field(
        description="Distance of the parts there; negative if they overlap. If their cores cross, it is minus the sum "
        "of their half widths, which does not measure how deep they overlap."
    )
    input_angle: Angle | None = optional_field("Degrees; left out if the input slides.")
    input_place: Length | None = optional_field("Position of a sliding input, length units.")


class Layout(Answer):
    """Arrangement of a linkage in planes (docs/mechanisms/layout.md)."""

    buildable: bool = Field(description="Whether no parts collide over the whole motion.")
    planes: dict[str, int] = Field(
        description="Plane of each link and gear, from 1; the base is plane 0. If parts collide, the planes hold for "
        "the free part of the motion."
    )
    count: int = Field(description="The number of planes.")
    least: bool = Field(description="Whether the number of planes is proved to be the minimum.")
    height: Length = Field(description="Height of all planes, each with a gap below it.")
    pins: dict[str, tuple[int, int]] = Field(
        description="Lowest and highest plane that each pin joins, by its joint; 0 is the base, and `count` + 1 the "
        "second base."
    )
    stub_shafts: list[str] = Field(description="Joints at which a shaft cannot pass all planes because a link hits it.")
    crossings: list[tuple[str, str]] = Field(
        description="Pairs of links and gears that cross during the motion or pass over each other's pins, unless a "
        "pin joins them."
    )
    clashes: list[LayoutClash] = Field(
        description="Collisions that remain in these planes; empty if the linkage is buildable."
    )
    free_range: tuple[Angle, Angle] | None = optional_field(
        "Longest range of the input without collisions, degrees: the whole motion if the linkage is buildable. Left "
        "out if there is none or the input slides."
    )
    free_stroke: tuple[Length, Length] | None = optional_field(
        "Longest range of a sliding input without collisions, positions along its line."
    )
    remark: str | None = optional_field("Reason why there is no layout.")


LAYOUT_FIELD = optional_field("Arrangement in planes; left out if the problem has no `layout`.")
"""Field that all designs share."""

PEAKS_FIELD = optional_field("Peak forces of the design; left out if the problem has no `dynamics`.")
"""Field that all designs share."""


class ExactDesign(Answer):
    """The design as found, before it was rounded to the grid of a shop."""

    mechanism: LinkageMechanism
    rms_residual: float = Field(description="Root mean square residual, defined as in the metrics.")
    max_error: Length | None = optional_field("Maximum distance from a target.")
    max_angle_error: Angle | None = optional_field("Maximum difference of an angle at a target, degrees.")
    min_transmission_angle: Angle


EXACT_FIELD = optional_field("The design before rounding; left out if `manufacture` has neither `round` nor `stock`.")
"""Field that all designs share."""


class LinkageDesign(Answer):
    """A mechanism with its verified behaviour."""

    mechanism: LinkageMechanism
    targets: list[Target]
    verification: Verification
    metrics: LinkageMetrics
    layout: Layout | None = LAYOUT_FIELD
    forces: DesignForces | None = PEAKS_FIELD
    manufacture: ManufactureReport | None = MANUFACTURE_FIELD
    exact: ExactDesign | None = EXACT_FIELD


ERROR_FIELDS = {
    "rms_structural_error": "rms_structural_error",
    "straightness_error": "straightness_error",
    "jitter": "jitter",
    "steering_error": "steering_error",
    "rms_residual": "rms",
}
"""Names of errors in the Pareto front, by field of the metrics. The first field that a design has is its error."""


class Front(Answer):
    """Pareto front of the designs: those that no other dominates.

    A design dominates another if it is no worse in any of the quantities and better in one.
    """

    quantities: list[str] = Field(
        description="Quantities that are compared, by field of the metrics: the error of the kind (rms for "
        "rms_residual) and the size, to be minimized; the minimum transmission angle, to be maximized."
    )
    designs: list[int] = Field(description="Indices of the designs that no other design of the answer dominates.")


Linkage = TypeVar("Linkage", bound=Answer)


class LinkageResult(Result[Linkage], Generic[Linkage]):
    """The answer to a problem of linkages, with the Pareto front of its designs."""

    front: Front | None = optional_field("Pareto front of the designs; left out for fewer than two.")
