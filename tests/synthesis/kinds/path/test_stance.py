"""The stance of a leg: what is measured of it, the kernels that steer into it, and curves of planted legs."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from kinematics.linkage.fourbar import Fourbar, positions
from synthesis.dispatch import solve
from synthesis.fit.chart import CRANK_ROCKER, GEARED_FIVEBAR, SLIDER_CRANK, compute_lengths
from synthesis.fit.constraints import FAMILY_INDEX, SIGN_INDEX
from synthesis.fit.coupler_curve import place_linkage
from synthesis.fit.linkage.descent import build_point_targets
from synthesis.fit.linkage.margins import count_margins
from synthesis.fit.linkage.residuals import FIRST_NODE, count_rows
from synthesis.fit.linkage.setting import STEPS
from synthesis.fit.linkage.topology import list_forms
from synthesis.kinds.path.multiloop.limits import build_packer
from synthesis.kinds.path.multiloop.shape_matching import find_similar_linkages
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.constraint_vector import count_setting_margins
from synthesis.kinds.path.residuals.curve_constraints import pack_curve_setting
from synthesis.kinds.path.residuals.stance import (
    JAM_CYCLE,
    LENGTH_MARGIN_COUNT,
    LONGEST,
    MARGIN_COUNT,
    PIVOT_LIMITS,
    PIVOT_MARGIN_COUNT,
    RATIO,
    SIMPLE_FAMILY,
    SIMPLE_SIGN,
    SIMPLE_SIZE,
    STANCE_SIZE,
    compute_fourbar_stance_rows,
    compute_linkage_stance_rows,
    compute_simple_stance_rows,
)
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.kinds.path.verification.stance import measure_stance
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.support.synthesis.random_linkages import trace_nodes

TURNS = np.linspace(0.0, math.tau, 24, endpoint=False)


def leg(points: np.ndarray, stance: dict[str, Any], **more: Any) -> dict[str, Any]:
    stated = [{"x": float(z.real), "y": float(z.imag)} for z in points]
    return {"kind": "path", "method": "curve_match", "closed": True, "points": stated, "stance": stance, **more}


@pytest.mark.parametrize(("first", "last"), [(2, 9), (20, 3)])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_made_motion_is_measured(first: int, last: int, way: float) -> None:
    """P goes s = θ + sin(4θ)/20 along a line at 0.7 rad, and sin(3θ) across it: all is known in closed form."""
    unit = cmath.exp(0.7j)

    def foot(turns: np.ndarray) -> np.ndarray:
        at = way * turns
        return np.asarray(unit * (at + 0.05 * np.sin(4.0 * at) + 0.01j * np.sin(3.0 * at)))

    inputs = way * TURNS
    begin, end = TURNS[first], TURNS[last] + (math.tau if first > last else 0.0)
    points = foot(inputs) + 0.0
    points[last] = points[first] + unit  # the line of the stance, wherever P is between its points
    problem = PathProblem.model_validate(leg(points, {"points": [first, last], "flatness": 1.0}))
    found = measure_stance(problem, foot, (0.0, math.tau), inputs)
    at = np.linspace(begin, end, 200001)
    heights, ways = 0.01 * np.sin(3.0 * at), at + 0.05 * np.sin(4.0 * at)
    speeds = (1.0 + 0.2 * np.cos(4.0 * at)) * (end - begin) / (ways[-1] - ways[0])
    assert found["flatness"] == pytest.approx(np.ptp(heights), rel=1e-8)
    assert found["speed_deviation"] == pytest.approx(np.abs(speeds - 1.0).max(), rel=1e-6)
    assert found["rotation"] == pytest.approx(math.degrees(end - begin))


PLANTED = FourbarConfiguration(0j, 20.0 + 0j, 50.0 + 45.0j, 60.0 + 0j, 30.0 - 30.0j)


def test_a_leg_that_is_moved_turned_and_sized_has_the_same_stance() -> None:
    told = []
    for size, turn, shift in ((1.0, 0.0, 0j), (25.4, 2.1, 300.0 - 70.0j), (1e-3, -0.9, 5.0j)):
        unit = size * cmath.exp(1j * turn)
        joints = FourbarConfiguration(*(unit * joint + shift for joint in PLANTED))
        mechanism = build_fourbar(joints)
        known = Fourbar(0j, 60.0 + 0j, 20.0, abs(30.0 + 45.0j), abs(10.0 - 45.0j), _in_frame())
        points = unit * positions(known, TURNS).p + shift
        stance = {"points": [3, 10], "flatness": 9.0 * size, "speed": "constant"}
        design = verify_path(PathProblem.model_validate(leg(points, stance)), mechanism)
        assert design is not None
        metrics = design.metrics
        assert metrics.max_distance < 1e-9 * size * 60.0
        assert metrics.stance_flatness is not None
        checks = {check.name: check for check in design.verification.checks}
        assert checks["stance_flatness"].passed == (metrics.stance_flatness <= 9.0 * size)
        assert checks["stance_speed"].limit == pytest.approx(0.1)
        told.append((metrics.stance_flatness / size, metrics.stance_speed_deviation, metrics.stance_rotation))
    assert told[1:] == [pytest.approx(told[0], rel=1e-6)] * 2


def _in_frame() -> complex:
    _, a, b, _, p = PLANTED
    return (p - a) * abs(b - a) / (b - a)


Rows = Callable[..., int]


def assert_derivatives(rows: Rows, x: np.ndarray, points: np.ndarray, setting: np.ndarray, most: int, state: np.ndarray,
                       limits: int) -> None:  # fmt: skip
    """Rows of a linkage that is at the points: there the derivatives leave nothing out."""
    placed = points
    if points.ndim == 1:
        placed = np.stack([points.real, points.imag, np.zeros(len(points)), np.ones(len(points))], axis=1)
    multipliers = np.append(np.zeros(limits), 30.0)

    def settled(at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        residuals, jacobian, kept = np.empty(most), np.zeros((most, len(x))), state.copy()
        for _ in range(20):
            count = rows(at, placed, setting, multipliers, kept, residuals, jacobian)
        return residuals[:count], jacobian[:count]

    found = settled(x)[1]
    step = 1e-6
    by = np.stack(
        [
            (settled(x + step * one)[0] - settled(x - step * one)[0]) / (2.0 * step)
            for one in np.eye(len(x))
        ],
        axis=1,
    )  # fmt: skip
    assert len(found) > 2 * MARGIN_COUNT // 5
    stances = slice(len(found) - 30, None)
    assert np.abs(by - found)[stances].max() < 1e-5 * np.abs(found[stances]).max()
    assert np.abs(found[stances]).max() > 1e-2


LINE = [math.cos(0.3), math.sin(0.3), 0.01, 0.02]


@pytest.mark.parametrize(
    ("family", "ratio", "x"),
    [
        (SLIDER_CRANK, 0.0, [0.1, 0.2, 0.3, math.log(0.5), 0.0, 0.2, 0.8, 0.5]),
        (GEARED_FIVEBAR, -1.0,
         [0.0, 0.0, 1.2, 0.1, math.log(0.4), math.log(1.3), math.log(1.2), math.log(0.35), 0.4, 0.6, 0.5]),
    ],
)  # fmt: skip
def test_derivatives_of_linkages_with_one_closure(family: int, ratio: float, x: list[float]) -> None:
    setting = np.empty(SIMPLE_SIZE)
    setting[:STANCE_SIZE] = 2, 8, 0.0, *LINE
    setting[SIMPLE_FAMILY], setting[SIMPLE_SIGN], setting[RATIO] = family, 1.0, ratio
    setting[LONGEST], setting[JAM_CYCLE] = math.inf, math.tau
    setting[PIVOT_LIMITS] = np.tile([-math.inf, math.inf], 4)
    at, theta, limits = np.array(x), np.linspace(0.0, 3.0, 12), MARGIN_COUNT + LENGTH_MARGIN_COUNT + PIVOT_MARGIN_COUNT
    lengths = np.zeros(4)
    compute_lengths(family, at, lengths, np.zeros((4, 4)))
    points = np.array([place_linkage(family, at, lengths, 1.0, ratio, one)[1] for one in theta])
    state = np.concatenate([theta, np.zeros(limits)])
    assert_derivatives(compute_simple_stance_rows, at, points, setting, 24 + limits, state, limits)


CIRCLE = PathProblem.model_validate(
    {"kind": "path", "method": "curve_match", "closed": True,
     "points": [{"x": x, "y": y} for x, y in ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))]}
)  # fmt: skip


def test_derivatives_of_a_fourbar_whose_stance_goes_on_past_the_last_point() -> None:
    x = np.array([0.1, 0.2, 0.3, math.log(0.4), math.log(0.5), math.log(0.6), math.log(0.7), 0.8, 0.5])
    own = pack_curve_setting(CIRCLE, 0j, 1.0)
    own[FAMILY_INDEX], own[SIGN_INDEX] = CRANK_ROCKER, 1.0
    turned, limits, lengths = np.linspace(0.0, 6.0, 12), count_setting_margins(own) + MARGIN_COUNT, np.zeros(4)
    compute_lengths(CRANK_ROCKER, x, lengths, np.zeros((4, 4)))
    points = np.array([place_linkage(CRANK_ROCKER, x, lengths, 1.0, 0.0, x[2] + one)[1] for one in turned])
    state = np.concatenate([turned, np.zeros(24 + limits)])
    setting = np.concatenate([[10, 3, math.tau], LINE, own])
    assert_derivatives(compute_fourbar_stance_rows, x, points, setting, 24 + limits, state, limits)


def test_derivatives_of_a_sixbar_whose_stance_goes_on_past_the_last_point() -> None:
    topology = list_forms("stephenson_3")[0]
    around = np.exp(1j * np.arange(48) * math.tau / 48) * (1.0 + 0.1 * np.cos(np.arange(48)))
    fit = find_similar_linkages(topology, around, True, 4096, 2, np.random.default_rng(0))[0]
    own = build_packer(CIRCLE, 0j, 1.0, 20.0, 10.0)(topology).copy()
    own[STEPS] = 36
    limits = count_margins(own) + MARGIN_COUNT
    points = trace_nodes(topology, fit.x, fit.inputs)[:, topology.point] @ [1.0, 1.0j]
    targets = build_point_targets(points, np.ones(48))
    targets[:, FIRST_NODE] = topology.point
    setting = np.concatenate([[40, 10, math.tau], LINE, own])
    state = np.concatenate([fit.inputs, np.zeros(limits)])
    most = count_rows(48, own) + MARGIN_COUNT
    assert_derivatives(compute_linkage_stance_rows, fit.x, targets, setting, most, state, limits)


def by_two_circles(one: np.ndarray, other: np.ndarray, near: float, far: float) -> np.ndarray:
    """Where two bars from two pins meet, left of the way from one to the other."""
    base = other - one
    along = (np.abs(base) ** 2 + near**2 - far**2) / (2.0 * np.abs(base))
    return np.asarray(one + base / np.abs(base) * (along + 1j * np.sqrt(near**2 - along**2)))


def slider(turns: np.ndarray) -> np.ndarray:
    pin = 20.0 * np.exp(1j * turns)
    end = pin + np.sqrt(70.0**2 - (8.0 - pin.imag) ** 2) + 1j * (8.0 - pin.imag)
    return np.asarray(pin + (end - pin) / 70.0 * (25.0 + 18.0j))


def geared(turns: np.ndarray) -> np.ndarray:
    one, other = 16.0 * np.exp(1j * turns), 60.0 + 14.0 * np.exp(1j * (0.8 - turns))
    pin = by_two_circles(one, other, 55.0, 50.0)
    return np.asarray(one + (pin - one) / 55.0 * (30.0 + 20.0j))


def crank_rocker(turns: np.ndarray) -> np.ndarray:
    pin = 18.0 * np.exp(1j * turns)
    end = by_two_circles(pin, np.full(len(turns), 55.0 + 0j), 50.0, 45.0)
    return np.asarray(pin + (end - pin) / 50.0 * (30.0 - 35.0j))


LEGS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "fourbar": crank_rocker,
    "slider_crank": slider,
    "geared_fivebar": geared,
}


@pytest.mark.slow
@pytest.mark.parametrize("method", ["curve_match", "least_squares"])
@pytest.mark.parametrize("kind", further(LEGS, ["slider_crank"]))
def test_a_planted_leg_is_found_with_what_it_does(kind: str, method: str) -> None:
    """Its stance is where the way of a quarter turn is flattest, held to what it does there and 2 % more."""
    foot, dense = LEGS[kind], np.linspace(0.0, 0.25 * math.tau, 4001)

    def walked(first: int) -> tuple[float, float, float]:
        steps = foot(TURNS[first] + dense)
        along = (steps - steps[0]) / (steps[-1] - steps[0])
        speeds = np.gradient(along.real, dense) * dense[-1]
        return np.ptp(along.imag), np.abs(speeds - 1.0).max(), abs(steps[-1] - steps[0])

    first = min(range(24), key=lambda k: walked(k)[0])
    flat, uneven, way = walked(first)
    stance = {"points": [first, (first + 6) % 24], "flatness": 1.02 * flat * way}
    stance |= {"speed": "constant", "speed_tolerance": 1.02 * uneven}
    stated = leg(foot(TURNS), stance, method=method, mechanism=kind, max_designs=2)
    if kind == "geared_fivebar":
        stated["gear_ratio"] = -1.0
    result = solve(parse_problem(stated))
    best = result.designs[0]
    assert best.verification.passed
    assert best.metrics.stance_flatness <= 1.02 * flat * way
    assert best.metrics.stance_speed_deviation <= 1.02 * uneven
    assert best.metrics.rms_distance < 1e-3 * way
    assert f"within a band of {min(d.metrics.stance_flatness for d in result.designs):.3g}" in result.summary
