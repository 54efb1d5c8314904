"""The closure of linkages: links stay rigid, derivatives agree with differences."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synthesis.fit.linkage.closure import (
    CONSTANT_COUNT,
    close_linkage,
    compute_constants,
    differentiate_cosine,
    differentiate_input,
    differentiate_nodes,
    move_reference,
)
from synthesis.fit.linkage.topology import DYAD, VIEW, build_topology
from tests.support.synthesis.random_linkages import TOPOLOGIES, TURN, draw_linkage, trace_nodes

STEP = 1e-6


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_links_are_rigid_over_a_turn(name: str) -> None:
    topology = TOPOLOGIES[name]
    z = draw_linkage(topology)
    places = trace_nodes(topology, z, TURN)
    np.testing.assert_allclose(places[0].ravel(), z, atol=1e-12)
    np.testing.assert_allclose(places[-1], places[0], atol=1e-9)
    for a, b in topology.pairs:
        lengths = np.hypot(*(places[:, a] - places[:, b]).T)
        np.testing.assert_allclose(lengths, lengths[0], rtol=1e-9)
    arm = (places[:, 1] - places[:, 0]) @ [1.0, 1.0j]
    np.testing.assert_allclose(arm, arm[0] * np.exp(1j * TURN), atol=1e-12)
    if not topology.triad:
        np.testing.assert_array_equal(np.ptp(places[:, topology.fixed_pivots], axis=0), 0.0)


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_dyads_stay_on_their_side(name: str) -> None:
    topology = TOPOLOGIES[name]
    points = trace_nodes(topology, draw_linkage(topology, 1), TURN) @ [1.0, 1.0j]
    for k, (kind, i, j, _) in enumerate(topology.nodes):
        if kind == DYAD:
            sides = ((points[:, j] - points[:, i]).conj() * (points[:, k] - points[:, i])).imag
            assert np.all(sides * sides[0] > 0.0)


@pytest.mark.parametrize("name", [name for name in TOPOLOGIES if "stephenson_2" in name])
def test_views_show_the_ground_at_rest(name: str) -> None:
    topology = TOPOLOGIES[name]
    places = trace_nodes(topology, draw_linkage(topology), TURN) @ [1.0, 1.0j]
    seen = {node[1]: k for k, node in enumerate(topology.nodes) if node[0] == VIEW}
    o2, o4 = topology.fixed_pivots
    a = topology.links["link_3"][0]
    e = topology.links["output"][1]
    # The input, from O2 to A, and the output, from O4 to E, turn about pivots at rest.
    for pivot, pin in ((o2, a), (o4, e)):
        reach = np.abs(places[:, seen[pin]] - places[0, pivot])
        np.testing.assert_allclose(reach, reach[0], rtol=1e-9)


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_derivatives_agree_with_differences(name: str) -> None:
    topology, theta = TOPOLOGIES[name], 0.7
    nodes, z = topology.nodes, draw_linkage(topology)
    n = len(nodes)
    constants, places, cosines = np.empty((n, CONSTANT_COUNT)), np.empty((n, 2)), np.zeros(n)

    def move(change: np.ndarray, turn: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        compute_constants(nodes, z + change, constants)
        assert close_linkage(nodes, z + change, constants, theta + turn, places, cosines)
        return places.copy(), cosines.copy()

    differences = [
        [(more - less) / (2.0 * STEP) for more, less in zip(move(0.0 * z, STEP), move(0.0 * z, -STEP), strict=True)]
    ]
    for one in STEP * np.eye(2 * n):
        differences.append(
            [(more - less) / (2.0 * STEP) for more, less in zip(move(one), move(-one), strict=True)]
        )  # fmt: skip
    move(0.0 * z)
    slopes, rates, row = np.zeros((n, 2, 1 + 2 * n)), np.empty((n, 2)), np.empty(1 + 2 * n)
    differentiate_nodes(nodes, z, constants, theta, places, slopes)
    differentiate_input(nodes, z, constants, places, rates)
    np.testing.assert_allclose(rates, slopes[:, :, 0], rtol=1e-12, atol=1e-12)
    for column, (by_places, _) in enumerate(differences):
        np.testing.assert_allclose(slopes[:, :, column], by_places, atol=1e-6 * max(1.0, np.abs(slopes).max()))
    for k in np.flatnonzero(nodes[:, 0] == DYAD):
        differentiate_cosine(nodes, z, constants, k, places, slopes, cosines[k], row)
        np.testing.assert_allclose(row, [by[k] for _, by in differences], atol=1e-5 * max(1.0, np.abs(row).max()))


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_another_reference_position_describes_the_same_linkage(name: str) -> None:
    topology = TOPOLOGIES[name]
    z = draw_linkage(topology)
    moved = np.empty_like(z)
    assert move_reference(topology.nodes, z, 1.1, moved)
    np.testing.assert_allclose(
        trace_nodes(topology, moved, TURN)[:, topology.point],
        trace_nodes(topology, z, TURN + 1.1)[:, topology.point],
        atol=1e-9,
    )


def test_a_linkage_that_cannot_close_is_refused() -> None:
    fourbar = build_topology(((1, 0),))
    n = len(fourbar.nodes)
    places, cosines, constants = np.empty((n, 2)), np.zeros(n), np.empty((n, CONSTANT_COUNT))
    # O2, A, O4, B, P: a triple-rocker, whose crank of length 2 cannot reach the far side of the ground of length 2.
    z = np.array([0.0, 0.0, 2.0, 0.0, 2.0, 1.5, 2.5, 0.7, 3.0, 1.0])
    compute_constants(fourbar.nodes, z, constants)
    assert close_linkage(fourbar.nodes, z, constants, 0.0, places, cosines)
    assert not close_linkage(fourbar.nodes, z, constants, math.pi, places, cosines)
    # Coinciding pins of a dyad give NaN, which counts as open.
    z[4:6] = z[2:4]
    compute_constants(fourbar.nodes, z, constants)
    assert not close_linkage(fourbar.nodes, z, constants, 0.0, places, cosines)
    assert not move_reference(fourbar.nodes, z, 0.0, np.empty_like(z))
