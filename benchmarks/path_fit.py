"""Fourbars fitted to the path problems of the optimization literature: our error beside the published ones.

    python -m benchmarks.path_fit [--seeds 3] [--row closed18_timed]

Points, bounds and rules are those of ``tests/cases/path_benchmarks.json``. `ours` is the worst of the seeds: the sum of
squared distances that the verification measures on the finished linkage, or its root where the row says so. `reference`
is the best value that is known, `published` the best that is printed. CPU seconds are from the parsed problem to the
verified answer, the slowest of the seeds.
"""

from __future__ import annotations

import argparse
import math
import time

from synthesis.dispatch import solve
from synthesis.kinds.path.design import PathResult
from synthesis.kinds.path.solver import warm_up
from synthesis.registry import parse_problem
from tests.support.problems.path_fit import best_published, rows, statement

LIMIT_S = 2.0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--row", default="")
    arguments = parser.parse_args()
    warm_up()
    print(f"{'row':<20}{'points':>7}{'ours':>14}{'published':>14}{'reference':>14}{'CPU s':>8}  reached")
    missed = 0
    for row in rows():
        if arguments.row not in row["id"]:
            continue
        worst, slowest = 0.0, 0.0
        for seed in range(arguments.seeds):
            problem = parse_problem(statement(row, seed))
            began = time.process_time()
            result = solve(problem, lambda share, message: None)
            slowest = max(slowest, time.process_time() - began)
            assert isinstance(result, PathResult)
            sound = (design.metrics.sum_of_squares for design in result.designs if design.verification.passed)
            worst = max(worst, min(sound, default=math.inf))
        published, reference = best_published(row), row.get("reference", {})
        allowed = [published] if published is not None else []
        if reference.get("must"):
            allowed.append(reference["value"] * (1.0 + reference["tol"]) + reference["atol"])
        reached = worst <= min(allowed, default=math.inf)
        missed += not reached
        known = reference.get("value")
        print(
            f"{row['id']:<20}{len(row['inputs']['points']):>7}{worst:>14.6g}"
            f"{'-' if published is None else format(published, '.6g'):>14}"
            f"{'-' if known is None else format(known, '.6g'):>14}{slowest:>8.2f}  {'yes' if reached else 'NO'}"
        )
    print(f"rows missed: {missed}; limit {LIMIT_S} s")


if __name__ == "__main__":
    main()
