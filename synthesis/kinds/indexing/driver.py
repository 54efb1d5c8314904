"""The drag link with which a Geneva drive has the least peak acceleration at a steady input.

Lengths over the ground and the output's angle in the middle of the index are drawn at random, what breaks a demand is
dropped, and the best few descend by Nelder and Mead's method; there are no more than these four numbers.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from kinematics.indexing.drag_link import Course, DragLink, steady_share
from kinematics.indexing.geneva import Geneva
from synthesis.kinds.indexing.problem import IndexingProblem

Real = NDArray[np.float64]

DRAWN, TRIED = 20000, 4
"""Drag links that are drawn, and those that descend."""

TURN = 120
"""Positions of a turn in which drawn ones are looked at."""

SAMPLED = 241
"""Positions of an index in which the descent looks at one."""

LONGEST = 5.0
"""Longest link over the ground."""

BROKEN, ALLOWED = 1e4, 1e2
"""What a link costs that breaks a demand, times how far; and the cost below which one is taken, to be judged later."""

ROUGH = 0.02
"""Of a turn by which a rest in few positions may be off."""

KEPT = 1e-6
"""Share by which the search keeps away from the limit of the transmission angle."""


def best_course(problem: IndexingProblem, geneva: Geneva) -> Course | None:
    """The best course of a drag link before a drive; None where none of those tried keeps the demands."""
    rng = np.random.default_rng(problem.seed)
    lengths = rng.uniform(1.05, LONGEST, (DRAWN, 3))
    phases = rng.uniform(0.0, 2.0 * math.pi, DRAWN)
    wanted = math.radians(problem.transmission_angle) * (1.0 + KEPT)
    sound = _turns(lengths) & (DragLink(*lengths.T).transmission_angle >= wanted)
    lengths, phases = lengths[sound], phases[sound]
    if not len(lengths):
        return None
    peaks, rests = _roughly(geneva, lengths, phases)
    peaks = peaks + np.abs(peaks).max() * (_outside(problem, rests) > ROUGH)
    found: tuple[float, Course] | None = None
    for number in np.argsort(peaks)[:TRIED]:
        begun = np.append(lengths[number], phases[number])
        result = minimize(
            lambda x: _cost(problem, geneva, x, wanted),
            begun,
            method="Nelder-Mead",
            options={"xatol": 1e-7, "fatol": 1e-9, "maxiter": 500},
        )
        if result.fun < ALLOWED and (found is None or result.fun < found[0]):
            found = float(result.fun), _course(geneva, result.x)
    return None if found is None else found[1]


def _course(geneva: Geneva, x: Real) -> Course:
    return Course(geneva, DragLink(*(float(length) for length in x[:3])), float(x[3]))


def _turns(lengths: Real) -> NDArray[np.bool_]:
    """Whether the links turn through, the ground of length 1 being the shortest (Grashof)."""
    return np.asarray((lengths > 1.0).all(axis=-1) & (1.0 + 2.0 * lengths.max(axis=-1) < lengths.sum(axis=-1)))


def _outside(problem: IndexingProblem, rest: float | Real) -> Real:
    """By how much a dwell share is outside what is stated."""
    stated = problem.constraints.dwell_share
    low = 0.0 if stated is None or stated.min is None else stated.min * (1.0 + KEPT)
    high = 1.0 if stated is None or stated.max is None else stated.max * (1.0 - KEPT)
    return np.asarray(np.maximum(np.maximum(low - rest, rest - high), 0.0))


def _roughly(geneva: Geneva, lengths: Real, phases: Real) -> tuple[Real, Real]:
    """Peak accelerations in positions of a turn, those outside the index left out, and shares of these."""
    angle = 2.0 * math.pi * np.arange(TURN) / TURN
    turned = DragLink(*(lengths[:, k, None] for k in range(3))).turned(angle)
    crank = np.mod(turned.s - phases[:, None] + math.pi, 2.0 * math.pi) - math.pi
    wheel = geneva.motion(crank)
    acceleration = wheel.a * turned.v**2 + wheel.v * turned.a
    moves = np.abs(crank) <= geneva.half
    return np.where(moves, np.abs(acceleration), 0.0).max(axis=1), 1.0 - moves.mean(axis=1)


def _cost(problem: IndexingProblem, geneva: Geneva, x: Real, wanted: float) -> float:
    """The peak acceleration, or how far demands are broken."""
    lengths = x[:3]
    over = max(0.0, float(lengths.max()) - LONGEST) + max(0.0, 1.0 + KEPT - float(lengths.min()))
    if over > 0.0 or not _turns(lengths):
        return BROKEN * (2.0 + over)
    course = _course(geneva, x)
    assert course.link is not None
    short = wanted - float(course.link.transmission_angle)
    if short > 0.0:
        return BROKEN * (1.0 + short)
    angle = np.linspace(course.start, course.end, SAMPLED)
    motion = course.motion(angle)
    peak = float(np.abs(motion.a).max())
    least = problem.constraints.steady_share
    missing = 0.0 if least is None else max(0.0, least * (1.0 + KEPT) + 1.0 / SAMPLED - steady_share(motion.v))
    rest = 1.0 - (course.end - course.start) / (2.0 * math.pi)
    return peak + BROKEN * (missing + float(_outside(problem, rest)))
