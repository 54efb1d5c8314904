"""Rigid bodies: mass, centre of gravity and moment of inertia of the links.

Bodies add up: the mass and its first moment are sums, and the moment of inertia about the common centre follows by the
parallel axis theorem (Norton, *Design of Machinery*, Sec. 10.1-10.6, eq. 10.3e, 10.8).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real


class Body(NamedTuple):
    """Mass, centre of gravity in the reference configuration, moment of inertia about it; arrays of shape S."""

    mass: Real
    cg: Complex
    inertia: Real


def make_body(mass: float, cg: complex = 0j, inertia: float = 0.0) -> Body:
    """Make a body from plain numbers."""
    return Body(np.asarray(mass, np.float64), np.asarray(cg, np.complex128), np.asarray(inertia, np.float64))


def join_bodies(bodies: Iterable[Body]) -> Body:
    """Join bodies that are fixed to one another into one.

    Examples
    --------
    Two masses of 1 at a distance of 2:

    >>> float(join_bodies([make_body(1.0, 0j), make_body(1.0, 2 + 0j)]).inertia)
    2.0
    """
    parts = list(bodies)
    mass = np.asarray(sum(part.mass for part in parts))
    first = sum(part.mass * part.cg for part in parts)
    # A body without mass keeps an arbitrary but finite centre.
    weightless = mass == 0.0
    anywhere = parts[0].cg if parts else np.complex128(0.0)
    cg = np.where(weightless, anywhere, first / np.where(weightless, 1.0, mass))
    inertia = sum(part.inertia + part.mass * np.abs(part.cg - cg) ** 2 for part in parts)
    return Body(mass, np.asarray(cg), np.asarray(inertia, np.float64))


def is_too_slender(part: Body, reach: float) -> bool:
    """Return whether the moment of inertia is too small for a body of this extent.

    A plane body of positive density has I > 0; below 1e-6 m·reach² it is practically a point mass.
    """
    return bool(np.any((part.mass > 0.0) & (part.inertia < 1e-6 * part.mass * reach * reach)))
