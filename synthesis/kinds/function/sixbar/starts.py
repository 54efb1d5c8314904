"""Random sixbars near a function: all nodes but those of the last dyad are drawn, and these follow by linear equations.

A chain of dyads ends with a dyad from a moving pin C to the output's pivot O. With C(u) known, the output's arm w at
output 0 and the length of the other link are the least-squares solution of

    |C − O|² = 2 Re((C − O) w̄ e^{−iψ}) + const,        ψ the output,

which is linear in w and const; the output's zero follows afterwards, since the whole linkage may be turned.

A Stephenson II is a fourbar on its input link, whose coupler point E carries the output. As this link sees it,

    E(θ) = O2 + g e^{−iφ} + w e^{i(ψ−φ)},        φ the input,

with g = O2 → O4 and w = O4 → E: linear in O2, g and w if the rotation θ of link 3 relative to the input link is a
random quadratic function of φ. In half of all Stephenson II it turns back.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.linkage.closure import CONSTANT_COUNT, close_linkage, compute_constants
from synthesis.fit.linkage.descent import Fit
from synthesis.fit.linkage.topology import Topology
from synthesis.fit.triad_slant import find_min_slant

SIZE_SPREAD = 0.5
"""Standard deviation of the logarithm of a linkage's size, in cranks."""

MIN_RATE_LOG, MAX_RATE_LOG = -2.5, 1.2
"""Range of the logarithm of the rotation of a Stephenson II's link 3 relative to the input, per rotation of the input.
"""

BEND_SPREAD, BEND_SHARE = 0.4, 0.5
"""Standard deviation of the quadratic coefficient of this rotation, per radian, and share of linkages that have one."""

MIN_ARM, MAX_ARM = 0.05, 20.0
"""Range of the ground and the output of a Stephenson II, in standard deviations of its nodes."""

MAX_STRETCH_COSINE = 0.98
"""Cosine up to which the dyad of a Stephenson II may be stretched, which does not transmit the force."""

MAX_TRIES = 200
"""Maximum number of linkages begun for each that is requested."""

INNER_NODE_COUNT = 5
"""Number of nodes of the fourbar in a Stephenson II, with E; O2 and O4 follow."""

REGULARISATION = 1e-13
"""Share of the trace of normal equations that is added to their diagonal."""

RATIO_EXCESS = 1.2
"""Factor by which the link ratio of a start may exceed its limit."""


def draw_starts(
    topology: Topology, inputs: Real, outputs: Real, max_cosine: float, max_ratio: float, count: int, keep: int,
    seed: int,
) -> list[Fit]:  # fmt: skip
    """Draw linkages of a topology near a function, and return the best, at most ``keep``.

    Parameters
    ----------
    topology : Topology
    inputs, outputs : float, shape (m,)
        Rotations, radians; the input is 0 in the reference position.
    max_cosine, max_ratio : float
        Maximum cosine of the transmission angle, and maximum link ratio.
    count, keep : int
    seed : int
    """
    z, thetas = np.zeros((count, 2 * len(topology.nodes))), np.tile(inputs, (count, 1))
    costs = np.full(count, math.inf)
    draw = _draw_inverted if topology.triad else _draw_chains
    drawn = draw(np.random.default_rng(seed), topology.nodes, inputs, outputs, max_cosine, z, thetas, costs)
    places = z[:drawn, 0::2] + 1j * z[:drawn, 1::2]
    lengths = np.abs(places[:, topology.pairs[:, 0]] - places[:, topology.pairs[:, 1]])
    even = np.flatnonzero(lengths.max(axis=1) < RATIO_EXCESS * max_ratio * lengths.min(axis=1))
    best = even[np.argsort(costs[even], kind="stable")[:keep]]
    return [Fit(topology, z[k].copy(), thetas[k].copy(), float(costs[k])) for k in best]


