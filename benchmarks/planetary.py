"""Times of planetary trains and gearboxes: ``python -m benchmarks.planetary``. CPU seconds of one process."""

from __future__ import annotations

import time
from typing import Any

from synthesis.dispatch import solve
from synthesis.registry import get_first_example, parse_problem

WIDE = {"min": 17, "max": 100, "ring_max": 200}

ROWS: list[tuple[str, dict[str, Any]]] = [
    ("planetary example", get_first_example("planetary_train")),
    ("simple, all members", {"kind": "planetary_train", "ratio": "pi", "arrangement": "simple", "teeth": WIDE}),
    *(
        (f"{name}, all members", {"kind": "planetary_train", "ratio": "-pi", "arrangement": name, "teeth": WIDE})
        for name in (
            "stepped", "stepped_suns", "stepped_rings", "wolfrom", "ravigneaux", "double_planet", "two_stage", "simpson"
        )
    ),
    ("auto, 17 to 60 teeth", {"kind": "planetary_train", "ratio": 7.77, "teeth": {"max": 60, "ring_max": 150}}),
    ("gearbox example", get_first_example("gearbox")),
    (
        "Rao 8.9, 18 speeds",
        {
            "kind": "gearbox",
            "input_speed": 352.0,
            "speeds": {"min": 50.0, "max": 2000.0, "count": 18},
            "tooth_sum": {"min": 50, "max": 100},
            "stage_ratio": {"min": 0.25, "max": 2.5},
        },
    ),
    (
        "R10, 12 speeds",
        {"kind": "gearbox", "input_speed": 1440.0, "speeds": {"min": 31.5, "series": "R10", "count": 12}},
    ),
    ("layshaft example", get_first_example("layshaft_gearbox")),
]  # fmt: skip


def main() -> None:
    for row in ("planetary_train", "gearbox", "layshaft_gearbox"):
        solve(parse_problem(get_first_example(row)), lambda fraction, message: None)
    print(f"{'problem':<32}{'CPU s':>9}{'combinations':>28}{'designs':>9}  best")
    for name, stated in ROWS:
        problem = parse_problem(stated)
        start = time.process_time()
        result: Any = solve(problem, lambda fraction, message: None)
        spent = time.process_time() - start
        metrics = result.designs[0].metrics if result.designs else None
        error = getattr(metrics, "error", getattr(metrics, "max_error", float("nan")))
        print(f"{name:<32}{spent:>9.3f}{result.search.candidates:>28,}{len(result.designs):>9}  {error:.3g}")


if __name__ == "__main__":
    main()
