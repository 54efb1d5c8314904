"""Fits to many noisy positions of planted linkages: time, and how the error compares with that of the planted one.

Run with ``python -m benchmarks.least_squares``. A row fails its purpose where the last column is not 0.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time

import numpy as np

from synthesis.dispatch import compile_kind, solve
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.registry import parse_problem
from tests.support.synthesis.planted import Planted, plant_many


def row(n: int, noise: float, tasks: int) -> None:
    times, ratios, worse = [], [], 0
    for seed in range(tasks):
        rng = np.random.default_rng(seed)
        planted = plant_many(rng, n)
        problem = parse_problem({"kind": "motion", "positions": noisy(planted, noise, rng)})
        one, other, first = planted.input_side, planted.output_side, planted.positions[0]
        joints = FourbarConfiguration(
            one.fixed_pivot, one.moving_pivot, other.moving_pivot, other.fixed_pivot, complex(first["x"], first["y"])
        )
        allowed = verify(problem, build_fourbar(joints, first["angle"]))
        start = time.process_time()
        result = solve(problem, lambda fraction, message: None)
        times.append(time.process_time() - start)
        if allowed is None or not allowed.verification.passed:
            continue
        reached = result.designs[0].metrics.rms_residual if result.designs else math.inf
        ratios.append(reached / allowed.metrics.rms_residual)
        worse += reached > allowed.metrics.rms_residual * (1.0 + 1e-9)
    print(
        f"{n:>9}{noise:>9.0e}{statistics.median(times):>13.2f}{max(times):>9.2f}{statistics.median(ratios):>15.3f}{worse:>9}"
    )


def noisy(planted: Planted, noise: float, rng: np.random.Generator) -> list[dict[str, float]]:
    points = [complex(p["x"], p["y"]) for p in planted.positions]
    size = max(abs(p - q) for p in points for q in points)
    return [
        {
            "x": p["x"] + noise * size * rng.normal(),
            "y": p["y"] + noise * size * rng.normal(),
            "angle": p["angle"] + math.degrees(noise * rng.normal()),
        }
        for p in planted.positions
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("--tasks", type=int, default=20, help="planted linkages per row")
    tasks = parser.parse_args().tasks
    compile_kind("motion")
    print(f"{'positions':>9}{'noise':>9}{'median CPU s':>13}{'worst':>9}{'error : plant':>15}{'worse':>9}")
    for n in (8, 12, 20, 40):
        for noise in (1e-4, 1e-3, 1e-2):
            row(n, noise, tasks)


if __name__ == "__main__":
    main()
