"""Random linkages: they turn through, transmit well, and belong to the requested class."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synthesis.fit.linkage.population import SWEEP_STEP_COUNT, Population
from synthesis.fit.linkage.topology import DYAD
from tests.support.synthesis.random_linkages import TOPOLOGIES, trace_nodes

COUNT, MIN_ANGLE = 64, 25.0


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_linkages_turn_through_and_transmit_well(name: str) -> None:
    topology = TOPOLOGIES[name]
    drawn = Population(topology, COUNT, MIN_ANGLE, -1, 3)
    # Few inversions turn over at no input; chains of dyads are completed almost always.
    assert len(drawn.z) >= (0.02 if topology.triad else 0.9) * COUNT
    inputs = 2.0 * math.pi * np.arange(SWEEP_STEP_COUNT) / SWEEP_STEP_COUNT
    for z, curve in zip(drawn.z[:16], drawn.curves[:16], strict=True):
        places = trace_nodes(topology, z, inputs) @ [1.0, 1.0j]
        np.testing.assert_allclose(places[:, topology.point], curve, atol=1e-9 * np.abs(places).max())
        for k, (kind, i, j, _) in enumerate(topology.nodes):
            if kind == DYAD and not topology.triad:
                angles = np.angle((places[:, i] - places[:, k]) / (places[:, j] - places[:, k]), deg=True)
                assert np.minimum(np.abs(angles), 180.0 - np.abs(angles)).min() > MIN_ANGLE - 1e-6


@pytest.mark.parametrize("family", [0, 1])
def test_first_fourbar_has_the_requested_shortest_link(family: int) -> None:
    topology = TOPOLOGIES["stephenson_3-0"]
    drawn = Population(topology, COUNT, MIN_ANGLE, family, 0)
    assert len(drawn.z) > COUNT // 2
    for z in drawn.z:
        places = z.reshape(-1, 2)
        links = [np.hypot(*(places[a] - places[b])) for a, b in topology.pairs[list(topology.families)]]
        assert np.argmin(links) == family


def test_a_seed_repeats_its_linkages() -> None:
    topology = TOPOLOGIES["watt_1-2"]
    first, again, other = (Population(topology, COUNT, MIN_ANGLE, -1, seed).z for seed in (5, 5, 6))
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first[:8], other[:8])
