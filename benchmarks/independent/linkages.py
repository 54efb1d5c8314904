"""Answers to ordinary tasks of all linkage kinds, compared with what their skeletons do."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from benchmarks.demands.ordinary import KINDS as ORDINARY
from benchmarks.demands.ordinary import tasks
from benchmarks.independent.comparison import Measured
from benchmarks.independent.guided import compare_guided
from benchmarks.independent.outputs import compare_dwell, compare_function, compare_quick_return
from benchmarks.independent.steering import compare_steering
from benchmarks.independent.ways import compare_line, compare_parallel
from synthesis.dispatch import solve
from synthesis.registry import parse_problem

Compare = Callable[[Measured, dict[str, Any], Any, str], set[str]]

KINDS: dict[str, Compare] = {
    "motion": compare_guided,
    "path": compare_guided,
    "function": compare_function,
    "dwell": compare_dwell,
    "quick_return": compare_quick_return,
    "straight_line": compare_line,
    "parallel_motion": compare_parallel,
    "steering": compare_steering,
}


def compare(result: Measured, stated: dict[str, Any], design: Any, name: str) -> None:
    """Compare all that a design states and its skeleton shows."""
    compared = KINDS[stated["kind"]](result, stated, design, name)
    result.leave(design, compared)


def linkages(answers: int, names: tuple[str, ...], seed: int, result: Measured, most: int = 10) -> int:
    """Solve so many ordinary tasks of a name at most, until so many designs are compared; how many were.

    ``names`` are those of :data:`benchmarks.demands.ordinary.KINDS`, all where there are none; ``most`` designs of an
    answer are compared.
    """
    count = 0
    for task in tasks(len(ORDINARY) * answers, seed):
        if names and task.name.rpartition(" ")[0] not in names:
            continue
        for k, design in enumerate(solve(parse_problem(task.statement)).designs[:most]):
            compare(result, task.statement, design, f"{task.name} (seed {seed}), design {k}")
            count += 1
        if count >= answers:
            break
    return count
