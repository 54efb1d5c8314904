"""What a body travels and turns between its positions, against a brute-force drive of plain complex arithmetic."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from synthesis.model.linkage.answer import LinkageDesign
from synthesis.verification.body_motion import compute_ease, measure_body_motion
from tests.campaign import further
from tests.support.synthesis.motion_search import ORDINARY, run
from tests.support.synthesis.planted import plant

DENSE = 400_001
"""Inputs of the brute-force drive."""


def driven(design: LinkageDesign, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """P and the body's angle of a fourbar by circles that intersect, at input angles in radians."""
    joints = {name: complex(*z) for name, z in design.mechanism.skeleton.joints.items()}
    o2, a, b, o4, p = (joints[name] for name in ("O2", "A", "B", "O4", "P"))
    pins = o2 + abs(a - o2) * np.exp(1j * inputs)
    base = o4 - pins
    coupler, output = abs(b - a), abs(b - o4)
    along = (np.abs(base) ** 2 + coupler**2 - output**2) / (2.0 * np.abs(base))
    side = math.copysign(1.0, ((o4 - a).conjugate() * (b - a)).imag)
    others = pins + base / np.abs(base) * (along + 1j * side * np.sqrt(coupler**2 - along**2))
    spins = (others - pins) / (b - a)
    return pins + (p - a) * spins, np.unwrap(np.angle(spins))


def confirm(design: LinkageDesign, stated: list[dict[str, Any]]) -> None:
    """All three measures by sums over a dense drive."""
    ends = np.radians([target.input_angle for target in design.targets])
    places, angles = driven(design, np.linspace(ends[0], ends[-1], DENSE))
    needed = sum(math.dist((p["x"], p["y"]), (q["x"], q["y"])) for p, q in pairwise(stated))
    turn = sum(abs(math.radians(math.remainder(q["angle"] - p["angle"], 360.0))) for p, q in pairwise(stated))
    metrics = design.metrics
    assert metrics.input_travel == pytest.approx(abs(math.degrees(ends[-1] - ends[0])), rel=1e-9)
    assert metrics.body_travel_ratio == pytest.approx(float(np.abs(np.diff(places)).sum()) / needed, rel=1e-6)
    assert metrics.body_turn_ratio == pytest.approx(float(np.abs(np.diff(angles)).sum()) / turn, rel=1e-6)
    assert metrics.body_travel_ratio >= 1.0 - 1e-9
    assert metrics.body_turn_ratio >= 1.0 - 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("n", further([2, 3, 4, 5], [3]))
def test_designs_say_what_a_dense_drive_finds(n: int) -> None:
    rng = np.random.default_rng(n)
    for _ in range(3):
        stated = plant(rng, n, 30.0).positions
        result = run(positions=stated, max_designs=6)
        assert result.designs
        for design in result.designs:
            confirm(design, stated)


def test_a_body_that_turns_to_and_fro_is_measured() -> None:
    """P and the body on known ways: an arc, and an angle that swings; both refined to far more than a grid's digits."""

    def pose(inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return 3.0 * np.exp(1j * inputs), 0.5 * np.sin(3.0 * inputs)

    ends = np.array([0.2, 2.6])
    places, turns = pose(ends)
    found = measure_body_motion(pose, (0.2, 2.6), places, turns, 5.0, slides=False)
    chord = abs(places[1] - places[0])
    assert found.input_turn == pytest.approx(2.4)
    assert found.travel_ratio == pytest.approx(3.0 * 2.4 / chord, rel=1e-8)
    peaks = [0.2, math.pi / 6.0, math.pi / 2.0, 2.6]
    swung = sum(abs(0.5 * math.sin(3.0 * q) - 0.5 * math.sin(3.0 * p)) for p, q in pairwise(peaks))
    needed = abs(turns[1] - turns[0])
    assert found.turn_ratio == pytest.approx(swung / needed, rel=1e-8)
    assert found.excess == pytest.approx(
        max((3.0 * 2.4 - chord) / max(chord, 5.0), (swung - needed) / max(needed, math.radians(15.0))), rel=1e-7
    )


def test_what_is_not_needed_has_no_ratio() -> None:
    def pose(inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return 1.0 * inputs + 0j, np.zeros(inputs.shape)

    found = measure_body_motion(pose, (0.0, 2.0), np.array([0.0, 2.0 + 0j]), np.zeros(2), 2.0, slides=True)
    assert found.turn_ratio is None
    assert found.travel_ratio == pytest.approx(1.0)
    assert found.input_turn == 0.0


def test_a_long_turn_and_a_wandering_body_cost_quality() -> None:
    assert compute_ease(0.0, 0.0) == 1.0
    assert compute_ease(math.pi, 0.0) == pytest.approx(0.5)
    assert compute_ease(0.0, 1.0) == pytest.approx(0.5)
    designs = run(positions=ORDINARY, max_designs=20).designs
    assert [design.metrics.quality for design in designs] == sorted(
        (design.metrics.quality for design in designs), reverse=True
    )


@pytest.mark.slow
def test_first_answers_turn_little_and_go_straight() -> None:
    """Ordinary tasks of three positions: few first answers turn their input by more than half a turn."""
    rng = np.random.default_rng(11)
    long_turns = wanders = 0
    for _ in range(12):
        points, angles = rng.uniform(-100.0, 100.0, (3, 2)), rng.uniform(-90.0, 90.0, 3)
        stated = [{"x": x, "y": y, "angle": a} for (x, y), a in zip(points, angles, strict=True)]
        metrics = run(positions=stated).designs[0].metrics
        long_turns += metrics.input_travel > 180.0
        wanders += max(metrics.body_travel_ratio, metrics.body_turn_ratio) > 2.0
    assert long_turns <= 4
    assert wanders <= 1


def test_a_sliding_input_has_a_stroke_and_a_body_that_is_measured() -> None:
    design = run(positions=ORDINARY, input_side={"dyad": "PR"}, max_designs=1).designs[0]
    assert design.metrics.input_travel is None
    assert design.metrics.input_stroke is not None
    assert design.metrics.body_travel_ratio >= 1.0 - 1e-9
    assert design.metrics.body_turn_ratio >= 1.0 - 1e-9
