"""Sixbar function generators as fits of the engine: against the core, differences, and planted pairs."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from synthesis.fit.linkage.descent import follow_valleys
from synthesis.fit.linkage.setting import pack_topology
from synthesis.fit.linkage.topology import FUNCTION_SIXBARS
from synthesis.kinds.function.fourbar.task import make_function_task
from synthesis.kinds.function.sixbar.criterion import SixbarFollower, SixbarLimits, list_free_coordinates
from synthesis.kinds.function.sixbar.fits import (
    SixbarCandidate,
    build_fit_task,
    build_packer,
    evaluate_errors,
    evaluate_margins,
    measure_motion,
)
from synthesis.kinds.function.sixbar.mechanism import build_function_linkage
from synthesis.kinds.function.sixbar.starts import draw_starts
from tests.support.synthesis.function_tasks import FunctionProblem

TASK = make_function_task(
    FunctionProblem(
        kind="function",
        function={"name": "sine", "x": [0.0, 90.0]},
        input_range=60.0,
        output_range=60.0,
        constraints={"max_link_ratio": 20.0},
    )
)
U = np.linspace(0.0, 1.0, 25)
V = TASK.problem.function.share_along(U)
SCALE = math.radians(60.0)
COSINE = math.cos(math.radians(15.0))
KINDS = tuple(FUNCTION_SIXBARS)


def drawn(kind: str, seed: int) -> SixbarCandidate:
    """A random sixbar near the function that can be driven through the whole range."""
    topology, rotations = FUNCTION_SIXBARS[kind], SCALE * (U - U[12])
    for fit in draw_starts(topology, rotations, SCALE * V, COSINE, 20.0, 300, 20, seed):
        one = SixbarCandidate(kind, fit, U, float(U[12]), (SCALE, SCALE))
        evaluated = evaluate_errors(one, U, V)
        if evaluated is not None:
            return replace(one, fit=evaluated[0])
    raise AssertionError("no start can be driven")


def stepped(one: SixbarCandidate, n: int, step: float) -> SixbarCandidate:
    x = one.fit.x.copy()
    x[n] += step
    return replace(one, fit=one.fit._replace(x=x))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_errors_and_transmission_are_those_of_the_driven_linkage(kind, seed):
    one = drawn(kind, seed)
    mechanism, dials = build_function_linkage(TASK, one)
    joints = {name: complex(*place) for name, place in mechanism.skeleton.joints.items()}
    linkage = catalogue.make_sixbar(kind, joints)
    inputs = np.radians(dials.input.place + dials.input.scale * (90.0 * U - dials.input.at))
    motion = drive(linkage, inputs - math.tau * round((inputs[0] - float(linkage.reference_input)) / math.tau), order=0)
    assert motion.valid.all()
    wanted = np.radians(dials.output.place + dials.output.scale * (np.sin(np.radians(90.0 * U)) - dials.output.at))
    _, errors, _ = evaluate_errors(one, U, V)
    off = np.angle(np.exp(1j * (motion.angles["output"][0] - wanted - errors)))
    assert np.abs(off).max() < 1e-9
    if kind != "stephenson_2":
        least = min(float(np.abs(sine).min()) for sine in motion.sines.values())
        assert math.sqrt(1.0 - np.abs(measure_motion(one, U).cosines).max() ** 2) == pytest.approx(least, abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_are_those_of_differences(kind):
    one, step = drawn(kind, 7), 1e-6
    _, _, slopes = evaluate_errors(one, U, V)
    ends, pack_limits = U[[0, -1]], build_packer(TASK.problem, 20.0, 100.0)
    rows = evaluate_margins(one, ends, pack_limits, 5)
    for n in range(len(one.fit.x)):
        sides = [stepped(one, n, side) for side in (step, -step)]
        errors = [evaluate_errors(side, U, V)[1] for side in sides]
        assert slopes[:, n] == pytest.approx((errors[0] - errors[1]) / (2.0 * step), abs=1e-5)
        margins = [evaluate_margins(side, ends, pack_limits, 5).margins for side in sides]
        assert rows.gradients[:, n] == pytest.approx((margins[0] - margins[1]) / (2.0 * step), abs=1e-5)


@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_by_the_scales_are_those_of_differences(kind):
    one, step = drawn(kind, 3), 1e-5
    follower, at = SixbarFollower(one, U, V), np.concatenate([one.fit.x, one.scales])
    slopes = follower.derivatives(at, np.zeros(len(U)), 1.0)
    for n in (-2, -1):
        move = np.zeros(len(at))
        move[n] = step
        ends = follower.errors(np.array([follower.apply_step(at, move), follower.apply_step(at, -move)]), np.ones(2))
        assert slopes[:, n] == pytest.approx((ends[0] - ends[1]) / (2.0 * step), abs=1e-5)


@pytest.mark.parametrize("kind", KINDS)
def test_held_coordinates_only_place_the_linkage(kind):
    """The free ones change the errors in as many independent ways as all."""
    one = drawn(kind, 1)
    _, _, slopes = evaluate_errors(one, U, V)
    free = list_free_coordinates(one)
    assert free.sum() == {"watt_2": 9, "stephenson_2": 11, "stephenson_3": 11}[kind]
    ranks = [np.linalg.matrix_rank(part, tol=1e-8 * np.abs(slopes).max()) for part in (slopes, slopes[:, free])]
    assert ranks[0] == ranks[1]


@pytest.mark.parametrize("kind", ["watt_2", "stephenson_3"])
def test_limits_of_the_first_fourbar_have_the_derivatives_of_differences(kind):
    constraints = TASK.problem.constraints.model_copy(update={"grashof": "crank_rocker"})
    task = TASK._replace(problem=TASK.problem.model_copy(update={"constraints": constraints}))
    one, step = drawn(kind, 2), 1e-6
    limits = SixbarLimits(task, one, U, build_packer(task.problem, 20.0, 100.0), every=True)
    at = np.concatenate([one.fit.x, one.scales])
    _, slopes = limits.values(at, derivatives=True)
    for n in range(len(at) - 2):
        ends = []
        for side in (step, -step):
            moved = at.copy()
            moved[n] += side
            ends.append(limits.values(moved)[0])
        assert slopes[:, n] == pytest.approx((ends[0] - ends[1]) / (2.0 * step), abs=1e-4)


def test_a_linkage_that_does_not_reach_an_input_has_no_errors():
    one = drawn("watt_2", 0)
    assert evaluate_errors(replace(one, scales=(math.tau, SCALE)), np.linspace(-1.0, 1.0, 73), np.zeros(73)) is None


def test_a_curved_valley_is_followed_to_its_end():
    # The sixbar's own function, from a part of its links away: the least squares are nothing at the end of a valley.
    one = drawn("watt_2", 0)
    rotations, (_, errors, _) = one.compute_rotations(U), evaluate_errors(one, U, V)
    task = build_fit_task(one.topology, rotations, SCALE * V + errors, np.full(25, 0.2), pack_topology, 0)
    start = one.fit.x + 0.1 * np.random.default_rng(0).normal(size=len(one.fit.x))
    fit = one.fit._replace(x=start, inputs=rotations)
    (followed,) = follow_valleys([fit], task, 300)
    # Half a sum of squares: 1e-20 is a rms error of a ten-billionth of a radian.
    assert followed.cost < 1e-20
