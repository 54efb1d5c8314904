"""Linkages as a shop makes them, against exhaustive search and another formulation; and how fast samples are driven.

    python -m benchmarks.manufacture [rounded] [yields] [seed]

Fourbars are drawn by chance and driven through five positions, which they are then held to. Three figures:

* rounded: on how many of (100) fourbars the linkage on the grid is no farther from the task than the best of all
  within two steps, which are driven by Freudenstein's equation in plain numpy;
* yields: for how many of (50) designs the 99 % interval from 10⁵ samples holds the share of 10⁶ other ones that are
  good by that formulation;
* speed: processor time for 10⁵ samples of a fourbar through five positions.
"""

from __future__ import annotations

import math
import sys
import time
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.linkage import Fourbar, fourbar
from synthesis.manufacture.grid import find_nearest_on_grid
from synthesis.manufacture.linkage import Linkage, build_product
from synthesis.manufacture.yield_sampling import sample_yield
from synthesis.model.manufacture.request import Manufacture, RequiredTargets
from tests.oracles import made_linkages
from tests.oracles.made_linkages import Stated

STEP = 0.5
"""Of the grid, with links of 20 to 100 units."""

CHUNK = 250_000
SAMPLES = 1_000_000
TURNED = (20.0, 120.0)
"""Degrees that the input turns from the first position to the last."""

SURELY_FARTHER = 4.0
"""Times the sum of squares by which an estimate must exceed it for a linkage to be left out of a closer look."""

NUDGE = 1e-4
"""Radians by which the input is moved for an estimate of the nearest place."""


class Drawn(NamedTuple):
    """A fourbar, what it is held to, the range that it is used over, and the same for the other formulation."""

    linkage: Linkage
    held: RequiredTargets
    used: tuple[float, float]
    other: Stated


def drawn(rng: np.random.Generator) -> Drawn:
    """A fourbar that goes through five positions on one branch, with transmission angles of 25 degrees and more."""
    while True:
        row = np.concatenate([rng.uniform(-50.0, 50.0, 4), rng.uniform(20.0, 100.0, 3), rng.uniform(-60.0, 60.0, 2)])
        o2, o4 = complex(row[0], row[1]), complex(row[2], row[3])
        if abs(o4 - o2) < 20.0:
            continue
        linkage = Fourbar(o2, o4, row[4], row[5], row[6], complex(row[7], row[8]))
        sign = int(rng.choice([1, -1]))
        span = math.radians(rng.uniform(*TURNED))
        first = rng.uniform(0.0, math.tau)
        way = fourbar.positions(linkage, np.linspace(first, first + span, 101), sign)
        between = np.abs(np.sin(way.coupler_angle - way.output_angle))
        if not way.valid.all() or between.min() < math.sin(math.radians(25.0)):
            continue
        inputs = np.sort(first + span * np.concatenate([[0.0, 1.0], rng.uniform(0.05, 0.95, 3)]))
        at = fourbar.positions(linkage, inputs, sign)
        size = float(np.abs(at.p[:, None] - at.p).max())
        used = float(inputs[0]), float(inputs[-1])
        angles = np.unwrap(at.coupler_angle)
        held = RequiredTargets(inputs, points=at.p, angles=angles, body=float(angles[0]), size=size)
        other = Stated(row, None, 0j, inputs, at.p, angles, None, used, True)
        return Drawn(Linkage("fourbar", row, sign, None, 0j, used[0]), held, used, other)


def rounded(count: int, rng: np.random.Generator) -> None:
    """Compare the search of a grid with every linkage on it within two steps."""
    block = Manufacture.model_validate({"round": {"length": STEP, "coordinates": STEP}})
    worse, taken, better = 0, [], []
    for _ in range(count):
        design = drawn(rng)
        begun = time.process_time()
        found = find_nearest_on_grid(design.linkage, design.held, block, design.used)
        taken.append(time.process_time() - begun)
        assert not isinstance(found, str)
        least = exhaustive(design, float(found.squares[0]))
        worse += least < found.squares[0] * (1.0 - 1e-6)
        alone = made_linkages.squares(design.other, np.round(design.linkage.row[None] / STEP) * STEP, design.held.size)
        better.append(math.sqrt(alone[0] / found.squares[0]))
    print(f"rounded: {count - worse} of {count} fourbars are no farther than the best of all within two steps")
    print(f"  rounded one by one they are {np.median(better):.1f} times as far (median)")
    print(f"  processor time a design: median {np.median(taken):.2f} s, most {max(taken):.2f} s")


