"""Steering: Ackermann's linkage with the minimum steering error, and Davis's gear, verified from lock to lock."""

from __future__ import annotations

from functools import partial

from kinematics.message import compose, join_messages
from synthesis.kinds.steering.ackermann import find_ackermann_linkages
from synthesis.kinds.steering.davis import build_davis_gears
from synthesis.kinds.steering.design import SteeringDesign, SteeringMechanisms, SteeringResult
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.kinds.steering.verification import verify_steering
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.practicality import is_judged
from synthesis.results.ranking import rank_designs


def solve_steering(problem: SteeringProblem, progress: Progress) -> SteeringResult:
    """Solve a problem of steering."""
    mechanisms: list[SteeringMechanisms] = []
    remarks = []
    progress(0.0, compose("steering-fitting-ackermann"))
    if problem.mechanism in ("ackermann", "auto"):
        linkages = find_ackermann_linkages(problem)
        mechanisms += linkages
        if not linkages:
            remarks.append(compose("steering-lock-out-of-reach"))
    progress(0.8, compose("steering-verifying"))
    if problem.mechanism in ("davis", "auto"):
        mechanisms += build_davis_gears(problem)
    sifting = CandidateLog[SteeringDesign](problem)
    sifting.verify_candidates(mechanisms, partial(verify_steering, problem))
    progress(1.0, compose("steering-verified"))
    # Only Davis's gear has a single solution with a known reach; Ackermann's is an optimum found by search.
    complete = problem.mechanism == "davis" and not sifting.rejected
    return SteeringResult(
        designs=sifting.select_designs(partial(_rank_designs, problem.rank_by)),
        search=sifting.build_search("steering", complete=complete),
        summary=join_messages([_describe_result(problem, sifting, complete=complete), *remarks]),
    )


def _rank_designs(rank_by: str, designs: list[SteeringDesign]) -> list[SteeringDesign]:
    """Rank designs: Ackermann's linkages, without slides, come first; steering error decides quality and accuracy."""
    return rank_designs(
        designs,
        rank_by,
        {"quality": _get_steering_error, "accuracy": _get_steering_error},
        group=lambda design: design.mechanism.type != "fourbar",
        ties=_get_steering_error,
    )


def _get_steering_error(design: SteeringDesign) -> float:
    return design.metrics.steering_error


def _describe_result(problem: SteeringProblem, sifting: CandidateLog[SteeringDesign], *, complete: bool) -> str:
    passed = sifting.passed
    fourbars = [design.metrics.steering_error for design in passed if design.mechanism.type == "fourbar"]
    text = []
    if fourbars:
        text.append(compose("steering-best-error", count=len(fourbars), error=f"{min(fourbars):.4f}"))
    clearances = [clear for design in passed if (clear := design.metrics.tie_rod_clearance) is not None]
    if is_judged(problem) and clearances and min(clearances) < 0.0 <= max(clearances):
        text.append(compose("steering-inside-wheels-first"))
    if any(design.mechanism.type == "davis" for design in passed):
        text.append(compose("steering-davis-is-exact"))
    if not passed:
        text.append(compose("steering-none-exists") if complete else compose("steering-none-found"))
    return join_messages([*text, sifting.describe_reasons().strip()])
