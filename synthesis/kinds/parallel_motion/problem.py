"""Problems of parallel motion: a body carried along a coupler curve without turning."""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Literal

from pydantic import ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from kinematics.message import compose
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage.given_linkage import (
    AGREEMENT_TOLERANCE,
    BODY_DESCRIPTION,
    Assembly,
    CouplerPointSpec,
    FixedPivotsSpec,
    FourbarLengths,
    SkeletonSpec,
)
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import CANCELLATION_TOLERANCE, Contradiction, Degrees, Statement

PIN_TOLERANCE = 1e-6
"""Distance of P from A or B, as a share of the coupler, below which P counts as on the pin. P then moves on a circle,
and the fourbar has no cognates."""


JOINT_NAMES = frozenset({"O2", "O4", "A", "B"})

LINK_JOINTS = ({"O2", "O4"}, {"O2", "A"}, {"A", "B"}, {"O4", "B"})
"""Joints of the links of a fourbar in a skeleton; the coupler may also contain P."""


class SourceLinkage(Statement):
    """The fourbar whose coupler curve is to be followed: by its dimensions, or in the form of an answer."""

    type: Literal["fourbar"] = "fourbar"
    fixed_pivots: FixedPivotsSpec
    links: FourbarLengths
    coupler_point: CouplerPointSpec
    assembly: Assembly = Field(
        default="open", description="open: B lies to the left of the directed line from A to O4."
    )
    reference_input_angle: Degrees | None = Field(
        default=None,
        description="Input angle of the first position, absolute, degrees; by default the skeleton's, or any possible "
        "one.",
    )
    reference_body_angle: Degrees | None = Field(default=None, description=BODY_DESCRIPTION)
    skeleton: SkeletonSpec | None = Field(
        default=None, description="Skeleton in the first position; its joints must agree with the dimensions."
    )

    @model_validator(mode="before")
    @classmethod
    def check_is_fourbar(cls, given: object) -> object:
        """Reject mechanisms other than a fourbar, whose cognates guide the body."""
        if isinstance(given, dict) and given.get("type", "fourbar") != "fourbar":
            raise PydanticCustomError(
                "no_fourbar",
                compose("parallel_motion-no-cognates"),
            )
        return given

    @property
    def reference(self) -> float | None:
        """The input angle of the first position, degrees: the given one, or that of the skeleton."""
        if self.reference_input_angle is not None or self.skeleton is None:
            return self.reference_input_angle
        o2, a = (complex(*self.skeleton.joints[name]) for name in ("O2", "A"))
        return math.degrees(cmath.phase(a - o2))

    @property
    def joints(self) -> dict[str, complex]:
        """The joints in the first position, whose input angle must be known.

        If the circles of coupler and output miss one another, B is the point nearest to both.
        """
        assert self.reference is not None
        o2, o4 = complex(*self.fixed_pivots.input), complex(*self.fixed_pivots.output)
        a = o2 + cmath.rect(self.links.input, math.radians(self.reference))
        # B is at the intersection of two circles about A and O4, on the side that the assembly gives.
        reach, b, c = abs(o4 - a), self.links.coupler, self.links.output
        along = (b * b - c * c + reach * reach) / (2.0 * reach) if reach else 0.0
        across = math.sqrt(max(b * b - along * along, 0.0)) * (1.0 if self.assembly == "open" else -1.0)
        turn = (o4 - a) / reach if reach else 1.0
        pin = a + complex(along, across) * turn
        return {"O2": o2, "O4": o4, "A": a, "B": pin, "P": a + self.coupler_point.vector * (pin - a) / b}


