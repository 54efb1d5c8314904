"""Nine pairs: all Watt II sixbars through those of random ones, and through nine points of the logarithm.

A planted sixbar turns its input by 50° to 120° without a toggle. ``lost`` are solutions that were not computed, and
``own`` is how far the nearest real one is from the planted one, in grounds.
"""

from __future__ import annotations

import time

import numpy as np

from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from synthesis.dispatch import solve
from synthesis.kinds.function.nine_pairs.continuation import find_all_watts
from synthesis.registry import parse_problem
from tests.support.sixbars.planted_functions import drawn

TASKS = 5

DENSE, PAIRS = 193, 9
LEAST, SWING, STEP = 10.0, 20.0, 5.0
"""Least transmission angle of a planted sixbar, what its output turns at least, and at most from place to place,
degrees."""

LOGARITHM = {
    "kind": "function",
    "function": {"name": "logarithm", "x": [1.0, 10.0]},
    "input_range": 60.0,
    "output_range": 60.0,
    "precision_points": 9,
    "mechanisms": ["watt_2"],
}


def planted(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Crank and rocker, input link and output of a random sixbar, with grounds of 1; inputs and outputs, radians."""
    while True:
        joints = drawn("watt_2", rng)
        mechanism = catalogue.make_sixbar("watt_2", joints)
        turned = np.radians(rng.uniform(50.0, 120.0)) * np.linspace(0.0, 1.0, DENSE)
        motion = drive(mechanism, float(mechanism.reference_input) + turned, order=0)
        if not motion.valid.all() or min(np.abs(s).min() for s in motion.sines.values()) < np.sin(np.radians(LEAST)):
            continue
        outputs = np.unwrap(motion.angles["output"][0])
        if np.abs(np.diff(outputs)).max() > np.radians(STEP) or np.ptp(outputs) < np.radians(SWING):
            continue
        o2, a, b, o4, c, d, o6 = (joints[name] for name in ("O2", "A", "B", "O4", "C", "D", "O6"))
        first, second = o4 - o2, o6 - o4
        every = (DENSE - 1) // (PAIRS - 1)
        vectors = np.array([(a - o2) / first, (b - o4) / first, (c - o4) / second, (d - o6) / second])
        return vectors, turned[::every], outputs[::every]


def table(tasks: int, seed: int) -> None:
    print(f"{'nine pairs':<12}{'lost':>6}{'real':>7}{'own':>10}{'CPU s':>8}{'wall s':>8}")
    rng = np.random.default_rng(seed)
    for n in range(tasks):
        vectors, inputs, outputs = planted(rng)
        wall, processor = time.perf_counter(), time.process_time()
        watts = find_all_watts(inputs, outputs, np.random.default_rng(n), lambda share: None)
        processor, wall = time.process_time() - processor, time.perf_counter() - wall
        own = float(np.abs(watts.real - vectors).max(axis=1).min(initial=np.inf))
        print(
            f"planted {n + 1:<4}{watts.lost:>6}{len(watts.real):>7}{own:>10.1e}{processor:>8.0f}{wall:>8.0f}",
            flush=True,
        )
    wall, processor = time.perf_counter(), time.process_time()
    result = solve(parse_problem(LOGARITHM))
    print(
        f"logarithm: {time.process_time() - processor:.0f} s CPU, {time.perf_counter() - wall:.0f} s. {result.summary}"
    )
