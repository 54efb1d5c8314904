"""Harmonics of an engine's forces, moments and torque, as sums over its cylinders.

Cylinder i has its axis at β_i and its top dead centre where the crank has turned by τ_i = φ_i + β_i. Its k-th harmonic
exerts the force u(β_i) cos k(θ − τ_i) on the frame, in units of m_B r ω² A_k. As a complex number the sum is

    P e^(jkθ) + N e^(−jkθ),    P = ½ Σ w_i e^(j(β_i − kτ_i)),    N = ½ Σ w_i e^(j(β_i + kτ_i)):

an ellipse of half axes |P| + |N| and ||P| − |N||. With N = 0 weights on a shaft that turns k times as fast balance it,
with |P| = |N| a pair of shafts that turn against each other. Moments have w_i = z_i and are turned by a right angle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real


class TurningParts(NamedTuple):
    """Forward and backward part of a harmonic: it turns with the crank, and against it. Complex, over arrangements."""

    forward: Complex
    backward: Complex

    @property
    def major(self) -> Real:
        """Maximum magnitude over a turn."""
        return np.asarray(np.abs(self.forward) + np.abs(self.backward))

    @property
    def minor(self) -> Real:
        """Minimum magnitude over a turn."""
        return np.asarray(np.abs(np.abs(self.forward) - np.abs(self.backward)))


def compute_turning_parts(order: int, axis: Real, top: Real, weight: Real | float = 1.0) -> TurningParts:
    """Compute both parts of a harmonic, in units of m_B r ω² A_k.

    Parameters
    ----------
    axis, top : float, shape S + (n,)
        β and τ of the cylinders, radians.
    weight : float, shape S + (n,)
        1 for forces, the positions along the shaft for moments.
    """
    return TurningParts(
        0.5 * (weight * np.exp(1j * (axis - order * top))).sum(axis=-1),
        0.5 * (weight * np.exp(1j * (axis + order * top))).sum(axis=-1),
    )


def sum_torque(order: int, top: Real, weight: Real | float = 1.0) -> Complex:
    """Sum e^(−jkτ) over the cylinders: the k-th harmonic of the torque, in units of that of one cylinder."""
    return np.asarray((weight * np.exp(-1j * order * top)).sum(axis=-1))
