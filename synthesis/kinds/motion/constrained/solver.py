"""Constrained fit for two to four positions with tolerances: use the tolerances to satisfy all constraints.

Starting linkages (:mod:`synthesis.kinds.motion.constrained.starts`) meet poses sampled within the tolerances. Each is
then fitted to all constraints at once (:mod:`synthesis.kinds.motion.constrained.fit`), with every position within its
tolerance, and is driven and verified like any other. Positions without a tolerance are met to rounding.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from kinematics.arrays import Real
from kinematics.linkage.fourbar import positions
from kinematics.message import compose, join_messages
from synthesis.kinds.motion.constrained.fit import (
    make_constrained_fit,
    make_target_rows,
    pack_task_workspace,
    release_from_start,
    select_distinct_fits,
    solve_constrained,
    verify_fit,
)
from synthesis.kinds.motion.constrained.starts import Start, list_starts
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.kinds.motion.task.target_poses import make_target_poses
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.kind import Progress
from synthesis.model.linkage.answer import FourbarMechanism, LinkageDesign, LinkageMechanism
from synthesis.model.linkage.conversion import (
    FourbarConfiguration,
    build_driven_fourbar,
    build_fourbar,
    compute_body_shift,
)
from synthesis.results.candidate_log import DEFECT_REASONS, LENGTH_REASONS, OUTRANKED_REASON, CandidateLog
from synthesis.results.ranking import rank_designs

MAX_STARTS, MAX_IMPROVED = 40, 8
"""Maximum number of starting linkages, which are first fitted close to their starts; and of the distinct results that
are then optimised freely."""

REASONS = DEFECT_REASONS | LENGTH_REASONS | {"within_tolerance": "tolerance"}
"""Rejection reason by failed check; other checks use their own name."""


def solve_with_tolerances(problem: MotionProblem, exact: MotionResult, progress: Progress) -> MotionResult:
    """Find designs that use the tolerances, and merge them with those that meet the positions exactly.

    Parameters
    ----------
    problem : MotionProblem
        Two to four positions.
    exact : MotionResult
        The result with all positions met exactly.
    progress : callable
        Progress callback.
    """
    task = make_motion_task(problem)
    rows = make_target_rows(problem, task)
    progress(0.0, compose("motion-sampling-poses"))
    listed = list_starts(problem, task, rows[:, 3:], MAX_STARTS)
    progress(0.4, compose("motion-fitting-linkages", count=len(listed)))
    first = [make_constrained_fit(problem, task, rows, start) for start in listed]
    steered = solve_constrained(rows, first)
    sifting = CandidateLog[LinkageDesign](problem, REASONS)
    # Both searches belong to the answer, so their counts are added.
    sifting.merge_search(exact.search)
    sifting.passed = [design for design in exact.designs if design.verification.passed]
    sifting.failed = [design for design in exact.designs if not design.verification.passed]
    met = len(sifting.passed)
    # Staying near the starts keeps the fits diverse; only then may the distinct ones move to better minima.
    unlike = select_distinct_fits(steered)
    free = [release_from_start(linkage) for linkage in unlike[:MAX_IMPROVED]]
    bettered = solve_constrained(rows, free)
    # Improved designs first; the originals remain as alternatives.
    offered = select_distinct_fits([*bettered, *unlike])
    sifting.reject("not_steered", len(first) - len(steered) + len(free) - len(bettered))
    sifting.reject(OUTRANKED_REASON, len(steered) + len(bettered) - len(offered))
    progress(0.8, compose("motion-verifying-linkages", count=len(offered)))
    target = make_target_poses(problem)
    sifting.verify_candidates(offered, lambda linkage: verify_fit(problem, task, rows, linkage.x, target))
    progress(1.0, compose("motion-verified"))
    return MotionResult(
        designs=sifting.select_designs(partial(rank_designs, rank_by=problem.rank_by)),
        curves=exact.curves,
        search=sifting.build_search("tolerance_search"),
        summary=_describe_result(sifting, len(listed), len(sifting.passed) - met, met),
    )


def continue_constrained(problem: MotionProblem, designs: Sequence[LinkageDesign]) -> list[LinkageDesign]:
    """Continue designs of a looser problem to this one by constrained fits; driver dyads are removed first."""
    task, target = make_motion_task(problem), make_target_poses(problem)
    rows = make_target_rows(problem, task)
    # The looser problem's designs may have drivers, which are fitted to the fourbar later.
    bare = (verify(problem, _extract_fourbar(design.mechanism), target) for design in designs[:MAX_IMPROVED])
    room = pack_task_workspace(problem, task)
    free = [
        release_from_start(make_constrained_fit(problem, task, rows, _make_start(problem, task, rows, one), room))
        for one in bare
        if one
    ]
    verified = (
        verify_fit(problem, task, rows, linkage.x, target)
        for linkage in select_distinct_fits(solve_constrained(rows, free))
    )
    return [design for design in verified if isinstance(design, LinkageDesign) and design.verification.passed]


def _extract_fourbar(mechanism: LinkageMechanism) -> FourbarMechanism:
    """Return a linkage's fourbar, without its driver dyad if it has one."""
    if isinstance(mechanism, FourbarMechanism):
        return mechanism
    joints = (complex(*mechanism.skeleton.joints[name]) for name in ("O2", "A", "B", "O4", "P"))
    return build_fourbar(FourbarConfiguration(*joints), mechanism.reference_body_angle)


def _make_start(problem: MotionProblem, task: MotionTask, rows: Real, design: LinkageDesign) -> Start:
    """Convert a verified fourbar to a start, with the poses in which it meets its targets."""
    assert isinstance(design.mechanism, FourbarMechanism)
    fourbar = build_driven_fourbar(design.mechanism)
    at = positions(fourbar.linkage, np.radians([target.position for target in design.targets]), fourbar.assembly)
    shift = compute_body_shift(design.mechanism, problem.positions[0].angle)
    first = float(positions(fourbar.linkage, fourbar.reference, fourbar.assembly).coupler_angle)
    places = (at.p - task.origin) / task.size
    off = at.coupler_angle - first + shift - rows[:, 2]
    offsets = np.stack([places.real - rows[:, 0], places.imag - rows[:, 1], off - math.tau * np.round(off / math.tau)])
    poses = rows[:, :3] + offsets.T
    # Deviations in tolerances; exact coordinates have none.
    shares = np.divide(offsets.T, rows[:, 3:], out=np.zeros_like(poses), where=rows[:, 3:] > 0.0)
    fixed = [task.to_task(complex(pivot)) for pivot in (fourbar.linkage.input_pivot, fourbar.linkage.output_pivot)]
    # Rotate the pins back to the body's first target pose, the frame of the unknowns.
    back = cmath.exp(-1j * float(poses[0, 2]))
    body = [task.points[0] + back * (pin[0] - at.p[0]) / task.size for pin in (at.a, at.b)]
    return Start(np.array([*fixed, *body]), shares, poses)


def _describe_result(sifting: CandidateLog[LinkageDesign], started: int, fit_count: int, exact: int) -> str:
    if not sifting.passed:
        reasons = sifting.format_reasons(OUTRANKED_REASON) or compose("motion-none-rejected")
        return compose("motion-no-fit-within-tolerances", starts=started, reasons=reasons)
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    return join_messages(
        [
            compose("motion-fits-within-tolerances", fits=fit_count, starts=started, exact=exact),
            compose("motion-best-transmission-angle", angle=f"{best:.1f}"),
            compose("motion-better-pose-possible"),
        ]
    )
