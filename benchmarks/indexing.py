"""Geneva drives: closed forms against driven geometry, outlines measured, forces by reactions; random statements.

python -m benchmarks.indexing
"""

from __future__ import annotations

import time
from collections import Counter
from typing import Any

import numpy as np

from synthesis.dispatch import solve
from synthesis.registry import parse_problem

DRIVES = ("geneva_external", "geneva_internal", "geneva_spherical")
STATIONS = (3, 4, 5, 6, 8, 10, 12, 16)
RANDOM = 60
AGREEMENTS = ("program_is_driven", "forces_by_reactions", "energy_balance")


def solved(statement: dict[str, Any]) -> Any:
    return solve(parse_problem({"kind": "indexing", **statement}), lambda fraction, message: None)


def worst(result: Any, name: str) -> float:
    values = [check.value for one in result.designs for check in one.verification.checks if check.name == name]
    return max((float(value) for value in values), default=0.0)


def table() -> None:
    heads = f"{'index':>8} {'v':>7} {'a':>8} {'size':>8} {'set by':13} {'agrees':>8} CPU s"
    print(f"{'drive':17} {'n':>3} rollers {heads}")
    for drive in DRIVES:
        for stations in STATIONS:
            start = time.process_time()
            wanted = {"drive": drive, "stations": stations, "roller_diameter": 10.0, "speed_rpm": 60.0}
            result = solved(wanted | {"load_inertia": 0.02, "wheel_shaft_diameter": 20.0})
            spent = time.process_time() - start
            off = max(worst(result, name) for name in AGREEMENTS)
            if not result.designs:
                print(f"{drive:17} {stations:3} {result.summary}")
            for one in result.designs:
                metrics = one.metrics
                moved = f"{one.index_angle:8.2f} {metrics.peak_velocity:7.4f} {metrics.peak_acceleration:8.4f}"
                sized = f"{metrics.size:8.2f} {metrics.sized_by!s:13} {off:8.1e} {spent:5.2f}"
                print(f"{drive:17} {stations:3} {one.mechanism.rollers:7} {moved} {sized}")


def at_random() -> None:
    rng = np.random.default_rng(1)
    reasons: Counter[str] = Counter()
    offered, off = 0, 0.0
    for _ in range(RANDOM):
        roller = float(10.0 ** rng.uniform(-3.0, 3.0))
        statement = {
            "drive": str(rng.choice(DRIVES)),
            "stations": int(rng.integers(3, 25)),
            "roller_diameter": roller,
            "wall_thickness": roller * float(rng.uniform(0.1, 2.0)),
            "wheel_shaft_diameter": roller * float(rng.uniform(0.0, 5.0)),
            "speed_rpm": float(10.0 ** rng.uniform(0.0, 4.0)),
            "load_inertia": float(10.0 ** rng.uniform(-6.0, 3.0)),
            "clearances": {"slot": 0.02 * roller * float(rng.random()), "locking": 0.02 * roller * float(rng.random())},
        }
        result = solved(statement)
        offered += len(result.designs)
        reasons.update(result.search.rejected)
        off = max(
            off, *(worst(result, name) for name in ("program_is_driven", "forces_by_reactions", "energy_balance"))
        )
    print(f"\n{RANDOM} random statements: {offered} drives, worst difference {off:.1e}; rejected {dict(reasons)}")


def main() -> None:
    table()
    at_random()


if __name__ == "__main__":
    main()
