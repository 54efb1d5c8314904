"""Two to four positions with tolerances, for linkages without a constrained fit: sample poses within the tolerances.

Sliders and links with given angles can be solved only for exact positions. So sets of poses are sampled within the
tolerances, the targets themselves first; each set is solved exactly, and the results are verified at the positions of
the problem.
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
"""Maximum number of solved sets of poses; fewer are solved if they give enough designs."""

USABLE = 30.0
"""Minimum transmission angle, degrees, of a design that counts towards the requested number."""


def solve_drawn(
    problem: MotionProblem, exactly: Callable[[MotionProblem, Progress], MotionResult], progress: Progress
) -> MotionResult:
    """Find designs that use the tolerances.

    Parameters
    ----------
    problem : MotionProblem
        Two to four positions.
    exactly : callable
        Solver for a problem whose positions are all exact.
    progress : callable
        Progress callback.
    """
    target = demanded(problem)
    sifting = Sifting[LinkageDesign](problem, REASONS)
    tolerances = np.array(problem.limits)
    results: list[MotionResult] = []
    drawn = tolerances.copy()
    if any(side.has_partial_moving_pivot for side in (problem.input_side, problem.output_side)):
        drawn[0] = 0.0  # a given coordinate of a pin refers to the body in the first target position
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
    """Select distinct designs of each type, best first: neighbouring sets of poses give similar linkages."""
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
    """Return the problem with its positions moved by (x, y, degrees), shape (n, 3), and met exactly."""
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
    """Transform choices that refer to the body in its first position to a displaced first position.

    ``moved`` is the new P and the body's rotation e^{iα} from the target position; ``turned`` is α in degrees.
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
    sets = f"{len(results)} set{'s' * (len(results) > 1)} of poses sampled within the tolerances"
    if not sifting.passed:
        return (
            f"No linkage for {sets} satisfies all constraints. The search is not exhaustive, so a solution may still "
            f"exist. For the exact positions: {results[0].summary}"
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    count = sifting.accepted
    found = f"{count} linkages for {sets} satisfy" if count > 1 else f"1 linkage for {sets} satisfies"
    return f"{found} all constraints. Best minimum transmission angle: {best:.1f}°. A better linkage may exist."
