"""Entry point of balancing: corrections of rotors, each verified by the forces of the corrected rotor, and linkages."""

from __future__ import annotations

from functools import partial

from kinematics.message import compose
from synthesis.kinds.balancing.design import BalancingResult, RotorDesign
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.rotor.solver import balance_rotor, build_rotor
from synthesis.kinds.balancing.verification.rotor import verify_rotor
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.ranking import sort_designs
from synthesis.results.remarks import append_remark, write_quantity


def solve_balancing(problem: BalancingProblem, progress: Progress) -> BalancingResult:
    """Solve a problem of balancing."""
    if problem.object == "linkage":
        from synthesis.kinds.balancing.linkage_solver import solve_linkage

        return solve_linkage(problem, progress)
    progress(0.0, compose("balancing-choosing-masses"))
    rotor = build_rotor(problem)
    ways = balance_rotor(problem, rotor)
    progress(0.8, compose("results-verifying"))
    sifting = CandidateLog[RotorDesign](problem)
    sifting.verify_candidates(ways, partial(verify_rotor, problem, rotor))
    progress(1.0, compose("results-verified"))
    # The correction with the smallest residual also has the smallest grade if the grade refers to the same planes.
    proving = {"grade"} if _is_graded_in_planes(problem) else set()
    complete = all(way.proved for way in ways) and not sifting.rejected.keys() - proving
    return BalancingResult(
        designs=sifting.select_designs(partial(_rank_designs, problem)),
        search=sifting.build_search("rotor", complete=complete),
        summary=_write_summary(problem, sifting, complete),
    )


def _is_graded_in_planes(problem: BalancingProblem) -> bool:
    """Return whether the bearings lie in the planes of correction, or no bearings are given."""
    return problem.supports is None or sorted(problem.supports) == sorted(problem.used_planes)


def _rank_designs(problem: BalancingProblem, designs: list[RotorDesign]) -> list[RotorDesign]:
    by_places = [_get_place_count] if problem.rank_by == "places" else []
    return sort_designs(designs, *by_places, _get_residual)


def _get_place_count(design: RotorDesign) -> float:
    return design.metrics.places


def _get_residual(design: RotorDesign) -> float:
    return design.metrics.residual_unbalance


def _write_summary(problem: BalancingProblem, sifting: CandidateLog[RotorDesign], complete: bool) -> str:
    """Describe the residual and the proven bound."""
    if not sifting.passed:
        grades = [grade for design in sifting.failed if (grade := design.metrics.grade) is not None]
        remark = compose("balancing-smallest-grade", grade=f"{min(grades):.4g}") if grades else ""
        return append_remark(compose("balancing-none-exists" if complete else "balancing-none-found"), remark)
    planes = len(problem.used_planes)
    first = _rank_designs(problem, sifting.passed)[0].metrics
    least = min(design.metrics.residual_unbalance for design in [*sifting.passed, *sifting.failed])
    kept = any(design.metrics.residual_unbalance == least for design in sifting.passed)
    if problem.correction is None or problem.correction.place_choice is None:
        return compose("balancing-rotor-balanced", planes=planes)
    unit = "g·mm" if problem.units == "si" else ""
    balanced = compose(
        "balancing-rotor-balanced-by-places",
        planes=planes,
        places=first.places,
        residual=write_quantity(f"{first.residual_unbalance:.4g}", unit),
    )
    if first.optimal:
        smallest = "balancing-smallest-residual-proven" if kept else "balancing-smallest-residual-proven-grade-exceeded"
    else:
        smallest = "balancing-smallest-residual" if kept else "balancing-smallest-residual-grade-exceeded"
    return append_remark(balanced, compose(smallest, residual=write_quantity(f"{least:.4g}", unit)))
