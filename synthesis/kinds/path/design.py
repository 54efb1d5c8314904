"""Results of path generation problems."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, optional_field
from synthesis.model.dimension import Angle, Area, Length
from synthesis.model.linkage.answer import FourbarMechanism, LinkageDesign, LinkageMetrics, LinkageResult


class CognateTriples(Answer):
    """Account of the 1442 triples of cognate fourbars through nine points, over all rounds."""

    rounds: int = Field(description="Sets of nine points that were solved; 1 if nine were given.")
    computed: int = Field(description="Triples found, real and complex; 1442 per round if none is missing.")
    real: int
    on_one_circuit: int = Field(description="Real triples with all required points on one circuit.")
    largest_residual: float = Field(description="Largest residual of the equations, with points of unit mean distance.")
    closed_under_conjugation: bool = Field(description="Whether complex solutions come in pairs, as they must.")


class PathMetrics(LinkageMetrics):
    """Measured properties of a linkage that guides a point, with its errors in length units."""

    sum_of_squares: Area = Field(description="Sum of squared distances of P from the points, length units squared.")
    rms_distance: Length = Field(description="Root mean square of these distances, length units.")
    max_distance: Length = Field(description="Largest of these distances, length units.")
    curve_distance: Length | None = optional_field(
        "For fits: the largest distance of the traced curve from the straight lines through the points, over a full "
        "turn if these are closed, else from the first point to the last; length units."
    )
    excursion: Length | None = optional_field(
        "For fits: how far the traced curve strays from these lines beyond max_distance and the bulge that a curve may "
        "have between points, a quarter of their distance; length units."
    )
    both_way_rms: Length | None = optional_field(
        "For fits by sixbars and eightbars to 24 points or more: root mean square of the points' distances from the "
        "curve and of the curve's, weighted by its length, from the straight lines through the points; length units."
    )
    stance_flatness: Length | None = optional_field(
        "Height, across the stance line, of the band in which P stays from the first point of a stance to its last; "
        "length units."
    )
    stance_speed_deviation: float | None = optional_field(
        "Largest deviation of P's speed along the stance line from its mean, as a share of the mean, at constant "
        "input speed."
    )
    stance_rotation: Angle | None = optional_field("Rotation of the input during the stance, degrees.")


class CurvePlacement(Answer):
    """Where a matched curve is traced, if not where it was drawn: scaled and rotated about the origin, then shifted."""

    size: float
    rotation: Angle = Field(description="Degrees.")
    shift: Point


class PathCognate(Answer):
    """Another fourbar that traces the same curve (Roberts and Chebyshev), measured at the design's targets.

    The left cognate shares the input's fixed pivot with the design, the right one the output's.
    """

    side: Literal["left", "right"]
    mechanism: FourbarMechanism
    grashof: str
    full_rotation: bool
    same_timing: bool = Field(description="Its input turns with the design's input, so that crank angles are kept.")
    same_branch: bool = Field(description="Its own input drives it through all targets without a toggle.")
    visits_in_order: bool
    min_transmission_angle: Angle = Field(description="Over the used range of its own input, degrees.")
    deviation: Length = Field(description="Largest distance of its P from the design's at the targets, length units.")


class PathDesign(LinkageDesign):
    """A linkage that guides a point, with its verification."""

    metrics: PathMetrics
    placement: CurvePlacement | None = optional_field(
        "For a curve with a free place; the metrics refer to this placement."
    )
    cognates: list[PathCognate] = Field(default=[], description="The two other fourbars of the same curve.")
    point_link: str | None = optional_field(
        "The link of a sixbar or eightbar that carries P, by its name in the skeleton."
    )
    cognate_choice: str = Field(default="", description="Comparison of the design with its cognates.")


class GivenPivotSolutions(Answer):
    """Account of the 36 fourbars through five points on two given fixed pivots."""

    computed: int = Field(description="Solutions found, real and complex; 36 if none is missing.")
    real: int
    on_one_circuit: int = Field(description="Real solutions with all required points on one circuit.")
    largest_residual: float = Field(
        description="Largest residual of the equations, with points and pivots of unit mean distance."
    )


class FamilySearch(Answer):
    """Account of the search of the fourbars through fewer than nine points."""

    followed: int = Field(description="Linkages that were fitted to the points by least squares.")
    met: int = Field(description="Those of them that meet all points and the required pivots exactly.")


class TimedDyads(Answer):
    """Account of the fourbars through five points at their crank angles; for both directions, if requested."""

    inputs: int = Field(description="Real input dyads: at most four for each direction.")
    fourbars: int = Field(description="Real fourbars: at most twelve for each direction.")
    sliders: int = Field(description="Dyads with a pivot at infinity.")


class CurveSweep(Answer):
    """Account of a match of whole curves."""

    linkages: int = Field(description="Random linkages that were generated.")
    curves: int = Field(description="Curves, or parts of curves, whose shape was compared with the target's.")
    refined: int = Field(description="Linkages that were refined by least squares.")


class PathResult(LinkageResult[PathDesign]):
    """Linkages whose coupler point goes through the points."""

    triples: CognateTriples | None = optional_field(
        "For up to nine points of free timing; left out if other methods were used."
    )
    sweep: CurveSweep | None = optional_field("For curves that are matched as a whole.")
    given_pivots: GivenPivotSolutions | None = optional_field("For five points on two given fixed pivots.")
    family: FamilySearch | None = optional_field("For fewer than nine points with constraints.")
    timed: TimedDyads | None = optional_field("For five points at their crank angles.")
