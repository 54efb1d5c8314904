"""Engines: harmonics against a Fourier transform of exact pistons, and all arrangements that fire evenly.

python -m benchmarks.engine
"""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

from synthesis.dispatch import solve
from synthesis.registry import parse_problem

SAMPLES = 2048
LAYOUTS: dict[str, dict[str, Any]] = {
    "inline": {"type": "inline"},
    "vee 90": {"type": "vee", "vee_angle": 90.0},
    "vee 60": {"type": "vee", "vee_angle": 60.0},
    "vee 60, own pins": {"type": "vee", "vee_angle": 60.0, "pins": "own"},
    "opposed, own pins": {"type": "opposed", "pins": "own"},
    "opposed": {"type": "opposed"},
    "radial": {"type": "radial"},
}


def solved(count: int, strokes: int, layout: dict[str, Any]) -> Any:
    problem = {"kind": "engine", "cylinders": count, "stroke_cycle": strokes, "stroke": 2.0, "rod_ratio": 3.5}
    return solve(parse_problem(problem | {"layout": layout, "max_designs": 1}), lambda fraction, message: None)


def throws_of(layout: dict[str, Any], count: int) -> int:
    """How many throws there are; none where the cylinders do not fill the banks."""
    if layout["type"] == "radial":
        return 1
    if layout["type"] == "inline" or layout.get("pins") == "own":
        return count
    return 0 if count % 2 else count // 2


def off(design: Any) -> float:
    """The largest difference from a Fourier transform, in units of m_B r ω² for each cylinder."""
    turn, ratio = 2.0 * math.pi * np.arange(SAMPLES) / SAMPLES, design.mechanism.rod / design.mechanism.crank
    number = np.fft.fftfreq(SAMPLES, 1.0 / SAMPLES)
    total = np.zeros(SAMPLES, np.complex128)
    for one in design.mechanism.cylinders:
        after = turn - math.radians(one.phase + one.axis)
        place = np.cos(after) + np.sqrt(ratio**2 - np.sin(after) ** 2)
        total += np.fft.ifft(number**2 * np.fft.fft(place)).real * np.exp(1j * math.radians(one.axis))
    found = np.abs(np.fft.fft(total)) / SAMPLES
    return max(
        max(
            abs(found[k.order] - abs(k.coefficient) * k.force.forward),
            abs(found[-k.order] - abs(k.coefficient) * k.force.backward),
        )
        for k in design.harmonics
        if k.coefficient is not None
    ) / len(design.mechanism.cylinders)


def main() -> None:
    rng = np.random.default_rng(1)
    worst = 0.0
    for layout in LAYOUTS.values():
        for count in range(1, 17):
            throws = throws_of(layout, count)
            if throws:
                phases = rng.uniform(0.0, 360.0, throws).tolist()
                worst = max(worst, off(solved(count, 2, layout | {"throws": phases}).designs[0]))
    print(f"harmonics against the Fourier transform, 1 to 16 cylinders: largest difference {worst:.1e} m_B r w^2\n")
    print(f"{'layout':20} cyl. strokes {'count':>14} complete {'CPU s':>6}  best")
    for name, layout in LAYOUTS.items():
        for count in (2, 3, 4, 5, 6, 8, 12, 16):
            for strokes in (2, 4):
                if not throws_of(layout, count):
                    continue
                start = time.process_time()
                result = solved(count, strokes, layout)
                spent = time.process_time() - start
                best = result.designs[0] if result.designs else None
                order = "" if best is None else "-".join(map(str, best.firing.orders[0].order))
                throws = "" if best is None else ", ".join(f"{phase:.4g}" for phase in best.mechanism.throws)
                done = "yes" if result.search.complete else "no"
                print(f"{name:20} {count:4} {strokes:7} {result.count:14} {done:8} {spent:6.2f}  {throws}; {order}")


if __name__ == "__main__":
    main()
