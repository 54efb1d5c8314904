"""Measurements on outlines alone: the depth of a wheel in a disc, and the distance of points from a polygon."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.indexing.design import LockingDisc

ARC_TOLERANCE = 1e-9
"""Share of a radius within which a corner counts as on an arc."""

BISECTION_COUNT, TRIAL_COUNT = 24, 48
"""Numbers of bisections, and of equal trial steps over half a station, for the play of a locked wheel."""


def close_outline(outline: Complex) -> Complex:
    """Return an outline with its first corner repeated at its end."""
    return np.append(outline, outline[:1])


def subdivide_outline(outline: Complex, longest: float, arcs: Complex, radius: float) -> Complex:
    """Return the corners of a closed outline, with points in between on edges longer than ``longest``.

    Edges of arcs of a radius about given centers are left unchanged: points in between would not be on the arc.
    """
    corners = close_outline(outline)
    on_arc = np.any(np.abs(np.abs(corners[:, None] - arcs) - radius) < ARC_TOLERANCE * radius, axis=1)
    start, edge = corners[:-1], np.diff(corners)
    counts = np.ceil(np.abs(edge) / longest).astype(int)
    counts = np.where(on_arc[:-1] & on_arc[1:], 1, np.maximum(counts, 1))
    of_edge = np.repeat(np.arange(len(edge)), counts)
    within = np.arange(len(of_edge)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.asarray(start[of_edge] + edge[of_edge] * (within / counts[of_edge]))


def measure_depth(disc: LockingDisc, points: Complex) -> Real:
    """Measure the depth of points of the crank's frame in a disc, along the ray from its axis; negative outside."""
    angle = np.radians(disc.angle)
    outer, inner = np.array(disc.outer_radius), np.array(disc.inner_radius)
    whole = not inner.any()
    if whole:
        angle = np.append(angle, angle[0] + 2.0 * math.pi)
        outer, inner = np.append(outer, outer[0]), np.append(inner, inner[0])
    at = np.mod(np.angle(points) - angle[0], 2.0 * math.pi) + angle[0]
    within = at <= angle[-1]
    k = np.clip(np.searchsorted(angle, at, side="right") - 1, 0, len(angle) - 2)
    before, after = at - angle[k], angle[k + 1] - at
    far = np.abs(points)
    found = _measure_edge_distance(outer[k], outer[k + 1], before, after) - far
    if not whole:
        found = np.minimum(found, far - _measure_edge_distance(inner[k], inner[k + 1], before, after))
    return np.where(within, found, -far)


def _measure_edge_distance(first: Real, second: Real, before: Real, after: Real) -> Real:
    """Return the distance of the edge between two corners along rays between them."""
    # The ray through the origin meets the chord where both triangles share its length.
    whole = first * np.sin(before) + second * np.sin(after)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(whole > 0.0, first * second * np.sin(before + after) / whole, 0.0)


def measure_play(deepest: Callable[[Real], Real], step: float) -> float:
    """Measure the angle by which a locked wheel can be turned, radians; half a station if nothing holds it.

    Parameters
    ----------
    deepest : callable
        Depth of the wheel in the disc when it is turned by angles, shape (k,).
    step : float
        Half the angle between stations, at which a slot faces the disc, which may fit into it.
    """
    # The trial angles rise densely from zero, because the wheel may be free again beyond the first held angle.
    tried = step * np.unique(
        np.concatenate([2.0 ** -np.arange(BISECTION_COUNT), np.arange(1, TRIAL_COUNT) / TRIAL_COUNT])
    )
    within = np.nonzero(deepest(tried) > 0.0)[0]
    if not len(within):
        return step
    first = int(within[0])
    free, held = float(tried[first - 1]) if first else 0.0, float(tried[first])
    for _ in range(BISECTION_COUNT):
        middle = 0.5 * (free + held)
        if float(deepest(np.array([middle]))[0]) > 0.0:
            held = middle
        else:
            free = middle
    return held


def measure_distance(outline: Complex, points: Complex) -> float:
    """Return the minimum distance of points, shape (m,), from the edges of a closed outline."""
    start = outline
    edge = np.roll(outline, -1) - outline
    apart = points[:, None] - start
    square = np.maximum(np.abs(edge) ** 2, np.finfo(np.float64).tiny)
    share = np.clip((apart * edge.conj()).real / square, 0.0, 1.0)
    return float(np.abs(apart - share * edge).min())
