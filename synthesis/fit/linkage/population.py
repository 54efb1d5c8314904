"""Random linkages of any topology whose input turns through, drawn node by node.

The crank is the unit. Its full turn is swept while the linkage grows: the lengths of a dyad are drawn after its pins
have moved once around, so that their least and greatest distance show which lengths close it with a sound transmission
angle. If no pair of several closes it, the nodes since the last dyad are drawn again. Almost every linkage begun is
completed; drawing all lengths first and testing afterwards would complete one in thousands.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.linkage.closure import CONSTANT_COUNT, close_linkage, compute_constants
from synthesis.fit.linkage.margins import get_triad_pins
from synthesis.fit.linkage.setting import FAMILY, POINT_NODE, TRIAD, pack_topology, unpack_table
from synthesis.fit.linkage.topology import CRANK, DYAD, FIXED, POINT, VIEW, Topology
from synthesis.fit.triad_slant import find_min_slant

SWEEP_STEP_COUNT = 96
"""Number of equal steps of the input at which a linkage is swept."""

MIN_PIVOT_LOG, MAX_PIVOT_LOG = -1.2, 2.0
"""Range of the logarithm of a fixed pivot's distance from the input's, in cranks."""

MIN_ARM_LOG, MAX_ARM_LOG = -2.0, 0.8
"""Range of the logarithm of a point's distance from the middle of its link, in lengths of the link."""

MIN_LINK_LOG, MAX_LINK_LOG = -1.4, 1.1
"""Range of the logarithm of a dyad's links, in greatest distances of its pins."""

MAX_VIEWER_OFFSET = 0.6
"""Maximum distance of the pivot of a viewing link from the middle of the curve that it must be inside, as a share of
the curve's mean radius."""

LENGTH_TRIAL_COUNT = 12
"""Number of pairs of lengths tried for a dyad."""

MAX_RESTARTS = 12
"""Maximum number of times that a linkage goes back to an earlier node before another one is begun."""

MAX_STRETCH_COSINE = 0.999
"""Cosine up to which a dyad may be stretched if it does not transmit the force: it must close, no more."""


class Population:
    """Random linkages of a topology.

    Attributes
    ----------
    z : float, shape (count, 2n)
        Unknowns, in cranks.
    curves : complex, shape (count, SWEEP_STEP_COUNT)
        Places of the traced point at equal steps of the input from the reference position.
    """

    def __init__(self, topology: Topology, count: int, min_angle: float, family: int, seed: int) -> None:
        """Draw linkages.

        Parameters
        ----------
        topology : Topology
        count : int
            Number of linkages begun; some of them cannot be completed.
        min_angle : float
            Least transmission angle, degrees.
        family : int
            The shortest link of the first fourbar, in the order ground, input, coupler, output; −1 for any.
        seed : int
        """
        setting = pack_topology(topology)
        setting[FAMILY] = family
        z = np.zeros((count, 2 * len(topology.nodes)))
        curves = np.empty((count, SWEEP_STEP_COUNT), np.complex128)
        drawn = _draw_each(np.random.default_rng(seed), setting, math.cos(math.radians(min_angle)), z, curves)
        self.z, self.curves = z[:drawn], curves[:drawn]


@njit(**OPTIONS)
def _draw_lengths(
    rng: np.random.Generator, places: Real, i: int, j: int, cosine: float, family: int, lengths: Real
) -> bool:
    """Draw the lengths of a dyad on nodes i and j that transmit well at all steps; return whether any were found.

    For the first dyad, j is a fixed pivot, and ``family`` its fourbar's shortest link; otherwise it is −1.
    """
    least, greatest = np.inf, 0.0
    for s in range(places.shape[1]):
        square = (places[j, s, 0] - places[i, s, 0]) ** 2 + (places[j, s, 1] - places[i, s, 1]) ** 2
        least, greatest = min(least, square), max(greatest, square)
    for _ in range(LENGTH_TRIAL_COUNT):
        r1 = math.sqrt(greatest) * math.exp(rng.uniform(MIN_LINK_LOG, MAX_LINK_LOG))
        r2 = math.sqrt(greatest) * math.exp(rng.uniform(MIN_LINK_LOG, MAX_LINK_LOG))
        # Law of cosines at the least and the greatest distance of the pins.
        twice, around = 2.0 * r1 * r2, r1 * r1 + r2 * r2
        if around - least > cosine * twice or greatest - around > cosine * twice:
            continue
        if family >= 0:
            ground = math.hypot(places[j, 0, 0] - places[0, 0, 0], places[j, 0, 1] - places[0, 0, 1])
            links = (ground, 1.0, r1, r2)
            if links[family] > min(min(ground, 1.0), min(r1, r2)):
                continue
        lengths[0], lengths[1] = r1, r2
        return True
    return False


