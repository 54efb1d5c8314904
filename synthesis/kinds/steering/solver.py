"""Steering: Ackermann's linkage with the minimum steering error, and Davis's gear, verified from lock to lock."""

from __future__ import annotations

from functools import partial

from synthesis.kinds.steering.ackermann import ackermann_linkages
from synthesis.kinds.steering.davis import davis_gears
from synthesis.kinds.steering.design import SteeringDesign, SteeringMechanisms, SteeringResult
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.kinds.steering.verification import verify_steering
from synthesis.model.counting import counted
from synthesis.model.kind import Progress
from synthesis.outcome.ranking import ranked
from synthesis.outcome.sifting import Sifting


def solve_steering(problem: SteeringProblem, progress: Progress) -> SteeringResult:
    """Solve a problem of steering."""
    mechanisms: list[SteeringMechanisms] = []
    said = []
    progress(0.0, "fitting Ackermann's linkage")
    if problem.mechanism in ("ackermann", "auto"):
        linkages = ackermann_linkages(problem)
        mechanisms += linkages
        if not linkages:
            said.append("No Ackermann linkage with such arms reaches the lock.")
    progress(0.8, "verifying")
    if problem.mechanism in ("davis", "auto"):
        mechanisms += davis_gears(problem)
    sifting = Sifting[SteeringDesign](problem)
    sifting.sift(mechanisms, partial(verify_steering, problem))
    progress(1.0, "verified")
    # Only Davis's gear has a single solution with a known reach; Ackermann's is an optimum found by search.
    complete = problem.mechanism == "davis" and not sifting.rejected
    return SteeringResult(
        designs=sifting.designs(partial(_ranked, problem.rank_by)),
        search=sifting.search("steering", complete=complete),
        summary=" ".join([_summary(sifting, complete=complete), *said]),
    )


def _ranked(rank_by: str, designs: list[SteeringDesign]) -> list[SteeringDesign]:
    """Rank designs: Ackermann's linkages, without slides, come first; steering error decides quality and accuracy."""
    return ranked(
        designs,
        rank_by,
        {"quality": _steering_error, "accuracy": _steering_error},
        group=lambda design: design.mechanism.type != "fourbar",
        ties=_steering_error,
    )


def _steering_error(design: SteeringDesign) -> float:
    return design.metrics.steering_error


def _summary(sifting: Sifting[SteeringDesign], *, complete: bool) -> str:
    passed = sifting.passed
    fourbars = [design.metrics.steering_error for design in passed if design.mechanism.type == "fourbar"]
    text = []
    if fourbars:
        text.append(
            f"The best of {counted(len(fourbars), 'Ackermann linkage')} has a steering error of {min(fourbars):.4f}°."
        )
    if any(design.mechanism.type == "davis" for design in passed):
        text.append("Davis's gear steers correctly at every angle.")
    if not passed:
        text.append("No design exists." if complete else "No design was found.")
    if sifting.rejected:
        text.append(f"Rejected: {sifting.listed()}.")
    return " ".join(text)