@njit(**OPTIONS)
def _draw_chains(
    rng: np.random.Generator, nodes: Integers, inputs: Real, outputs: Real, cosine: float, z: Real, _thetas: Real,
    costs: Real,
) -> int:  # fmt: skip
    """Draw chains of dyads into the rows of ``z`` with their costs; return their number."""
    n, m, drawn = len(nodes), len(inputs), 0
    head, pin, pivot = nodes[: n - 1].copy(), nodes[n - 1, 1], nodes[n - 1, 2]
    constants, places, cosines = np.empty((n, CONSTANT_COUNT)), np.empty((n, 2)), np.zeros(n)
    away, x = np.empty(m, np.complex128), np.zeros(2 * n)
    for _ in range(MAX_TRIES * len(z)):
        if drawn == len(z):
            break
        size, angle = math.exp(SIZE_SPREAD * rng.normal()), 2.0 * math.pi * rng.random()
        for k in range(4, 2 * n):
            x[k] = size * rng.normal()
        x[2], x[3] = math.cos(angle), math.sin(angle)
        compute_constants(head, x, constants)
        closes, cosines[:] = True, 0.0
        for k in range(m):
            closes = close_linkage(head, x, constants, inputs[k], places, cosines) and np.abs(cosines).max() <= cosine
            if not closes:
                break
            away[k] = complex(places[pin, 0] - places[pivot, 0], places[pin, 1] - places[pivot, 1])
        if not closes or not close_linkage(head, x, constants, 0.0, places, cosines):
            continue
        there = complex(places[pin, 0] - places[pivot, 0], places[pin, 1] - places[pivot, 1])
        costs[drawn], arm, turned = _close_last_dyad(away, outputs, there, cosine)
        if not costs[drawn] < np.inf:
            continue
        places[n - 1, 0], places[n - 1, 1] = places[pivot, 0] + arm.real, places[pivot, 1] + arm.imag
        for k in range(n):
            place = complex(places[k, 0], places[k, 1]) * turned
            z[drawn, 2 * k], z[drawn, 2 * k + 1] = place.real, place.imag
        drawn += 1
    return drawn


@njit(**OPTIONS)
def _regularise(matrix: Real | Complex) -> None:
    """Make normal equations positive definite, which those of two pairs are not."""
    trace = matrix[0, 0] + matrix[1, 1] + matrix[2, 2]
    for i in range(3):
        matrix[i, i] += REGULARISATION * trace


@njit(**OPTIONS)
def _close_last_dyad(away: Complex, outputs: Real, there: complex, cosine: float) -> tuple[float, complex, complex]:
    """Fit the last dyad to a pin's places relative to the output's pivot.

    Returns half the mean square error (infinite on failure), the output's arm for the pin at ``there``, and the
    rotation of the linkage that brings the output to its zero.
    """
    failed = np.inf, 0j, 0j
    m, row = len(away), np.empty(3)
    matrix, right = np.zeros((3, 3)), np.zeros(3)
    for k in range(m):
        seen = away[k] * complex(math.cos(outputs[k]), -math.sin(outputs[k]))
        row[0], row[1], row[2] = 2.0 * seen.real, 2.0 * seen.imag, 1.0
        for i in range(3):
            right[i] += row[i] * (seen.real * seen.real + seen.imag * seen.imag)
            for j in range(3):
                matrix[i, j] += row[i] * row[j]
    _regularise(matrix)
    solved = np.linalg.solve(matrix, right)
    w = complex(solved[0], solved[1])
    arm, square = abs(w), solved[2] + abs(w) ** 2
    if not (square > 0.0 and arm > 0.0):
        return failed
    sides = 0.0
    for k in range(m):
        seen = away[k] * complex(math.cos(outputs[k]), -math.sin(outputs[k]))
        sides += math.copysign(1.0, (w * seen.conjugate()).imag)
    side, middle, turns = math.copysign(1.0, sides), 0j, np.empty(m, np.complex128)
    for k in range(m + 1):
        pin = away[k] if k < m else there
        r = abs(pin)
        along = (arm * arm + r * r - square) / (2.0 * arm * r)
        # Cosine of the angle between the dyad's links.
        slant = (arm * arm + square - r * r) / (2.0 * arm * math.sqrt(square))
        if not (abs(along) < 1.0 and abs(slant) <= cosine):
            return failed
        direction = pin / r * complex(along, side * math.sqrt(1.0 - along * along))
        if k == m:
            break
        turns[k] = direction * complex(math.cos(outputs[k]), -math.sin(outputs[k]))
        middle += turns[k]
    middle /= abs(middle)
    cost = 0.0
    for k in range(m):
        off = turns[k] * middle.conjugate()
        cost += 0.5 * math.atan2(off.imag, off.real) ** 2 / m
    return cost, arm * direction, middle.conjugate()


