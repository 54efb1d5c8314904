"""Planted tasks with limits on forces: a known linkage, and limits 5 % above what it has.

    python -m benchmarks.dynamics limited [--kind KIND] [--count N] [--seed N]

Each kind of task is made from random linkages whose cranks turn through: motions of three positions by fourbars and by
slider-cranks, paths of five points that are met exactly, of seven with tolerances and of twelve that are fitted,
functions of three and four pairs, and whole functions. Drive torque and pin forces are limited. Every design that is
answered is measured again by the general equations at 1440 positions.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.analyses.linkages.dynamics import find_force_peaks
from synthesis.dispatch import solve
from synthesis.model.dynamics.request import DesignDynamics
from synthesis.registry import parse_problem
from synthesis.results.forces import apply_link_shape, prepare_drive
from tests.support.problems.limited_forces import BLOCK, LADEN, SPEED_RPM, fourbar, slider_crank

DRIVING = BLOCK | {"loads": [{"link": "output", "torque": {"constant": 5.0}}]}
PUSHING = BLOCK | {"loads": [{"joint": "B", "force": {"constant": [-50.0, 0.0]}}]}

OVER = 1.05
"""Limits over what the planted linkage has."""

CONFIRMED = 1440
"""Positions at which answers are measured."""

ROUNDING = 1e-4
"""Share of a limit by which peaks of more positions may pass those that were refined between fewer."""


class Planted(NamedTuple):
    """A task without limits, and the linkage that it was made from."""

    stated: dict[str, Any]
    mechanism: Mechanism


def _driven(rng: np.random.Generator, mechanism: Mechanism, turned: float, count: int) -> tuple[Any, Any]:
    """Inputs from the reference on, spread at random over ``turned`` radians, and the motion there."""
    steps = rng.uniform(0.5, 1.5, count - 1)
    start = float(np.asarray(mechanism.reference_input))
    inputs = start + turned * np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])
    return inputs, drive(mechanism, inputs)


def motion(rng: np.random.Generator, mechanism: Mechanism, turned: float, count: int) -> list[dict[str, Any]]:
    """Positions of the coupler."""
    _, found = _driven(rng, mechanism, turned, count)
    angles = np.degrees(found.angles["coupler"][0] - found.angles["coupler"][0][0])
    places = zip(found.joints["P"][0], angles, strict=True)
    return [{"x": float(z.real), "y": float(z.imag), "angle": float(angle)} for z, angle in places]


def _by_fourbar(rng: np.random.Generator) -> Planted:
    mechanism = fourbar(rng)
    return Planted({"kind": "motion", "positions": motion(rng, mechanism, 2.0, 3), "dynamics": LADEN}, mechanism)


def _by_slider(rng: np.random.Generator) -> Planted:
    mechanism = slider_crank(rng)
    stated = {"kind": "motion", "positions": motion(rng, mechanism, 2.0, 3), "output_side": {"dyad": "PR"}}
    return Planted(stated | {"dynamics": LADEN}, mechanism)


def points(rng: np.random.Generator, mechanism: Mechanism, turned: float, count: int) -> list[dict[str, Any]]:
    """Places of the coupler point."""
    _, found = _driven(rng, mechanism, turned, count)
    return [{"x": float(z.real), "y": float(z.imag)} for z in found.joints["P"][0]]


def _path(count: int, tolerance: float | None) -> Callable[[np.random.Generator], Planted]:
    def made(rng: np.random.Generator) -> Planted:
        mechanism = fourbar(rng)
        listed = points(rng, mechanism, 4.0, count)
        if tolerance is not None:
            listed = [point | {"tolerance": tolerance} for point in listed]
        return Planted({"kind": "path", "points": listed, "dynamics": LADEN}, mechanism)

    return made


def _table(rng: np.random.Generator, mechanism: Mechanism, turned: float, count: int) -> list[dict[str, float]]:
    """What the output does while the input turns."""
    inputs, found = _driven(rng, mechanism, turned, count)
    outputs = np.degrees(found.angles["output"][0] - found.angles["output"][0][0])
    rows = zip(np.degrees(inputs - inputs[0]), outputs, strict=True)
    return [{"input": float(x), "output": float(y)} for x, y in rows]


def _pairs(count: int) -> Callable[[np.random.Generator], Planted]:
    def made(rng: np.random.Generator) -> Planted:
        mechanism = fourbar(rng)
        stated = {
            "kind": "function",
            "pairs": _table(rng, mechanism, 2.0, count),
            "zeros": None,
            "fixed_pivots": _pivots(mechanism),
        }
        return Planted(stated | {"dynamics": DRIVING}, mechanism)

    return made


def _pivots(mechanism: Mechanism) -> dict[str, list[float]]:
    pivots = zip(("input", "output"), ("O2", "O4"), strict=True)
    return {side: [float(mechanism.joints[joint].real), float(mechanism.joints[joint].imag)] for side, joint in pivots}


def _function(rng: np.random.Generator) -> Planted:
    """A table of what a known linkage does, approximated, in any place and size within limits."""
    mechanism = fourbar(rng)
    stated = {
        "kind": "function",
        "pairs": _table(rng, mechanism, 1.6, 12),
        "zeros": None,
        "constraints": {"link_length": {"min": 25.0, "max": 400.0}},
    }
    return Planted(stated | {"dynamics": DRIVING}, mechanism)


def _slider_pairs(rng: np.random.Generator) -> Planted:
    mechanism = slider_crank(rng)
    inputs, found = _driven(rng, mechanism, 2.0, 4)
    moved = (found.joints["B"][0] - found.joints["B"][0][0]).real
    rows = zip(np.degrees(inputs - inputs[0]), moved, strict=True)
    stated = {
        "kind": "function",
        "mechanism": "slider_crank",
        "pairs": [{"input": float(x), "output": float(y)} for x, y in rows],
        "zeros": None,
        "fixed_pivots": {"input": [0.0, 0.0], "output": [100.0, 0.0]},
    }
    return Planted(stated | {"dynamics": PUSHING}, mechanism)


KINDS: dict[str, Callable[[np.random.Generator], Planted]] = {
    "motion": _by_fourbar,
    "slider_motion": _by_slider,
    "path": _path(5, None),
    "path_tolerance": _path(7, 2.0),
    "path_fitted": _path(12, None),
    "function": _pairs(4),
    "function_of_three": _pairs(3),
    "function_table": _function,
    "slider_function": _slider_pairs,
}


def _peaks(planted: Planted) -> dict[str, float]:
    """Torque and pin force of the linkage that a task was made from, over its turn."""
    block = DesignDynamics.model_validate(planted.stated["dynamics"])
    start = math.degrees(float(np.asarray(planted.mechanism.reference_input)))
    at = start + np.linspace(0.0, 360.0, 73)
    mechanism = planted.mechanism
    _, found = find_force_peaks(
        mechanism, apply_link_shape(block, mechanism.links), "mm", at, SPEED_RPM * math.tau / 60.0
    )
    return _named(found)


def _named(found: dict[str, Any]) -> dict[str, float]:
    pins = [peak.value for name, peak in found.items() if name.startswith("joint ")]
    return {"max_drive_torque": found["drive"].value, "max_joint_force": max(pins)}


def limited(kind: str, count: int, seed: int, over: float = OVER) -> None:
    """How many planted tasks are answered, whether the answers keep the limits, and what they take."""
    answered, designs, off, spent, missed = 0, 0, 0, [], []
    for n in range(count):
        rng = np.random.default_rng([seed, 70, n])
        planted = KINDS[kind](rng)
        limits = {name: over * value for name, value in _peaks(planted).items()}
        stated = planted.stated | {"max_designs": 5, "seed": n}
        problem = parse_problem(stated | {"constraints": stated.get("constraints", {}) | limits})
        begun = time.process_time()
        result = solve(problem)
        spent.append(time.process_time() - begun)
        passed = [design for design in result.designs if design.verification.passed]
        answered += bool(passed)
        for design in passed:
            run = prepare_drive(problem.dynamics, design, CONFIRMED)
            _, found = find_force_peaks(run.mechanism, run.block, problem.length_unit, run.at, run.speed)
            share = max(value / limits[name] for name, value in _named(found).items())
            designs += 1
            off += share > 1.0 + ROUNDING
        if not passed:
            missed.append(n)
    print(f"{kind}: {answered} of {count} answered; {designs - off} of {designs} designs confirmed; not: {missed}")
    print(f"{kind}: CPU median {statistics.median(spent):.2f} s, worst {max(spent):.2f} s", flush=True)
