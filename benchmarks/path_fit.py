"""Fourbars fitted to the path problems of the optimization literature: our error beside the published ones.

    python -m benchmarks.path_fit [--seeds 3] [--row closed18_timed]

Points, bounds and rules are those of ``tests/cases/path_benchmarks.json``. `ours` is the worst of the seeds: the sum of
squared distances that the verification measures on the finished linkage, or its root where the row says so. `reference`
is the best value that is known, `published` the best that is printed. CPU seconds are from the parsed problem to the
verified answer, the slowest of the seeds.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from pathlib import Path
from typing import Any

from synthesis.dispatch import solve
from synthesis.kinds.path.design import PathResult
from synthesis.kinds.path.solver import warm_up
from synthesis.registry import parse_problem

CASES = Path(__file__).resolve().parent.parent / "tests" / "cases" / "path_benchmarks.json"

LIMIT_S = 2.0


def rows() -> list[dict[str, Any]]:
    """The rows that a fourbar is fitted to."""
    listed: list[dict[str, Any]] = json.loads(CASES.read_text(encoding="utf-8"))
    return [row for row in listed if row["kind"] in ("path_timed", "path_untimed")]


def statement(row: dict[str, Any], seed: int = 0) -> dict[str, Any]:
    """A row as a problem: r1..r4 are the links, rcx and rcy the coupler point, x0 and y0 the input's fixed pivot."""
    inputs, constraints = row["inputs"], {}
    rules = " ".join(inputs.get("constraints", []))
    if "r2 shortest" in rules:
        constraints["grashof"] = "crank_rocker"
    elif "crank" in rules:
        constraints["full_rotation"] = True
    bounds = {name: [float(low), float(high)] for name, (low, high) in inputs.get("bounds", {}).items()}
    if "r" in bounds:
        constraints["link_length"] = {"min": bounds["r"][0], "max": bounds["r"][1]}
    if "rc" in bounds:
        constraints["coupler_point"] = {"along": bounds["rc"], "across": bounds["rc"]}
    if "xy" in bounds:
        constraints["input_pivot_region"] = {"x": bounds["xy"], "y": bounds["xy"]}
    points: list[dict[str, float]] = [{"x": float(x), "y": float(y)} for x, y in inputs["points"]]
    problem = {"kind": "path", "method": "least_squares", "constraints": constraints, "seed": seed}
    if row["kind"] == "path_timed":
        angles = inputs.get("theta2") or inputs["theta2_offsets"]
        points = [{**point, "crank_angle": math.degrees(angle)} for point, angle in zip(points, angles, strict=True)]
        problem |= {"timing": "prescribed", "crank_phase": "ground_line" if inputs.get("theta2") else "free"}
    fixed = inputs.get("fixed", {})
    if "x0" in fixed:
        pivot = [float(fixed["x0"]), float(fixed["y0"])]
        # θ0 = 0: the output's fixed pivot is level with the input's.
        problem["fixed_pivots"] = {"input": pivot, "output": [None, pivot[1]]}
    return {**problem, "points": points}


def best_published(row: dict[str, Any]) -> float | None:
    """The least sum of squares that is printed for a row, and what the printed digits leave open added to it."""
    values = [
        (entry["value"] * (1.0 + entry.get("tol", 0.0))) ** (2.0 if entry["metric"] == "sqrt_sse" else 1.0)
        for entry in row["published"]
        if entry["value"] is not None and entry["metric"] in ("sse", "sqrt_sse")
    ]
    return min(values, default=None)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--row", default="")
    arguments = parser.parse_args()
    warm_up()
    print(f"{'row':<20}{'points':>7}{'ours':>14}{'published':>14}{'reference':>14}{'CPU s':>8}  reached")
    missed = 0
    for row in rows():
        if arguments.row not in row["id"]:
            continue
        worst, slowest = 0.0, 0.0
        for seed in range(arguments.seeds):
            problem = parse_problem(statement(row, seed))
            began = time.process_time()
            result = solve(problem, lambda share, message: None)
            slowest = max(slowest, time.process_time() - began)
            assert isinstance(result, PathResult)
            sound = (design.metrics.sum_of_squares for design in result.designs if design.verification.passed)
            worst = max(worst, min(sound, default=math.inf))
        published, reference = best_published(row), row.get("reference", {})
        allowed = [published] if published is not None else []
        if reference.get("must"):
            allowed.append(reference["value"] * (1.0 + reference["tol"]) + reference["atol"])
        reached = worst <= min(allowed, default=math.inf)
        missed += not reached
        known = reference.get("value")
        print(
            f"{row['id']:<20}{len(row['inputs']['points']):>7}{worst:>14.6g}"
            f"{'-' if published is None else format(published, '.6g'):>14}"
            f"{'-' if known is None else format(known, '.6g'):>14}{slowest:>8.2f}  {'yes' if reached else 'NO'}"
        )
    print(f"rows missed: {missed}; limit {LIMIT_S} s")


if __name__ == "__main__":
    main()