@njit(**OPTIONS)
def _place_fixed(rng: np.random.Generator, places: Real, k: int, around: int) -> None:
    """Draw a fixed pivot: about the input's, or inside the curve of node ``around`` unless that is negative."""
    angle = 2.0 * math.pi * rng.random()
    if around < 0:
        x = y = 0.0
        reach = math.exp(rng.uniform(MIN_PIVOT_LOG, MAX_PIVOT_LOG))
    else:
        x, y = places[around, :, 0].mean(), places[around, :, 1].mean()
        radius = np.hypot(places[around, :, 0] - x, places[around, :, 1] - y).mean()
        # The root spreads pivots evenly over the disc.
        reach = MAX_VIEWER_OFFSET * radius * math.sqrt(rng.random())
    places[k, :, 0], places[k, :, 1] = x + reach * math.cos(angle), y + reach * math.sin(angle)


@njit(**OPTIONS)
def _place_on_pair(rng: np.random.Generator, places: Real, i: int, j: int, k: int, r1: float, r2: float) -> None:
    """Place a dyad's pin at all steps, on a random side."""
    side = 1.0 if rng.random() < 0.5 else -1.0
    for s in range(places.shape[1]):
        bx, by = places[j, s, 0] - places[i, s, 0], places[j, s, 1] - places[i, s, 1]
        per = 1.0 / (bx * bx + by * by)
        p = 0.5 * (r1 * r1 - r2 * r2 + bx * bx + by * by) * per
        q = side * math.sqrt(max(r1 * r1 * per - p * p, 0.0))
        places[k, s, 0], places[k, s, 1] = places[i, s, 0] + p * bx - q * by, places[i, s, 1] + p * by + q * bx


@njit(**OPTIONS)
def _place_point(rng: np.random.Generator, places: Real, i: int, j: int, k: int) -> None:
    """Draw a point of the link through i and j, about the link's middle; on the crank, about its pivot."""
    angle, reach = 2.0 * math.pi * rng.random(), math.exp(rng.uniform(MIN_ARM_LOG, MAX_ARM_LOG))
    p, q = (0.0 if i == 0 else 0.5) + reach * math.cos(angle), reach * math.sin(angle)
    for s in range(places.shape[1]):
        bx, by = places[j, s, 0] - places[i, s, 0], places[j, s, 1] - places[i, s, 1]
        places[k, s, 0], places[k, s, 1] = places[i, s, 0] + p * bx - q * by, places[i, s, 1] + p * by + q * bx


