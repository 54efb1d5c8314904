"""Answers to tasks of all linkage kinds, compared with what their skeletons do."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.support.independent.comparison import Beside, Measured
from tests.support.independent.dwell import compare_dwell
from tests.support.independent.function import compare_function
from tests.support.independent.guided import compare_guided
from tests.support.independent.quick_return import compare_quick_return
from tests.support.independent.statements import families
from tests.support.independent.steering import compare_steering
from tests.support.independent.ways import compare_line, compare_parallel

Compare = Callable[[Beside, dict[str, Any]], None]

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
    beside = result.beside(stated["kind"], design, name)
    try:
        KINDS[stated["kind"]](beside, stated)
    except (ArithmeticError, LookupError, ValueError) as error:
        # Something that was not thought of here: the design counts as one that was not compared.
        beside.unmeasured(f"{type(error).__name__}: {error}")
    beside.finish()


def linkages(
    answers: int, names: tuple[str, ...], seed: int, result: Measured, most: int = 10, told: float | None = None
) -> int:
    """Solve tasks of all families in turn until so many designs are compared; how many were.

    ``names`` are those of :func:`tests.support.independent.statements.families`, all where there are none; each is
    asked ``answers`` times at most, and ``most`` designs of an answer are compared. A line says how far it has come
    after each statement that took ``told`` seconds.
    """
    chosen = [family for family in families() if not names or family.name in names]
    unknown = set(names) - {family.name for family in chosen}
    if unknown:
        raise ValueError("no such family: " + ", ".join(sorted(unknown)))
    rngs = {family.name: np.random.default_rng([seed, k]) for k, family in enumerate(chosen)}
    count, clock = 0, time.perf_counter()
    for turn in range(answers):
        for family in chosen:
            if turn % family.every:
                continue
            begun = time.perf_counter()
            statement = family.stated(rngs[family.name])
            designs = solve(parse_problem(statement)).designs[: min(most, answers - count)]
            solved = time.perf_counter()
            for k, design in enumerate(designs):
                compare(result, statement, design, f"{family.name} {turn} (seed {seed}), design {k}")
            count += len(designs)
            if told is not None and time.perf_counter() - begun > told:
                spent = f"{solved - begun:.1f} s solved, {time.perf_counter() - solved:.1f} s measured"
                come = f"{time.perf_counter() - clock:7.0f} s, {count} designs; {family.name} {turn}: {len(designs)}"
                print(f"{come}, {spent}; {len(result.over)} over", file=sys.stderr, flush=True)
            if count >= answers:
                return count
    return count
