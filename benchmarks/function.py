"""Function generation: the classical tasks by three criteria, and planted linkages through two to seven pairs.

Run with ``python -m benchmarks.function``. Errors are the greatest structural errors in degrees (of least squares also
the root mean square), as measured on the driven linkage; ``alternations`` are extremes of changing sign and one size.
``table`` is the optimum that the literature's tasks are known to have, link ratios unlimited; a row fails its purpose
where ``over`` is above 1.01. Times are of the processor.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time
from typing import Any

import numpy as np

from synthesis.designs import FunctionResult
from synthesis.dispatch import solve
from synthesis.function.solver import warm_up
from synthesis.kinds import parse_problem
from tests.synthesis.test_function import CASES, holds, pairs_of, planted_fourbar, scaled_pairs, task_of

CLASSICAL: dict[str, dict[str, Any]] = {
    "x^1.5, 1 to 4": {"name": "power", "exponent": 1.5, "x": [1.0, 4.0]},
    "log x, 1 to 2": {"name": "logarithm", "x": [1.0, 2.0]},
    "sin x, 0 to 90°": {"name": "sine", "x": [0.0, 90.0]},
    "e^x, 0 to 1": {"name": "exponential", "x": [0.0, 1.0]},
    "1/x, 1 to 2": {"name": "reciprocal", "x": [1.0, 2.0]},
    "tan x, 0 to 45°": {"name": "tangent", "x": [0.0, 45.0]},
}
RANGES = ((60.0, 60.0), (60.0, 120.0), (90.0, 90.0), (120.0, 60.0), (120.0, 120.0))
CRITERIA = ("precision", "least_squares", "minimax")


def answered(**fields: Any) -> tuple[FunctionResult, float]:
    """The answer to a problem and the processor's seconds."""
    problem = parse_problem({"kind": "function", **fields})
    start = time.process_time()
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(result, FunctionResult)
    return result, time.process_time() - start


def table() -> None:
    print(f"{'task':<28}{'optimum':>11}{'found':>11}{'over':>8}{'alternations':>14}{'ratio':>8}{'s':>7}")
    for case in CASES:
        result, seconds = answered(**task_of(case), criterion="minimax")
        best, optimum = result.designs[0], case["reference"]["value"]
        error = best.structural_error
        print(
            f"{case['id']:<28}{optimum:>11.6f}{error.max:>11.6f}{error.max / optimum:>8.4f}{error.alternations:>14}"
            f"{best.metrics.link_ratio:>8.1f}{seconds:>7.2f}"
        )


def classical(limit: float | None) -> None:
    heads = ("5 points", "squares", "(rms)", "minimax")
    print(
        f"{'function':<18}{'input':>6}{'output':>7}" + "".join(f"{head:>11}" for head in heads) + f"{'alt.':>6}{'s':>7}"
    )
    for name, function in CLASSICAL.items():
        for ranges in RANGES:
            cells, seconds, alternations = [], 0.0, ""
            for criterion in CRITERIA:
                result, took = answered(
                    function=function,
                    input_range=ranges[0],
                    output_range=ranges[1],
                    criterion=criterion,
                    constraints={"max_link_ratio": limit},
                )
                seconds += took
                if not result.designs:
                    cells += ["–"] * (2 if criterion == "least_squares" else 1)
                    continue
                error = result.designs[0].structural_error
                cells.append(f"{error.max:.6f}")
                if criterion == "least_squares":
                    cells.append(f"{error.rms:.6f}")
                if criterion == "minimax":
                    alternations = str(error.alternations)
            row = "".join(f"{cell:>11}" for cell in cells)
            print(f"{name:<18}{ranges[0]:>6.0f}{ranges[1]:>7.0f}{row}{alternations:>6}{seconds:>7.2f}")


def planted(tasks: int) -> None:
    print(f"{'pairs':>6}{'tasks':>7}{'returned':>10}{'complete':>10}{'most linkages':>15}{'ms (median)':>13}")
    for count in (3, 4, 5, 6, 7):
        rng = np.random.default_rng(count)
        back, complete, most, times = 0, 0, 0, []
        for _ in range(tasks):
            if count <= 5:
                lengths, inputs, outputs = planted_fourbar(rng, count)
                pairs = pairs_of(inputs, outputs)
            else:
                lengths, pairs = scaled_pairs(rng, planted_fourbar(rng, count))
            zeros = {"zeros": {"output": 0.0}} if count == 4 else {}
            result, took = answered(pairs=pairs, constraints={"max_link_ratio": None}, max_designs=50, **zeros)
            back += holds(result, lengths, 1e-5)
            complete += result.search.complete
            most = max(most, len(result.designs))
            times.append(took)
        print(f"{count:>6}{tasks:>7}{back:>10}{complete:>10}{most:>15}{1e3 * statistics.median(times):>13.1f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("--tasks", type=int, default=30, help="planted linkages for each number of pairs")
    parser.add_argument("--ratio", type=float, default=math.inf, help="greatest link ratio of the classical tasks")
    given = parser.parse_args()
    warm_up()
    print("optima of the literature's tasks\n")
    table()
    print("\nclassical tasks\n")
    classical(None if math.isinf(given.ratio) else given.ratio)
    print("\nplanted linkages\n")
    planted(given.tasks)


if __name__ == "__main__":
    main()