@njit(**OPTIONS)
def _draw_inverted(
    rng: np.random.Generator, nodes: Integers, inputs: Real, outputs: Real, cosine: float, z: Real, thetas: Real,
    costs: Real,
) -> int:  # fmt: skip
    """Draw Stephenson II sixbars into the rows of ``z``, with the rotations of link 3 and the costs."""
    n, m, drawn = len(nodes), len(inputs), 0
    head, inner = nodes[:INNER_NODE_COUNT].copy(), 2 * INNER_NODE_COUNT
    constants, places, cosines = np.empty((n, CONSTANT_COUNT)), np.empty((n, 2)), np.zeros(n)
    points, x = np.empty(m, np.complex128), np.zeros(2 * n)
    for _ in range(MAX_TRIES * len(z)):
        if drawn == len(z):
            break
        for k in range(2, inner):
            x[k] = rng.normal()
        rate = math.exp(rng.uniform(MIN_RATE_LOG, MAX_RATE_LOG)) * (1.0 if rng.random() < 0.5 else -1.0)
        bend = BEND_SPREAD * rng.normal() if rng.random() < BEND_SHARE else 0.0
        theta = inputs * (rate + bend * inputs)
        compute_constants(head, x, constants)
        closes, cosines[:] = True, 0.0
        for k in range(m):
            closes = close_linkage(head, x, constants, theta[k], places, cosines)
            closes = closes and np.abs(cosines).max() <= MAX_STRETCH_COSINE
            if not closes:
                break
            points[k] = complex(places[INNER_NODE_COUNT - 1, 0], places[INNER_NODE_COUNT - 1, 1])
        if not closes:
            continue
        pivot, ground, arm = _carry_output(points, inputs, outputs)
        if not (MIN_ARM < abs(ground) < MAX_ARM and MIN_ARM < abs(arm) < MAX_ARM):
            continue
        other, cost = pivot + ground, 0.0
        x[inner], x[inner + 1], x[inner + 2], x[inner + 3] = pivot.real, pivot.imag, other.real, other.imag
        for k in range(m):
            back = complex(math.cos(inputs[k]), -math.sin(inputs[k]))
            turned = arm * complex(math.cos(outputs[k]), math.sin(outputs[k]))
            cost += 0.5 * abs(points[k] - pivot - back * (ground + turned)) ** 2 / m
        costs[drawn] = cost / abs(arm) ** 2
        if not _transmits(nodes, x, theta, inputs, cosine):
            continue
        thetas[drawn] = theta
        # Turned so that the output is at its zero.
        turned = arm.conjugate() / abs(arm)
        for k in range(n):
            place = complex(x[2 * k], x[2 * k + 1]) * turned
            z[drawn, 2 * k], z[drawn, 2 * k + 1] = place.real, place.imag
        drawn += 1
    return drawn


@njit(**OPTIONS)
def _transmits(nodes: Integers, x: Real, theta: Real, inputs: Real, cosine: float) -> bool:
    """Return whether a Stephenson II transmits well at all inputs, on one side of its toggles."""
    n, hand = len(nodes), 0.0
    constants, places, cosines = np.empty((n, CONSTANT_COUNT)), np.empty((n, 2)), np.zeros(n)
    compute_constants(nodes, x, constants)
    for k in range(len(inputs)):
        if not close_linkage(nodes, x, constants, theta[k], places, cosines):
            return False
        a, b, c, d, e, o2, o4 = (
            complex(places[0, 0], places[0, 1]), complex(places[1, 0], places[1, 1]),
            complex(places[2, 0], places[2, 1]), complex(places[3, 0], places[3, 1]),
            complex(places[4, 0], places[4, 1]), complex(places[5, 0], places[5, 1]),
            complex(places[6, 0], places[6, 1]),
        )  # fmt: skip
        # The input link sees the ground turned back.
        o4 = o2 + (o4 - o2) * complex(math.cos(inputs[k]), -math.sin(inputs[k]))
        slant, sine, _ = find_min_slant(e, o4, a, b, c, d)
        if not (abs(slant) <= cosine and hand * sine >= 0.0):
            return False
        hand = sine
    return True


@njit(**OPTIONS)
def _carry_output(points: Complex, inputs: Real, outputs: Real) -> tuple[complex, complex, complex]:
    """Return O2, g and w of a Stephenson II from places of E as the input link sees them."""
    matrix, right = np.zeros((3, 3), np.complex128), np.zeros(3, np.complex128)
    row = np.empty(3, np.complex128)
    for k in range(len(points)):
        row[0], row[1] = 1.0, complex(math.cos(inputs[k]), -math.sin(inputs[k]))
        row[2] = row[1] * complex(math.cos(outputs[k]), math.sin(outputs[k]))
        for i in range(3):
            right[i] += row[i].conjugate() * points[k]
            for j in range(3):
                matrix[i, j] += row[i].conjugate() * row[j]
    _regularise(matrix)
    solved = np.linalg.solve(matrix, right)
    return solved[0], solved[1], solved[2]
