"""Dwells: sixbars whose output rests while the crank continues to turn."""

from __future__ import annotations

from synthesis.kinds.dwell.design import DwellDesign, DwellMechanism, DwellResult
from synthesis.kinds.dwell.gallery import GALLERY
from synthesis.kinds.dwell.problem import DwellProblem
from synthesis.kinds.dwell.shorter_dwells import SHORTER_DWELLS
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: DwellProblem, progress: Progress) -> DwellResult:
    from synthesis.kinds.dwell.solver import solve_dwell

    return solve_dwell(problem, progress)


def _warm_up() -> None:
    from synthesis.kinds.dwell.solver import warm_up

    warm_up()


def _verify(problem: DwellProblem, mechanism: DwellMechanism) -> DwellDesign | None:
    from synthesis.kinds.dwell.verification import verify_dwell

    return verify_dwell(problem, mechanism)


KIND = Kind(
    "dwell",
    DwellProblem,
    DwellResult,
    _solve,
    _warm_up,
    verify=_verify,
    easing=SHORTER_DWELLS,
    gallery=GALLERY,
)
