"""Code that several tests share: curve verification."""

import math

import numpy as np


def distance_from(polygon, z):
    """Distance of one place from a closed polygon, side by side."""
    least = math.inf
    for start, end in zip(polygon, np.roll(polygon, -1), strict=True):
        share = ((z - start) * (end - start).conjugate()).real / abs(end - start) ** 2
        least = min(least, abs(z - start - min(max(share, 0.0), 1.0) * (end - start)))
    return least
