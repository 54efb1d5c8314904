"""Laws of automatic segments: the best by the criterion among the laws that fit the neighbouring segments.

A law fits if its velocity and acceleration at both ends agree with those of the neighbours. For a row of automatic
segments, the best laws form a shortest path over the states at the joints (dynamic programming).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.pieces import Motion
from kinematics.cam.motion.segments import Condition as PolynomialCondition
from kinematics.cam.motion.segments import Segment, build_law_segment, build_polynomial_segment
from kinematics.message import compose
from synthesis.kinds.cam.follower_loads import build_follower_load
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.program.criterion import DERIVATIVE_ORDERS, compute_extra_preload
from synthesis.kinds.cam.statement.followers import BarrelRoller, TranslatingFlat
from synthesis.kinds.cam.statement.segment_ends import END_RATES, State, compute_law_ends
from synthesis.kinds.cam.statement.segments import Move

JOINT_TOLERANCE = 1e-9
"""Maximum jump at a joint, as a share of the segments' own rates, for which an automatic law fits."""

SAMPLE_COUNT = 721
"""Number of points of a segment at which laws are compared by a criterion without a closed form."""


def choose_laws(
    problem: CamProblem,
    heights: Sequence[tuple[float, float]],
    ends: list[tuple[State, State] | None],
    segments: list[Segment | None],
    names: list[str],
) -> str | None:
    """Fill in the automatic segments with the best laws that fit at the joints, for each row of neighbours.

    Return the reason if no law fits a segment, otherwise None.
    """
    count = len(segments)
    auto = [isinstance(s, Move) and s.law == "auto" for s in problem.segments]
    if not any(auto):
        return None
    # Start after a segment that is not automatic, so that no row of neighbours is split at the end of the turn.
    first = next((k for k in range(count) if not auto[k]), 0)
    row: list[int] = []
    # The sentinel −1 closes the last row.
    for k in [*((first + n) % count for n in range(count)), -1]:
        if k >= 0 and auto[k]:
            row.append(k)
        elif row:
            refused = _choose_row(problem, heights, ends, segments, names, row)
            if refused is not None:
                return refused
            row = []
    return None


def _choose_row(
    problem: CamProblem,
    heights: Sequence[tuple[float, float]],
    ends: list[tuple[State, State] | None],
    segments: list[Segment | None],
    names: list[str],
    row: list[int],
) -> str | None:
    """Choose the laws of one row of automatic segments: a shortest path over the states at its joints."""
    count = len(segments)
    before, after = ends[row[0] - 1], ends[(row[-1] + 1) % count]
    # If all segments are automatic the row is a closed ring; it starts and ends at rest, which always fits.
    closed = len(row) == count
    enter = (0.0, 0.0) if before is None or closed else before[1][1:]
    leave = (0.0, 0.0) if after is None or closed else after[0][1:]
    # Only the cheapest path to each state at a joint is kept (dynamic programming).
    paths: dict[tuple[float, float], tuple[float, tuple[tuple[str, Segment], ...]]] = {enter: (0.0, ())}
    for n, k in enumerate(row):
        angle, (start, end) = math.radians(problem.segments[k].angle), heights[k]
        unit = abs(end - start) / angle
        following: dict[tuple[float, float], tuple[float, tuple[tuple[str, Segment], ...]]] = {}
        for state, (cost, chosen) in paths.items():
            wanted = leave if n == len(row) - 1 else None
            for name, segment, at_start, at_end in _list_candidates(angle, start, end, state, wanted):
                # Both states are compared in units of the segment's mean velocity, so that the
                # tolerance has no dimension.
                near = (
                    abs(at_start[0] - state[0]) <= JOINT_TOLERANCE * unit
                    and abs(at_start[1] - state[1]) <= JOINT_TOLERANCE * unit / angle
                )
                if not near or not _is_within_limits(problem, segment):
                    continue
                if wanted is not None and not (
                    abs(at_end[0] - wanted[0]) <= JOINT_TOLERANCE * unit
                    and abs(at_end[1] - wanted[1]) <= JOINT_TOLERANCE * unit / angle
                ):
                    continue
                total = _add_segment_cost(problem, cost, segment)
                # States count as equal if they agree to seven digits. Named laws give a few discrete states, the
                # polynomial any other.
                key = (round(at_end[0] / unit, 7), round(at_end[1] * angle / unit, 7))
                if key not in following or total < following[key][0]:
                    following[key] = total, (*chosen, (name, segment))
        paths = {(key[0] * unit, key[1] * unit / angle): value for key, value in following.items()}
        if not paths:
            return compose("cam-no-law-fits", segment=k)
    _, chosen = min(paths.values(), key=lambda path: path[0])
    for k, (name, segment) in zip(row, chosen, strict=True):
        segments[k], names[k] = segment, name
        ends[k] = _compute_segment_ends(segment)
    return None


