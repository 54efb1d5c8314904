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
import json
import math
import re
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.fourbar import positions
from synthesis.dispatch import solve
from synthesis.kinds.path.design import PathResult
from synthesis.kinds.path.solver import warm_up
from synthesis.model.linkage_answer import FourbarMechanism
from synthesis.model.linkages import driven_fourbar
from synthesis.registry import parse_problem
from tests.cases import HERE

Complex = NDArray[np.complex128]

STROKES = ("wu3_partial", "recover_c-shape", "recover_sharp")
"""Curves that a crank does not draw in one turn: they are listed from crank angle 0, with a gap where the crank turns
back, and begin behind that gap here."""


def curve_cases() -> list[dict[str, Any]]:
    """The rows of the file, with their points as ``curve``."""
    read = json.loads((HERE / "curves.json").read_text(encoding="utf-8"))
    cases: list[dict[str, Any]] = read["cases"]
    for case in cases:
        given = np.array(read["curves"][case["id"]]["points"]) @ np.array([1.0, 1.0j])
        case["closed"] = case["id"] not in STROKES
        if not case["closed"]:
            given = np.roll(given, -1 - int(np.abs(np.diff(np.append(given, given[0]))).argmax()))
        case["curve"] = given[np.append(True, np.abs(np.diff(given)) > 0.0)]
    return cases


def matched(curve: Complex, closed: bool, **more: Any) -> PathResult:
    """The answer for a curve."""
    points = [{"x": float(z.real), "y": float(z.imag)} for z in curve]
    problem = parse_problem({"kind": "path", "method": "curve_match", "closed": closed, "points": points, **more})
    found = solve(problem, lambda share, message: None)
    assert isinstance(found, PathResult)
    return found


def published_rms(case: dict[str, Any]) -> float:
    """The error of the published linkage: distances from its curve, in 20000 crank positions, either assembly."""
    least = math.inf
    for published in case.get("published", []):
        d, a, b, c, px, py, turned, x, y = published["dims"][:9]
        pin = a * np.exp(1j * (np.linspace(0.0, 2.0 * np.pi, 20001) + turned))
        base = d * np.exp(1j * turned) - pin
        f = np.abs(base)
        along = (b * b - c * c + f * f) / (2.0 * f)
        for sign in (1.0, -1.0):
            with np.errstate(invalid="ignore"):
                unit = base / f * (along + 1j * sign * np.sqrt(b * b - along * along)) / b
            curve = x + 1j * y + pin + unit * complex(px, py)
            curve = curve[np.isfinite(curve)]
            if len(curve):
                off = [float(np.abs(curve - z).min()) for z in case["curve"]]
                least = min(least, math.sqrt(float(np.mean(np.square(off)))))
    return least


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
    fourbar = driven_fourbar(mechanism)
    inputs = np.radians([target.input_angle for target in result.designs[0].targets])
    low, high = float(inputs.min()), float(inputs.max())
    if case["closed"]:
        high = low + math.tau
    ours = positions(fourbar.linkage, np.linspace(low, high, 40_001), fourbar.assembly).p
    return off(ours[np.isfinite(ours)], true) / math.hypot(float(np.ptp(true.real)), float(np.ptp(true.imag)))


def reference_rms(case: dict[str, Any]) -> float:
    """The best that others computed, printed as a sum of squares; exact for curves of a known linkage."""
    source = case.get("reference", {}).get("source", "")
    if "linkage" in case["inputs"]:
        return 0.0
    found = re.search(r"\['([0-9.e-]+)'", source)
    return math.sqrt(float(found.group(1)) / len(case["curve"])) if found else math.nan


def noisy(rng: np.random.Generator, noise: float) -> tuple[Complex, float]:
    """64 samples at equal crank steps of a random crank-rocker's curve, with noise; and its standard deviation."""
    while True:
        a = 1.0
        b, c, d = rng.uniform(1.2, 4.0, 3)
        if max(b, c, d) + a < sum((b, c, d)) - max(b, c, d):
            break
    p = b * complex(rng.uniform(-0.5, 1.5), rng.uniform(-1.0, 1.0))
    pin = a * np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False))
    base = d - pin
    f = np.abs(base)
    along = (b * b - c * c + f * f) / (2.0 * f)
    curve = pin + p * base / f * (along + 1j * np.sqrt(b * b - along * along)) / b
    size = math.hypot(float(np.ptp(curve.real)), float(np.ptp(curve.imag)))
    sigma = noise * size
    # Noise in every direction, of this root mean square distance.
    return curve + sigma * math.sqrt(0.5) * (rng.normal(size=64) + 1j * rng.normal(size=64)), sigma


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