@njit(**OPTIONS)
def _draw_nodes(
    rng: np.random.Generator, nodes: Integers, transmitting: Integers, setting: Real, cosine: float, places: Real
) -> bool:
    """Draw a linkage and its motion, shape (n, steps, 2), without its views; return whether it was completed."""
    steps, lengths = places.shape[1], np.empty(2)
    restarts, k = 0, 0
    # The pivot of the viewing link must be inside the curve of the pin that its dyad is joined to.
    viewer = int(setting[TRIAD][1]) if setting[TRIAD][0] >= 0.0 else -1
    while k < len(nodes):
        kind, i, j = nodes[k, 0], nodes[k, 1], nodes[k, 2]
        if kind == FIXED:
            if k == 0:
                places[k] = 0.0
            else:
                inside = viewer >= 0 and nodes[viewer, 2] == k
                _place_fixed(rng, places, k, nodes[viewer, 1] if inside else -1)
        elif kind == CRANK:
            for s in range(steps):
                angle = 2.0 * math.pi * s / steps
                places[k, s, 0], places[k, s, 1] = math.cos(angle), math.sin(angle)
        elif kind == POINT:
            _place_point(rng, places, i, j, k)
        elif kind == DYAD:
            family = int(setting[FAMILY]) if i == 1 else -1
            if not _draw_lengths(
                rng, places, i, j, cosine if transmitting[k] else MAX_STRETCH_COSINE, family, lengths
            ):  # fmt: skip
                restarts += 1
                if restarts > MAX_RESTARTS:
                    return False
                # Draw the nodes that this dyad is joined to again, back to the dyad that they depend on.
                k = max(max(i, j), 2)
                while k > 2 and nodes[k - 1, 0] != DYAD:
                    k -= 1
                continue
            _place_on_pair(rng, places, i, j, k, lengths[0], lengths[1])
        k += 1
    return True


@njit(**OPTIONS)
def _sweep_views(nodes: Integers, setting: Real, cosine: float, z: Real, curve: Complex) -> bool:
    """Sweep a linkage with views; return whether its triad transmits well and never turns over."""
    n, steps = len(nodes), len(curve)
    constants, places, cosines = np.empty((n, CONSTANT_COUNT)), np.empty((n, 2)), np.zeros(n)
    compute_constants(nodes, z, constants)
    point, hand = int(setting[POINT_NODE]), 0.0
    for s in range(steps):
        if not close_linkage(nodes, z, constants, 2.0 * math.pi * s / steps, places, cosines):
            return False
        slant, sine, _ = find_min_slant(*get_triad_pins(setting, places))
        # The negation also refuses NaN.
        if not (abs(slant) <= cosine and hand * sine >= 0.0):
            return False
        hand, curve[s] = sine, complex(places[point, 0], places[point, 1])
    return True


@njit(**OPTIONS)
def _has_one_turn(places: Real, pin: int, pivot: int) -> bool:
    """Return whether the curve of a pin goes around a pivot once, so that the input turns with the inner crank."""
    steps, around = places.shape[1], 0.0
    for s in range(steps):
        ax, ay = places[pin, s, 0] - places[pivot, s, 0], places[pin, s, 1] - places[pivot, s, 1]
        after = s + 1 if s + 1 < steps else 0
        bx, by = places[pin, after, 0] - places[pivot, after, 0], places[pin, after, 1] - places[pivot, after, 1]
        around += math.atan2(ax * by - ay * bx, ax * bx + ay * by)
    return abs(abs(around) - 2.0 * math.pi) < 1.0


@njit(**OPTIONS)
def _draw_each(rng: np.random.Generator, setting: Real, cosine: float, z: Real, curves: Complex) -> int:
    """Draw linkages into the rows of ``z``, and their curves; return their number."""
    nodes, transmitting = unpack_table(setting)[:2]
    n, steps, point = len(nodes), curves.shape[1], int(setting[POINT_NODE])
    places, drawn = np.zeros((n, steps, 2)), 0
    viewed = setting[TRIAD][0] >= 0.0
    for _ in range(len(z)):
        if not _draw_nodes(rng, nodes, transmitting, setting, cosine, places):
            continue
        for k in range(n):
            source = nodes[k, 1] if nodes[k, 0] == VIEW else k
            z[drawn, 2 * k], z[drawn, 2 * k + 1] = places[source, 0, 0], places[source, 0, 1]
        if viewed:
            q, j = int(setting[TRIAD][0]), int(setting[TRIAD][1])
            if not _has_one_turn(places, q, nodes[j, 2]):
                continue
            if not _sweep_views(nodes, setting, cosine, z[drawn], curves[drawn]):
                continue
        else:
            for s in range(steps):
                curves[drawn, s] = complex(places[point, s, 0], places[point, s, 1])
        drawn += 1
    return drawn
