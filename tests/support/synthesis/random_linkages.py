"""Random linkages of the engine's topologies, and their motion."""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from synthesis.fit.linkage.closure import CONSTANT_COUNT, close_linkage, compute_constants
from synthesis.fit.linkage.population import Population
from synthesis.fit.linkage.topology import Topology, list_chains, list_forms

SIXBAR_FORMS = {kind: list_forms(kind) for kind in ("watt_1", "stephenson_1", "stephenson_2", "stephenson_3")}
"""Topologies of the sixbars that trace or guide, by type."""

EIGHTBARS = list_chains(3)
TOPOLOGIES = {f"{kind}-{n}": form for kind, forms in SIXBAR_FORMS.items() for n, form in enumerate(forms)}
TOPOLOGIES |= {"fourbar": list_chains(1)[0]} | {f"eightbar-{n}": EIGHTBARS[n] for n in (0, 29, 61, 87)}
"""Topologies by a name for test cases."""


def draw_linkage(topology: Topology, seed: int = 0) -> Real:
    """Return the unknowns of a random linkage, about one unit large."""
    z = Population(topology, 32, 20.0, -1, seed).z[0]
    return z / np.abs(z).max()


def trace_nodes(topology: Topology, z: Real, inputs: Real) -> Real:
    """Return all nodes at inputs, shape (inputs, nodes, 2); all inputs must close."""
    n = len(topology.nodes)
    constants, cosines, places = np.empty((n, CONSTANT_COUNT)), np.zeros(n), np.empty((len(inputs), n, 2))
    compute_constants(topology.nodes, z, constants)
    for k, theta in enumerate(inputs):
        assert close_linkage(topology.nodes, z, constants, float(theta), places[k], cosines)
    return places


TURN = np.linspace(0.0, 2.0 * math.pi, 37)
