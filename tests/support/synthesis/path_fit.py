"""Code that several tests share: path fit."""

import numpy as np

from kinematics.linkage.fourbar import Fourbar
from tests.oracles.fourbar_sweep import coupler_points

CRANK_ROCKER = Fourbar(1.0 - 2.0j, 7.0 + 1.0j, 2.0, 6.0, 5.0, 3.0 + 2.0j)


def silent(share, message):
    pass


def listed(points, angles=None):
    return [
        {"x": float(z.real), "y": float(z.imag)} | ({} if angles is None else {"crank_angle": float(angles[k])})
        for k, z in enumerate(points)
    ]


def drawn(rng):
    """A random crank-rocker or double crank that is no near change point."""
    while True:
        a, b, c = rng.uniform(0.4, 2.0, 3)
        o2, o4 = rng.normal(size=2) + 1j * rng.normal(size=2)
        sides = sorted([a, b, c, abs(o4 - o2)])
        if min(a, abs(o4 - o2)) == sides[0] and sides[0] + sides[3] < 0.95 * (sides[1] + sides[2]):
            return Fourbar(o2, o4, a, b, c, b * complex(rng.normal(), rng.normal()))


def measured_at_angles(design, points, angles, way=1.0):
    """Sum of squared distances with the crank turned from its first angle as demanded."""
    turned = design.mechanism.reference_input_angle + way * (np.asarray(angles) - angles[0])
    return float(np.sum(np.abs(coupler_points(design.mechanism, turned) - points) ** 2))
