"""Penetration depth of moving parts in fixed ones: how far a part has to be shifted until it is outside.

A part A shifted by t meets B exactly if t lies in the Minkowski difference B ⊖ A = {b − a}. If they overlap, the origin
lies inside the difference, and its distance from the boundary is the depth. The difference of convex shapes is the hull
of the differences of their corners; that of other polygons is the union over their convex pieces. Widened outlines
widen the difference.

Depths are measured at samples of a motion and refined around the largest one. This is a measure for reports; whether a
clearance is kept is proved by :mod:`kinematics.linkage.clearance`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.clearance import Part
from kinematics.linkage.clearance.scene import Pairs, Scene
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.model.triangles import triangulate_polygon

SAMPLE_COUNT = 64
"""Number of samples of the input at which the depth of each pair is measured."""

SECTION_COUNT, NARROWING_STEPS = 8, 5
"""Number of sections of the interval around the deepest sample, and number of repetitions."""

MAX_PIECES = 12
"""Maximum number of convex pieces of an outline; outlines with more are simplified first."""

SIMPLIFICATION_TOLERANCE = 1e-3
"""First tolerance of the simplification, as a share of the extent; it doubles until the pieces are few enough."""


def measure_penetration(mechanism: Mechanism, parts: Sequence[Part], pairs: Pairs, low: float, high: float) -> float:
    """Measure the largest penetration depth of pairs of parts over a range of the input.

    Parameters
    ----------
    mechanism : Mechanism
        One design.
    parts : sequence of Part
    pairs : sequence of (int, int)
        Pairs of indices into ``parts``; the second part of each is fixed.
    low, high : float
        The range of absolute inputs, radians or positions along the input slide.

    Returns
    -------
    float
        Depth in length units; 0 if no pair overlaps at a sample.
    """
    scene = Scene(mechanism, parts, pairs)
    inputs = np.linspace(low, high, SAMPLE_COUNT)
    depths = np.stack([_measure_depths(scene, parts, pair, inputs) for pair in range(len(pairs))])
    pair, sample = divmod(int(depths.argmax()), SAMPLE_COUNT)
    deepest = float(depths[pair, sample])
    if deepest == 0.0:
        return 0.0
    left, right = inputs[max(sample - 1, 0)], inputs[min(sample + 1, SAMPLE_COUNT - 1)]
    for _ in range(NARROWING_STEPS):
        inside = np.linspace(left, right, SECTION_COUNT + 1)
        found = _measure_depths(scene, parts, pair, inside)
        peak = int(found.argmax())
        deepest = max(deepest, float(found[peak]))
        left, right = inside[max(peak - 1, 0)], inside[min(peak + 1, SECTION_COUNT)]
    return deepest


def _measure_depths(scene: Scene, parts: Sequence[Part], pair: int, inputs: Real) -> Real:
    """Measure the depths of one pair at inputs, shape (n,)."""
    moving, fixed = (int(index) for index in scene.pairs[pair])
    distances = scene.distances(np.full(len(inputs), pair), inputs, np.zeros(len(inputs)))[0]
    # Outlines whose widths alone overlap have a distance of their cores, which is exact.
    depths = np.maximum(np.nan_to_num(-distances), 0.0)
    crossed = np.flatnonzero(distances <= scene.overlaps[pair])
    if len(crossed):
        radius = parts[moving].radius + parts[fixed].radius
        obstacle = split_convex(parts[fixed].points)
        pieces = [scene.carry_points(moving, piece, inputs[crossed]) for piece in split_convex(parts[moving].points)]
        for n, sample in enumerate(crossed):
            depths[sample] = max(depths[sample], measure_depth([piece[n] for piece in pieces], obstacle, radius))
    return np.asarray(depths)


def measure_depth(first: Sequence[Complex], second: Sequence[Complex], radius: float = 0.0) -> float:
    """Measure the penetration depth of two shapes, each the union of convex pieces; 0 if they do not overlap.

    ``radius`` is the sum of the amounts by which the shapes are widened.
    """
    import shapely

    differences = [(b[:, None] - a[None, :]).ravel() for a in first for b in second]
    corners = [np.stack([each.real, each.imag], axis=1) for each in differences]
    difference = shapely.union_all([shapely.MultiPoint(each).convex_hull for each in corners])
    origin = shapely.Point(0.0, 0.0)
    if len(corners) > 1:
        difference, radius = difference.buffer(radius), 0.0
    if not difference.intersects(origin):
        return max(radius - float(difference.distance(origin)), 0.0)
    return float(difference.boundary.distance(origin)) + radius if difference.area > 0.0 else radius


def split_convex(points: Complex) -> list[Complex]:
    """Split an outline into convex pieces: points, segments and convex polygons are one, other polygons triangles."""
    import shapely

    if len(points) < 3:
        return [points]
    polygon = shapely.Polygon(np.stack([points.real, points.imag], axis=1))
    hull = polygon.convex_hull
    tolerance = SIMPLIFICATION_TOLERANCE * float(np.hypot(*np.ptp([points.real, points.imag], axis=1)))
    if hull.area - polygon.area <= tolerance**2:
        return [points]
    while len(polygon.exterior.coords) - 3 > MAX_PIECES:
        polygon, tolerance = polygon.simplify(tolerance), 2.0 * tolerance
    corners = shapely.get_coordinates(polygon)[:-1] @ np.array([1.0, 1.0j])
    return list(triangulate_polygon(corners))
