"""Function generation: the classical tasks by three criteria, and planted linkages through two to seven pairs.

Run with ``python -m benchmarks.function``. Errors are the greatest structural errors in degrees (of least squares also
the root mean square), as measured on the driven linkage; ``alternations`` are extremes of changing sign and one size.
``table`` is the optimum that the literature's tasks are known to have, link ratios unlimited; a row fails its purpose
where ``over`` is above 1.01. "none" is said where no linkage without defect meets five Chebyshev-spaced points. Times
are of the processor.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time
from typing import Any

import numpy as np

from synthesis.dispatch import solve
from synthesis.kinds.function.design import FunctionResult
from synthesis.kinds.function.solver import warm_up
from synthesis.registry import parse_problem
from tests.support.synthesis.function_optimality import CLASSICAL, RANGES
from tests.support.synthesis.function_tasks import (
    CASES,
    holds,
    measured,
    pairs_of,
    planted_fourbar,
    scaled_pairs,
    task_of,
)

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
    """Greatest and root mean square errors over 1001 places, by a closure of the tests; ``best`` is said of a row where
    minimax has the least greatest error of the three and least squares the least mean square."""
    heads = ("5 points", "(rms)", "squares", "(rms)", "minimax", "(rms)")
    print(
        f"{'function':<16}{'input':>6}{'output':>7}"
        + "".join(f"{head:>10}" for head in heads)
        + f"{'alt.':>5}{'best':>5}{'s':>6}"
    )
    shares = np.linspace(0.0, 1.0, 1001)
    for name, function in CLASSICAL.items():
        for ranges in RANGES:
            worst, mean, seconds, alternations = {}, {}, 0.0, ""
            for criterion in CRITERIA:
                task = {"function": function, "input_range": ranges[0], "output_range": ranges[1]}
                result, took = answered(**task, criterion=criterion, constraints={"max_link_ratio": limit})
                seconds += took
                for design in result.designs[:1]:
                    errors = measured(design, task, shares)
                    worst[criterion] = float(np.abs(errors).max())
                    mean[criterion] = math.sqrt(np.trapezoid(errors**2, shares))
                    alternations = str(design.structural_error.alternations)
            best = worst["minimax"] <= min(worst.values()) and mean["least_squares"] <= min(mean.values())
            row = "".join(
                f"{worst[criterion]:>10.6f}{mean[criterion]:>10.6f}" if criterion in worst else f"{'none':>10}{'':>10}"
                for criterion in CRITERIA
            )
            print(
                f"{name:<16}{ranges[0]:>6.0f}{ranges[1]:>7.0f}{row}{alternations:>5}{'yes' if best else 'NO':>5}"
                f"{seconds:>6.2f}"
            )


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
