"""Search for the drag link that minimizes the peak acceleration of a Geneva drive at a constant input speed.

The ratios of the lengths to the ground and the output's angle at mid-index are sampled at random. Infeasible samples
are dropped, and the best few are refined by the Nelder-Mead method, which suffices for these four variables.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from kinematics.arrays import Real
from kinematics.indexing.drag_link import CrankCourse, DragLink, compute_steady_share
from kinematics.indexing.geneva import Geneva
from synthesis.kinds.indexing.problem import IndexingProblem

SAMPLE_COUNT, DESCENT_COUNT = 20000, 4
"""Number of sampled drag links, and of those that are refined."""

POSITIONS_PER_TURN = 120
"""Number of positions of a turn at which sampled ones are evaluated."""

POSITIONS_PER_INDEX = 241
"""Number of positions of an index at which the refinement evaluates one."""

MAX_LINK_RATIO = 5.0
"""Maximum ratio of the longest link to the ground."""

PENALTY, MAX_COST = 1e4, 1e2
"""Cost per unit of a violated constraint; and the cost below which a link is accepted, to be verified later."""

DWELL_TOLERANCE = 0.02
"""Permitted violation of the limits on a dwell share estimated from few positions, as a share of a turn."""

LIMIT_MARGIN = 1e-6
"""Margin that the search keeps from its limits."""


def find_best_course(problem: IndexingProblem, geneva: Geneva) -> CrankCourse | None:
    """Find the best motion of a drag link in front of a drive; None if no tried link keeps the constraints."""
    rng = np.random.default_rng(problem.seed)
    lengths = rng.uniform(1.05, MAX_LINK_RATIO, (SAMPLE_COUNT, 3))
    phases = rng.uniform(0.0, 2.0 * math.pi, SAMPLE_COUNT)
    wanted = math.radians(problem.transmission_angle) * (1.0 + LIMIT_MARGIN)
    sound = _has_full_rotation(lengths) & (DragLink(*lengths.T).transmission_angle >= wanted)
    lengths, phases = lengths[sound], phases[sound]
    if not len(lengths):
        return None
    peaks, rests = _estimate_peaks(geneva, lengths, phases)
    # Links outside the dwell limits are ranked last, not dropped, because the refinement may still make them feasible.
    peaks = peaks + np.abs(peaks).max() * (_compute_dwell_violation(problem, rests) > DWELL_TOLERANCE)
    found: tuple[float, CrankCourse] | None = None
    for number in np.argsort(peaks)[:DESCENT_COUNT]:
        begun = np.append(lengths[number], phases[number])
        result = minimize(
            lambda x: _compute_cost(problem, geneva, x, wanted),
            begun,
            method="Nelder-Mead",
            options={"xatol": 1e-7, "fatol": 1e-9, "maxiter": 500},
        )
        if result.fun < MAX_COST and (found is None or result.fun < found[0]):
            found = float(result.fun), _build_course(geneva, result.x)
    return None if found is None else found[1]


def _build_course(geneva: Geneva, x: Real) -> CrankCourse:
    return CrankCourse(geneva, DragLink(*(float(length) for length in x[:3])), float(x[3]))


def _has_full_rotation(lengths: Real) -> NDArray[np.bool_]:
    """Return whether the links rotate fully, the ground of length 1 being the shortest (Grashof)."""
    return np.asarray((lengths > 1.0).all(axis=-1) & (1.0 + 2.0 * lengths.max(axis=-1) < lengths.sum(axis=-1)))


def _compute_dwell_violation(problem: IndexingProblem, rest: float | Real) -> Real:
    """Return the excess of a dwell share over its limits."""
    stated = problem.constraints.dwell_share
    low = 0.0 if stated is None or stated.min is None else stated.min * (1.0 + LIMIT_MARGIN)
    high = 1.0 if stated is None or stated.max is None else stated.max * (1.0 - LIMIT_MARGIN)
    return np.asarray(np.maximum(np.maximum(low - rest, rest - high), 0.0))


def _estimate_peaks(geneva: Geneva, lengths: Real, phases: Real) -> tuple[Real, Real]:
    """Estimate peak accelerations within the index from positions of a turn, and the dwell shares."""
    angle = 2.0 * math.pi * np.arange(POSITIONS_PER_TURN) / POSITIONS_PER_TURN
    turned = DragLink(*(lengths[:, k, None] for k in range(3))).output_motion(angle)
    crank = np.mod(turned.s - phases[:, None] + math.pi, 2.0 * math.pi) - math.pi
    wheel = geneva.motion(crank)
    acceleration = wheel.a * turned.v**2 + wheel.v * turned.a
    # Outside the index the wheel rests and has no acceleration.
    moves = np.abs(crank) <= geneva.half
    return np.where(moves, np.abs(acceleration), 0.0).max(axis=1), 1.0 - moves.mean(axis=1)


def _compute_cost(problem: IndexingProblem, geneva: Geneva, x: Real, wanted: float) -> float:
    """Return the peak acceleration, or a penalty for violated constraints."""
    lengths = x[:3]
    # Penalties are ordered: impossible links cost most, then poor transmission, then dwell and steadiness.
    # ``over`` is the distance outside the box of permitted link lengths.
    over = max(0.0, float(lengths.max()) - MAX_LINK_RATIO) + max(0.0, 1.0 + LIMIT_MARGIN - float(lengths.min()))
    if over > 0.0 or not _has_full_rotation(lengths):
        return PENALTY * (2.0 + over)
    course = _build_course(geneva, x)
    assert course.link is not None
    short = wanted - float(course.link.transmission_angle)
    if short > 0.0:
        return PENALTY * (1.0 + short)
    angle = np.linspace(course.start, course.end, POSITIONS_PER_INDEX)
    motion = course.motion(angle)
    peak = float(np.abs(motion.a).max())
    least = problem.constraints.steady_share
    missing = (
        0.0
        if least is None
        else max(0.0, least * (1.0 + LIMIT_MARGIN) + 1.0 / POSITIONS_PER_INDEX - compute_steady_share(motion.v))
    )
    rest = 1.0 - (course.end - course.start) / (2.0 * math.pi)
    return peak + PENALTY * (missing + float(_compute_dwell_violation(problem, rest)))
