"""Rows of fits: their gradient is that of the cost, with every constraint under load; margins are what they say."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synthesis.fit.linkage.descent import build_pose_targets
from synthesis.fit.linkage.margins import EQUATION_COUNT, count_margins
from synthesis.fit.linkage.residuals import (
    FIRST_NODE,
    FREE,
    KIND,
    PLACE,
    ROOT,
    SECOND_NODE,
    SLOT,
    TARGET_SIZE,
    TURN,
    X,
    Y,
    compute_linkage_rows,
    count_rows,
)
from synthesis.fit.linkage.setting import (
    BACK,
    COSINE,
    FAMILY,
    FULL_TURN,
    GIVEN_PIVOTS,
    GRASHOF,
    INPUT_BOX,
    LINKS,
    MOVING_BOX,
    ORDER,
    PIVOT_BOX,
    RATIO,
    REACH,
    STEPS,
    WIDTH,
    WORKSPACE_BOX,
    pack_topology,
)
from synthesis.fit.linkage.topology import Topology, list_forms
from tests.support.synthesis.random_linkages import TOPOLOGIES, draw_linkage, trace_nodes

POINT_COUNT, STEP = 16, 1e-6
INPUTS = np.linspace(0.0, 2.0 * math.pi, POINT_COUNT, endpoint=False)


def build_setting(topology: Topology, z: np.ndarray, *, robust: bool, full: bool) -> np.ndarray:
    """Return limits of every kind, most of them violated, so that their margins bear loads."""
    setting = pack_topology(topology)
    setting[FULL_TURN], setting[STEPS], setting[BACK], setting[WIDTH] = full, 24, 0.7, 0.05 if robust else 0.0
    setting[COSINE], setting[RATIO], setting[LINKS] = 0.3, 1.2, (0.4, 0.5)
    setting[INPUT_BOX] = setting[PIVOT_BOX] = z[0] + 0.1, z[0] + 0.2, z[1] + 0.1, z[1] + 0.3
    setting[GIVEN_PIVOTS] = 0.1, math.nan, 0.2, 0.3
    setting[MOVING_BOX], setting[WORKSPACE_BOX] = (-0.1, 0.1, -0.2, 0.1), (-0.3, 0.2, -0.2, 0.25)
    setting[FAMILY] = 1.0 if topology.families else -1.0
    return setting


def build_targets(topology: Topology, places: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return places of the traced point that it misses a little."""
    targets = np.zeros((len(places), TARGET_SIZE))
    targets[:, KIND], targets[:, FIRST_NODE] = PLACE, topology.point
    targets[:, X : Y + 1] = places[:, topology.point] + 1e-3 * rng.normal(size=(len(places), 2))
    targets[:, ROOT] = np.linspace(0.2, 0.5, len(places))
    targets[:, SLOT], targets[:, FREE] = np.arange(len(places)), 1.0
    return targets


