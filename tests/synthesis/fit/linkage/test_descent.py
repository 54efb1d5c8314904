"""Descents of linkages: planted ones are found again, constraints hold, and basin hopping loses nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synthesis.fit.linkage.descent import (
    Fit,
    FitTask,
    build_point_targets,
    descend_softly,
    fit_constrained,
    hop_basins,
    perturb_fit,
)
from synthesis.fit.linkage.setting import COSINE, pack_topology
from synthesis.fit.linkage.topology import DYAD, VIEW, Topology
from tests.support.synthesis.random_linkages import TOPOLOGIES, draw_linkage, trace_nodes

INPUTS = np.linspace(0.0, 2.0 * math.pi, 24, endpoint=False)


def plant_task(topology: Topology) -> tuple[FitTask, Fit]:
    """Return a task whose points a random linkage goes through, and that linkage."""
    z = draw_linkage(topology)
    curve = trace_nodes(topology, z, INPUTS)[:, topology.point] @ [1.0, 1.0j]
    return FitTask(build_point_targets(curve, np.ones(len(curve))), pack_topology), Fit(topology, z, INPUTS.copy())


@pytest.mark.parametrize("name", ["fourbar", "watt_1-0", "stephenson_1-1", "stephenson_2-2", "stephenson_3-0",
                                  "eightbar-61"])  # fmt: skip
def test_a_planted_linkage_is_found_again_from_nearby(name: str) -> None:
    task, planted = plant_task(TOPOLOGIES[name])
    start = perturb_fit(planted, 0.02, np.random.default_rng(0))
    end = descend_softly([start], task, 200, 1e-14)[0]
    assert end.cost < 1e-16
    assert descend_softly([start], task, 0)[0].cost > 1e-7


def test_enforced_transmission_angle_holds_at_every_step() -> None:
    topology = TOPOLOGIES["watt_1-0"]
    task, planted = plant_task(topology)
    limit = math.cos(math.radians(40.0))

    def pack_limited(one: Topology) -> np.ndarray:
        setting = pack_topology(one)
        setting[COSINE] = limit
        return setting

    end = fit_constrained([planted], FitTask(task.targets, pack_limited))[0]
    assert math.isfinite(end.cost)
    places = trace_nodes(topology, end.x, 2.0 * math.pi * np.arange(36) / 36) @ [1.0, 1.0j]
    for k, (kind, i, j, _) in enumerate(topology.nodes):
        if kind == DYAD:
            ratios = (places[:, i] - places[:, k]) / (places[:, j] - places[:, k])
            assert np.abs(np.cos(np.angle(ratios))).max() < limit + 1e-3


def test_hopping_keeps_the_best_and_repeats_for_a_seed() -> None:
    task, planted = plant_task(TOPOLOGIES["stephenson_3-0"])
    pool = descend_softly([perturb_fit(planted, 0.3, np.random.default_rng(k)) for k in range(6)], task, 20)
    before = min(fit.cost for fit in pool)
    ends = [hop_basins(pool, task, 8, 20, np.random.default_rng(1)) for _ in range(2)]
    assert ends[0][0].cost <= before
    np.testing.assert_array_equal(ends[0][0].x, ends[1][0].x)


def test_views_are_not_perturbed() -> None:
    topology = TOPOLOGIES["stephenson_2-0"]
    planted = Fit(topology, draw_linkage(topology), INPUTS)
    moved = perturb_fit(planted, 0.1, np.random.default_rng(0)).x - planted.x
    is_view = topology.nodes[:, 0] == VIEW
    assert not moved.reshape(-1, 2)[is_view].any()
    assert moved.reshape(-1, 2)[~is_view].all()
