"""Points of several complex numbers that are known, each once: two are the same that agree to a share of their size."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Complex = NDArray[np.complex128]
Mask = NDArray[np.bool_]


def crowded(points: Complex, share: float) -> Mask:
    """Which of some points, shape (k, numbers), are the same as another one of them."""
    return np.asarray(_near(points, points, share) > 1)


def _near(known: Complex, points: Complex, share: float) -> NDArray[np.int64]:
    """How many known points are the same as each of some."""
    radius = share * np.abs(points).max(axis=-1)
    tree = cKDTree(np.ascontiguousarray(known).view(np.float64))
    near = tree.query_ball_point(np.ascontiguousarray(points).view(np.float64), radius, p=np.inf, return_length=True)
    return np.asarray(near)


class Known:
    """What has been met so far.

    Parameters
    ----------
    numbers : int
        Of a point.
    share : float
        Of the size of a point, its largest number, to which the same ones agree in every number.
    """

    def __init__(self, numbers: int, share: float) -> None:
        self._points = np.empty((0, numbers), np.complex128)
        self._share = share

    def holds(self, points: Complex) -> Mask:
        """Which of some points, shape (k, numbers), are known."""
        if not len(self._points) or not len(points):
            return np.zeros(len(points), np.bool_)
        return np.asarray(_near(self._points, points, self._share) > 0)

    def add(self, points: Complex) -> Mask:
        """Add some points, shape (k, numbers); tells which of them were new, of several that are the same the first."""
        new = ~self.holds(points)
        own = points[new]
        if len(own):
            radius = self._share * np.abs(own).max(axis=-1)
            tree = cKDTree(np.ascontiguousarray(own).view(np.float64))
            groups = tree.query_ball_point(tree.data, radius, p=np.inf)
            new[new] = [min(group) == n for n, group in enumerate(groups)]
        self._points = np.concatenate([self._points, points[new]])
        return np.asarray(new)
