"""The one door to every solver."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from kinematics import linkage
from synthesis.designs import Result
from synthesis.kinds import KINDS, Progress, example, examples, parse_problem
from synthesis.problems import StatedProblem

__all__ = ["Progress", "solve", "warm_up", "warm_up_kind", "warm_up_rest"]


def solve(problem: StatedProblem, progress: Progress) -> Result[Any]:
    """Solve a problem and verify every design.

    Parameters
    ----------
    problem : StatedProblem
        A statement without contradictions.
    progress : callable
        Told from time to time how far the work is.

    Raises
    ------
    ContradictionError
        Where ``problem.contradictions()`` is not empty.
    """
    problem.require_consistent()
    module, function = KINDS[problem.kind].solver.split(":")
    result = getattr(import_module(module), function)(problem, progress)
    assert isinstance(result, Result)
    return result


def warm_up() -> None:
    """Compile the kernels of the most usual jobs, or load them from their cache; the rest is :func:`warm_up_rest`."""
    solve(parse_problem(example("motion")), _silent)


def warm_up_rest() -> None:
    """Compile or load everything else: the analysis core, and what the solvers of all kinds need."""
    linkage.warm_up()
    for name in KINDS:
        warm_up_kind(name)


def warm_up_kind(name: str) -> None:
    """Compile or load what the solver of one kind needs.

    A solver's module that has a ``warm_up`` of its own is warmed by that, any other by the examples of its kind.
    """
    module = import_module(KINDS[name].solver.split(":")[0])
    if hasattr(module, "warm_up"):
        module.warm_up()
        return
    for one in examples(name):
        solve(parse_problem(one), _silent)


def _silent(_fraction: float, _message: str) -> None:
    pass
