"""Motion: tasks of five positions of three sorts, and how many of them have a sound fourbar and a sound sixbar.

*On a way*: the body goes along a bent way and turns by up to 30° from position to position. *Within a box*: positions
anywhere in a square, turned by up to ±30°. *Anyhow*: the same, up to ±90°. Sound is one branch and circuit, in order,
no toggle, a transmission angle of 20° and no link longer than five task sizes. Each sixbar is driven once more by its
loops (tests/oracles/loops.py), which know nothing of the product.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from synthesis.dispatch import solve
from synthesis.kinds.motion.design import MotionResult
from synthesis.registry import parse_problem
from tests.oracles.loops import Loops
from tests.support.sixbars.driven import find_dyad_pins, transmits
from tests.support.sixbars.spread import each

TASKS = 200

SIXBARS = ["watt_1", "stephenson_1", "stephenson_2", "stephenson_3"]
SOUND, REACH = 20.0, 5.0
ROUNDING = 1e-7
Task = list[dict[str, float]]


def stated(points: Any, angles: Any) -> Task:
    return [{"x": float(p.real), "y": float(p.imag), "angle": float(a)} for p, a in zip(points, angles, strict=True)]


def on_a_way(rng: np.random.Generator, n: int = 5) -> Task:
    course = rng.uniform(0.0, 2.0 * np.pi) + np.cumsum(rng.uniform(-0.9, 0.9, n))
    return stated(
        100.0 * np.cumsum(rng.uniform(0.3, 1.0, n) * np.exp(1j * course)), np.cumsum(rng.uniform(-30.0, 30.0, n))
    )


def within_a_box(rng: np.random.Generator, most: float = 30.0) -> Task:
    points = 100.0 * (rng.uniform(-1.0, 1.0, 5) + 1j * rng.uniform(-1.0, 1.0, 5))
    return stated(points, rng.uniform(-most, most, 5))


def anyhow(rng: np.random.Generator) -> Task:
    return within_a_box(rng, 90.0)


SORTS: dict[str, Callable[[np.random.Generator], Task]] = {
    "on a way, up to 30° from each to the next": on_a_way,
    "within a box, up to ±30°": within_a_box,
    "anyhow, up to ±90°": anyhow,
}


def solved(task: Task, **more: Any) -> tuple[MotionResult, float, float]:
    problem = parse_problem({"kind": "motion", "positions": task, **({"max_designs": 3} | more)})
    wall, processor = time.perf_counter(), time.process_time()
    result = solve(problem)
    return result, time.process_time() - processor, time.perf_counter() - wall


def sound(result: MotionResult) -> list[Any]:
    """Of the designs those that pass, transmit and are not too large."""
    passed = [design for design in result.designs if design.verification.passed]
    return [d for d in passed if d.metrics.min_transmission_angle >= SOUND and (d.metrics.reach or 0.0) <= REACH]


def false_claim(design: Any, task: Task) -> str:
    """What another formulation does not confirm of a design; empty where it confirms all."""
    inputs = np.radians([target.input_angle for target in design.targets])
    try:
        loops = Loops(design.mechanism.skeleton.model_dump(mode="json"))
        met = loops.followed(inputs - inputs[0])
    except AssertionError as error:
        return str(error)
    if not met.branch > 0.0:
        return "another branch"
    if not (np.all(np.diff(inputs) > 0.0) or np.all(np.diff(inputs) < 0.0)):
        return "out of order"
    points = np.array([complex(p["x"], p["y"]) for p in task])
    turns = np.exp(1j * np.radians([p["angle"] - task[0]["angle"] for p in task]))
    size = np.abs(points[:, None] - points).max()
    # A body that is fitted is so in the first position too.
    stands = design.mechanism.reference_body_angle
    first = 0.0 if stands is None else np.radians(stands - task[0]["angle"])
    off = np.hypot(np.abs(met.points - points) / size, np.abs(np.exp(1j * (met.turns + first)) - turns))
    if math.sqrt(np.mean(off**2)) > 1.01 * design.metrics.rms_residual + ROUNDING:
        return "another position"
    return "" if transmits(design, loops, met, find_dyad_pins(design.mechanism.type, loops)) else "transmission angle"


def tried(task: Task) -> tuple[bool, bool, float, float, list[str]]:
    """Whether a task has a sound fourbar and a sound sixbar, what that took, and what is not confirmed of each."""
    simple = bool(sound(solved(task, mechanisms=["fourbar"])[0]))
    result, processor, wall = solved(task, mechanisms=SIXBARS)
    designs = sound(result)
    faults = [false_claim(design, task) for design in designs]
    for design, fault in zip(designs, faults, strict=True):
        if fault:
            print(f"  {fault}: {design.mechanism.model_dump_json()}")
    return simple, bool(designs), processor, wall, faults


def table(tasks: int, seed: int) -> None:
    print(
        f"{'five positions':<44}{'tasks':>6}{'fourbar %':>11}{'sixbar %':>10}"
        f"{'CPU s':>8}{'most':>7}{'over 20 s':>10}{'wall s':>8}{'false':>7}"
    )
    for name, draw in SORTS.items():
        rng = np.random.default_rng(seed)
        rows = list(each(tried, [(draw(rng),) for _ in range(tasks)]))
        fourbars, sixbars, times, walls, faults = zip(*rows, strict=True)
        listed = [fault for of_task in faults for fault in of_task]
        print(
            f"{name:<44}{tasks:>6}{100.0 * sum(fourbars) / tasks:>11.1f}{100.0 * sum(sixbars) / tasks:>10.1f}"
            f"{statistics.median(times):>8.2f}{max(times):>7.1f}{sum(time > 20.0 for time in times):>10}"
            f"{max(walls):>8.1f}{sum(map(bool, listed)):>4}/{len(listed)}",
            flush=True,
        )
