"""Rigid rotors: corrections that balance them in one or two planes, and the loads on their bearings.

An unbalance is a moment U = m R e^{jθ} at a position z along the axis, in the frame of the rotor. Balance requires

    in one plane    Σ U = 0,                                                  (Norton, *Design of Machinery*, 12.2)
    in two planes   Σ U = 0 and Σ U z = 0,                                    (12.4)

so that neither a force ω² Σ U nor a couple ω² Σ U z rotates on the bearings.
"""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Complex, Real


def compute_plane_corrections(moments: Complex, z: Real, planes: Real) -> Complex:
    """Compute the moments that have to be added in one or two planes.

    Parameters
    ----------
    moments : complex, shape (n,)
        The rotor's unbalances.
    z : float, shape (n,)
        Their positions along the axis.
    planes : float, shape (1,) or (2,)
        Positions of the planes; two must differ.

    Returns
    -------
    complex, shape (1,) or (2,)
        Correcting moments by plane. A single plane balances the force only.

    Examples
    --------
    Norton, Example 12-1, kg·m:

    >>> masses = np.array([1.2 * 1.135, 1.8 * 0.822]) * np.exp(1j * np.radians([113.4, 48.8]))
    >>> added = compute_plane_corrections(masses, np.zeros(2), np.zeros(1))
    >>> round(float(abs(added[0])), 3), round(float(np.degrees(np.angle(added[0]))) % 360.0, 1)
    (2.403, 259.6)
    """
    if len(planes) == 1:
        return np.asarray([-moments.sum()])
    # Lever rule: each moment is split between the planes by its position.
    near, far = planes
    shares = (z - near) / (far - near)
    return np.asarray([-(moments * (1.0 - shares)).sum(), -(moments * shares).sum()])


def compute_bearing_moments(moments: Complex, z: Real, bearings: Real) -> Complex:
    """Compute the load on the two bearings, divided by ω², shape (2,): each moment is shared by the lever rule."""
    return -compute_plane_corrections(moments, z, bearings)


def compute_influence_coefficients(initial: Complex, runs: Complex, trials: Complex) -> Complex:
    """Compute the change of each reading per unit of unbalance in each plane, shape (sensors, planes).

    Parameters
    ----------
    initial : complex, shape (sensors,)
        Readings of the uncorrected rotor: amplitude and phase.
    runs : complex, shape (planes, sensors)
        Readings with a trial weight in each plane in turn.
    trials : complex, shape (planes,)
        Moments of the trial weights.
    """
    # Linear model: readings change in proportion to the trial moment.
    return np.asarray(((runs - initial) / trials[:, None]).T)


def solve_unbalances(initial: Complex, coefficients: Complex) -> Complex:
    """Solve for the moments in the planes that cause the initial readings, shape (planes,); least squares."""
    return np.asarray(np.linalg.lstsq(coefficients, initial, rcond=None)[0])
