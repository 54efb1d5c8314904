"""Placement of a linkage whose task does not fix its position, so that its pivots lie in their regions.

The links are brought within their limits of length if the size is free, too.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Collection, Sequence
from typing import Any, Protocol, Self, TypeVar

import numpy as np

from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.answer import Skeleton
from synthesis.model.linkage.problem import Constraints, Region
from synthesis.model.linkage.zones import EDGE_TOLERANCE
from synthesis.numerics.box_placement import Boxes, Placement, place_in_boxes


class LinkageMechanism(Protocol):
    """Interface of a linkage mechanism in an answer, a model of its dimensions."""

    @property
    def skeleton(self) -> Skeleton:
        """Joints and links at the first target."""
        ...

    def model_dump(self) -> JsonObject:
        """Return the fields by name."""
        ...

    @classmethod
    def model_validate(cls, obj: object) -> Self:
        """Build a mechanism of this type from its fields."""
        ...


Mechanism = TypeVar("Mechanism", bound=LinkageMechanism)


def find_placement(
    constraints: Constraints,
    fixed: Sequence[complex],
    moving: Sequence[complex],
    lengths: Sequence[float] | None,
    preferred: complex,
    *,
    turned: bool = True,
) -> Placement:
    """Find the similarity that maps a linkage from its own frame to its position.

    Parameters
    ----------
    constraints : Constraints
        Constraints with the regions and limits of length to satisfy.
    fixed, moving : sequence of complex
        Fixed pivots, and moving pivots in the first position.
    lengths : sequence of float or None
        Lengths of the links; None if the size is fixed to that of ``preferred``.
    preferred : complex
        Preferred size (modulus) and direction (argument), used if they fit.
    turned : bool
        Whether another direction is permitted.
    """
    limits = constraints.link_length
    if limits is None and constraints.fixed_pivot_region is None and constraints.moving_pivot_region is None:
        # Any position fits: keep the preferred one at the origin.
        return Placement(0j, preferred, True)
    least, most = 0.0, math.inf
    if lengths is None:
        least = most = abs(preferred)
    elif limits is not None:
        # One scale applies to all links: the shortest gives its minimum, the longest its maximum.
        least = limits.min / min(lengths)
        most = math.inf if limits.max is None else limits.max / max(lengths)
    regions = [constraints.fixed_pivot_region] * len(fixed) + [constraints.moving_pivot_region] * len(moving)
    points = np.array([*fixed, *moving], np.complex128)
    return place_in_boxes(points, convert_regions(regions), least, most, preferred, turned=turned)


def convert_regions(regions: Sequence[Region | None]) -> Boxes:
    """Convert the regions of joints to boxes; a joint without a region gets an infinite box."""
    table = np.array(
        [(-math.inf, math.inf) * 2 if region is None else (*region.x, *region.y) for region in regions]
    ).reshape(-1, 4)
    return Boxes(*table.T)


def place_mechanism(
    constraints: Constraints, mechanism: Mechanism, lengths: Sequence[float], *, sized: bool, turned: bool
) -> Mechanism:
    """Place a finished mechanism so that its pivots lie in their regions and its links are within their limits.

    Parameters
    ----------
    constraints : Constraints
        Constraints with the regions and limits of length to satisfy.
    mechanism : a mechanism of an answer
        The mechanism; it is returned unchanged if it already fits.
    lengths : sequence of float
        Lengths of its links.
    sized, turned : bool
        Whether another size, and another direction, are permitted.
    """
    skeleton = mechanism.skeleton
    still = next(link.joints for link in skeleton.links if link.name == "ground")
    # P is a point of the body, not a pivot, so regions do not apply to it.
    places = {name: complex(*place) for name, place in skeleton.joints.items() if name != "P"}
    fixed = [place for name, place in places.items() if name in still]
    moving = [place for name, place in places.items() if name not in still]
    # A mechanism that fits stays exactly as it was computed.
    if _is_placed(constraints, fixed, moving, lengths):
        return mechanism
    there = find_placement(constraints, fixed, moving, lengths if sized else None, 1.0 + 0j, turned=turned)
    return transform_mechanism(mechanism, there.origin, there.along)


def _is_placed(
    constraints: Constraints, fixed: Collection[complex], moving: Collection[complex], lengths: Sequence[float]
) -> bool:
    """Return whether the linkage already satisfies all regions and limits."""
    limits = constraints.link_length
    # The tolerance accepts a link that a fit placed exactly at its limit.
    if limits is not None and min(lengths) < limits.min * (1.0 - EDGE_TOLERANCE):
        return False
    if limits is not None and limits.max is not None and max(lengths) > limits.max * (1.0 + EDGE_TOLERANCE):
        return False
    regions = (constraints.fixed_pivot_region, fixed), (constraints.moving_pivot_region, moving)
    return all(region is None or all(map(region.contains, places)) for region, places in regions)


def transform_mechanism(mechanism: Mechanism, origin: complex, along: complex) -> Mechanism:
    """Transform positions, lengths and directions of a mechanism by the similarity z → origin + along · z."""
    size, turn = abs(along), math.degrees(cmath.phase(along))

    def transform_point(point: Sequence[float]) -> tuple[float, float]:
        there = origin + along * complex(*point)
        return there.real, there.imag

    def transform_line(of: JsonObject) -> JsonObject:
        # A slide of an inverted linkage is given in its link's own frame, without a point, and is not transformed.
        return {**of, "point": transform_point(of["point"]), "angle": of["angle"] + turn} if "point" in of else of

    # Fields that are absent here are ratios or names, which a similarity does not change.
    changed: dict[str, Callable[[Any], Any]] = {
        "fixed_pivot": transform_point,
        "fixed_pivots": lambda pivots: {name: transform_point(point) for name, point in pivots.items()},
        "links": lambda links: {name: size * length for name, length in links.items()},
        "coupler_point": lambda point: {**point, "distance": size * point["distance"]},
        "offset": lambda offset: size * offset,
        "slide": transform_line,
        "reference_input_angle": lambda angle: angle + turn,
        "reference_body_angle": lambda angle: angle + turn,
        "skeleton": lambda skeleton: {
            **skeleton,
            "joints": {name: transform_point(point) for name, point in skeleton["joints"].items()},
            "slides": [transform_line(slide) for slide in skeleton["slides"]],
        },
    }
    stated = {
        name: changed[name](value) if name in changed and value is not None else value
        for name, value in mechanism.model_dump().items()
    }
    return type(mechanism).model_validate(stated)
