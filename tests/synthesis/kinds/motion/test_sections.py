"""All dyads of five positions and of stated choices: their number exactly, planted ones, sliders, degenerate tasks."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from synthesis.kinds.motion.dyads.equations import DyadConditions
from synthesis.kinds.motion.dyads.finite_sets import find_section
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.registry import parse_problem
from tests.campaign import sampled
from tests.oracles.five_positions import real_dyads
from tests.support.synthesis.planted import plant


def open_choices(task: MotionTask) -> DyadConditions:
    return DyadConditions(rotations=(None,) * (len(task.points) - 1))


def lengths_vary(task: MotionTask, fixed: np.ndarray, moving: np.ndarray) -> float:
    """Largest change of a link's length over the positions, relative to the dyad's size."""
    links = np.abs(task.images(moving) - fixed[:, None])
    return float((np.ptp(links, axis=1) / (1.0 + np.abs(fixed) + np.abs(moving))).max(initial=0.0))


def rational_task(
    rng: np.random.Generator, moved: Fraction = Fraction(1), turned: Fraction = Fraction(1)
) -> tuple[MotionTask, int]:
    """Five positions by rational numbers, and how many real dyads they have; moves and turns may be made small.

    The task's unit is the greatest move, as it is of a stated one.
    """
    numbers = np.stack([rng.choice(829, 5, replace=False) - 414 for _ in range(3)], axis=1)
    scales = moved, moved, turned
    poses = [tuple(Fraction(int(v), 997) * scale for v, scale in zip(row, scales, strict=True)) for row in numbers]
    first = poses[0]
    points = np.array([complex(float(x - first[0]), float(y - first[1])) for x, y, _ in poses])
    halves = [float((t - first[2]) / (1 + t * first[2])) for _, _, t in poses]
    turns = np.array([(1.0 + 1j * t) ** 2 / (1.0 + t**2) for t in halves])
    size = float(np.abs(points[:, None] - points).max()) if moved < 1 else 1.0
    return MotionTask(points / size, turns, 0j, size), real_dyads(poses)


def compared_with_the_oracle(seed: int, count: int) -> set[int]:
    rng = np.random.default_rng(seed)
    met = set()
    for _ in range(count):
        task, expected = rational_task(rng)
        found = find_section(task, open_choices(task))
        assert found.proved
        assert not found.double.any()
        assert len(found.dyads.fixed) + len(found.sliders) == expected
        assert lengths_vary(task, *found.dyads) < 1e-11
        met.add(expected)
    return met


@pytest.mark.slow
def test_number_of_real_dyads_is_exact() -> None:
    assert compared_with_the_oracle(0, 40) == {0, 2, 4}


@pytest.mark.parametrize("moved", [0, 4, 9])
@pytest.mark.parametrize("turned", [1, 2, 3, 4, 5, 6, 7, 9, 12])
def test_what_is_lost_in_digits_is_never_proved(moved: int, turned: int) -> None:
    """Small moves and turns: the number of dyads is the exact one, or it is not said to be all."""
    rng = np.random.default_rng([moved, turned])
    proofs = 0
    for _ in range(5):
        task, expected = rational_task(rng, Fraction(1, 10**moved), Fraction(1, 10**turned))
        found = find_section(task, open_choices(task))
        if found.finite and found.proved:
            assert len(found.dyads.fixed) + len(found.sliders) == expected
            assert found.far == 0
            proofs += 1
    # A body that turns by some degrees leaves digits enough, however small the unit is.
    assert proofs == 5 or turned > 2


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(1, 5))
def test_number_of_real_dyads_is_exact_for_a_thousand_tasks(seed: int) -> None:
    compared_with_the_oracle(seed, sampled(250))


def test_planted_dyads_of_five_positions_are_among_the_answers() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        planted = plant(rng, 5, 10.0 ** rng.uniform(-3.0, 3.0), complex(*rng.uniform(-5.0, 5.0, 2)))
        task = make_motion_task(parse_problem({"kind": "motion", "positions": planted.positions}))
        found = find_section(task, open_choices(task))
        for side in (planted.input_side, planted.output_side):
            gaps = np.abs(found.dyads.fixed - task.to_task(side.fixed_pivot))
            gaps += np.abs(found.dyads.moving - task.to_task(side.moving_pivot))
            assert gaps.min(initial=math.inf) < 1e-6


@pytest.mark.parametrize("kind", ["PR", "RP"])
def test_sliders_are_dyads_at_infinity(kind: str) -> None:
    """Positions whose body has a point on a line, or a line through a point: that dyad is found, and said."""
    rng = np.random.default_rng(2)
    for _ in range(20):
        angles = rng.uniform(-1.0, 1.0, 5)
        along = rng.uniform(-1.0, 1.0, 5)
        direction, pin = np.exp(1j * rng.uniform(-3.0, 3.0)), complex(*rng.normal(size=2))
        turns = np.exp(1j * (angles - angles[0]))
        place = complex(*rng.normal(size=2))
        if kind == "PR":  # the body's point at ``pin`` in the first position moves along ``direction``
            images = pin + (along - along[0]) * direction
            points = images + turns * (place - pin)
        else:  # the body's line through ``pin`` along ``direction`` keeps passing through ``pin``
            points = pin + turns * (place - pin + (along - along[0]) * direction)
        task = MotionTask(points - points[0], turns, 0j, 1.0)
        found = find_section(task, open_choices(task))
        assert found.proved
        sliders = [slider for slider in found.sliders if slider.kind == kind]
        assert len(sliders) == 1
        assert abs((np.conj(sliders[0].normal) * direction).real) < 1e-8
        offset = sliders[0].point - (pin - points[0])
        assert abs(offset if kind == "PR" else (np.conj(sliders[0].normal) * offset).real) < 1e-8
        assert (len(found.dyads.fixed) + len(found.sliders)) % 2 == 0


@pytest.mark.slow
def test_a_double_dyad_is_said_and_counted_once() -> None:
    """Between tasks of four and of two real dyads lies one where two coincide, before they become complex."""
    rng = np.random.default_rng(6)
    met = 0
    for _ in range(20):
        (few, n), (many, m) = rational_task(rng), rational_task(rng)
        if {n, m} != {2, 4}:
            continue
        if n == 4:
            few, many = many, few

        def between(share: float, few: MotionTask = few, many: MotionTask = many) -> MotionTask:
            turns = np.angle(few.turns) + share * (np.angle(many.turns) - np.angle(few.turns))
            return MotionTask(few.points + share * (many.points - few.points), np.exp(1j * turns), 0j, 1.0)

        low, high = 0.0, 1.0
        while high - low > 1e-16 and low < (low + high) / 2.0 < high:
            middle = (low + high) / 2.0
            found = find_section(between(middle), open_choices(few))
            if len(found.dyads.fixed) + len(found.sliders) < 3:
                low = middle
            else:
                high = middle
        found = find_section(between(high), open_choices(few))
        if np.abs(found.dyads.fixed).max() > 1e3:  # the two meet at infinity
            continue
        assert found.double.any()
        assert not found.proved
        assert lengths_vary(between(high), *found.dyads) < 1e-9
        met += 1
    assert met >= 2


def test_a_family_of_dyads_is_said() -> None:
    """A body point that is at one place in three positions and at another in two has its centre anywhere on a line."""
    angles = np.array([0.0, 0.4, -0.7, 0.2, 0.9])
    arm = np.exp(1j * angles)
    pins = np.array([0.0, 0.0, 0.0, 1.0 + 0.5j, 1.0 + 0.5j])
    points = pins + arm * (0.6 - 0.8j)
    task = MotionTask(points - points[0], arm / arm[0], 0j, 1.0)
    found = find_section(task, open_choices(task))
    assert not found.finite
    assert not found.proved


def test_symmetric_positions_have_a_double_dyad_or_simple_ones_but_never_a_false_count() -> None:
    """Positions that mirror each other in the middle one."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        x, y, a = rng.normal(size=(3, 2))
        points = np.array([-x[0] + 1j * y[0], -x[1] + 1j * y[1], 0.0, x[1] + 1j * y[1], x[0] + 1j * y[0]])
        turns = np.exp(1j * np.array([-a[0], -a[1], 0.0, a[1], a[0]]))
        task = MotionTask(points - points[0], turns / turns[0], 0j, 1.0)
        found = find_section(task, open_choices(task))
        assert found.finite
        assert lengths_vary(task, *found.dyads) < 1e-9
        count = len(found.dyads.fixed) + len(found.sliders)
        assert count % 2 == 0 or found.double.any()
