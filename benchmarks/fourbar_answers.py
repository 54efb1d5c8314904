"""What seeded tasks are answered with, as digests: revisions that print the same have the same answers, bit for bit.

    python -m benchmarks.fourbar_answers > here.txt

None of the tasks states ``mechanisms``. A digest is of every number of every mechanism of an answer, in its order.
"""

from __future__ import annotations

import hashlib
import json
import math
from typing import Any

import numpy as np

from synthesis.dispatch import solve
from synthesis.registry import parse_problem

FUNCTIONS = {"sine": [0.0, 90.0], "logarithm": [1.0, 2.0], "exponential": [0.0, 1.0], "reciprocal": [1.0, 2.0]}
RANGES = {"input_range": 80.0, "output_range": 70.0}
SEED = 7

Task = dict[str, Any]


def poses(rng: np.random.Generator, count: int) -> list[dict[str, float]]:
    """A body on a wavy way."""
    along = np.cumsum(rng.uniform(5.0, 30.0, count))
    up = 20.0 * np.sin(3.0 * np.sort(rng.random(count)) + rng.random()) + rng.uniform(-5.0, 5.0, count)
    turned = np.cumsum(rng.uniform(-25.0, 35.0, count))
    return [{"x": x, "y": y, "angle": a} for x, y, a in np.stack([along, up, turned], axis=1).tolist()]


def ring(rng: np.random.Generator, count: int) -> list[dict[str, float]]:
    """Points of an oval with a dent."""
    t = np.linspace(0.0, math.tau, count, endpoint=False)
    places = 40.0 * np.cos(t) + 1j * rng.uniform(18.0, 24.0) * np.sin(t) + 6.0 * np.exp(1j * (2.0 * t + rng.random()))
    return [{"x": float(z.real), "y": float(z.imag)} for z in places]


def tasks() -> list[Task]:
    """Motion, functions and paths, exactly and as fits."""
    rng = np.random.default_rng(SEED)
    motion: list[Task] = [
        {"positions": poses(rng, count), "max_designs": 20} for count in (2, *4 * [3], *4 * [4], *4 * [5])
    ]
    motion += [{"positions": poses(rng, count), "method": "least_squares", "max_designs": 5} for count in (6, 8)]
    functions: list[Task] = []
    for name, x in FUNCTIONS.items():
        stated = {"function": {"name": name, "x": x}, **RANGES}
        functions += [{**stated, "criterion": criterion} for criterion in ("minimax", "least_squares")]
        functions += [{**stated, "precision_points": count} for count in (3, 4, 5)]
    paths: list[Task] = [{"points": ring(rng, 24)[: 2 * count : 2], "max_designs": 5} for count in (3, 4, 5)]
    paths.append({"points": ring(rng, 9), "max_designs": 5})
    closed = {"closed": True, "max_designs": 5}
    paths += [{"points": ring(rng, count), "method": "least_squares", **closed} for count in (12, 24)]
    paths += [{"points": ring(rng, 32), "method": "curve_match", **closed} for _ in range(2)]
    by_kind = {"motion": motion, "function": functions, "path": paths}
    return [{"kind": kind, **task} for kind, listed in by_kind.items() for task in listed]


def main() -> None:
    for number, task in enumerate(tasks()):
        result: Any = solve(parse_problem(task))
        told = [json.dumps(design.model_dump(mode="json")["mechanism"], sort_keys=True) for design in result.designs]
        print(
            f"{number:3d} {task['kind']:>8} {len(told):3d} {hashlib.sha256(''.join(told).encode()).hexdigest()[:16]}",
            flush=True,
        )


if __name__ == "__main__":
    main()
