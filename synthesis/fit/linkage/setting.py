"""Packed settings of fits: a topology's table and the limits on its linkages, as one array for the compiled kernels.

Lengths and places are in the unit of the task. An absent limit is infinite, an absent minimum length 0.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from kinematics.arrays import Integers, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.linkage.topology import Topology
from synthesis.numerics.array_layout import ArrayLayout

SETTING = ArrayLayout(
    node_count=1,
    pair_count=1,
    pivot_count=1,
    pin_count=1,
    arm_count=1,
    point=1,
    family=1,
    grashof=1,
    first_fourbar=4,
    triad=6,
    full_turn=1,
    steps=1,
    order=1,
    back=1,
    width=1,
    cosine=1,
    ratio=1,
    links=2,
    reach=1,
    input_box=4,
    pivot_box=4,
    given_pivots=4,
    moving_box=4,
    room=4,
)
"""Layout of a setting before the topology's table."""

NODE_COUNT, PAIR_COUNT = SETTING.index("node_count"), SETTING.index("pair_count")
"""Numbers of nodes, and of pairs of pins of one link."""

PIVOT_COUNT, PIN_COUNT = SETTING.index("pivot_count"), SETTING.index("pin_count")
"""Numbers of fixed pivots and of moving pins."""

ARM_COUNT = SETTING.index("arm_count")
"""Number of the pins of the link that has the traced point."""

POINT_NODE = SETTING.index("point")
"""Node of the traced point."""

FAMILY = SETTING.index("family")
"""Which link of the first fourbar must be its shortest, in the order ground, input, coupler, output; −1 for any."""

GRASHOF = SETTING.index("grashof")
"""1 if the first fourbar must satisfy the Grashof condition with that shortest link, −1 if it must not, else 0."""

FIRST_FOURBAR = SETTING.slice("first_fourbar")
"""Pairs of the links of the first fourbar."""

TRIAD = SETTING.slice("triad")
"""Nodes of the triad that transmits the force; negative if dyads do."""

FULL_TURN = SETTING.index("full_turn")
"""Whether the input turns through; otherwise a linkage moves in a range of inputs."""

STEPS = SETTING.index("steps")
"""Number of equal steps of the input at which the motion is constrained."""

ORDER = SETTING.index("order")
"""Whether the inputs of the slots follow one another in one direction; their steps are unknowns then."""

BACK = SETTING.index("back")
"""Weight of the way back, which all steps share: squared distances of the curve from the polyline of the points."""

WIDTH = SETTING.index("width")
"""δ of a robust, order-free fit, see :mod:`synthesis.fit.linkage.residuals`; 0 for squared distances in order."""

COSINE = SETTING.index("cosine")
"""Cosine of the minimum transmission angle."""

RATIO, LINKS = SETTING.index("ratio"), SETTING.slice("links")
"""Maximum link ratio, and minimum and maximum distance of two pins of a link."""

REACH = SETTING.index("reach")
"""Maximum distance of the traced point from the pins of its link."""

INPUT_BOX, PIVOT_BOX = SETTING.slice("input_box"), SETTING.slice("pivot_box")
"""Boxes of the input's fixed pivot and of all others, each as minimum x, maximum x, minimum y, maximum y."""

GIVEN_PIVOTS = SETTING.slice("given_pivots")
"""Given coordinates of the first two fixed pivots; NaN if free."""

MOVING_BOX = SETTING.slice("moving_box")
"""Box of all moving pins at the first point."""

WORKSPACE_BOX = SETTING.slice("room")
"""Box of all moving joints, with the traced point, over the motion."""

TABLE_START = SETTING.size
"""Index of the topology's table: nodes, transmitting dyads, pairs, fixed pivots, moving pins, arms."""


def pack_topology(topology: Topology) -> Real:
    """Pack a topology with no limits on its linkages."""
    out = np.full(SETTING.size, math.inf)
    pairs = topology.pairs
    out[NODE_COUNT], out[PAIR_COUNT] = len(topology.nodes), len(pairs)
    out[PIVOT_COUNT], out[PIN_COUNT] = len(topology.fixed_pivots), len(topology.moving_pins)
    out[ARM_COUNT], out[ORDER], out[GRASHOF] = len(topology.arms), 0.0, 0.0
    out[POINT_NODE], out[FAMILY], out[FIRST_FOURBAR] = topology.point, -1.0, topology.families or -1.0
    out[TRIAD], out[FULL_TURN], out[STEPS], out[BACK], out[WIDTH] = topology.triad or -1.0, 1.0, 0.0, 0.0, 0.0
    out[LINKS], out[GIVEN_PIVOTS] = (0.0, math.inf), math.nan
    for box in (INPUT_BOX, PIVOT_BOX, MOVING_BOX, WORKSPACE_BOX):
        out[box] = -math.inf, math.inf, -math.inf, math.inf
    table = [topology.nodes, topology.transmitting, pairs, topology.fixed_pivots, topology.moving_pins, topology.arms]
    return np.concatenate([out, *(np.asarray(part, np.float64).ravel() for part in table)])


pack_unlimited = cache(pack_topology)
"""Pack a topology with no limits, once; do not change the result."""


@njit(**OPTIONS)
def _unpack_integers(setting: Real, first: int, out: Integers) -> int:
    """Fill a table from consecutive entries of a setting; return the index after them."""
    flat = out.ravel()
    for k in range(flat.size):
        flat[k] = int(setting[first + k])
    return first + flat.size


@njit(**OPTIONS)
def unpack_table(setting: Real) -> tuple[Integers, Integers, Integers, Integers, Integers, Integers]:
    """Return nodes (n, 4), transmitting dyads (n,), pairs (p, 2), fixed pivots, moving pins and arms (a, 2)."""
    nodes = np.empty((int(setting[NODE_COUNT]), 4), np.int64)
    transmitting = np.empty(len(nodes), np.int64)
    pairs = np.empty((int(setting[PAIR_COUNT]), 2), np.int64)
    pivots, pins = np.empty(int(setting[PIVOT_COUNT]), np.int64), np.empty(int(setting[PIN_COUNT]), np.int64)
    first = _unpack_integers(setting, TABLE_START, nodes)
    first = _unpack_integers(setting, first, transmitting)
    first = _unpack_integers(setting, first, pairs)
    first = _unpack_integers(setting, first, pivots)
    arms = np.empty((int(setting[ARM_COUNT]), 2), np.int64)
    first = _unpack_integers(setting, first, pins)
    _unpack_integers(setting, first, arms)
    return nodes, transmitting, pairs, pivots, pins, arms
