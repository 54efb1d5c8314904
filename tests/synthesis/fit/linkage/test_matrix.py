"""Every topology with every kind of targets under every constraint: planted linkages are found again within the limits.

A planted linkage satisfies each limit with little to spare, its perturbed copy mostly does not. What the fit returns is
measured on the motion of its nodes, not by the margins of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import combinations
from typing import NamedTuple

import numpy as np
import pytest

from kinematics.arrays import Integers, Real
from synthesis.fit.linkage.descent import Fit, FitTask, build_point_targets, descend_softly, fit_constrained
from synthesis.fit.linkage.residuals import (
    DIRECTION,
    FIRST_NODE,
    FREE,
    KIND,
    ROOT,
    SECOND_NODE,
    SLOT,
    TARGET_SIZE,
    TURN,
    X,
)
from synthesis.fit.linkage.setting import (
    COSINE,
    FAMILY,
    GIVEN_PIVOTS,
    INPUT_BOX,
    LINKS,
    MOVING_BOX,
    PIVOT_BOX,
    RATIO,
    WORKSPACE_BOX,
    pack_topology,
)
from synthesis.fit.linkage.topology import DYAD, Topology
from tests.support.synthesis.random_linkages import TOPOLOGIES, draw_linkage, trace_nodes

INPUTS = np.linspace(0.0, 2.0 * math.pi, 14, endpoint=False)
TURNED = np.linspace(0.0, 2.0 * math.pi, 60, endpoint=False)
SLACK, PERTURBATION, MIN_ANGLE = 0.02, 0.01, 20.0
"""Share of the size by which limits are wider than the planted linkage; that of perturbations; the angle of draws."""


class Planted(NamedTuple):
    """A planted linkage: its nodes at the targets and over a turn, and the lengths of its links."""

    topology: Topology
    z: Real
    at_targets: Real
    over_turn: Real

    @property
    def pins(self) -> Integers:
        return np.array([*self.topology.moving_pins, self.topology.point])


def plant(name: str) -> Planted:
    topology = TOPOLOGIES[name]
    z = draw_linkage(topology)
    return Planted(topology, z, trace_nodes(topology, z, INPUTS), trace_nodes(topology, z, TURNED))


def measure_lengths(topology: Topology, places: Real) -> Real:
    """Distances of all pairs of pins of one link in one position."""
    return np.array([np.hypot(*(places[a] - places[b])) for a, b in topology.pairs])


def measure_cosines(topology: Topology, motion: Real) -> Real:
    """Absolute cosines of the angles at all dyads by their arms, over a motion."""
    found = []
    for k, (kind, i, j, _) in enumerate(topology.nodes):
        if kind == DYAD:
            one, other = motion[:, k] - motion[:, i], motion[:, k] - motion[:, j]
            found.append((one * other).sum(axis=1) / np.hypot(*one.T) / np.hypot(*other.T))
    return np.abs(found)


def surround(places: Real) -> Real:
    """A box around places with little to spare: minimum x, maximum x, minimum y, maximum y."""
    low, high = places.min(axis=0) - SLACK, places.max(axis=0) + SLACK
    return np.array([low[0], high[0], low[1], high[1]])


def is_inside(places: Real, box: Real) -> bool:
    low, high = box[[0, 2]], box[[1, 3]]
    return bool(np.all(places >= low - 1e-3) and np.all(places <= high + 1e-3))


def limit_transmission(setting: Real, _planted: Planted) -> Callable[[Real], bool]:
    setting[COSINE] = limit = math.cos(math.radians(MIN_ANGLE - 2.0))
    triad = _planted.topology.triad
    return lambda z: bool(triad) or measure_cosines(_planted.topology, trace(_planted, z)).max() < limit + 5e-3


def limit_ratio(setting: Real, planted: Planted) -> Callable[[Real], bool]:
    lengths = measure_lengths(planted.topology, planted.at_targets[0])
    setting[RATIO] = limit = lengths.max() / lengths.min() * (1.0 + SLACK)

    def holds(z: Real) -> bool:
        found = measure_lengths(planted.topology, trace(planted, z)[0])
        return bool(found.max() / found.min() < limit * 1.002)

    return holds


def limit_lengths(setting: Real, planted: Planted) -> Callable[[Real], bool]:
    lengths = measure_lengths(planted.topology, planted.at_targets[0])
    low, high = lengths.min() * (1.0 - SLACK), lengths.max() * (1.0 + SLACK)
    setting[LINKS] = low, high

    def holds(z: Real) -> bool:
        found = measure_lengths(planted.topology, trace(planted, z)[0])
        return bool(found.min() > low * 0.998 and found.max() < high * 1.002)

    return holds


def limit_class(setting: Real, planted: Planted) -> Callable[[Real], bool]:
    families = planted.topology.families
    if not families:
        # A Stephenson II has no such fourbar; problems refuse the limit with a sentence.
        return lambda _z: True
    lengths = measure_lengths(planted.topology, planted.at_targets[0])[list(families)]
    setting[FAMILY] = shortest = int(np.argmin(lengths))
    return lambda z: int(np.argmin(measure_lengths(planted.topology, trace(planted, z)[0])[list(families)])) == shortest


def limit_pivots(setting: Real, planted: Planted) -> Callable[[Real], bool]:
    pivots = list(planted.topology.fixed_pivots)
    boxes = surround(planted.at_targets[0, pivots[:1]]), surround(planted.at_targets[0, pivots[1:]])
    setting[INPUT_BOX], setting[PIVOT_BOX] = boxes
    return lambda z: (
        is_inside(trace(planted, z)[0, pivots[:1]], boxes[0]) and is_inside(trace(planted, z)[0, pivots[1:]], boxes[1])
    )


def give_pivots(setting: Real, planted: Planted) -> Callable[[Real], bool]:
    pivots = list(planted.topology.fixed_pivots[:2])
    given = planted.at_targets[0, pivots]
    setting[GIVEN_PIVOTS] = given.ravel()
    return lambda z: bool(np.abs(trace(planted, z)[0, pivots] - given).max() < 1e-3)


def limit_moving_pins(setting: Real, planted: Planted) -> Callable[[Real], bool]:
    # The first target's input is nearly that of the reference position.
    pins = list(planted.topology.moving_pins)
    setting[MOVING_BOX] = box = surround(planted.at_targets[0, pins])
    return lambda z: is_inside(trace(planted, z)[0, pins], box + 0.05 * np.array([-1.0, 1.0, -1.0, 1.0]))


def limit_workspace(setting: Real, planted: Planted) -> Callable[[Real], bool]:
    setting[WORKSPACE_BOX] = box = surround(planted.over_turn[:, planted.pins].reshape(-1, 2))
    grown = box + 0.01 * np.array([-1.0, 1.0, -1.0, 1.0])
    return lambda z: is_inside(trace(planted, z)[:, planted.pins].reshape(-1, 2), grown)


def trace(planted: Planted, z: Real) -> Real:
    return trace_nodes(planted.topology, z, TURNED)


CONSTRAINTS = {
    "none": lambda _setting, _planted: lambda _z: True,
    "transmission": limit_transmission,
    "ratio": limit_ratio,
    "lengths": limit_lengths,
    "class": limit_class,
    "pivots": limit_pivots,
    "given pivots": give_pivots,
    "moving pins": limit_moving_pins,
    "workspace": limit_workspace,
}


def target_places(planted: Planted) -> Real:
    return build_point_targets(
        planted.at_targets[:, planted.topology.point] @ np.array([1.0, 1.0j]), np.ones(len(INPUTS))
    )


def target_places_at_inputs(planted: Planted) -> Real:
    targets = target_places(planted)
    targets[:, FREE] = 0.0
    return targets


def find_arm(planted: Planted) -> tuple[int, int]:
    """The traced point and a pin of its link, as the ground sees them, whose direction is that of the body."""
    topology = planted.topology
    name = next(name for node, name in topology.pin_names.items() if node in topology.links[topology.body])
    return topology.point, topology.joints[name]


def target_poses(planted: Planted) -> Real:
    """Places and rotations of the body, two targets of one free input each."""
    places = target_places(planted)
    point, pin = find_arm(planted)
    arms = (planted.at_targets[:, pin] - planted.at_targets[:, point]) @ np.array([1.0, 1.0j])
    targets = np.zeros((2 * len(INPUTS), TARGET_SIZE))
    targets[::2] = places
    targets[1::2, KIND], targets[1::2, FIRST_NODE], targets[1::2, SECOND_NODE] = TURN, point, pin
    targets[1::2, X], targets[1::2, ROOT], targets[1::2, FREE] = np.unwrap(np.angle(arms / arms[0])), 1.0, 1.0
    targets[:, SLOT] = np.repeat(np.arange(len(INPUTS)), 2)
    return targets


def target_directions(planted: Planted) -> Real:
    """Directions of the output at given inputs."""
    start, end = planted.topology.get_direction("output")
    arms = (planted.at_targets[:, end] - planted.at_targets[:, start]) @ np.array([1.0, 1.0j])
    targets = np.zeros((len(INPUTS), TARGET_SIZE))
    targets[:, KIND], targets[:, FIRST_NODE], targets[:, SECOND_NODE] = DIRECTION, start, end
    targets[:, X], targets[:, ROOT], targets[:, SLOT] = np.unwrap(np.angle(arms)), 1.0, np.arange(len(INPUTS))
    return targets


TARGETS = {
    "places": target_places,
    "places at inputs": target_places_at_inputs,
    "poses": target_poses,
    "directions": target_directions,
}


def fit_again(planted: Planted, build_targets: Callable[[Planted], Real], setting: Real) -> Fit:
    """Fit a perturbed copy of the planted linkage to its targets under the limits."""
    rng = np.random.default_rng(0)
    task = FitTask(build_targets(planted), lambda _topology: setting, steps=24)
    copies = [
        Fit(planted.topology, planted.z + PERTURBATION * share * rng.normal(size=planted.z.size), INPUTS.copy())
        for share in (1.0, 0.5, 0.3, 0.2, 0.1, 0.03, 0.01)
    ]
    begun = [fit for fit in descend_softly(copies, task, 60) if math.isfinite(fit.cost)]
    return min(fit_constrained(begun, task), key=lambda fit: fit.cost)


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_a_planted_linkage_is_found_again_under_every_constraint(name: str) -> None:
    planted, failed = plant(name), []
    for kind, build_targets in TARGETS.items():
        # A coupler point turns no output, and views of a Stephenson II have arms instead of directions.
        if kind == "directions" and (planted.topology.triad or "output" not in planted.topology.links):
            continue
        for constraint, limit in CONSTRAINTS.items():
            setting = pack_topology(planted.topology)
            holds = limit(setting, planted)
            fit = fit_again(planted, build_targets, setting)
            if not (fit.cost < 1e-10 and holds(fit.x[: planted.z.size])):
                failed.append((kind, constraint, fit.cost))
    assert not failed


def test_every_pair_of_constraints_can_be_kept_together() -> None:
    planted, failed = plant("watt_1-0"), []
    for one, other in combinations(CONSTRAINTS, 2):
        setting = pack_topology(planted.topology)
        held = [CONSTRAINTS[name](setting, planted) for name in (one, other)]
        fit = fit_again(planted, target_poses, setting)
        if not (fit.cost < 1e-10 and all(holds(fit.x[: planted.z.size]) for holds in held)):
            failed.append((one, other, fit.cost))
    assert not failed