def evaluate_settled(
    x: np.ndarray, targets: np.ndarray, setting: np.ndarray, inputs: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return residuals, Jacobian and state after the free inputs have settled."""
    limits, most = count_margins(setting), count_rows(len(targets), setting)
    state, multipliers = np.concatenate([inputs, np.zeros(limits)]), np.append(np.zeros(limits), 5.0)
    residuals, jacobian = np.zeros(most), np.zeros((most, len(x)))
    for _ in range(12):
        count = compute_linkage_rows(x, targets, setting, multipliers, state, residuals, jacobian)
        assert count > 0
    return residuals[:count].copy(), jacobian[:count].copy(), state


def assert_gradient(x: np.ndarray, targets: np.ndarray, setting: np.ndarray, inputs: np.ndarray) -> None:
    """Assert that the gradient of half the sum of squares is that of differences."""
    residuals, jacobian, _ = evaluate_settled(x, targets, setting, inputs)
    gradient, differences = jacobian.T @ residuals, []
    for change in STEP * np.eye(len(x)):
        costs = [0.5 * np.sum(evaluate_settled(x + s * change, targets, setting, inputs)[0] ** 2) for s in (1.0, -1.0)]
        differences.append((costs[0] - costs[1]) / (2.0 * STEP))
    np.testing.assert_allclose(gradient, differences, atol=2e-4 * np.abs(gradient).max())
    assert np.abs(gradient).max() > 1e-2


@pytest.mark.parametrize("robust", [False, True])
@pytest.mark.parametrize("name", ["watt_1-0", "watt_1-3", "stephenson_1-0", "stephenson_2-0", "stephenson_2-1",
                                  "stephenson_3-0", "fourbar", "eightbar-29"])  # fmt: skip
def test_gradient_over_a_full_turn(name: str, robust: bool) -> None:
    topology = TOPOLOGIES[name]
    z = draw_linkage(topology)
    targets = build_targets(topology, trace_nodes(topology, z, INPUTS), np.random.default_rng(0))
    assert_gradient(z, targets, build_setting(topology, z, robust=robust, full=True), INPUTS)


@pytest.mark.parametrize("name", ["watt_1-0", "stephenson_3-0", "eightbar-61"])
def test_gradient_over_a_range_with_free_ends(name: str) -> None:
    topology, inputs = TOPOLOGIES[name], np.linspace(-0.35, 0.85, POINT_COUNT)
    z = draw_linkage(topology)
    targets = build_targets(topology, trace_nodes(topology, z, inputs), np.random.default_rng(0))
    x = np.concatenate([z, [-0.4, 0.9]])
    assert_gradient(x, targets, build_setting(topology, z, robust=True, full=False), inputs)


@pytest.mark.parametrize("free", [False, True])
def test_gradient_of_poses_at_given_and_free_inputs(free: bool) -> None:
    """Place and rotation of the body share an input; the pose is missed a little."""
    topology, inputs = TOPOLOGIES["stephenson_1-0"], np.linspace(0.0, 2.5, 5)
    z = draw_linkage(topology)
    places = trace_nodes(topology, z, inputs)
    i, j = topology.links[topology.body]
    directions = (places[:, j] - places[:, i]) @ [1.0, 1.0j]
    targets = np.zeros((2 * len(inputs), TARGET_SIZE))
    targets[:, SLOT], targets[:, ROOT], targets[:, FREE] = np.repeat(np.arange(5), 2), 0.7, free
    targets[::2, KIND], targets[::2, FIRST_NODE] = PLACE, topology.point
    targets[::2, X : Y + 1] = places[:, topology.point] + 1e-3
    targets[1::2, KIND], targets[1::2, FIRST_NODE], targets[1::2, SECOND_NODE] = TURN, i, j
    targets[1::2, X] = np.angle(directions / directions[0]) + 2e-3
    setting = build_setting(topology, z, robust=False, full=True)
    setting[BACK] = 0.0
    assert_gradient(z, targets, setting, inputs)


@pytest.mark.parametrize("grashof", [1.0, -1.0])
@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize(("kind", "number"), [("watt_1", 1), ("stephenson_1", 0), ("stephenson_2", 1)])
def test_gradient_of_ordered_poses_with_tolerances(kind: str, number: int, way: float, grashof: float) -> None:
    """Some coordinates are within their tolerances; the steps of the inputs are unknowns."""
    topology, inputs = list_forms(kind, guides=True)[number], way * np.array([0.0, 0.1, 0.25, 0.3, 0.5])
    z = draw_linkage(topology)
    places = trace_nodes(topology, z, inputs)
    points = places[:, topology.point] @ [1.0, 1.0j]
    headings = np.angle(places[:, topology.heading] @ [1.0, 1.0j] - points)
    rng = np.random.default_rng(0)
    off = rng.normal(size=(3, 5)) * 0.03
    tolerances = rng.choice([0.0, 0.01, 0.1], (5, 3))
    targets = build_pose_targets(points + off[0] + 1j * off[1], headings + off[2], tolerances, np.full(5, 0.7))
    targets[::2, FIRST_NODE] = targets[1::2, FIRST_NODE] = topology.point
    targets[1::2, SECOND_NODE] = topology.heading
    setting = build_setting(topology, z, robust=False, full=False)
    setting[BACK], setting[ORDER], setting[REACH], setting[GRASHOF] = (
        0.0,
        1.0,
        0.2,
        grashof if topology.families else 0.0,
    )
    x = np.concatenate([z, np.log(np.abs(np.diff(inputs)))])
    assert_gradient(x, targets, setting, inputs)


def test_exact_targets_leave_no_residual() -> None:
    for topology in TOPOLOGIES.values():
        z = draw_linkage(topology)
        targets = build_targets(topology, trace_nodes(topology, z, INPUTS), np.random.default_rng(0))
        targets[:, X : Y + 1] = trace_nodes(topology, z, INPUTS)[:, topology.point]
        residuals, _, state = evaluate_settled(z, targets, pack_topology(topology), INPUTS + 1e-3)
        assert np.abs(residuals).max() < 1e-9
        np.testing.assert_allclose(state[:POINT_COUNT], INPUTS, atol=1e-6)


@pytest.mark.parametrize("name", ["watt_1-0", "stephenson_2-0", "eightbar-87"])
def test_margins_are_distances_from_the_limits(name: str) -> None:
    topology = TOPOLOGIES[name]
    z = draw_linkage(topology)
    setting = build_setting(topology, z, robust=False, full=True)
    targets = build_targets(topology, trace_nodes(topology, z, INPUTS), np.random.default_rng(0))
    _, _, state = evaluate_settled(z, targets, setting, INPUTS)
    margins = state[POINT_COUNT:]
    places = z.reshape(-1, 2)
    lengths = np.array([np.hypot(*(places[a] - places[b])) for a, b in topology.pairs])
    count = len(lengths)
    assert margins[: 2 * count : 2] == pytest.approx(np.log(lengths / 0.4))
    assert margins[1 : 2 * count : 2] == pytest.approx(np.log(0.5 / lengths))
    assert margins[2 * count : count * (count + 1)].min() == pytest.approx(np.log(1.2 * lengths.min() / lengths.max()))
    o2, o4 = topology.fixed_pivots[:2]
    given = [places[o2, 0] - 0.1, places[o4, 0] - 0.2, places[o4, 1] - 0.3]
    assert margins[-EQUATION_COUNT:][[0, 2, 3]] == pytest.approx(given)
    # The last margins of a step are those of the workspace.
    motion = trace_nodes(topology, z, 2.0 * np.pi * np.arange(24) / 24)
    moving = motion[:, [*topology.moving_pins, topology.point]]
    last_step = margins[-EQUATION_COUNT - 4 : -EQUATION_COUNT]
    sides = [moving[-1, :, 0].min() + 0.3, 0.2 - moving[-1, :, 0].max(), moving[-1, :, 1].min() + 0.2,
             0.25 - moving[-1, :, 1].max()]  # fmt: skip
    assert last_step == pytest.approx(sides)


def test_a_linkage_that_does_not_close_is_refused() -> None:
    topology = TOPOLOGIES["fourbar"]
    z = np.array([0.0, 0.0, 2.0, 0.0, 2.0, 1.5, 2.5, 0.7, 3.0, 1.0])
    setting = pack_topology(topology)
    setting[STEPS] = 24
    limits, targets = count_margins(setting), np.zeros((1, TARGET_SIZE))
    targets[0, FIRST_NODE], targets[0, ROOT], targets[0, FREE] = topology.point, 1.0, 1.0
    most = count_rows(1, setting)
    for x in (z, np.full(10, math.nan), np.full(10, 1e9)):
        state = np.zeros(1 + limits)
        rows = compute_linkage_rows(
            x, targets, setting, np.ones(limits + 1), state, np.zeros(most), np.zeros((most, 10))
        )  # fmt: skip
        assert rows == -1
