"""Whole curves: those of the literature, and random crank-rockers' curves with noise.

    python -m benchmarks.curve_match [--random 20] [--seed 0]

`rms` and `largest` are distances of the given points from our curve. `published` is the rms of the linkage that was
published for the curve, measured on its own curve by brute force; `reference` the best that others computed. Where the
linkage that drew the curve is known, `recovered` is the largest distance of its curve from ours, between the given
points too, as a share of the curve's size. Times are of the whole job, verification included, after the kernels are
loaded: wall clock with two threads, and CPU.
"""

from __future__ import annotations

import argparse
import math
import time
from typing import Any

import numpy as np

from kinematics.arrays import Complex
from kinematics.linkage.fourbar import positions
from synthesis.kinds.path.design import PathResult
from synthesis.kinds.path.solver import warm_up
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.conversion import build_driven_fourbar
from tests.support.problems.curve_match import curve_cases, matched, noisy, published_rms, reference_rms


def recovered(case: dict[str, Any], result: PathResult) -> float:
    """Largest distance of the generating linkage's curve, in tenths of a degree, from ours, over the curve's size."""
    if "linkage" not in case["inputs"]:
        return math.nan
    d, a, b, c, px, py, turned, x, y, _ = case["inputs"]["linkage"]
    degrees = np.arange(3600) / 10.0

    def drawn(sign: float) -> Complex:
        at = np.concatenate([np.floor(degrees), degrees, np.ceil(degrees)])
        pin = a * np.exp(1j * (np.radians(at) + turned))
        base = d * np.exp(1j * turned) - pin
        f = np.abs(base)
        along = (b * b - c * c + f * f) / (2.0 * f)
        with np.errstate(invalid="ignore"):
            unit = base / f * (along + 1j * sign * np.sqrt(b * b - along * along)) / b
        # Between two whole degrees that are both listed.
        before, curve, after = np.split(x + 1j * y + pin + unit * complex(px, py), 3)
        return curve[np.isfinite(before) & np.isfinite(curve) & np.isfinite(after)]

    def off(curve: Complex, at: Complex) -> float:
        steps = np.diff(curve)
        largest = 0.0
        for z in at:
            share = np.clip(((z - curve[:-1]) * steps.conj()).real / np.abs(steps) ** 2, 0.0, 1.0)
            largest = max(largest, float(np.abs(curve[:-1] + share * steps - z).min()))
        return largest

    true = min((drawn(1.0), drawn(-1.0)), key=lambda curve: off(curve, case["curve"][:5]))
    mechanism = result.designs[0].mechanism
    assert isinstance(mechanism, FourbarMechanism)
    fourbar = build_driven_fourbar(mechanism)
    inputs = np.radians([target.input_angle for target in result.designs[0].targets])
    low, high = float(inputs.min()), float(inputs.max())
    if case["closed"]:
        high = low + math.tau
    ours = positions(fourbar.linkage, np.linspace(low, high, 40_001), fourbar.assembly).p
    return off(ours[np.isfinite(ours)], true) / math.hypot(float(np.ptp(true.real)), float(np.ptp(true.imag)))


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--random", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    warm_up()
    columns = ("rms", "largest", "published", "reference", "recovered")
    print(f"{'curve':<18}{'points':>7}" + "".join(f"{name:>12}" for name in columns) + f"{'wall s':>8}{'CPU s':>8}")
    for case in curve_cases():
        clock, begun = time.perf_counter(), time.process_time()
        result = matched(case["curve"], case["closed"], rank_by="accuracy", seed=given.seed)
        wall, spent = time.perf_counter() - clock, time.process_time() - begun
        metrics = result.designs[0].metrics
        others = f"{published_rms(case):>12.4g}{reference_rms(case):>12.4g}{recovered(case, result):>12.4g}"
        print(
            f"{case['id']:<18}{len(case['curve']):>7}{metrics.rms_distance:>12.4g}{metrics.max_distance:>12.4g}"
            f"{others}{wall:>8.2f}{spent:>8.2f}"
        )
    rng = np.random.default_rng(given.seed)
    ratios, times, walls = [], [], []
    for _ in range(given.random):
        curve, sigma = noisy(rng, 0.01)
        clock, begun = time.perf_counter(), time.process_time()
        result = matched(curve, True, rank_by="accuracy", seed=given.seed)
        times.append(time.process_time() - begun)
        walls.append(time.perf_counter() - clock)
        ratios.append(result.designs[0].metrics.rms_distance / sigma if result.designs else math.inf)
    if ratios:
        print(
            f"\n{sum(ratio <= 1.2 for ratio in ratios)} of {len(ratios)} noisy curves (1 %) within 1.2 of the noise; "
            f"largest ratio {max(ratios):.3g}; wall s median {np.median(walls):.2f}, most {max(walls):.2f}; "
            f"CPU s median {np.median(times):.2f}, most {max(times):.2f}"
        )


if __name__ == "__main__":
    main()