def _list_candidates(
    angle: float, start: float, end: float, enter: tuple[float, float], leave: tuple[float, float] | None
) -> list[tuple[str, Segment, tuple[float, float], tuple[float, float]]]:
    """List the named laws, and the polynomial through both end states; with v and a at start and end."""
    candidates = []
    for name in END_RATES:
        # These laws have velocity or acceleration jumps at their ends, so that they are only used on request.
        if name in ("constant_acceleration", "constant_velocity"):
            continue
        first, last = compute_law_ends(name, angle, start, end)
        candidates.append((name, build_law_segment(LAWS[name], angle, start, end), first[1:], last[1:]))
    leave = (0.0, 0.0) if leave is None else leave
    # Between two rests the named laws are better than a plain polynomial.
    if enter != (0.0, 0.0) or leave != (0.0, 0.0):
        states = ((0.0, start, *enter), (angle, end, *leave))
        conditions = [PolynomialCondition(at, i, x) for at, *state in states for i, x in enumerate(state)]
        candidates.append(("polynomial", build_polynomial_segment(angle, conditions), enter, leave))
    return candidates


def _is_within_limits(problem: CamProblem, segment: Segment) -> bool:
    limits = problem.limits
    for name, order in DERIVATIVE_ORDERS.items():
        limit = getattr(limits, name)
        if limit is not None and segment.extremes(order).largest > limit * (1.0 + JOINT_TOLERANCE):
            return False
    return True


def _add_segment_cost(problem: CamProblem, cost: float, segment: Segment) -> float:
    """Return the criterion's value with one more segment: the larger peak, or the sum of squares."""
    name = problem.minimize
    kind, _, of = name.partition("_")
    at = np.linspace(0.0, segment.angle, SAMPLE_COUNT)
    motion = segment.pieces.motion(at)
    if name == "size":
        return max(cost, _estimate_radius(problem, motion))
    if name == "peak_contact_force":
        load, speed = build_follower_load(problem)
        force = load.force(motion, speed)
        return max(cost, float(force.max()) + compute_extra_preload(problem, float(force.min())))
    if of == "torque":
        values = np.abs(motion.v * motion.a)
        return max(cost, float(values.max())) if kind == "peak" else cost + float(np.mean(values**2)) * segment.angle
    if kind == "peak":
        return max(cost, segment.extremes(DERIVATIVE_ORDERS[of]).largest)
    return cost + float(np.mean(motion[DERIVATIVE_ORDERS[of]] ** 2)) * segment.angle


def _estimate_radius(problem: CamProblem, motion: Motion) -> float:
    """Estimate, accurately enough to compare laws, the radius that a segment requires by itself."""
    if isinstance(problem.follower, TranslatingFlat):
        return float(np.max(-motion.s - motion.a))
    # R or d ≥ |v|/tan φ, minus the displacement for a radial cam.
    tangent = math.tan(math.radians(problem.limits.pressure_angle))
    barrel = isinstance(problem.follower, BarrelRoller)
    return float(np.max(np.abs(motion.v) / tangent - (0.0 if barrel else motion.s)))


def _compute_segment_ends(segment: Segment) -> tuple[State, State]:
    first = segment.pieces.motion(0.0)
    last = segment.pieces.motion(segment.angle, before=True)
    return (
        (float(first.s), float(first.v), float(first.a)),
        (float(last.s), float(last.v), float(last.a)),
    )
