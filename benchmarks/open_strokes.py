"""Open strokes: what designs of all types trace between the points, against a drive and measures of another kind.

    python -m benchmarks.open_strokes [--tasks N] [--seed SEED]

Strokes of 8 to 40 points are parts of random fourbars' curves, letters with corners, and smooth random curves, in turn.
Each is posed to one type of linkage. Every design that passes is driven once more: by its loops
(tests/oracles/loops.py) if it has several, else by intersections of circles and lines. From this motion

* the root mean square of the points' distances at the reported inputs,
* the largest distance of the curve from the lines between the points, and
* how far it strays beyond what the points permit

are measured on a dense curve, and compared with the reported ones. Printed by type are the tasks with a design, the
designs, the largest difference relative to the task's size, how many designs the drive does not confirm, and how many
stray by more than twice the largest distance at the points and a hundredth of the task's size, of all and of those
listed first.
"""

from __future__ import annotations

import argparse
import itertools
import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from kinematics.arrays import Complex, Real
from synthesis import parse_problem, solve
from tests.oracles.loops import Loops

TYPES = (
    "fourbar",
    "slider_crank",
    "geared_fivebar",
    "watt_1",
    "stephenson_1",
    "stephenson_2",
    "stephenson_3",
    "eightbar",
)

COUNTS = (8, 12, 16, 20, 24, 40)
"""Numbers of points of the strokes, in turn."""

DENSE_COUNT, ZOOM_COUNT = 20_001, 3
"""Number of places on a curve at which it is measured, and how often again around the largest distance: it often is at
a kink, midway between two lines, where the error of a grid is of the first order."""

STRAY_SHARE = 0.01
"""Share of the task's size below which no design counts as straying."""

BULGE = 0.25
"""Permitted bulge of a curve between two points, as a share of their distance, as documented."""

Drive = Callable[[Real], Complex]
"""P as a function of the input, radians."""

LETTERS: dict[str, list[complex]] = {
    "V": [0.0 + 100j, 40.0 + 0j, 80.0 + 100j],
    "L": [0.0 + 100j, 0.0 + 0j, 60.0 + 0j],
    "M": [0j, 100j, 40.0 + 40j, 80.0 + 100j, 80.0 + 0j],
    "N": [0j, 100j, 70.0 + 0j, 70.0 + 100j],
    "X": [0j, 70.0 + 100j, 70.0 + 0j, 100j],
    "Z": [0.0 + 100j, 70.0 + 100j, 0j, 70.0 + 0j],
}


def draw_stroke(number: int, count: int, rng: np.random.Generator) -> Complex:
    """Return the points of a stroke."""
    if number % 3 == 0:
        return _trace_fourbar(count, rng)
    if number % 3 == 1:
        corners = np.array(list(LETTERS.values())[int(rng.integers(len(LETTERS)))])
        along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(corners)))])
        at = np.linspace(0.0, along[-1], count)
        return np.interp(at, along, corners.real) + 1j * np.interp(at, along, corners.imag)
    knots = rng.uniform(-50.0, 50.0, 5) + 1j * rng.uniform(-50.0, 50.0, 5)
    return np.asarray(CubicSpline(np.arange(5.0), knots)(np.linspace(0.0, 4.0, count)))


def _trace_fourbar(count: int, rng: np.random.Generator) -> Complex:
    """Return points of a part of the curve of a random crank-rocker."""
    while True:
        a, b, c, d = 20.0, *rng.uniform(40.0, 120.0, 3)
        if a + max(b, c, d) >= b + c + d - max(b, c, d):
            continue
        theta = rng.uniform(0.0, math.tau) + np.linspace(0.0, rng.uniform(1.0, 4.5), count)
        pin = a * np.exp(1j * theta)
        arm = d - pin
        reach = np.abs(arm)
        along = (b * b - c * c + reach**2) / (2.0 * reach)
        coupler = arm / reach * (along + 1j * np.sqrt(b * b - along**2)) / b
        return np.asarray(pin + complex(*rng.uniform(-60.0, 60.0, 2)) * coupler)


def drive_pins(skeleton: dict[str, Any], first: float, last: float, own: float) -> Drive:
    """Return P as a function of the input, radians, from the loops."""
    loops = Loops(skeleton)
    spans = []
    for end in (first, last):
        met = loops.followed(np.array([end - own]))
        assert met.branch > 0.0, "another branch"
        # The first step from the reference is repeated by the other direction.
        inputs = own + np.linspace(0.0, end - own, len(met.places))
        spans.append((inputs, np.array([place["P"] for place in met.places])))
    inputs, places = (np.concatenate([spans[0][k][::-1][:-1], spans[1][k]]) for k in (0, 1))
    inputs, chosen = np.unique(inputs, return_index=True)
    return CubicSpline(inputs, places[chosen])


