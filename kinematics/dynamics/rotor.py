"""Rigid rotors: the corrections that balance them in one plane or in two, and what their bearings bear.

An unbalance is a moment U = m R e^{jθ} at a place z along the axis, in the frame of the rotor. Balanced are

    in one plane    Σ U = 0,                                                  (Norton, *Design of Machinery*, 12.2)
    in two planes   Σ U = 0 and Σ U z = 0,                                    (12.4)

so that a force ω² Σ U, and a couple ω² Σ U z, stay in the rotor and do not turn with it on the bearings.
"""

from __future__ import annotations

import numpy as np

from kinematics.linkage.planar.mechanism import Complex, Real


def plane_corrections(moments: Complex, z: Real, planes: Real) -> Complex:
    """The moments that have to be added in one plane or in two.

    Parameters
    ----------
    moments : complex, shape (n,)
        The rotor's unbalances.
    z : float, shape (n,)
        Their places along the axis.
    planes : float, shape (1,) or (2,)
        Those of the planes; two are apart.

    Returns
    -------
    complex, shape (1,) or (2,)
        In one plane the force alone is balanced.

    Examples
    --------
    Norton, Example 12-1, kg·m:

    >>> masses = np.array([1.2 * 1.135, 1.8 * 0.822]) * np.exp(1j * np.radians([113.4, 48.8]))
    >>> added = plane_corrections(masses, np.zeros(2), np.zeros(1))
    >>> round(float(abs(added[0])), 3), round(float(np.degrees(np.angle(added[0]))) % 360.0, 1)
    (2.403, 259.6)
    """
    if len(planes) == 1:
        return np.asarray([-moments.sum()])
    near, far = planes
    shares = (z - near) / (far - near)
    return np.asarray([-(moments * (1.0 - shares)).sum(), -(moments * shares).sum()])


def bearing_moments(moments: Complex, z: Real, bearings: Real) -> Complex:
    """What the rotor exerts on its two bearings, over ω², shape (2,): each moment is shared by the lever."""
    return -plane_corrections(moments, z, bearings)


def influence_coefficients(initial: Complex, runs: Complex, trials: Complex) -> Complex:
    """Change of each reading by a unit of unbalance in each plane, shape (sensors, planes).

    Parameters
    ----------
    initial : complex, shape (sensors,)
        Readings of the rotor as it is: amplitude and phase.
    runs : complex, shape (planes, sensors)
        Those with a trial weight in one plane after the other.
    trials : complex, shape (planes,)
        Moments of the trial weights.
    """
    return np.asarray(((runs - initial) / trials[:, None]).T)


def unbalances_by_influence(initial: Complex, coefficients: Complex) -> Complex:
    """The moments in the planes that make the initial readings, shape (planes,); least squares with more sensors."""
    return np.asarray(np.linalg.lstsq(coefficients, initial, rcond=None)[0])
