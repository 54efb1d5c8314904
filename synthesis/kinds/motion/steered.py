"""Constrained fit for two to four positions with tolerances: use the tolerances to satisfy all constraints.

Starting linkages (:mod:`synthesis.kinds.motion.steered_starts`) meet poses sampled within the tolerances. Each is then
fitted to all constraints at once (:mod:`synthesis.kinds.motion.steered_fit`), with every position within its tolerance,
and is driven and verified like any other. Positions without a tolerance are met to rounding.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from kinematics.linkage.fourbar import positions
from synthesis.kinds.motion.demanded import demanded
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.steered_fit import (
    all_steered,
    begun,
    demanded_rows,
    different,
    driven,
    let_go,
    room_of,
)
from synthesis.kinds.motion.steered_starts import Start, starts
from synthesis.kinds.motion.task import MotionTask, Real, motion_task
from synthesis.kinds.motion.verification import verify
from synthesis.model.counting import agreeing, counted
from synthesis.model.kind import Progress
from synthesis.model.linkage_answer import FourbarMechanism, LinkageDesign, LinkageMechanism
from synthesis.model.linkages import FourbarConfiguration, body_shift, driven_fourbar, fourbar_mechanism
from synthesis.outcome.ranking import ranked
from synthesis.outcome.sifting import DEFECTS, LENGTHS, OUTRANKED, Sifting

STARTED, BETTERED = 40, 8
"""Maximum number of starting linkages, which are first fitted close to their starts; and of the distinct results that
are then optimised freely."""

REASONS = DEFECTS | LENGTHS | {"within_tolerance": "tolerance"}
"""Rejection reason by failed check; other checks use their own name."""


def solve_steered(problem: MotionProblem, exact: MotionResult, progress: Progress) -> MotionResult:
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
    task = motion_task(problem)
    rows = demanded_rows(problem, task)
    progress(0.0, "sampling poses within the tolerances")
    listed = starts(problem, task, rows[:, 3:], STARTED)
    progress(0.4, f"fitting {len(listed)} linkages to the tolerances")
    first = [begun(problem, task, rows, start) for start in listed]
    steered = all_steered(rows, first)
    sifting = Sifting[LinkageDesign](problem, REASONS)
    sifting.join(exact.search)
    sifting.passed = [design for design in exact.designs if design.verification.passed]
    sifting.failed = [design for design in exact.designs if not design.verification.passed]
    met = len(sifting.passed)
    # Staying near the starts keeps the fits diverse; only then may the distinct ones move to better minima.
    unlike = different(steered)
    free = [let_go(linkage) for linkage in unlike[:BETTERED]]
    bettered = all_steered(rows, free)
    offered = different([*bettered, *unlike])
    sifting.reject("not_steered", len(first) - len(steered) + len(free) - len(bettered))
    sifting.reject(OUTRANKED, len(steered) + len(bettered) - len(offered))
    progress(0.8, f"verifying {len(offered)} linkages")
    target = demanded(problem)
    sifting.sift(offered, lambda linkage: driven(problem, task, rows, linkage.x, target))
    progress(1.0, "verified")
    return MotionResult(
        designs=sifting.designs(partial(ranked, rank_by=problem.rank_by)),
        curves=exact.curves,
        search=sifting.search("tolerance_search"),
        summary=_summary(sifting, len(listed), len(sifting.passed) - met, met),
    )


def steered_on(problem: MotionProblem, designs: Sequence[LinkageDesign]) -> list[LinkageDesign]:
    """Continue designs of a looser problem to this one by constrained fits; driver dyads are removed first."""
    task, target = motion_task(problem), demanded(problem)
    rows = demanded_rows(problem, task)
    bare = (verify(problem, _fourbar_of(design.mechanism), target) for design in designs[:BETTERED])
    room = room_of(problem, task)
    free = [let_go(begun(problem, task, rows, _start_of(problem, task, rows, one), room)) for one in bare if one]
    verified = (driven(problem, task, rows, linkage.x, target) for linkage in different(all_steered(rows, free)))
    return [design for design in verified if isinstance(design, LinkageDesign) and design.verification.passed]


def _fourbar_of(mechanism: LinkageMechanism) -> FourbarMechanism:
    """Return a linkage's fourbar, without its driver dyad if it has one."""
    if isinstance(mechanism, FourbarMechanism):
        return mechanism
    joints = (complex(*mechanism.skeleton.joints[name]) for name in ("O2", "A", "B", "O4", "P"))
    return fourbar_mechanism(FourbarConfiguration(*joints), mechanism.reference_body_angle)


def _start_of(problem: MotionProblem, task: MotionTask, rows: Real, design: LinkageDesign) -> Start:
    """Convert a verified fourbar to a start, with the poses in which it meets its targets."""
    assert isinstance(design.mechanism, FourbarMechanism)
    fourbar = driven_fourbar(design.mechanism)
    at = positions(fourbar.linkage, np.radians([target.at for target in design.targets]), fourbar.assembly)
    shift = body_shift(design.mechanism, problem.positions[0].angle)
    first = float(positions(fourbar.linkage, fourbar.reference, fourbar.assembly).coupler_angle)
    places = (at.p - task.origin) / task.size
    off = at.coupler_angle - first + shift - rows[:, 2]
    offsets = np.stack([places.real - rows[:, 0], places.imag - rows[:, 1], off - math.tau * np.round(off / math.tau)])
    poses = rows[:, :3] + offsets.T
    shares = np.divide(offsets.T, rows[:, 3:], out=np.zeros_like(poses), where=rows[:, 3:] > 0.0)
    fixed = [task.to_task(complex(pivot)) for pivot in (fourbar.linkage.input_pivot, fourbar.linkage.output_pivot)]
    back = cmath.exp(-1j * float(poses[0, 2]))
    body = [task.points[0] + back * (pin[0] - at.p[0]) / task.size for pin in (at.a, at.b)]
    return Start(np.array([*fixed, *body]), shares, poses)


def _summary(sifting: Sifting[LinkageDesign], started: int, steered: int, exact: int) -> str:
    if not sifting.passed:
        return (
            f"No design found: fits from {counted(started, 'start')} within the tolerances all violate a constraint "
            f"(rejected: {sifting.listed(OUTRANKED) or 'none'}). The search is not exhaustive, so a solution may still "
            "exist."
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    return (
        f"{counted(steered, 'design', 'designs')} from {counted(started, 'start')} "
        f"{agreeing(steered, 'uses', 'use')} the tolerances, and {counted(exact, 'design meets', 'designs meet')} the "
        f"positions exactly. Best minimum transmission angle: {best:.1f}°. The search samples poses within the "
        "tolerances, so a better linkage may exist."
    )