def locate_point(mechanism: dict[str, Any], own: float, inputs: Real) -> Complex:
    """Return P of a fourbar, slider-crank or geared fivebar at inputs, radians; ``own`` is that of the reference."""
    skeleton = mechanism["skeleton"]
    joints = {name: complex(*place) for name, place in skeleton["joints"].items()}
    turned = inputs - own
    pin = joints["O2"] + (joints["A"] - joints["O2"]) * np.exp(1j * turned)
    if mechanism["type"] == "slider_crank":
        slide, end = skeleton["slides"][0], "B"
        along = np.exp(1j * math.radians(slide["angle"]))
        # Seen along the slide, the coupler's end is at half a chord from the foot of the crank's pin.
        foot = (pin - complex(*slide["point"])) / along
        half = np.sqrt(abs(joints["B"] - joints["A"]) ** 2 - foot.imag**2)
        ahead = ((joints["B"] - joints["A"]) / along).real
        far = complex(*slide["point"]) + along * (foot.real + math.copysign(1.0, ahead) * half)
    else:
        if mechanism["type"] == "fourbar":
            end, first_other, other = "B", joints["O4"], np.full(len(turned), joints["O4"])
        else:
            end, first_other, ratio = "C", joints["B"], skeleton["gears"][0]["ratio"]
            other = joints["O5"] + (joints["B"] - joints["O5"]) * np.exp(1j * ratio * turned)
        first_length, second_length = abs(joints[end] - joints["A"]), abs(joints[end] - first_other)
        base = other - pin
        share = (first_length**2 - second_length**2 + np.abs(base) ** 2) / (2.0 * np.abs(base) ** 2)
        height = np.sqrt((first_length / np.abs(base)) ** 2 - share**2)
        side = math.copysign(1.0, ((first_other - joints["A"]).conjugate() * (joints[end] - joints["A"])).imag)
        far = pin + base * (share + 1j * side * height)
    turn = (far - pin) / (joints[end] - joints["A"])
    return np.asarray(pin + (joints["P"] - joints["A"]) * turn)


def measure_distances(places: Complex, points: Complex, missed: float) -> tuple[Real, Real]:
    """Return the distances of places from the lines between points, and how far they are beyond the permitted."""
    farthest = np.full(len(places), math.inf)
    beyond = np.full(len(places), math.inf)
    for start, end in itertools.pairwise(points):
        side = end - start
        share = np.clip(((places - start) * np.conj(side)).real / max(abs(side) ** 2, 1e-300), 0.0, 1.0)
        distance = np.abs(places - start - share * side)
        farthest, beyond = np.minimum(farthest, distance), np.minimum(beyond, distance - missed - BULGE * abs(side))
    return farthest, beyond


def find_largest(drive: Drive, ends: tuple[float, float], points: Complex, missed: float, which: int) -> float:
    """Return the largest of one of the distances over a range of inputs."""
    low, high = ends
    for _ in range(ZOOM_COUNT + 1):
        inputs = np.linspace(low, high, DENSE_COUNT)
        distances = measure_distances(drive(inputs), points, missed)[which]
        at = int(distances.argmax())
        low, high = float(inputs[max(at - 1, 0)]), float(inputs[min(at + 1, DENSE_COUNT - 1)])
    return float(distances.max())


def compare_design(design: Any, points: Complex, size: float) -> tuple[float, float]:
    """Return the largest difference from another measure, as a share of the size, and what the design strays by."""
    mechanism = design.mechanism.model_dump(mode="json")
    inputs = np.radians([target.input_angle for target in design.targets])
    own = math.radians(mechanism["reference_input_angle"]) if "reference_input_angle" in mechanism else inputs[0]
    if mechanism["type"] in ("fourbar", "slider_crank", "geared_fivebar"):
        drive: Drive = partial(locate_point, mechanism, own)
    else:
        drive = drive_pins(mechanism["skeleton"], float(inputs[0]), float(inputs[-1]), float(own))
    metrics, misses = design.metrics, np.abs(drive(inputs) - points)
    ends = float(inputs[0]), float(inputs[-1])
    farthest, beyond = (find_largest(drive, ends, points, metrics.max_distance, which) for which in (0, 1))
    beyond = max(beyond, 0.0)
    differences = [
        math.sqrt(float(np.mean(misses**2))) - metrics.rms_distance,
        farthest - metrics.curve_distance,
        beyond - metrics.excursion,
    ]
    return max(map(abs, differences)) / size, beyond


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tasks", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    chosen = parser.parse_args()
    print(f"{'type':<16}{'tasks':>6}{'with':>6}{'designs':>9}{'difference':>12}{'other':>7}{'stray':>7}{'first':>7}")
    for row, kind in enumerate(TYPES):
        rng = np.random.default_rng([chosen.seed, row])
        tasks = len(range(row, chosen.tasks, len(TYPES)))
        solved, designs, worst, others, straying, first = 0, 0, 0.0, 0, 0, 0
        for number in range(tasks):
            points = draw_stroke(number, COUNTS[number % len(COUNTS)], rng)
            problem = parse_problem(
                {
                    "kind": "path", "method": "least_squares", "closed": False, "mechanisms": [kind], "max_designs": 3,
                    "points": [{"x": float(z.real), "y": float(z.imag)} for z in points],
                }
            )  # fmt: skip
            passed = [design for design in solve(problem).designs if design.verification.passed]
            solved += bool(passed)
            for rank, design in enumerate(passed):
                designs += 1
                try:
                    difference, beyond = compare_design(design, points, float(problem.task_size))
                except (AssertionError, ValueError) as error:
                    print(f"  {kind}, stroke {number}: {error}")
                    others += 1
                    continue
                worst = max(worst, difference)
                if beyond > max(2.0 * design.metrics.max_distance, STRAY_SHARE * float(problem.task_size)):
                    straying, first = straying + 1, first + (rank == 0)
        print(
            f"{kind:<16}{tasks:>6}{solved:>6}{designs:>9}{worst:>12.1e}{others:>7}{straying:>7}{first:>7}", flush=True
        )


if __name__ == "__main__":
    main()
