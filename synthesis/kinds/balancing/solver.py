"""Balancing: corrections, each verified by the forces of the corrected rotor."""

from __future__ import annotations

from functools import partial

from synthesis.kinds.balancing.design import BalancingResult, RotorDesign
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.rotor import balanced, rotor_of
from synthesis.kinds.balancing.verify_rotor import verify_rotor
from synthesis.model.kind import Progress
from synthesis.outcome.sifting import Sifting


def solve_balancing(problem: BalancingProblem, progress: Progress) -> BalancingResult:
    """Solve a problem of balancing."""
    if problem.object == "linkage":
        from synthesis.kinds.balancing.linkage import solve_linkage

        return solve_linkage(problem, progress)
    progress(0.0, "choosing masses")
    rotor = rotor_of(problem)
    ways = balanced(problem, rotor)
    progress(0.8, "verifying")
    sifting = Sifting[RotorDesign](problem)
    sifting.sift(ways, partial(verify_rotor, problem, rotor))
    progress(1.0, "verified")
    # The smallest residual in the planes also has the smallest grade if the grade refers to these planes.
    proving = {"grade"} if _graded_in_planes(problem) else set()
    complete = all(way.proved for way in ways) and not sifting.rejected.keys() - proving
    return BalancingResult(
        designs=sifting.designs(partial(_ranked, problem)),
        search=sifting.search("rotor", complete=complete),
        summary=_summary(problem, sifting, complete),
    )


def _graded_in_planes(problem: BalancingProblem) -> bool:
    """Return whether the bearings are in the planes, or no bearings count."""
    return problem.supports is None or sorted(problem.supports) == sorted(problem.used_planes)


def _ranked(problem: BalancingProblem, designs: list[RotorDesign]) -> list[RotorDesign]:
    if problem.rank_by == "places":
        return sorted(designs, key=lambda design: (design.metrics.places, design.metrics.residual_unbalance))
    return sorted(designs, key=lambda design: design.metrics.residual_unbalance)


def _summary(problem: BalancingProblem, sifting: Sifting[RotorDesign], complete: bool) -> str:
    """Describe the residual and the proven bound."""
    if not sifting.passed:
        grades = [grade for design in sifting.failed if (grade := design.metrics.grade) is not None]
        told = f" The smallest grade found is {min(grades):.4g} mm/s." if grades else ""
        return ("No design exists." if complete else "No design found.") + told
    planes = len(problem.used_planes)
    where = "in one plane" if planes == 1 else "in two planes"
    first = _ranked(problem, sifting.passed)[0].metrics
    least = min(design.metrics.residual_unbalance for design in [*sifting.passed, *sifting.failed])
    kept = any(design.metrics.residual_unbalance == least for design in sifting.passed)
    if problem.correction is None or problem.correction.placed is None:
        force = " The shaking force is balanced; moments out of the plane remain." if planes == 1 else ""
        return f"Balanced {where}.{force}"
    unit = " g·mm" if problem.units == "si" else ""
    proved = "proven for this number of places" if first.optimal else "not proven to be the best"
    return (
        f"Balanced {where} by {first.places} masses or holes; residual unbalance {first.residual_unbalance:.4g}{unit}. "
        f"The smallest residual found is {least:.4g}{unit}, {proved}{'' if kept else '; its grade exceeds the limit'}."
    )
