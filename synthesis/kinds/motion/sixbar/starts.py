"""Random linkages that close at one input for each target of a task, as starts of fits.

The nodes are normally distributed about the targets. Most random linkages do not close over a whole rotation of the
input: they are drawn until some do, and the one nearest to the targets is taken.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.linkage.closure import CONSTANT_COUNT, close_linkage, compute_constants
from synthesis.fit.linkage.descent import Fit, FitTask
from synthesis.fit.linkage.margins import count_margins
from synthesis.fit.linkage.residuals import DIRECTION, KIND, SLOT, X, Y, compute_linkage_rows, count_rows
from synthesis.fit.linkage.setting import unpack_table
from synthesis.fit.linkage.topology import VIEW, Topology
from synthesis.numerics.levenberg import compute_half_square

PICK_COUNT, MAX_DRAWS = 3, 4000
"""Number of random linkages that close, of which the one with the lowest cost is a start; and the maximum number drawn
for it."""

MIN_SPREAD, MAX_SPREAD = 0.35, 1.35
"""Range of the standard deviation of random nodes around the targets, task sizes."""

MIN_TURN, MAX_TURN = math.radians(30.0), math.radians(300.0)
"""Range of the input's rotation in random linkages."""

MIN_SHARE = 0.2
"""Least rotation between two targets, relative to the greatest."""

TEST_COUNT = 7
"""Number of inputs at which a random linkage is tested before its residuals are computed, which takes longer."""


def draw_starts(topology: Topology, task: FitTask, count: int, rng: np.random.Generator) -> list[Fit]:
    """Return at most ``count`` random linkages of a topology that close over the targets, each the best of a few."""
    targets, setting = task.pack_topology(topology)
    slots = int(targets[-1, SLOT]) + 1
    z, inputs = np.empty((count, 2 * len(topology.nodes) + slots - 1)), np.empty((count, slots))
    heading = next(float(target[X]) for target in targets if target[KIND] == DIRECTION)
    source, pointer = topology.get_source(topology.point), topology.get_source(topology.heading)
    drawn = _draw_each(rng, targets, setting, source, pointer, heading, z, inputs)
    return [Fit(topology, z[k].copy(), inputs[k].copy()) for k in range(drawn)]


@njit(**OPTIONS)
def _draw_linkage(
    rng: np.random.Generator, setting: Real, centre: complex, first: complex, heading: float, source: int,
    pointer: int, z: Real, inputs: Real,
) -> bool:  # fmt: skip
    """Draw a linkage in the first pose and a rotation of its input; return whether it closes at some inputs."""
    nodes = unpack_table(setting)[0]
    n, slots = len(nodes), len(inputs)
    # Logarithmically uniform: small and large linkages are drawn alike.
    spread = MIN_SPREAD * (MAX_SPREAD / MIN_SPREAD) ** rng.random()
    for k in range(n):
        if nodes[k, 0] != VIEW:
            z[2 * k], z[2 * k + 1] = centre.real + spread * rng.normal(), centre.imag + spread * rng.normal()
    z[2 * source], z[2 * source + 1] = first.real, first.imag
    z[2 * pointer], z[2 * pointer + 1] = first.real + math.cos(heading), first.imag + math.sin(heading)
    inputs[0] = 0.0
    for k in range(1, slots):
        inputs[k] = inputs[k - 1] + MIN_SHARE + (1.0 - MIN_SHARE) * rng.random()
    way = 1.0 if rng.random() < 0.5 else -1.0
    inputs *= way * (MIN_TURN + (MAX_TURN - MIN_TURN) * rng.random()) / inputs[slots - 1]
    for k in range(1, slots):
        z[2 * n + k - 1] = math.log(abs(inputs[k] - inputs[k - 1]))
    constants, places, cosines = np.empty((n, CONSTANT_COUNT)), np.empty((n, 2)), np.zeros(n)
    compute_constants(nodes, z, constants)
    for k in range(TEST_COUNT):
        if not close_linkage(nodes, z, constants, inputs[slots - 1] * k / (TEST_COUNT - 1), places, cosines):
            return False
    return True


@njit(**OPTIONS)
def _draw_each(
    rng: np.random.Generator, targets: Real, setting: Real, source: int, pointer: int, heading: float, z: Real,
    inputs: Real,
) -> int:  # fmt: skip
    """Draw starts into the rows of ``z`` and ``inputs``; return their number."""
    slots, unknowns, limits = inputs.shape[1], z.shape[1], count_margins(setting)
    most = count_rows(len(targets), setting)
    x, at, state = np.zeros(unknowns), np.empty(slots), np.zeros(slots + limits)
    residuals, jacobian, multipliers = np.zeros(most), np.zeros((most, unknowns)), np.zeros(limits + 1)
    multipliers[limits] = 1.0
    centre = complex(targets[::2, X].mean(), targets[::2, Y].mean())
    first = complex(targets[0, X], targets[0, Y])
    drawn = 0
    for _ in range(len(z)):
        least, closed = np.inf, 0
        for _draw in range(MAX_DRAWS):
            if not _draw_linkage(rng, setting, centre, first, heading, source, pointer, x, at):
                continue
            state[:slots] = at
            m = compute_linkage_rows(x, targets, setting, multipliers, state, residuals, jacobian)
            if m < 0:
                continue
            closed += 1
            cost = compute_half_square(residuals, m)
            if cost < least:
                least, z[drawn], inputs[drawn] = cost, x, at
            if closed == PICK_COUNT:
                break
        if least < np.inf:
            drawn += 1
    return drawn
