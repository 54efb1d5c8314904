"""Placement of a matched curve: free position, rotation and size are used to meet given pivots and lengths.

A linkage can be moved, rotated and scaled together with its curve. If everything is free both fixed pivots can be
given, because z → αz + β is known from two points. If the position is free one pivot can be given, or a region for
pivots; if the size is free, scaling satisfies the limits of link lengths and of the coupler point.
"""

from __future__ import annotations

import math

from synthesis.kinds.path.design import CurvePlacement, PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage.conversion import FourbarConfiguration, to_point
from synthesis.model.linkage.problem import Region

ROUNDING_MARGIN = 1e-9
"""Share of a limit's range reserved for rounding: cognates repeat a curve only up to a few roundings."""


def relax_constraints(problem: PathProblem) -> PathProblem:
    """Return the problem of the shape search, without the constraints that the later placement satisfies or changes."""
    free = set(problem.placement_free)
    demands: dict[str, object] = {}
    limits: dict[str, object] = {}
    if _get_both_pivots(problem) is not None or ("position" in free and _get_single_pivot(problem) is not None):
        demands["fixed_pivots"] = type(problem.fixed_pivots)()
    if "position" in free:
        limits |= {"fixed_pivot_region": None, "input_pivot_region": None, "moving_pivot_region": None}
    if "size" in free:
        limits |= {"link_length": None, "coupler_point": None}
    if limits:
        demands["constraints"] = problem.constraints.model_copy(update=limits)
    return problem.model_copy(update=demands) if demands else problem


def find_placement(problem: PathProblem, joints: FourbarConfiguration) -> tuple[complex, complex]:
    """Return α and β of the map z → αz + β that places a linkage and its curve to satisfy the constraints.

    They are 1 and 0 if nothing is free.
    """
    free = set(problem.placement_free)
    both = _get_both_pivots(problem)
    if both is not None:
        alpha = (both[1] - both[0]) / (joints.o4 - joints.o2)
        return alpha, both[0] - alpha * joints.o2
    # Rotation is used only together with everything else, for two given pivots.
    alpha = complex(_find_scale(problem, joints)) if "size" in free else 1.0 + 0j
    # Scale about the curve's own first point, so that the curve stays where it was drawn.
    beta = (1.0 - alpha) * joints.p
    if "position" in free:
        o2, o4 = alpha * joints.o2 + beta, alpha * joints.o4 + beta
        one = _get_single_pivot(problem)
        if one is not None:
            beta += one[1] - (o2 if one[0] == "input" else o4)
        else:
            beta += _shift_into(problem.constraints.fixed_pivot_region, [o2, o4])
            beta += _shift_into(problem.constraints.input_pivot_region, [alpha * joints.o2 + beta])
    return alpha, beta


def transform_problem(problem: PathProblem, alpha: complex, beta: complex) -> PathProblem:
    """Return the problem with its curve mapped by z → αz + β; tolerances are scaled with it."""
    points = []
    for point in problem.points:
        z = alpha * point.point + beta
        width = None if point.tolerance is None else abs(alpha) * point.tolerance
        points.append(point.model_copy(update={"x": z.real, "y": z.imag, "tolerance": width}))
    return problem.model_copy(update={"points": points})


def place_problem(problem: PathProblem, design: PathDesign) -> PathProblem:
    """Return the problem with its curve at the place where a design traces it."""
    at = design.placement
    if at is None:
        return problem
    turned = math.radians(at.rotation)
    return transform_problem(problem, at.size * complex(math.cos(turned), math.sin(turned)), complex(*at.shift))


def describe_placement(alpha: complex, beta: complex) -> CurvePlacement | None:
    """Return the placement for the answer; None for a curve that stays where it was drawn."""
    # Exact comparison: the unplaced case sets these very values.
    if alpha == 1.0 and beta == 0.0:
        return None
    return CurvePlacement(
        size=abs(alpha), rotation=math.degrees(math.atan2(alpha.imag, alpha.real)), shift=to_point(beta)
    )


def _get_both_pivots(problem: PathProblem) -> tuple[complex, complex] | None:
    """Return both given pivots if position, rotation and size of the curve are all free."""
    if set(problem.placement_free) != {"position", "rotation", "size"} or problem.fixed_pivots.count_given() != 4:
        return None
    pair = [complex(*map(float, pivot)) for pivot in _list_full_pivots(problem).values()]
    return pair[0], pair[1]


def _get_single_pivot(problem: PathProblem) -> tuple[str, complex] | None:
    """Return the side and place of the only pivot that is given by both coordinates."""
    whole = _list_full_pivots(problem)
    if len(whole) != 1 or problem.fixed_pivots.count_given() != 2:
        return None
    ((side, pivot),) = whole.items()
    return side, complex(*pivot)


def _list_full_pivots(problem: PathProblem) -> dict[str, tuple[float, float]]:
    """Return the pivots that are given by both coordinates, by side."""
    pivots = {}
    for side, pivot in (("input", problem.fixed_pivots.input), ("output", problem.fixed_pivots.output)):
        if pivot is not None and pivot[0] is not None and pivot[1] is not None:
            pivots[side] = (pivot[0], pivot[1])
    return pivots


def _find_scale(problem: PathProblem, joints: FourbarConfiguration) -> float:
    """Return the scale nearest to 1 at which links and coupler point are within their limits; 1 if there is none."""
    least, most = 0.0, math.inf
    limit = problem.constraints.link_length
    if limit is not None:
        least = limit.min / min(joints.lengths)
        most = math.inf if limit.max is None else limit.max / max(joints.lengths)
    box = problem.constraints.coupler_point
    if box is not None:
        coupler = joints.b - joints.a
        local = (joints.p - joints.a) * coupler.conjugate() / abs(coupler)
        for coordinate, interval in ((local.real, box.along), (local.imag, box.across)):
            if interval is not None:
                smallest, largest = _find_scale_range(coordinate, interval)
                # All limits must hold at one scale: intersect their intervals.
                least, most = max(least, smallest), min(most, largest)
    return min(max(1.0, least), most) if least <= most else 1.0


def _find_scale_range(coordinate: float, interval: tuple[float, float]) -> tuple[float, float]:
    """Return the minimum and maximum factor that scale a coordinate into an interval; minimum > maximum for none.

    The interval is shrunk by :data:`ROUNDING_MARGIN`, so that rounded results lie inside.
    """
    low, high = interval
    if coordinate < 0.0:
        # A positive coordinate keeps the order of the bounds under division.
        coordinate, low, high = -coordinate, -high, -low
    margin = ROUNDING_MARGIN * min(high - low, max(abs(low), abs(high)))
    if coordinate == 0.0:
        return (0.0, math.inf) if low <= 0.0 <= high else (math.inf, 0.0)
    return max(0.0, (low + margin) / coordinate), (high - margin) / coordinate


def _shift_into(region: Region | None, pivots: list[complex]) -> complex:
    """Return the shortest shift that moves pivots into a region, if they fit into it."""
    if region is None:
        return 0j
    shift = []
    for values, (low, high) in (
        ([pivot.real for pivot in pivots], region.x),
        ([pivot.imag for pivot in pivots], region.y),
    ):
        below, above = low - min(values), high - max(values)
        # Every shift between the two bounds puts all pivots inside; if they do not fit, centre them.
        shift.append(min(max(0.0, below), above) if below <= above else 0.5 * (below + above))
    return complex(*shift)
