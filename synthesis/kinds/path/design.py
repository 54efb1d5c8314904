"""Answers to problems of path generation."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, optional
from synthesis.model.dimension import Angle, Area, Length
from synthesis.model.linkage_answer import FourbarMechanism, LinkageDesign, LinkageMetrics, LinkageResult


class CognateTriples(Answer):
    """What was computed of the 1442 triples of cognate fourbars through nine points, in all rounds together."""

    rounds: int = Field(description="Sets of nine points that were solved; 1 where nine were given.")
    computed: int = Field(description="Triples found, real and complex; 1442 a round where none is missing.")
    real: int
    on_one_circuit: int = Field(description="Real triples with all demanded points on one circuit.")
    largest_residual: float = Field(description="Of the equations, with points of unit mean distance.")
    closed_under_conjugation: bool = Field(description="Whether complex solutions come in pairs, as they must.")


class PathMetrics(LinkageMetrics):
    """Measured properties of a linkage that guides a point, with its errors in length units."""

    sum_of_squares: Area = Field(description="Of the distances of P from the points, length units squared.")
    rms_distance: Length = Field(description="Root mean square of these distances, length units.")
    max_distance: Length = Field(description="The largest of them, length units.")
    curve_distance: Length | None = optional(
        "For fits: the largest distance of the traced curve from the straight lines through the points, over a whole "
        "turn where these are closed, else from the first point to the last; length units."
    )
    excursion: Length | None = optional(
        "For fits: how much farther the traced curve goes from these lines than max_distance and what a curve may "
        "bulge between points, a quarter of their distance; length units."
    )
    both_way_rms: Length | None = optional(
        "For fits by sixbars to 24 points and more: root mean square of the points' distances from the curve and of "
        "the curve's, by its length, from the straight lines through the points; length units."
    )
    stance_flatness: Length | None = optional(
        "Of a stance: height across its line of the band in which P stays from its first point to its last; length "
        "units."
    )
    stance_speed_deviation: float | None = optional(
        "Of a stance: how much the speed of P along its line differs at most from its mean, as a share of that, while "
        "the input turns evenly."
    )
    stance_rotation: Angle | None = optional("Of a stance: rotation of the input during it, degrees.")


class CurvePlacement(Answer):
    """Where a matched curve is traced, if not where it was drawn: sized and turned about the origin, then shifted."""

    size: float
    rotation: Angle = Field(description="Degrees.")
    shift: Point


class PathCognate(Answer):
    """Another fourbar that traces the same curve (Roberts and Chebyshev), measured where the design meets its targets.

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
    """A linkage that guides a point, with the proof of what it does."""

    metrics: PathMetrics
    placement: CurvePlacement | None = optional("For a curve whose place was left free; what is measured, is there.")
    cognates: list[PathCognate] = Field(default=[], description="The two other fourbars of the same curve.")
    point_link: str | None = optional("Of a sixbar: the link that P is on, by its name in the skeleton.")
    cognate_choice: str = Field(default="", description="What speaks for the design or for a cognate of it.")


class GivenPivotSolutions(Answer):
    """What was computed of the 36 fourbars through five points on two given fixed pivots."""

    computed: int = Field(description="Solutions found, real and complex; 36 where none is missing.")
    real: int
    on_one_circuit: int = Field(description="Real ones with all demanded points on one circuit.")
    largest_residual: float = Field(description="Of the equations, with points and pivots of unit mean distance.")


class FamilySearch(Answer):
    """What was looked at of the fourbars through fewer than nine points."""

    followed: int = Field(description="Linkages that were brought to the points by least squares.")
    met: int = Field(description="Of these, the ones that came to meet all points, and the pivots that are demanded.")


class TimedDyads(Answer):
    """What was computed of the fourbars through five points at their crank angles; for both directions, if asked."""

    inputs: int = Field(description="Real input dyads: four at most for each direction.")
    fourbars: int = Field(description="Real fourbars: twelve at most for each direction.")
    sliders: int = Field(description="Dyads with a pivot at infinity.")


class CurveSweep(Answer):
    """What a match of whole curves has looked at."""

    linkages: int = Field(description="Linkages that were drawn.")
    curves: int = Field(description="Curves, or parts of curves, whose shape was compared with the target's.")
    refined: int = Field(description="Linkages that were refined by least squares.")


class PathResult(LinkageResult[PathDesign]):
    """Linkages whose coupler point goes through the points."""

    triples: CognateTriples | None = optional(
        "For up to nine points of free timing; left out where other methods were used."
    )
    sweep: CurveSweep | None = optional("For curves that are matched as a whole.")
    given_pivots: GivenPivotSolutions | None = optional("For five points on two given fixed pivots.")
    family: FamilySearch | None = optional("For fewer than nine points with demands.")
    timed: TimedDyads | None = optional("For five points at their crank angles.")
