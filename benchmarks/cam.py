"""Cams: optimal motions against the known limits, sizing against brute force, whole problems.

    python -m benchmarks.cam [--programs 40]

Times are of the process (CPU); the import of the modelling library, a second, is paid before the table.
"""

from __future__ import annotations

import argparse
import math
import statistics
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from kinematics.cam.motion.laws import LAWS
from synthesis.dispatch import solve
from synthesis.kinds.cam.program.convex_programs import Condition, Limit
from synthesis.kinds.cam.program.optimal import (
    NoMotion,
    Optimum,
    Run,
    minimize_derivative,
    minimize_roller_size,
    minimize_torque,
)
from synthesis.kinds.cam.sizing.sizing import RollerLimits, size_oscillating_roller, size_translating_roller
from synthesis.numerics.convex import import_cvxpy
from synthesis.registry import KINDS, parse_problem
from tests.support.synthesis.cam_sampling import first_sound, oscillating, random_program, translating

ENDS = ((0.0, 0.0), (1.0, 1.0))


def rise(angle: float = 1.0, continuity: int = 2, **limits: float) -> Run:
    """A unit rise from dwell to dwell."""
    conditions = [
        Condition.fix_derivative(share * angle, order, height if order == 0 else 0.0)
        for share, height in ENDS
        for order in range(continuity + 1)
    ]
    orders = {"a": 2, "j": 3}
    return Run(angle, tuple(conditions), continuity, tuple(Limit(orders[k], x) for k, x in limits.items()))


def norton_8_10() -> Optimum | NoMotion:
    rate = 2.0 * math.pi
    conditions = [
        Condition.fix_derivative(at, order, x / rate**order)
        for at, s in ((0.0, 5.0), (math.pi, 0.0))
        for order, x in ((0, s), (1, 10.0), (2, 0.0))
    ]
    return minimize_derivative(Run(math.pi, tuple(conditions), 2, (Limit(3, 4800.0 / rate**3),)), "peak", 2)


def least_acceleration(jerk: float) -> float:
    return 0.25 * jerk * (1.0 - math.sqrt(1.0 - 32.0 / jerk))


def targets() -> list[tuple[str, Callable[[], Optimum | NoMotion], float, float]]:
    """Name, program, known limit, factor from the program's unit."""
    _, a, j = (factor.largest for factor in LAWS["modified_sine"].factors)
    sixty, tangent = math.pi / 3.0, math.tan(math.radians(20.0))
    small = rise(sixty, a=a / sixty**2, j=j / sixty**3)
    rows: list[tuple[str, Callable[[], Optimum | NoMotion], float, float]] = [
        ("peak v", lambda: minimize_derivative(rise(), "peak", 1), 1.0, 1.0),
        ("peak a", lambda: minimize_derivative(rise(), "peak", 2), 4.0, 1.0),
        ("peak j", lambda: minimize_derivative(rise(), "peak", 3), 32.0, 1.0),
        ("rms a", lambda: minimize_derivative(rise(), "rms", 2), math.sqrt(12.0), 1.0),
        ("rms j", lambda: minimize_derivative(rise(), "rms", 3), math.sqrt(720.0), 1.0),
        ("rms fourth derivative", lambda: minimize_derivative(rise(continuity=3), "rms", 4), math.sqrt(100800.0), 1.0),
    ]
    for name in ("modified_sine", "modified_trapezoid", "polynomial_345", "cycloidal"):
        jerk = LAWS[name].factors[2].largest
        rows.append(
            (
                f"peak a at the jerk of {name} ({LAWS[name].factors[1].largest:.3f})",
                lambda jerk=jerk: minimize_derivative(rise(j=jerk), "peak", 2),
                least_acceleration(jerk),
                1.0,
            )
        )
    rows += [
        (
            "peak v at modified sine's a and j (1.760)",
            lambda: minimize_derivative(rise(a=a, j=j), "peak", 1),
            1.572,
            1.0,
        ),
        ("peak |v a| (modified sine 5.458)", lambda: minimize_torque(rise(), "peak"), 2.25, 1.0),
        (
            "motion and prime radius, 60°, 20° (4.142)",
            lambda: minimize_roller_size([small], [(tangent, tangent)], 0.0, []),
            3.647,
            1.0,
        ),
        ("Norton 8-10, peak a, in/s² (230.9)", norton_8_10, 190.1, (2.0 * math.pi) ** 2),
    ]
    return rows


