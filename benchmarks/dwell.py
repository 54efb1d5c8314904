"""Dwell sixbars: what is found for a range of tasks, and times.

    python -m benchmarks.dwell

Times are of the process (CPU), after the kernels are loaded.
"""

from __future__ import annotations

import time
from typing import Any

from synthesis.dispatch import solve
from synthesis.kinds.dwell.solver import warm_up
from synthesis.registry import parse_problem

TASKS: list[dict[str, Any]] = [
    {"mechanism": kind, "count": count, "dwell_angle": dwell, "output": output}
    for kind, output in (
        ("pseudo_arc", {"type": "rocker", "swing": 90.0}),
        ("pseudo_arc", {"type": "rocker", "swing": 40.0}),
        ("pseudo_arc", {"type": "slider", "stroke": 50.0}),
        ("straight_slot", {"type": "rocker", "swing": 50.0}),
    )
    for count, dwell in ((1, 60.0), (1, 120.0), (2, 40.0))
]


def main() -> None:
    warm_up()
    print("Designs within a hundredth of the way; of the best by jitter: share of the way, width, transmission angle")
    print(
        f"{'type':>14} {'output':>16} {'dwells':>9} {'designs':>8} "
        f"{'jitter %':>9} {'widths':>16} {'trans.':>7} {'s CPU':>6}"
    )
    for task in TASKS:
        begun = time.process_time()
        result: Any = solve(parse_problem({"kind": "dwell", "rank_by": "accuracy", **task}), lambda share, words: None)
        took = time.process_time() - begun
        kind, way = list(task["output"].values())
        dwells = f"{task['count']:d} × {task['dwell_angle']:g}°"
        row = f"{task['mechanism']:>14} {kind:>8} {way:7g} {dwells:>9} {len(result.designs):8d}"
        if result.designs:
            best = result.designs[0]
            widths = ", ".join(f"{rest.width:.1f}°" for rest in best.targets)
            row += f" {100.0 * best.metrics.jitter / way:9.2g} {widths:>16} {best.metrics.min_transmission_angle:6.1f}°"
        else:
            row += f"{'none found':>37}"
        print(f"{row} {took:6.2f}")


if __name__ == "__main__":
    main()