def exhaustive(design: Drawn, most: float) -> float:
    """The least sum of squares of all linkages within two steps, as far as it is not well over ``most``."""
    rows = made_linkages.neighbours(design.other, np.full(9, STEP))
    sign = made_linkages.branch(design.other)
    least = math.inf
    for begin in range(0, len(rows), CHUNK):
        part = rows[begin : begin + CHUNK]
        part = part[_estimates(design, part, sign) <= SURELY_FARTHER * most]
        if len(part):
            squares = made_linkages.squares(design.other, part, design.held.size, most * 1.001)
            least = min(least, float(squares.min()))
    return least


def _estimates(design: Drawn, rows: Real, sign: int) -> Real:
    """The sums of squares at inputs that one step of Newton's method on each target leads to, to the first order."""
    total = np.zeros(len(rows))
    for k, nominal in enumerate(design.other.inputs):
        here = np.full(len(rows), float(nominal))
        off = _offsets(design, rows, here, sign, k)
        rate = (_offsets(design, rows, here + NUDGE, sign, k) - off) / NUDGE
        along = (off * rate).sum(axis=0)
        total += np.nan_to_num((off * off).sum(axis=0) - along * along / (rate * rate).sum(axis=0), nan=math.inf)
    return total


def _offsets(design: Drawn, rows: Real, inputs: Real, sign: int, k: int) -> Real:
    other = design.other
    assert other.points is not None
    assert other.turns is not None
    place, turned, _ = made_linkages.posed(other, rows, inputs, sign)
    gap = (place - other.points[k]) / design.held.size
    return np.stack([gap.real, gap.imag, np.mod(turned - other.turns[k] + math.pi, math.tau) - math.pi])


def yields(count: int, rng: np.random.Generator) -> None:
    """Compare yields with the share of other samples that another formulation finds good."""
    held, values = 0, []
    for n in range(count):
        design = drawn(rng)
        tolerances = {"length": 0.1, "pivot": 0.05}
        limits = float(rng.uniform(0.1, 0.5)), float(rng.uniform(0.1, 0.5))
        distribution, fixed = str(rng.choice(["uniform", "normal"])), bool(rng.random() < 0.3)
        block = Manufacture.model_validate(
            {
                "tolerances": tolerances,
                "distribution": distribution,
                "input": "fixed" if fixed else "adjusted",
                "quality": {"max_error": limits[0], "max_angle_error": limits[1]},
            }
        )
        made = build_product(design.linkage, design.held, block, design.used)
        assert not isinstance(made, str)
        told = sample_yield(made, block, n)
        good = 0
        for part in range(SAMPLES // CHUNK):
            rows = made_linkages.samples(design.other, tolerances, distribution, CHUNK, 1000 * n + part)
            good += int(made_linkages.good(design.other, rows, *limits, fixed=fixed, reach=0.05).sum())
        held += told.low <= good / SAMPLES <= told.high
        values.append(told.value)
    print(f"yields: {held} of {count} intervals hold the share of {SAMPLES:.0e} other samples")
    print(f"  yields from {min(values):.3f} to {max(values):.3f}, median {np.median(values):.3f}")


def speed(rng: np.random.Generator) -> None:
    """Time the yield of a fourbar through five positions."""
    block = Manufacture.model_validate(
        {"tolerances": {"length": 0.1, "pivot": 0.05}, "quality": {"max_error": 0.3, "max_angle_error": 0.3}}
    )
    times = []
    for n in range(20):
        design = drawn(rng)
        made = build_product(design.linkage, design.held, block, design.used)
        assert not isinstance(made, str)
        sample_yield(made, block.model_copy(update={"samples": 100}), n)
        begun = time.process_time()
        sample_yield(made, block, n)
        times.append(time.process_time() - begun)
    print(f"speed: 10^5 samples at five positions in {np.median(times):.3f} s (median), {max(times):.3f} s at most")


def main(arguments: list[str]) -> None:
    """Print the figures."""
    count, designs, seed = (int(given) for given in (*arguments, *("100", "50", "0")[len(arguments) :]))
    speed(np.random.default_rng([seed, 1]))
    rounded(count, np.random.default_rng([seed, 2]))
    yields(designs, np.random.default_rng([seed, 3]))


if __name__ == "__main__":
    main(sys.argv[1:])