def timed(function: Callable[[], Any]) -> tuple[Any, float]:
    start = time.process_time()
    return function(), time.process_time() - start


def optimal_table() -> None:
    print(f"{'optimal motion':<52}{'known':>10}{'found':>11}{'off, %':>9}{'bound':>11}{'gap, %':>9}{'CPU s':>8}")
    for name, program, known, unit in targets():
        best, seconds = timed(program)
        assert isinstance(best, Optimum)
        off, gap = 100.0 * (best.value * unit / known - 1.0), 100.0 * (best.value / best.bound - 1.0)
        found, bound = best.value * unit, best.bound * unit
        print(f"{name:<52}{known:>10.4f}{found:>11.4f}{off:>9.3f}{bound:>11.4f}{gap:>9.3f}{seconds:>8.2f}")


def keeps(limits: RollerLimits, oscillates: bool, radius: float, motion: Any) -> bool:
    angle, kappa = oscillating(motion, radius, 1.0, 1.3, 1) if oscillates else translating(motion, radius, 0.1)
    return bool((angle <= limits.rise).all() and (np.abs(kappa) * limits.pitch_radius <= 1.0).all())


def sizing_row(name: str, programs: int, oscillates: bool) -> None:
    """Random programs: the greatest deviation from brute force, and both times."""
    rng = np.random.default_rng(7)
    worst, ours, brutes = 0.0, [], []
    for _ in range(programs):
        program = random_program(rng, math.radians(20.0) if oscillates else 1.0)
        limits = RollerLimits(math.radians(35.0), math.radians(35.0), 0.1 if oscillates else 1.0, 0.05)
        if oscillates:
            size, seconds = timed(partial(size_oscillating_roller, program, 1.0, 1.3, 1, limits))
        else:
            size, seconds = timed(partial(size_translating_roller, program, 0.1, limits))
        ours.append(seconds)
        if size is None:
            continue
        start = 0.3001 if oscillates else 0.1001
        sound = partial(keeps, limits, oscillates)
        brute, seconds = timed(partial(first_sound, program, sound, start, 1.3 * size.radius))
        brutes.append(seconds)
        worst = max(worst, abs(size.radius / brute - 1.0))
    print(f"{name:<52}{worst:>12.1e}{1e3 * statistics.median(ours):>12.1f}{1e3 * statistics.median(brutes):>14.1f}")


def problem_table() -> None:
    print(f"\n{'whole problem, verified':<52}{'CPU s':>8}  answer")
    extra = KINDS["cam"].problem.model_config["json_schema_extra"]
    assert isinstance(extra, dict)
    examples = extra["examples"]
    assert isinstance(examples, list)
    for name, example in zip(
        ("double dwell", "rise-fall-dwell", "critical path motion", "engine valve", "barrel"), examples, strict=True
    ):
        problem = parse_problem(example)
        result, seconds = timed(lambda p=problem: solve(p, lambda fraction, message: None))
        print(f"{name:<52}{seconds:>8.2f}  {result.summary}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("--programs", type=int, default=40, help="random programs per row of sizing")
    programs = parser.parse_args().programs
    _, seconds = timed(import_cvxpy)
    print(f"import of the modelling library: {seconds:.2f} s")
    minimize_derivative(rise(), "peak", 2)
    optimal_table()
    print(f"\n{'sizing against brute force':<52}{'worst rel.':>12}{'median ms':>12}{'brute ms':>14}")
    sizing_row("translating roller, pressure angle and curvature", programs, False)
    sizing_row("oscillating roller, pressure angle and curvature", programs, True)
    problem_table()


if __name__ == "__main__":
    main()
