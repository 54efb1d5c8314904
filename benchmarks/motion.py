"""Motion generation: times of exact problems and of searches, and what the searches find.

    python -m benchmarks.motion [--tasks 100]

Exact problems are Norton's examples and the five-position tasks of tests/cases, solved and verified in process.
Searches are the three- and four-position tasks of tests/cases, and random ordinary ones: the body moves within a few
times its size and turns by up to 90°. Most random tasks of four positions have no linkage; which have, brute force
tells. Times are processor times.
"""

from __future__ import annotations

import argparse
import cmath
import math
import statistics
import time
from typing import Any

import numpy as np

from benchmarks.four_positions import brute_force
from synthesis.dispatch import compile_kind, solve
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.registry import parse_problem
from tests.cases import search_tasks

REPEATS = 400

GOOD_ENOUGH = 20.0
"""Degrees of transmission angle that count in tasks of four positions."""


def at(magnitude: float, degrees: float) -> complex:
    return cmath.rect(magnitude, math.radians(degrees))


def motion(points: list[complex], angles: list[float], **more: Any) -> MotionProblem:
    positions = [{"x": p.real, "y": p.imag, "angle": a} for p, a in zip(points, angles, strict=True)]
    return parse_problem({"kind": "motion", "positions": positions, **more})


EXACT = {
    "2 positions, Norton Example 5-1": motion(
        [0j, at(2.416, 165.2)],
        [0.0, 43.3],
        input_side={"rotations": [38.4], "coupler_vector": {"length": 1.298, "angle": 26.5}},
        output_side={"rotations": [85.6], "coupler_vector": {"length": 1.035, "angle": 104.1}},
    ),
    "3 positions, Norton Example 5-2": motion(
        [0j, at(2.798, -31.19), at(3.919, -16.34)],
        [0.0, -45.0, 9.3],
        input_side={"rotations": [342.3, 324.8]},
        output_side={"rotations": [30.9, 80.6]},
    ),
    "3 positions, Norton Example 5-3": motion(
        [0j, -0.244 + 0.013j, -0.542 + 0.029j],
        [0.0, -11.34, -22.19],
        input_side={"fixed_pivot": [-1.712, 0.033]},
        output_side={"fixed_pivot": [0.288, 0.033]},
    ),
    "3 positions, Norton Problem 5-26": motion(
        [0j, 184 - 17j, 211 - 180j],
        [0.0, -45.0, -90.0],
        input_side={"fixed_pivot": [86.0, -132.0]},
        output_side={"fixed_pivot": [104.0, -155.0]},
    ),
}


def timed(problem: MotionProblem) -> tuple[MotionResult, float]:
    start = time.process_time()
    result = solve(problem, lambda fraction, message: None)
    return result, time.process_time() - start


def ordinary(rng: np.random.Generator, n: int) -> MotionProblem:
    """A task as a designer states it: n places within a few times the body's size, turned by up to ±90°."""
    points = rng.uniform(-1.0, 1.0, n) + 1j * rng.uniform(-1.0, 1.0, n)
    angles = rng.uniform(-90.0, 90.0, n)
    return motion([100.0 * complex(p) for p in points], [float(a) for a in angles])


def stated(n: int) -> list[MotionProblem]:
    """The tasks of n positions of tests/cases."""
    return [parse_problem({"kind": "motion", "positions": task["positions"]}) for task in search_tasks(n)]


def exact_table() -> None:
    print(f"{'exact problem, solved and verified in process':<50}{'median ms':>11}{'p90 ms':>9}")
    for name, problem in EXACT.items():
        result, _ = timed(problem)
        assert len(result.designs) == 1
        assert result.search.complete
        times = [1e3 * timed(problem)[1] for _ in range(REPEATS)]
        print(f"{name:<50}{statistics.median(times):>11.2f}{statistics.quantiles(times, n=10)[-1]:>9.2f}")
    times = []
    for problem in stated(5):
        timed(problem)
        times += [1e3 * timed(problem)[1] for _ in range(REPEATS // 20)]
    name = "5 positions, the tasks of tests/cases"
    print(f"{name:<50}{statistics.median(times):>11.2f}{statistics.quantiles(times, n=10)[-1]:>9.2f}")


def search_row(name: str, problems: list[MotionProblem]) -> None:
    """Time, and how often at least one and at least five designs of transmission angle 30° and more are returned."""
    found = [timed(problem) for problem in problems]
    good = [sum(d.metrics.min_transmission_angle >= 30.0 for d in result.designs) for result, _ in found]
    times = [seconds for _, seconds in found]
    one, five = (100.0 * sum(n >= k for n in good) / len(good) for k in (1, 5))
    print(f"{name:<50}{statistics.median(times):>11.2f}{max(times):>9.2f}{one:>10.1f}{five:>10.1f}")


def four_by_brute_force(problems: list[MotionProblem]) -> None:
    """How often the search reaches 20° where a grid over all dyads does."""
    there = found = alone = 0
    times, grid_times = [], []
    for problem in problems:
        result, seconds = timed(problem)
        times.append(seconds)
        start = time.process_time()
        possible = brute_force(problem, GOOD_ENOUGH) > 0.0
        grid_times.append(time.process_time() - start)
        reached = any(design.metrics.min_transmission_angle >= GOOD_ENOUGH for design in result.designs)
        there += possible
        found += possible and reached
        alone += reached and not possible
    print(f"\n{'4 positions, random ordinary tasks':<42}{'tasks':>8}{'median s':>11}{'worst s':>9}")
    print(f"{'search':<42}{len(problems):>8}{statistics.median(times):>11.2f}{max(times):>9.2f}")
    print(f"{'brute force':<42}{len(problems):>8}{statistics.median(grid_times):>11.2f}{max(grid_times):>9.2f}")
    print(f"{'brute force finds 20° in':<42}{there:>8}")
    print(f"{'of these the search finds 20° in':<42}{found:>8}{100.0 * found / max(there, 1):>10.1f} %")
    print(f"{'the search alone finds 20° in':<42}{alone:>8}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("--tasks", type=int, default=100, help="random tasks per row")
    tasks = parser.parse_args().tasks
    compile_kind("motion")
    exact_table()
    print(f"\n{'search over free choices':<50}{'median s':>11}{'worst s':>9}{'≥ 1, %':>10}{'≥ 5, %':>10}")
    search_row("4 positions, the tasks of tests/cases", stated(4))
    search_row("3 positions, the tasks of tests/cases", stated(3))
    rng = np.random.default_rng(0)
    search_row("3 positions, random ordinary tasks", [ordinary(rng, 3) for _ in range(tasks)])
    search_row("2 positions, random ordinary tasks", [ordinary(rng, 2) for _ in range(tasks)])
    four_by_brute_force([ordinary(rng, 4) for _ in range(tasks)])


if __name__ == "__main__":
    main()
