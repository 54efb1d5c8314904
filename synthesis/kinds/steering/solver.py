"""Steering: Ackermann's linkage with the least steering error, and Davis's gear, verified from lock to lock."""

from __future__ import annotations

from collections import Counter

from synthesis.kinds.steering.ackermann import ackermann_linkages
from synthesis.kinds.steering.davis import davis_gears
from synthesis.kinds.steering.design import (
    SteeringDesign,
    SteeringMechanisms,
    SteeringResult,
)
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.kinds.steering.verification import verify_steering
from synthesis.model.answer import Search
from synthesis.model.kind import Progress


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
    passed: list[SteeringDesign] = []
    failed: list[SteeringDesign] = []
    rejected: Counter[str] = Counter()
    for mechanism in mechanisms:
        design = verify_steering(problem, mechanism)
        if design is None:
            rejected["cannot_be_driven"] += 1
        elif design.verification.passed:
            passed.append(design)
        else:
            failed.append(design)
            rejected[next(check.name for check in design.verification.checks if not check.passed)] += 1
    progress(1.0, "verified")
    shown = _ranked(passed, problem.rank_by) + (_ranked(failed, problem.rank_by) if problem.include_failed else [])
    # Davis's gear alone has one solution, and its reach is known; Ackermann's is an optimum found by search.
    complete = problem.mechanism == "davis" and not rejected
    return SteeringResult(
        designs=shown[: problem.max_designs],
        search=Search(
            method="steering",
            complete=complete,
            candidates=len(mechanisms),
            accepted=len(passed),
            rejected=dict(rejected),
            seed=problem.seed,
        ),
        summary=" ".join([_summary(passed, rejected, complete=complete), *said]),
    )


def _ranked(designs: list[SteeringDesign], rank_by: str) -> list[SteeringDesign]:
    """Ackermann's linkages, which have no slides, come first; then by what is asked for, ties by the error."""

    def key(design: SteeringDesign) -> tuple[bool, float, float]:
        metrics = design.metrics
        value = {"size": metrics.size, "transmission_angle": -metrics.min_transmission_angle}.get(rank_by, 0.0)
        return design.mechanism.type != "fourbar", value, metrics.steering_error

    return sorted(designs, key=key)


def _summary(passed: list[SteeringDesign], rejected: Counter[str], *, complete: bool) -> str:
    fourbars = [design.metrics.steering_error for design in passed if design.mechanism.type == "fourbar"]
    text = []
    if fourbars:
        text.append(f"The best of {len(fourbars)} Ackermann linkages has a steering error of {min(fourbars):.4f}°.")
    if any(design.mechanism.type == "davis" for design in passed):
        text.append("Davis's gear steers correctly at every angle.")
    if not passed:
        text.append("No design exists." if complete else "No design was found.")
    if rejected:
        text.append(f"Rejected: {', '.join(f'{name} {n}'.replace('_', ' ') for name, n in rejected.items())}.")
    return " ".join(text)