class ParallelMotionProblem(LinkageProblem):
    """Parallel motion: a Watt I sixbar that carries a link along a coupler curve without turning it.

    The curve is that of a fourbar (`linkage`), or of the fourbars that a path generation problem finds (`path`). Two
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
        default=None, description="A path generation problem; sixbars are built from the fourbars that it finds."
    )
    include_cognates: Annotated[bool, Field(strict=True)] = Field(
        default=True,
        description="Also build sixbars from the cognates of `linkage`, and with the output link as the input.",
    )

    def find_contradictions(self) -> list[Contradiction]:
        """Return contradictory requests: no curve or two, a point without a cognate, lengths that form no linkage."""
        found = list(self.find_contradicting_constraints())
        if (self.linkage is None) == (self.path is None):
            found.append(Contradiction("/linkage", compose("parallel_motion-linkage-or-path")))
        if self.path is not None:
            found += [fault._replace(path=f"/path{fault.path}") for fault in self.path.find_contradictions()]
            # Both describe the finished mechanism.
            for name in ("layout", "space"):
                if getattr(self.path, name) is not None:
                    detail = compose("parallel_motion-belongs-to-sixbar")
                    found.append(Contradiction(f"/path/{name}", detail))
        if self.linkage is not None:
            found += _find_linkage_errors(self.linkage)
        return found


def _find_linkage_errors(linkage: SourceLinkage) -> list[Contradiction]:
    found = []
    links, point = linkage.links, linkage.coupler_point
    ground = math.dist(linkage.fixed_pivots.input, linkage.fixed_pivots.output)
    lengths = sorted((ground, links.input, links.coupler, links.output))
    if ground == 0.0:
        found.append(Contradiction("/linkage/fixed_pivots/output", compose("parallel_motion-pivots-coincide")))
    elif lengths[3] >= sum(lengths[:3]):
        found.append(Contradiction("/linkage/links", compose("parallel_motion-link-too-long")))
    if links.ground is not None and abs(links.ground - ground) > AGREEMENT_TOLERANCE * max(ground, links.ground):
        detail = compose("parallel_motion-ground-disagrees", length=f"{ground:.9g}")
        found.append(Contradiction("/linkage/links/ground", detail))
    far = max(map(abs, (*linkage.fixed_pivots.input, *linkage.fixed_pivots.output)))
    if min(lengths[0], point.distance or lengths[0]) < CANCELLATION_TOLERANCE * far and ground > 0.0:
        detail = compose("parallel_motion-links-too-short")
        found.append(Contradiction("/linkage/links", detail))
    if min(point.distance, abs(point.vector - links.coupler)) <= PIN_TOLERANCE * links.coupler:
        detail = compose("parallel_motion-point-on-pin")
        found.append(Contradiction("/linkage/coupler_point", detail))
    return found or [*_find_reference_errors(linkage), *_find_skeleton_errors(linkage)]


def _find_reference_errors(linkage: SourceLinkage) -> list[Contradiction]:
    """Return an error if coupler and output do not meet at the given input angle."""
    if linkage.reference_input_angle is None:
        return []
    joints, links = linkage.joints, linkage.links
    reach = abs(joints["O4"] - joints["A"])
    low, high = abs(links.coupler - links.output), links.coupler + links.output
    # Triangle A B O4 closes, up to the rounding of printed dimensions.
    if (1.0 - AGREEMENT_TOLERANCE) * low <= reach <= (1.0 + AGREEMENT_TOLERANCE) * high:
        return []
    detail = compose("parallel_motion-input-angle-impossible")
    return [Contradiction("/linkage/reference_input_angle", detail)]


def _find_skeleton_errors(linkage: SourceLinkage) -> list[Contradiction]:
    """Return an error if the skeleton is not the fourbar's, or its joints disagree with the dimensions."""
    skeleton = linkage.skeleton
    if skeleton is None:
        return []
    # P may be listed on the coupler or left out.
    shape = {frozenset(link.joints) - {"P"} for link in skeleton.links}
    if (
        shape != set(map(frozenset, LINK_JOINTS))
        or skeleton.slides
        or skeleton.gears
        or not skeleton.joints.keys() >= JOINT_NAMES
    ):
        detail = compose("parallel_motion-skeleton-of-other-type")
        return [Contradiction("/linkage/skeleton", detail)]
    size = max(abs(z) for z in linkage.joints.values())
    for name, place in linkage.joints.items():
        stated = skeleton.joints.get(name)
        if stated is not None and abs(complex(*stated) - place) > AGREEMENT_TOLERANCE * size:
            detail = compose(
                "parallel_motion-joint-disagrees", joint=name, x=f"{place.real:.9g}", y=f"{place.imag:.9g}"
            )
            return [Contradiction(f"/linkage/skeleton/joints/{name}", detail)]
    return []
