"""Burmester's curves of four positions against the determinant that defines them, and against planted linkages."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synthesis.kinds.motion.dyads.burmester import (
    BurmesterCurve,
    Window,
    find_burmester_curve,
    sample_branches,
    sample_dyads,
)
from synthesis.kinds.motion.dyads.equations import DyadConditions
from synthesis.kinds.motion.dyads.finite_sets import find_section
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.registry import parse_problem
from tests.support.synthesis.planted import inverted_images, plant


def random_task(rng: np.random.Generator, n: int = 4) -> MotionTask:
    points = rng.uniform(-1.0, 1.0, n) + 1j * rng.uniform(-1.0, 1.0, n)
    turns = np.exp(1j * rng.uniform(-1.5, 1.5, n))
    return MotionTask(points - points[0], turns / turns[0], 0j, 1.0)


def curve_of(task: MotionTask) -> BurmesterCurve:
    curve = find_burmester_curve(task, DyadConditions(rotations=(None,) * 3))
    assert curve is not None
    return curve


def centre_cubic(task: MotionTask, fixed: np.ndarray) -> np.ndarray:
    """Whether O is the centre for some point: its four inverted images lie on a circle, a 4 × 4 determinant."""
    z = inverted_images(task, fixed)
    matrix = np.stack([np.abs(z) ** 2, z.real, z.imag, np.ones(z.shape)], axis=-1)
    scale = np.linalg.norm(matrix, axis=-1).prod(axis=-1)
    return np.asarray(np.abs(np.linalg.det(matrix)) / scale)


PLAIN = Window((0j, 0j), 6.0, math.inf)


def test_samples_lie_on_the_curves() -> None:
    rng = np.random.default_rng(0)
    for _ in range(20):
        task = random_task(rng)
        for branch in sample_branches(curve_of(task), PLAIN, 300):
            assert centre_cubic(task, branch.dyads.fixed).max() < 1e-10
            links = np.abs(task.images(branch.dyads.moving) - branch.dyads.fixed[:, None])
            assert np.ptp(links, axis=1).max() < 1e-9
            assert np.abs(branch.dyads.fixed).max() <= 6.0
            assert np.abs(branch.dyads.moving).max() <= 6.0


def test_samples_are_even_by_arc_length() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        task = random_task(rng)
        for branch in sample_branches(curve_of(task), PLAIN, 600):
            if len(branch.dyads.fixed) < 60:
                continue
            steps = np.hypot(np.abs(np.diff(branch.dyads.fixed)), np.abs(np.diff(branch.dyads.moving)))
            assert steps.max() < 1.5 * np.median(steps)
            assert steps.min() > 0.5 * np.median(steps)


def test_every_branch_is_there() -> None:
    """Wherever a line meets the centre-point cubic, a sample is near: the line's points by an exact section."""
    rng = np.random.default_rng(2)
    met = 0
    for _ in range(20):
        task = random_task(rng)
        found = sample_branches(curve_of(task), PLAIN, 1500)
        fixed = np.concatenate([branch.dyads.fixed for branch in found])
        moving = np.concatenate([branch.dyads.moving for branch in found])
        for _ in range(5):
            vector = complex(*rng.normal(size=2))
            rotation = float(rng.uniform(-math.pi, math.pi))
            for conditions in (
                DyadConditions(rotations=(None,) * 3, link_angle=np.asarray(np.angle(vector))),
                DyadConditions(rotations=(np.asarray(rotation), None, None)),
            ):
                for o, a in zip(*find_section(task, conditions).dyads, strict=True):
                    if max(abs(o), abs(a)) < 5.5:
                        assert np.hypot(np.abs(fixed - o), np.abs(moving - a)).min() < 0.05
                        met += 1
    assert met > 200


def test_the_curve_passes_through_planted_linkages() -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        planted = plant(rng, 4, 20.0)
        task = make_motion_task(parse_problem({"kind": "motion", "positions": planted.positions}))
        dyads = sample_dyads(curve_of(task), Window((complex(task.points.mean()), 0j), 60.0, 0.15), 4000)
        for side in (planted.input_side, planted.output_side):
            gaps = np.hypot(
                np.abs(dyads.fixed - task.to_task(side.fixed_pivot)),
                np.abs(dyads.moving - task.to_task(side.moving_pivot)),
            )
            size = 1.0 + abs(task.to_task(side.fixed_pivot)) + abs(task.to_task(side.moving_pivot))
            assert gaps.min() < 0.02 * size


def test_closed_branches_close() -> None:
    rng = np.random.default_rng(4)
    closed = 0
    for _ in range(40):
        for branch in sample_branches(curve_of(random_task(rng)), PLAIN, 600):
            if branch.closed:
                step = np.abs(np.diff(branch.dyads.fixed)) + np.abs(np.diff(branch.dyads.moving))
                gap = abs(branch.dyads.fixed[0] - branch.dyads.fixed[-1])
                gap += abs(branch.dyads.moving[0] - branch.dyads.moving[-1])
                assert gap < 2.0 * step.max()
                closed += 1
    assert closed > 3


def test_a_line_that_belongs_to_the_curve_is_sampled() -> None:
    """A body point with one place in three positions is a circle point with its centre anywhere on a bisector.

    Whether that line is one of the ruling's depends on the pair of positions that the ruling is taken from.
    """
    rng = np.random.default_rng(5)
    of_the_ruling = 0
    for _ in range(12):
        arm = np.exp(1j * rng.uniform(-1.5, 1.5, 4))
        pins = np.array([0.0, 0.0, 0.0, complex(*rng.uniform(-1.0, 1.0, 2))])
        points = pins + arm * complex(*rng.uniform(-1.0, 1.0, 2))
        task = MotionTask(points - points[0], arm / arm[0], 0j, 1.0)
        curve = curve_of(task)
        of_the_ruling += bool(curve.lines)
        found = sample_branches(curve, PLAIN, 400)
        moving = np.concatenate([branch.dyads.moving for branch in found])
        fixed = np.concatenate([branch.dyads.fixed for branch in found])
        there = np.abs(moving - (pins[0] - points[0])) < 1e-6
        assert there.sum() > 20
        bisector = fixed[there] - (pins[0] + pins[3] - 2.0 * points[0]) / 2.0
        assert np.abs((np.conj(pins[3]) * bisector).real).max() < 1e-5
        assert not there.all()
    assert of_the_ruling


@pytest.mark.parametrize("angles", [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.5, 0.5], [0.0, 0.0, 0.0, 0.5]])
def test_parallel_positions(angles: list[float]) -> None:
    """Without rotation between some positions the curve is found all the same; without any there is none."""
    points = np.array([0.0, 1.0 + 0.2j, 1.5 - 0.4j, 0.3 + 0.8j])
    task = MotionTask(points, np.exp(1j * np.array(angles)), 0j, 1.0)
    curve = find_burmester_curve(task, DyadConditions(rotations=(None,) * 3))
    assert (curve is None) == (angles[3] == 0.0)
    if curve is not None:
        found = sample_branches(curve, PLAIN, 200)
        assert found
        for branch in found:
            assert centre_cubic(task, branch.dyads.fixed).max() < 1e-9
