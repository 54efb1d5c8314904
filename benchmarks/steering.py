"""Steering errors of the best Ackermann linkages: ``python -m benchmarks.steering``. CPU seconds of one process."""

from __future__ import annotations

import time

from synthesis.dispatch import solve
from synthesis.kinds.steering.design import SteeringResult
from synthesis.registry import get_first_example, parse_problem

VEHICLES = (
    ("Rao, Solved Problem 4.6", 2.745, 1.22, 33.0),
    ("car", 2.7, 1.4, 38.0),
    ("truck", 5.5, 1.9, 45.0),
    ("tractor", 2.2, 1.5, 55.0),
)
"""Wheelbase and pivot distance, metres, and lock, degrees."""


def main() -> None:
    solve(parse_problem(get_first_example("steering")), lambda fraction, message: None)
    heads = f"{'arm/pivot':>11}{'arm angle':>11}{'error':>9}{'Davis':>10}{'CPU s':>8}"
    print(f"{'vehicle':<26}{'lock':>6}{'tie rod':>9}{heads}")
    for name, wheelbase, pivot, lock in VEHICLES:
        stated = {"kind": "steering", "wheelbase": wheelbase, "pivot_distance": pivot, "lock": lock}
        problem = parse_problem(stated)
        start = time.process_time()
        result = solve(problem, lambda fraction, message: None)
        spent = time.process_time() - start
        assert isinstance(result, SteeringResult)
        davis = max(d.metrics.steering_error for d in result.designs if d.mechanism.type == "davis")
        for side in ("behind", "ahead"):
            of_side = [d for d in result.designs if d.mechanism.type == "fourbar" and d.metrics.tie_rod == side]
            best = of_side[0].metrics
            print(
                f"{name:<26}{lock:>5g}°{side:>9}{best.arm_length / pivot:>11.3f}{best.arm_angle:>10.3f}°"
                f"{best.steering_error:>8.4f}°{davis:>10.1e}{spent:>8.3f}"
            )


if __name__ == "__main__":
    main()
