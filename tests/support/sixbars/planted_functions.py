"""Planted function generators: random sixbars, each with 24 pairs of its own motion, and whether they are found again.

A planted sixbar turns its input by 50° to 120° without a toggle, with transmission angles of 25° at least. The task is
its pairs, its type, its least transmission angle and twice its link ratio. Found is a sixbar that keeps these and is
off by a millionth of a degree at most. ``false`` counts designs that their loops do not confirm
(:func:`tests.support.sixbars.function.false_claim`).
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.support.sixbars.function import false_claim
from tests.support.sixbars.spread import each

TASKS = 100

SAMPLES, DENSE = 24, 200
LEAST = 25.0
FOUND = 1e-6
TYPES = ["watt_2", "stephenson_2", "stephenson_3"]


def drawn(kind: str, rng: np.random.Generator) -> dict[str, complex]:
    """Joints anywhere in a square."""
    names = sorted({joint for listed in catalogue.SIXBAR_LINKS[kind].values() for joint in listed if joint != "P"})
    places = rng.uniform(-1.0, 1.0, len(names)) + 1j * rng.uniform(-1.0, 1.0, len(names))
    return dict(zip(names, (complex(z) for z in places), strict=True))


def ratio_of(joints: dict[str, complex], kind: str) -> float:
    """The greatest distance between pins of a link over the least."""
    links = ([j for j in listed if j != "P"] for listed in catalogue.SIXBAR_LINKS[kind].values())
    ways = [abs(joints[a] - joints[b]) for listed in links for n, a in enumerate(listed) for b in listed[:n]]
    return max(ways) / min(ways)


def planted(kind: str, rng: np.random.Generator) -> tuple[dict[str, Any], dict[str, float]]:
    """Pairs of a random sixbar, and what it keeps."""
    while True:
        joints = drawn(kind, rng)
        ratio = ratio_of(joints, kind)
        if ratio > 10.0:
            continue
        mechanism = catalogue.make_sixbar(kind, joints)
        start, turned = float(mechanism.reference_input), math.radians(rng.uniform(50.0, 120.0))
        dense = drive(mechanism, start + turned * np.linspace(0.0, 1.0, DENSE), order=0)
        if not dense.valid.all():
            continue
        least = math.degrees(math.asin(min(float(np.abs(sine).min()) for sine in dense.sines.values())))
        outputs = np.degrees(np.unwrap(dense.angles["output"][0]))
        if least < LEAST or np.abs(np.diff(outputs)).max() > 5.0 or np.ptp(outputs) < 20.0:
            continue
        inputs = turned * np.linspace(0.0, 1.0, SAMPLES)
        at = np.degrees(np.unwrap(drive(mechanism, start + inputs, order=0).angles["output"][0]))
        pairs = [{"input": float(x), "output": float(y)} for x, y in zip(np.degrees(inputs), at - at[0], strict=True)]
        return {"pairs": pairs}, {"min_transmission_angle": least - 0.5, "max_link_ratio": 2.0 * ratio}


def tried(kind: str, task: dict[str, Any], constraints: dict[str, float]) -> tuple[float, float, list[str]]:
    """The least of the greatest errors of the designs of a task, infinite where there is none, what it took, and what
    is not confirmed of each."""
    problem = parse_problem(
        {"kind": "function", **task, "mechanisms": [kind], "constraints": constraints, "max_designs": 1}
    )
    begun = time.process_time()
    designs = [design for design in solve(problem).designs if design.verification.passed]
    spent = time.process_time() - begun
    x, y = zip(*((pair["input"], pair["output"]) for pair in task["pairs"]), strict=True)
    faults = [false_claim(design, np.array(x), np.array(y)) for design in designs]
    return min((design.structural_error.max for design in designs), default=math.inf), spent, faults


def table(tasks: int, seed: int) -> None:
    print(
        f"{'planted':<14}{'tasks':>6}{'found %':>9}{'median error °':>16}{'worst °':>12}{'CPU s':>7}{'most':>7}"
        f"{'false':>7}"
    )
    for kind in TYPES:
        rng = np.random.default_rng([seed, TYPES.index(kind)])
        errors, times, faults = zip(*each(tried, [(kind, *planted(kind, rng)) for _ in range(tasks)]), strict=True)
        listed = [fault for of_task in faults for fault in of_task]
        share = 100.0 * float(np.mean(np.array(errors) <= FOUND))
        print(
            f"{kind:<14}{tasks:>6}{share:>9.1f}{np.median(errors):>16.2e}{max(errors):>12.2e}"
            f"{np.median(times):>7.2f}{max(times):>7.1f}{sum(map(bool, listed)):>4}/{len(listed)}",
            flush=True,
        )
