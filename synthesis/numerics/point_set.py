"""Sets of distinct points of several complex numbers; points are the same if they agree to a share of their size."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from kinematics.arrays import Complex, Mask


def mark_duplicates(points: Complex, share: float) -> Mask:
    """Return a mask of the points, shape (k, numbers), that equal another point of the same array."""
    return np.asarray(_count_neighbours(points, points, share) > 1)


def _count_neighbours(known: Complex, points: Complex, share: float) -> NDArray[np.int64]:
    """Count the known points that equal each of ``points``."""
    radius = share * np.abs(points).max(axis=-1)
    # A complex number is two coordinates of the tree; the maximum norm avoids squares.
    tree = cKDTree(np.ascontiguousarray(known).view(np.float64))
    near = tree.query_ball_point(np.ascontiguousarray(points).view(np.float64), radius, p=np.inf, return_length=True)
    return np.asarray(near)


class KnownPoints:
    """Set of the points found so far.

    Parameters
    ----------
    numbers : int
        Number of complex numbers per point.
    share : float
        Relative tolerance: two points are the same if all their numbers agree to this share of the largest number.
    """

    def __init__(self, numbers: int, share: float) -> None:
        self._points = np.empty((0, numbers), np.complex128)
        self._share = share

    def mark_known(self, points: Complex) -> Mask:
        """Return a mask of the points, shape (k, numbers), that are known."""
        if not len(self._points) or not len(points):
            return np.zeros(len(points), np.bool_)
        return np.asarray(_count_neighbours(self._points, points, self._share) > 0)

    def add(self, points: Complex) -> Mask:
        """Add points, shape (k, numbers), and return a mask of the new ones; of equal points only the first is new."""
        new = ~self.mark_known(points)
        own = points[new]
        if len(own):
            radius = self._share * np.abs(own).max(axis=-1)
            tree = cKDTree(np.ascontiguousarray(own).view(np.float64))
            # A point is kept if no equal one precedes it.
            groups = tree.query_ball_point(tree.data, radius, p=np.inf)
            new[new] = [min(group) == n for n, group in enumerate(groups)]
        self._points = np.concatenate([self._points, points[new]])
        return np.asarray(new)
