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
    # What leaves least in the planes has the least grade where the grade is of these planes.
    proving = {"grade"} if _graded_in_planes(problem) else set()
    complete = all(way.proved for way in ways) and not sifting.rejected.keys() - proving
    return BalancingResult(
        designs=sifting.designs(partial(_ranked, problem)),
        search=sifting.search("rotor", complete=complete),
        summary=_summary(problem, sifting, complete),
    )


def _graded_in_planes(problem: BalancingProblem) -> bool:
    """Whether the bearings are in the planes, or there are none that count."""
    return problem.supports is None or sorted(problem.supports) == sorted(problem.used_planes)


def _ranked(problem: BalancingProblem, designs: list[RotorDesign]) -> list[RotorDesign]:
    if problem.rank_by == "places":
        return sorted(designs, key=lambda design: (design.metrics.places, design.metrics.residual_unbalance))
    return sorted(designs, key=lambda design: design.metrics.residual_unbalance)


def _summary(problem: BalancingProblem, sifting: Sifting[RotorDesign], complete: bool) -> str:
    """What is left, and what is proved, in words."""
    if not sifting.passed:
        grades = [grade for design in sifting.failed if (grade := design.metrics.grade) is not None]
        told = f" The least grade that was found is {min(grades):.4g} mm/s." if grades else ""
        return ("No design exists." if complete else "No design was found.") + told
    planes = len(problem.used_planes)
    where = "in one plane" if planes == 1 else "in two planes"
    first = _ranked(problem, sifting.passed)[0].metrics
    least = min(design.metrics.residual_unbalance for design in [*sifting.passed, *sifting.failed])
    kept = any(design.metrics.residual_unbalance == least for design in sifting.passed)
    if problem.correction is None or problem.correction.placed is None:
        force = " The force is balanced; what the masses do out of the plane is left." if planes == 1 else ""
        return f"Balanced {where}.{force}"
    unit = " g·mm" if problem.units == "si" else ""
    proved = "than which no choice of the places leaves less" if first.optimal else "and better choices may exist"
    return (
        f"Balanced {where} by {first.places} masses or holes, up to {first.residual_unbalance:.4g}{unit}. "
        f"The least that was found is {least:.4g}{unit}, {proved}{'' if kept else '; its grade is beyond the limit'}."
    )
