"""Code that several tests share: path fit."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

CASES = Path(__file__).resolve().parents[2] / "cases" / "path_benchmarks.json"


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
