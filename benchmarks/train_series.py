"""Trains in series against a brute force, and the times of searches: ``python -m benchmarks.train_series``.

Random statements of two and three units are solved and gone through by a loop that knows nothing of the solver
(:mod:`tests.support.independent.train_series`): the least error, how many series have it, the fewest teeth of these,
the number of all series, and whether there is one at all, have to be the same. Times are CPU seconds of one process.
"""

from __future__ import annotations

import argparse
import time
from random import Random
from typing import Any

from synthesis.dispatch import solve
from synthesis.kinds.train_series.design import TrainSeriesResult
from synthesis.registry import parse_problem
from tests.support.independent.train_series import best_series, statements
from tests.support.problems.train_series import same

SIMPLE: dict[str, Any] = {
    "type": "planetary_train",
    "arrangement": "simple",
    "input": "sun",
    "output": "carrier",
    "fixed": "ring",
}
GEARS: dict[str, Any] = {"type": "gear_train", "teeth": {"min": 17, "max": 100}}
OPEN = {"type": "planetary_train", "arrangement": "simple"}

TIMED: list[tuple[str, dict[str, Any]]] = [
    ("two simple sets, 17 to 100 teeth", {"ratio": "pi*20", "units": [SIMPLE, SIMPLE]}),
    ("two simple sets, all members", {"ratio": "pi*20", "units": [OPEN, {**OPEN, "planets": 4}]}),
    ("two simple sets, smallest", {"ratio": "50", "units": [SIMPLE] * 2, "rank_by": "size", "tolerance": 1e-3}),
    ("a winch of 333", {"ratio": 333, "units": [SIMPLE, {**SIMPLE, "planets": 4}, SIMPLE]}),
    ("gears, set and set", {"ratio": "-900", "units": [GEARS, SIMPLE, SIMPLE]}),
    ("stepped and simple", {"ratio": "333", "units": [{**SIMPLE, "arrangement": "stepped"}, SIMPLE]}),
    ("Wolfrom and gears", {"ratio": "-5000", "units": [{"type": "planetary_train", "arrangement": "wolfrom",
        "input": "sun", "output": "ring_2", "fixed": "ring_1", "teeth": {"max": 50, "ring_max": 120}}, GEARS]}),
]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tasks", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    agreed = none = 0
    for statement in statements(options.tasks, Random(options.seed)):
        result, best = solve(parse_problem(statement)), best_series(statement)
        assert isinstance(result, TrainSeriesResult)
        if same(result, best):
            agreed += 1
            none += best.error is None
        else:
            print(f"differs: {statement}\n  {result.summary}\n  {best}")
    print(f"{agreed} of {options.tasks} series agree with the brute force, {none} of them that there is none")
    for name, statement in TIMED:
        problem = parse_problem({"kind": "train_series", **statement})
        start = time.process_time()
        result = solve(problem)
        print(f"{name:36s} {time.process_time() - start:7.2f} s  {result.summary}")


if __name__ == "__main__":
    main()
