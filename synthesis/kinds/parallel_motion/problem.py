"""Parallel motion: a body carried along a coupler curve without turning."""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.statement import ROUNDED_OFF, Contradiction, Degrees, Point, PositiveLength, Statement

AT_PIN = 1e-6
"""P this near to A or B, as a share of the coupler, is on it: there is no cognate, and P runs on a circle."""


class SourcePivots(Statement):
    """Fixed pivots O2 (input) and O4 (output)."""

    input: Point
    output: Point


class SourceLinks(Statement):
    """Link lengths; the ground's follows from the pivots."""

    input: PositiveLength
    coupler: PositiveLength
    output: PositiveLength


class SourcePoint(Statement):
    """P: its distance from A, and the angle from the line A → B to the line A → P, degrees."""

    distance: PositiveLength
    angle: Degrees = 0.0


class SourceLinkage(Statement):
    """The fourbar whose coupler curve is to be followed."""

    fixed_pivots: SourcePivots
    links: SourceLinks
    coupler_point: SourcePoint
    assembly: Literal["open", "crossed"] = Field(
        default="open", description="open: B lies to the left of the directed line from A to O4."
    )
    reference_input_angle: Degrees | None = Field(
        default=None, description="Input angle of the first position, absolute, degrees; by default one that there is."
    )


class ParallelMotionProblem(LinkageProblem):
    """Parallel motion: a Watt sixbar that carries a link along a coupler curve without turning it.

    The curve is that of a fourbar (`linkage`), or of the fourbars that a problem of path generation finds (`path`). Two
    cognates of a fourbar trace one curve; one of them, moved to the other's pivot and joined to its crank, guides a
    second point of the body along the same curve, so that the body translates.
    """

    model_config = ConfigDict(
        title="Parallel motion",
        json_schema_extra={
            "examples": [
                {
                    "kind": "parallel_motion",
                    "linkage": {
                        "fixed_pivots": {"input": [0.0, 0.0], "output": [60.0, 0.0]},
                        "links": {"input": 20.0, "coupler": 70.0, "output": 90.0},
                        "coupler_point": {"distance": 60.0, "angle": 30.0},
                        "assembly": "open",
                    },
                }
            ]
        },
    )

    kind: Literal["parallel_motion"]
    linkage: SourceLinkage | None = None
    path: PathProblem | None = Field(
        default=None, description="A problem of path generation; what it finds is made into sixbars."
    )
    include_cognates: Annotated[bool, Field(strict=True)] = Field(
        default=True,
        description="Also make sixbars of the cognates of `linkage`, and with the output link as the input.",
    )

    def contradictions(self) -> list[Contradiction]:
        """No curve, or two; a point that has no cognate; lengths that make no linkage."""
        found = list(self.constraints.contradictions())
        if (self.linkage is None) == (self.path is None):
            found.append(Contradiction("/linkage", "state either a linkage or a path"))
        if self.path is not None:
            found += [fault._replace(path=f"/path{fault.path}") for fault in self.path.contradictions()]
        if self.linkage is not None:
            found += _faults(self.linkage)
        return found


def _faults(linkage: SourceLinkage) -> list[Contradiction]:
    found = []
    links, point = linkage.links, linkage.coupler_point
    ground = math.dist(linkage.fixed_pivots.input, linkage.fixed_pivots.output)
    lengths = sorted((ground, links.input, links.coupler, links.output))
    if ground == 0.0:
        found.append(
            Contradiction("/linkage/fixed_pivots/output", "equal to the input's pivot; no ground link is left")
        )
    elif lengths[3] >= sum(lengths[:3]):
        found.append(Contradiction("/linkage/links", "one link is longer than the others together can reach"))
    far = max(map(abs, (*linkage.fixed_pivots.input, *linkage.fixed_pivots.output)))
    if min(lengths[0], point.distance) < ROUNDED_OFF * far and ground > 0.0:
        detail = "too short beside the coordinates of the pivots; move the origin nearer"
        found.append(Contradiction("/linkage/links", detail))
    vector = cmath.rect(point.distance, math.radians(point.angle))
    if min(abs(vector), abs(vector - links.coupler)) <= AT_PIN * links.coupler:
        detail = "on a pin of the coupler it runs on a circle and has no cognate; a parallelogram carries a body there"
        found.append(Contradiction("/linkage/coupler_point", detail))
    return found
