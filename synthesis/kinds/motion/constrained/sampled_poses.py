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

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose, join_messages
from synthesis.kinds.motion.constrained.fit import DUPLICATE_TOLERANCE
from synthesis.kinds.motion.constrained.solver import REASONS
from synthesis.kinds.motion.constrained.starts import sample_deviations
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices, to_complete_point
from synthesis.kinds.motion.task.target_poses import make_target_poses
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.model.linkage.conversion import to_point
from synthesis.results.candidate_log import OUTRANKED_REASON, CandidateLog
from synthesis.results.ranking import rank_designs, select_distinct

SET_COUNT = 8
"""Maximum number of solved sets of poses; fewer are solved if they give enough designs."""

USABLE_ANGLE = 30.0
"""Minimum transmission angle, degrees, of a design that counts towards the requested number."""


def solve_sampled_poses(
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
    target = make_target_poses(problem)
    sifting = CandidateLog[LinkageDesign](problem, REASONS)
    tolerances = np.array(problem.limits)
    results: list[MotionResult] = []
    drawn = tolerances.copy()
    if any(side.has_partial_moving_pivot for side in (problem.input_side, problem.output_side)):
        drawn[0] = 0.0  # a given coordinate of a pin refers to the body in the first target position
    for k, shares in enumerate(sample_deviations(drawn, SET_COUNT)):
        poses = shares * tolerances
        result = exactly(
            _displace_positions(problem, poses), scale_progress(progress, k / SET_COUNT, (k + 1.0) / SET_COUNT)
        )
        results.append(result)
        sifting.rejected.update(result.search.rejected)
        # Designs beyond the requested number were accepted but not returned by the exact solver.
        sifting.reject(OUTRANKED_REASON, max(0, result.search.accepted - len(result.designs)))
        for design in result.designs:
            # The body's angle at the reference differs from the target's if it has a tolerance.
            angle = problem.positions[0].angle + float(poses[0, 2]) if tolerances[0, 2] > 0.0 else None
            mechanism = design.mechanism.model_copy(update={"reference_body_angle": angle})
            sifting.record_candidate(verify(problem, mechanism, target))
        # Designs with poor transmission do not end the search early.
        usable = [design for design in sifting.passed if design.metrics.min_transmission_angle >= USABLE_ANGLE]
        if len(usable) >= problem.max_designs:
            break
    sifting.withdraw(_select_distinct(problem, sifting.passed), OUTRANKED_REASON)
    return MotionResult(
        designs=sifting.select_designs(partial(rank_designs, rank_by=problem.rank_by)),
        curves=results[0].curves,
        search=sifting.build_search("tolerance_search"),
        summary=_describe_result(sifting, results),
    )


def _select_distinct(problem: MotionProblem, designs: list[LinkageDesign]) -> list[LinkageDesign]:
    """Select distinct designs of each type, best first: neighbouring sets of poses give similar linkages."""
    chosen: list[LinkageDesign] = []
    alike: dict[str, list[LinkageDesign]] = {}
    for design in rank_designs(designs, problem.rank_by):
        # Compare within a type only: others have other joints.
        alike.setdefault(design.mechanism.type, []).append(design)
    for listed in alike.values():
        joints = [[complex(*place) for place in design.mechanism.skeleton.joints.values()] for design in listed]
        kept = select_distinct(np.array(joints), len(listed), DUPLICATE_TOLERANCE * problem.task_size)
        chosen += [listed[k] for k in kept]
    return chosen


def _displace_positions(problem: MotionProblem, by: Real) -> MotionProblem:
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
    # Choices that refer to the body must move with it.
    first = problem.positions[0].point
    moved = positions[0].point, cmath.exp(1j * math.radians(float(by[0, 2])))
    sides = {
        name: _move_choices(getattr(problem, name), first, moved, float(by[0, 2]))
        for name in ("input_side", "output_side")
    }
    space = None if problem.space is None else problem.space.move_with_body(first, *moved)
    return problem.model_copy(update={"positions": positions, "method": "auto", "space": space, **sides})


def _move_choices(side: DyadChoices, first: complex, moved: tuple[complex, complex], turned: float) -> DyadChoices:
    """Transform choices that refer to the body in its first position to a displaced first position.

    ``moved`` is the new P and the body's rotation e^{iα} from the target position; ``turned`` is α in degrees.
    """
    update: dict[str, object] = {}
    pivot, vector = to_complete_point(side.moving_pivot), side.coupler_vector
    if pivot is not None:
        update["moving_pivot"] = to_point(moved[0] + moved[1] * (pivot - first))
    if vector is not None and vector.angle is not None:
        update["coupler_vector"] = vector.model_copy(update={"angle": vector.angle + turned})
    # An RP slide is a line of the body and turns with it; a PR slide is fixed.
    if side.dyad == "RP" and side.slide_angle is not None:
        update["slide_angle"] = side.slide_angle + turned
    return side.model_copy(update=update)


def _describe_result(sifting: CandidateLog[LinkageDesign], results: list[MotionResult]) -> str:
    if not sifting.passed:
        return compose("motion-no-linkage-for-sampled-poses", sets=len(results), summary=results[0].summary)
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    return join_messages(
        [
            compose("motion-linkages-for-sampled-poses", linkages=sifting.accepted, sets=len(results)),
            compose("motion-best-transmission-angle", angle=f"{best:.1f}"),
            compose("motion-better-possible"),
        ]
    )
