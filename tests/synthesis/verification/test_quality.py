"""Quality of every kind agrees with docs/methods/ranking.md: recomputed here from the skeleton of each answer."""

from __future__ import annotations

import math
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.support.synthesis.quality import BODY, CASES, line
from tests.support.synthesis.screening import excess_of


def joints_of(mechanism: Any) -> dict[str, complex]:
    return {name: complex(*place) for name, place in mechanism.skeleton.joints.items()}


def restated(design: Any, task: float) -> float:
    """Quality by the text of docs/methods/ranking.md, from joints and links alone."""
    joints, skeleton = joints_of(design.mechanism), design.mechanism.skeleton
    links = design.mechanism.links if isinstance(design.mechanism.links, dict) else dict(design.mechanism.links)
    lengths = [length for length in links.values() if length > 0.0]
    ground = next(link.joints for link in skeleton.links if link.name == "ground")
    if "ground" not in links and len(ground) == 2:
        lengths.append(abs(joints[ground[0]] - joints[ground[1]]))
    longest = max(
        abs(joints[one] - joints[two]) for link in skeleton.links for one, two in combinations(link.joints, 2)
    )
    ratio = max(lengths) / min(lengths)
    sine = math.sin(math.radians(design.metrics.min_transmission_angle))
    return sine / ((1.0 + (longest / task / 3.0) ** 2) * (1.0 + (ratio / 8.0) ** 2))


SLOW = {"motion by a sixbar", "path of a slider-crank", "path of a geared fivebar", "dwell of a rocker"}


@pytest.mark.slow
@pytest.mark.parametrize("name", further(CASES, CASES.keys() - SLOW))
def test_quality_is_the_documented_one(name: str) -> None:
    statement, task = CASES[name]
    designs = solve(parse_problem(statement)).designs
    assert designs
    for design in designs:
        links = design.mechanism.links if isinstance(design.mechanism.links, dict) else dict(design.mechanism.links)
        size = task(design, links)
        if size is None:
            size = size_of_the_curve(design)
        wanted = restated(design, size)
        if statement["kind"] == "motion":
            stated = [{"x": x, "y": y, "angle": angle} for x, y, angle in BODY]
            turn = 0.0 if design.metrics.input_travel is None else design.metrics.input_travel
            wanted /= (1.0 + (turn / 180.0) ** 2) * (1.0 + excess_of(design, stated, size) ** 2)
        assert design.metrics.quality == pytest.approx(wanted, rel=1e-6)


def size_of_the_curve(design: Any) -> float:
    """Diagonal of the box around the coupler curve of the fourbar O2 A B O4 over the range that was driven."""
    joints = joints_of(design.mechanism)
    o2, o4, a, b, p = (joints[name] for name in ("O2", "O4", "A", "B", "P"))
    side = math.copysign(1.0, ((o4 - a).conjugate() * (b - a)).imag)
    pins = o2 + abs(a - o2) * np.exp(1j * np.radians(np.linspace(*design.metrics.input_range, 1441)))
    reach = o4 - pins
    along = (np.abs(reach) ** 2 + abs(b - a) ** 2 - abs(b - o4) ** 2) / (2.0 * np.abs(reach))
    bs = pins + reach / np.abs(reach) * (along + 1j * side * np.sqrt(abs(b - a) ** 2 - along**2))
    curve = pins + (bs - pins) * (p - a) / (b - a)
    return math.hypot(np.ptp(curve.real), np.ptp(curve.imag))


def test_a_long_side_of_the_coupler_counts() -> None:
    """Evans's linkage has B–P three times as long as A–B; a dwell's coupler point is far from its pins."""
    evans = solve(parse_problem(line("evans"))).designs[0]
    assert evans.metrics.quality == pytest.approx(0.41638, abs=1e-5)
    dwell = solve(parse_problem(CASES["dwell of a slider"][0])).designs[0]
    joints = joints_of(dwell.mechanism)
    side, crank = abs(joints["P"] - joints["A"]), abs(joints["A"] - joints["O2"])
    named = {dwell.mechanism.links[name] for name in ("ground", "input", "coupler", "rocker", "link_5")}
    assert side > 1.5 * max(named)
    # The crank is shortest, and reaches are in units of the stroke.
    uneven, bulky = 1.0 + (side / crank / 8.0) ** 2, 1.0 + (side / 50.0 / 3.0) ** 2
    sine = math.sin(math.radians(dwell.metrics.min_transmission_angle))
    assert dwell.metrics.quality == pytest.approx(sine / (uneven * bulky), rel=1e-9)
