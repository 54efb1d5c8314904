"""Two to four positions of which some have tolerances, of linkages that are not steered: poses drawn within them.

Sliders and links at stated angles are found for positions that are met exactly. So sets of poses are drawn within the
tolerances, the demanded ones first, each is solved exactly, and what is found is driven and verified at the positions
as they were stated.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from synthesis.kinds.motion.demanded import demanded
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.stated_dyads import DyadChoices, whole_point
from synthesis.kinds.motion.steered import REASONS
from synthesis.kinds.motion.steered_fit import SAME_LINKAGE
from synthesis.kinds.motion.steered_starts import deviations
from synthesis.kinds.motion.task import Real
from synthesis.kinds.motion.verification import verify
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_answer import LinkageDesign
from synthesis.model.linkages import to_point
from synthesis.outcome.ranking import distinct, ranked
from synthesis.outcome.sifting import OUTRANKED, Sifting

SETS = 8
"""Sets of poses that are solved, unless fewer give enough designs."""

USABLE = 30.0
"""Degrees of transmission angle from which on a design counts toward these."""


def solve_drawn(
    problem: MotionProblem, exactly: Callable[[MotionProblem, Progress], MotionResult], progress: Progress
) -> MotionResult:
    """Designs that use the tolerances.

    Parameters
    ----------
    problem : MotionProblem
        Two to four positions.
    exactly : callable
        Solves a problem whose positions are all met exactly.
    progress : callable
        Told how far the work is.
    """
    target = demanded(problem)
    sifting = Sifting[LinkageDesign](problem, REASONS)
    tolerances = np.array(problem.limits)
    results: list[MotionResult] = []
    drawn = tolerances.copy()
    if any(side.has_partial_moving_pivot for side in (problem.input_side, problem.output_side)):
        drawn[0] = 0.0  # a coordinate of a pin is stated of the body in the demanded first position
    for k, shares in enumerate(deviations(drawn, SETS)):
        poses = shares * tolerances
        result = exactly(_displaced(problem, poses), part_of(progress, k / SETS, (k + 1.0) / SETS))
        results.append(result)
        sifting.rejected.update(result.search.rejected)
        sifting.reject(OUTRANKED, max(0, result.search.accepted - len(result.designs)))
        for design in result.designs:
            angle = problem.positions[0].angle + float(poses[0, 2]) if tolerances[0, 2] > 0.0 else None
            mechanism = design.mechanism.model_copy(update={"reference_body_angle": angle})
            sifting.add(verify(problem, mechanism, target))
        usable = [design for design in sifting.passed if design.metrics.min_transmission_angle >= USABLE]
        if len(usable) >= problem.max_designs:
            break
    sifting.withdraw(_different(problem, sifting.passed), OUTRANKED)
    return MotionResult(
        designs=sifting.designs(partial(ranked, rank_by=problem.rank_by)),
        curves=results[0].curves,
        search=sifting.search("tolerance_search"),
        summary=_summary(sifting, results),
    )


def _different(problem: MotionProblem, designs: list[LinkageDesign]) -> list[LinkageDesign]:
    """Designs that differ, the best first: sets of poses that are near to one another have linkages that are."""
    chosen: list[LinkageDesign] = []
    alike: dict[str, list[LinkageDesign]] = {}
    for design in ranked(designs, problem.rank_by):
        alike.setdefault(design.mechanism.type, []).append(design)
    for listed in alike.values():
        joints = [[complex(*place) for place in design.mechanism.skeleton.joints.values()] for design in listed]
        kept = distinct(np.array(joints), len(listed), SAME_LINKAGE * problem.task_size)
        chosen += [listed[k] for k in kept]
    return chosen


def _displaced(problem: MotionProblem, by: Real) -> MotionProblem:
    """The problem with its positions moved by x, y and degrees, shape (n, 3), and met exactly there."""
    positions = [
        position.model_copy(
            update={
                "x": position.x + float(x),
                "y": position.y + float(y),
                "angle": position.angle + float(angle),
                "tolerance": None,
            }
        )
        for position, (x, y, angle) in zip(problem.positions, by, strict=True)
    ]
    first = problem.positions[0].point
    moved = positions[0].point, cmath.exp(1j * math.radians(float(by[0, 2])))
    sides = {
        name: _carried(getattr(problem, name), first, moved, float(by[0, 2])) for name in ("input_side", "output_side")
    }
    space = None if problem.space is None else problem.space.carried(first, *moved)
    return problem.model_copy(update={"positions": positions, "method": "auto", "space": space, **sides})


def _carried(side: DyadChoices, first: complex, moved: tuple[complex, complex], turned: float) -> DyadChoices:
    """What is stated of a body in its first position, where the body stands elsewhere.

    ``moved`` is where P is then, and the body's turn from the demanded first position, ``turned`` in degrees.
    """
    update: dict[str, Any] = {}
    pivot, vector = whole_point(side.moving_pivot), side.coupler_vector
    if pivot is not None:
        update["moving_pivot"] = to_point(moved[0] + moved[1] * (pivot - first))
    if vector is not None and vector.angle is not None:
        update["coupler_vector"] = vector.model_copy(update={"angle": vector.angle + turned})
    if side.dyad == "RP" and side.slide_angle is not None:
        update["slide_angle"] = side.slide_angle + turned
    return side.model_copy(update=update)


def _summary(sifting: Sifting[LinkageDesign], results: list[MotionResult]) -> str:
    sets = f"{len(results)} set{'s' * (len(results) > 1)} of poses drawn within the tolerances"
    if not sifting.passed:
        return (
            f"None of {sets} has a linkage that satisfies all demands. A linkage may exist that the search did not "
            f"meet. At the positions themselves: {results[0].summary}"
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    count = sifting.accepted
    found = f"{count} linkages that meet {sets} satisfy" if count > 1 else f"1 linkage that meets {sets} satisfies"
    return f"{found} all demands; the least transmission angle is up to {best:.1f}°. A better linkage may exist."
