"""Planted problems with demands, one row at a time.

    python -m benchmarks.demands ROW [--count 100] [--seed 0] [--verbose]

A row is a module of this package: ``tasks(count, seed)`` yields its statements, each with what counts as an answer.
Printed are the share that is answered, and the median and the worst time of a job, verification included, after the
kernels are loaded: wall clock, and processor time of both threads.
"""

from __future__ import annotations

import argparse
import importlib
import pkgutil
import time
from collections.abc import Iterator

import numpy as np

from synthesis.dispatch import compile_kind, solve
from synthesis.registry import parse_problem
from tests.support.demands.task import Task

NO_ROWS = {"__main__", "task", "planted"}
"""Modules of the package that are no rows."""


def rows() -> list[str]:
    """Names of all rows."""
    package = importlib.import_module("tests.support.demands")
    return sorted(module.name for module in pkgutil.iter_modules(package.__path__) if module.name not in NO_ROWS)


def main() -> None:
    """Run a row."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("row", choices=rows())
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--verbose", action="store_true", help="a line for each task")
    given = parser.parse_args()
    row = importlib.import_module(f"tests.support.demands.{given.row}")
    tasks: Iterator[Task] = row.tasks(given.count, given.seed)
    met, walls, spent = 0, [], []
    missed = []
    for task in tasks:
        problem = parse_problem(task.statement)
        if not walls:
            compile_kind(problem.kind)
        clock, begun = time.perf_counter(), time.process_time()
        result = solve(problem, lambda share, message: None)
        walls.append(time.perf_counter() - clock)
        spent.append(time.process_time() - begun)
        answered = task.answered(result)
        met += answered
        if not answered:
            missed.append(task.name)
        if given.verbose:
            print(f"{task.name:<16}{'yes' if answered else 'NO':>5}{walls[-1]:>8.2f} s  {result.summary}", flush=True)
    print(
        f"{given.row}: {met} of {len(walls)} answered; wall s median {np.median(walls):.2f}, worst {max(walls):.2f}; "
        f"CPU s median {np.median(spent):.2f}, worst {max(spent):.2f}"
    )
    if missed:
        print("not answered: " + ", ".join(missed))


if __name__ == "__main__":
    main()
