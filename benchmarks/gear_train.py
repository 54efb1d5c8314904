"""Gear trains: times of proven searches, what they cover, and what they find.

    python -m benchmarks.gear_train [--repeats 5]

Times are of the process's CPU, from the parsed problem to the verified answer, the kernels compiled before. `covered`
is the number of trains that the proof covers. The limits are those that the service sets itself.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import time
from typing import Any

from synthesis.dispatch import compile_kind, solve
from synthesis.kinds.gear_train.design import GearTrainResult
from synthesis.registry import parse_problem

WIDE, NARROW = {"min": 12, "max": 100}, {"min": 12, "max": 60}

TASKS: dict[str, tuple[float | None, dict[str, Any]]] = {
    "2 stages, 15-100, pi": (0.05, {"ratio": "pi", "max_stages": 2, "teeth": {"min": 15, "max": 100}}),
    "2 stages, 12-100, 1/7.3": (0.05, {"ratio": "1/7.3", "max_stages": 2, "teeth": WIDE}),
    "3 stages, 12-100, pi": (2.0, {"ratio": "pi", "max_stages": 3, "teeth": WIDE}),
    "3 stages, 12-100, 180": (2.0, {"ratio": 180, "max_stages": 3, "teeth": WIDE}),
    "3 stages, 12-100, 1": (2.0, {"ratio": 1, "max_stages": 3, "teeth": WIDE}),
    "3 stages, 12-100, e, stage ratio 3": (2.0, {"ratio": "e", "max_stages": 3, "teeth": WIDE, "max_stage_ratio": 3.0}),
    "3 stages, 12-100, pi, hunting teeth": (
        2.0,
        {"ratio": "pi", "max_stages": 3, "teeth": WIDE, "hunting_tooth": "require"},
    ),
    "3 stages, 12-100, 500": (2.0, {"ratio": 500, "max_stages": 3, "teeth": WIDE}),
    "3 stages, 12-100, 1000, out of reach": (2.0, {"ratio": 1000, "max_stages": 3, "teeth": WIDE}),
    "3 stages, 12-100, smallest exact 24": (
        2.0,
        {"ratio": 24, "max_stages": 3, "teeth": WIDE, "rank_by": "size", "tolerance": 0},
    ),
    "4 stages, 12-60, pi": (10.0, {"ratio": "pi", "max_stages": 4, "teeth": NARROW}),
    "4 stages, 12-60, 1": (10.0, {"ratio": 1, "max_stages": 4, "teeth": NARROW}),
    "4 stages, 12-60, 400": (10.0, {"ratio": 400, "max_stages": 4, "teeth": NARROW}),
    "reverted, 2 stages, 15-100, 3.1416": (
        0.05,
        {"ratio": "3.1416", "max_stages": 2, "teeth": {"min": 15, "max": 100}, "reverted": True},
    ),
    "reverted, 3 stages, 12-100, pi": (10.0, {"ratio": "pi", "max_stages": 3, "teeth": WIDE, "reverted": True}),
    "reverted, 3 stages, 12-100, 3 modules": (
        10.0,
        {"ratio": "pi", "max_stages": 3, "teeth": WIDE, "reverted": True, "module": [1.0, 1.25, 1.5]},
    ),
    "reverted, 4 stages, 12-100, pi": (None, {"ratio": "pi", "max_stages": 4, "teeth": WIDE, "reverted": True}),
    "4 stages, 12-100, pi": (None, {"ratio": "pi", "max_stages": 4, "teeth": WIDE}),
    "3 stages, 12-250, pi": (None, {"ratio": "pi", "max_stages": 3, "teeth": {"min": 12, "max": 250}}),
    "stock of 21, 3 stages, 64/5": (None, {"ratio": "64/5", "max_stages": 3, "stock": list(range(20, 121, 5))}),
}


def timed(statement: dict[str, Any], repeats: int) -> tuple[float, GearTrainResult]:
    problem = parse_problem({"kind": "gear_train", **statement})
    times = []
    for _ in range(repeats):
        start = time.process_time()
        result = solve(problem, lambda fraction, message: None)
        times.append(time.process_time() - start)
        if times[-1] > 1.0:
            break
    assert isinstance(result, GearTrainResult)
    return statistics.median(times), result


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--repeats", type=int, default=5)
    repeats = parser.parse_args().repeats
    compile_kind("gear_train")
    print(f"{'task':38} {'CPU s':>8} {'limit':>6} {'covered':>9} {'ties':>7} {'pareto':>6} {'error':>9}  best")
    for name, (limit, statement) in TASKS.items():
        seconds, result = timed(statement, repeats)
        best = result.designs[0] if result.designs else None
        stages = " ".join(f"{s.driver}:{s.driven}" for s in best.mechanism.stages) if best else "none"
        error = f"{abs(best.metrics.relative_error):.2e}" if best else "-"
        over = " OVER" if limit is not None and seconds > limit else ""
        print(
            f"{name:38} {seconds:8.3f} {limit or '-':>6} {result.search.combinations:9.2e} {result.search.ties:7} "
            f"{len(result.pareto):6} {error:>9}  {stages}{over}"
        )
    print(f"largest memory: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")


if __name__ == "__main__":
    main()
