"""Quick return over swings and time ratios: ``python -m benchmarks.quick_return``. CPU seconds of one process.

Each row: the best transmission angle, how far measured ratio and swing are off, and the time of the whole job with its
verification.
"""

from __future__ import annotations

import time
from typing import Any

from synthesis.dispatch import solve
from synthesis.registry import list_examples, parse_problem

SWINGS = (20.0, 40.0, 60.0, 80.0, 100.0, 120.0)
TYPES = (
    ("drag_link_rocker", {"swing": 90.0}),
    ("offset_slider_crank", {"stroke": 100.0}),
    ("crank_shaper", {"stroke": 100.0}),
    ("whitworth", {"stroke": 100.0}),
    ("drag_link_slider", {"stroke": 100.0}),
)
RATIOS = (1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6)


def answer(stated: dict[str, Any]) -> tuple[Any, float]:
    """The answer to a problem and its CPU time."""
    problem = parse_problem({"kind": "quick_return", **stated})
    start = time.process_time()
    return solve(problem, lambda fraction, message: None), time.process_time() - start


def main() -> None:
    for stated in list_examples("quick_return"):
        answer(stated)
    print(f"{'crank-rocker':<20}{'transmission':>13}{'links':>8}{'ratio off':>11}{'swing off':>11}{'CPU s':>8}")
    slowest = 0.0
    for swing in SWINGS:
        for ratio in RATIOS:
            result, spent = answer({"time_ratio": ratio, "swing": swing, "mechanism": "fourbar"})
            slowest = max(slowest, spent)
            best = max(
                (design.metrics for design in result.designs), key=lambda metrics: metrics.min_transmission_angle
            )
            off = max(abs(design.metrics.time_ratio - ratio) for design in result.designs)
            swing_off = max(abs(design.metrics.swing - swing) for design in result.designs)
            print(
                f"{f'{swing:g}°, ratio {ratio:g}':<20}{best.min_transmission_angle:>12.3f}°{best.link_ratio:>8.2f}"
                f"{off:>11.1e}{swing_off:>11.1e}{spent:>8.3f}"
            )
    print(f"slowest: {slowest:.3f} s")
    print(f"{'all types':<28}{'transmission':>12}{'links':>8}{'ratio off':>10}{'output off':>11}{'CPU s':>8}")
    for ratio in (1.0, 1.25, 1.6, 2.0, 3.0):
        for name, output in TYPES:
            result, spent = answer({"time_ratio": ratio, **output, "mechanism": name, "rank_by": "transmission_angle"})
            if not result.designs:
                print(f"{f'{name} {ratio:g}':<28} {result.reachable[0].reason}")
                continue
            best = result.designs[0].metrics
            demanded, measured = (90.0, best.swing) if best.stroke is None else (100.0, best.stroke)
            print(
                f"{f'{name} {ratio:g}':<28}{best.min_transmission_angle:>11.3f}°{best.link_ratio:>8.2f}"
                f"{abs(best.time_ratio - ratio):>10.1e}{abs(measured / demanded - 1.0):>11.1e}{spent:>8.3f}"
            )
        for output in ({"swing": 60.0}, {"stroke": 100.0}):
            result, spent = answer({"time_ratio": ratio, **output})
            (what,) = output
            first = result.designs[0].mechanism.type
            print(f"{f'auto, {what}, {ratio:g}':<28}{len(result.designs):>3} designs, first {first:<20}{spent:>11.3f}")


if __name__ == "__main__":
    main()
