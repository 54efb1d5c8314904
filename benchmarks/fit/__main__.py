"""Solve planted tasks of a row, and hold every design against its room by another route.

    python -m benchmarks.fit ROW [--count 100] [--seed 1] [--first 0] [--verbose]

A line for each task that is not answered, and for each design that breaks what it is said to keep; then a table by
groups: tasks answered, median and worst seconds of a job after the kernels are loaded, wall clock and processor time of
all threads, and violations.
"""

from __future__ import annotations

import argparse
import importlib
import pkgutil
import time
from collections import defaultdict
from typing import NamedTuple

import numpy as np

from synthesis.dispatch import compile_kind, solve
from synthesis.registry import parse_problem
from tests.support.fit.task import Task
from tests.support.fit.verdict import violations

NO_ROWS = {"__main__", "linkage", "room", "task", "verdict"}
"""Modules of the package that are no rows."""


class _Run(NamedTuple):
    """What became of a task."""

    answered: bool
    wall: float
    spent: float
    designs: int
    broken: int


def rows() -> list[str]:
    """Names of all rows."""
    package = importlib.import_module("tests.support.fit")
    return sorted(module.name for module in pkgutil.iter_modules(package.__path__) if module.name not in NO_ROWS)


def main() -> None:
    """Run a row."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("row", choices=rows())
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first task that is solved")
    parser.add_argument("--verbose", action="store_true", help="a line for each task")
    given = parser.parse_args()
    row = importlib.import_module(f"tests.support.fit.{given.row}")
    groups: dict[str, list[_Run]] = defaultdict(list)
    warm = False
    for task in row.tasks(given.count, given.seed):
        if task.number >= given.first:
            if not warm:
                compile_kind(task.statement["kind"])
                warm = True
            groups[task.group].append(_solved(task, told=given.verbose))
    print(f"{'':<34}{'answered':>10}{'wall s':>14}{'CPU s':>14}{'designs':>9}{'violations':>12}")
    for group, runs in sorted(groups.items()):
        print(_line(group, runs))
    print(_line("all", [run for runs in groups.values() for run in runs]))


def _solved(task: Task, *, told: bool) -> _Run:
    """Solve a task, and look at each design of its answer."""
    problem = parse_problem(task.statement)
    clock, begun = time.perf_counter(), time.process_time()
    result = solve(problem)
    wall, spent = time.perf_counter() - clock, time.process_time() - begun
    passed = [design for design in result.designs if design.verification.passed]
    good = [design for design in passed if task.good(design)]
    if told or not good:
        verdict = f"{len(good)} designs" if good else "NONE"
        print(f"{task.number:>4} {task.group}: {verdict}, {spent:.2f} s CPU. {result.summary}", flush=True)
    broken = 0
    for n, design in enumerate(passed):
        faults = violations(task.statement, design)
        broken += bool(faults)
        if faults:
            print(f"{task.number:>4} {task.group}: design {n} VIOLATES: {'; '.join(faults)}", flush=True)
    return _Run(bool(good), wall, spent, len(passed), broken)


def _line(name: str, runs: list[_Run]) -> str:
    answered = f"{sum(run.answered for run in runs)}/{len(runs)}"
    columns = [
        f"{np.median(values):.2f} {max(values):.2f}"
        for values in ([run.wall for run in runs], [run.spent for run in runs])
    ]
    designs, broken = sum(run.designs for run in runs), sum(run.broken for run in runs)
    return f"{name:<34}{answered:>10}{columns[0]:>14}{columns[1]:>14}{designs:>9}{broken:>12}"


if __name__ == "__main__":
    main()
