"""Masses and loads of many fourbars, in the form of :mod:`kinematics.dynamics.fourbar`."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from kinematics.dynamics.fourbar import Fourbars, Weights
from synthesis.fit.chart import OPTIONS
from synthesis.fit.fourbar_loads import COUPLES, FORCE, FORCES, GRAVITY, LOADS, PINS, pack_loads, weigh_links
from synthesis.model.dynamics.request import DesignDynamics, LengthUnit

JOINTS = "O2", "A", "B", "O4", "P"


def is_closed_form(block: DesignDynamics) -> bool:
    """Return whether the closed form covers a block, which must have no springs, friction or variable loads."""
    # Whether the block can be packed does not depend on the unit and the origin.
    return pack_loads(block, "m", 0j) is not None


def build_fourbars(joints: Complex, span: Real, scale: float) -> Fourbars:
    """Build fourbars from their joints in the reference configuration.

    Parameters
    ----------
    joints : complex, shape (n, 5)
        O2, A, B, O4, P in the reference configuration, length units.
    span : float, shape (n,)
        Rotation of the input from the reference to the end of its motion, radians.
    scale : float
        The length unit in the unit of the forces.
    """
    o2, a, b, o4, p = (scale * column for column in joints.T)
    line = (b - a) / np.abs(b - a)
    # The sign of the open assembly is +1: B lies to the left of the line from A to O4.
    sign = np.where((np.conj(o4 - a) * (b - a)).imag >= 0.0, 1.0, -1.0)
    return Fourbars(
        o2, o4, np.abs(a - o2), np.abs(b - a), np.abs(b - o4), (p - a) / line, sign, np.angle(a - o2), np.asarray(span)
    )


def build_weights(dynamics: DesignDynamics, joints: Complex, unit: LengthUnit) -> Weights:
    """Build masses and loads of fourbars for a block that satisfies :func:`is_closed_form`.

    Parameters
    ----------
    dynamics : DesignDynamics
        Masses and loads of every fourbar.
    joints : complex, shape (n, 5)
        O2, A, B, O4, P in the reference configuration, length units.
    unit : str
        The length unit.

    Raises
    ------
    ValueError
        If the block has springs, friction or variable loads.
    """
    count, scale = len(joints), dynamics.scale(unit)
    # An origin near the linkages preserves the digits of moments, which are differences of products.
    origin = complex(joints[0, 0]) if count else 0j
    block = pack_loads(dynamics, unit, origin)
    if block is None:
        raise ValueError("expected a block without springs, friction and loads that change; use `Machine` for others")
    loads = int(block[LOADS])
    mass, inertia = np.empty((2, count, 3))
    cg = np.empty((count, 3), np.complex128)
    arm, force = np.empty((2, count, loads), np.complex128)
    _weigh_each(block, np.ascontiguousarray(scale * (joints - origin)), mass, cg, inertia, arm, force)
    listed = block[FORCES:].reshape(loads, FORCE)
    about = joints[:, 0] if dynamics.moment_about is None else np.full(count, complex(*dynamics.moment_about))
    return Weights(
        mass,
        cg,
        inertia,
        np.tile(block[PINS : PINS + 3], (count, 1)),
        complex(*block[GRAVITY : GRAVITY + 2]),
        listed[:, 0].astype(np.int64),
        arm,
        force,
        listed[:, 6] > 0.0,
        block[COUPLES : COUPLES + 3].copy(),
        scale * about,
    )


@njit(**OPTIONS)
def _weigh_each(
    block: Real, joints: Complex, mass: Real, cg: Complex, inertia: Real, arm: Complex, force: Complex
) -> None:
    for n in range(len(joints)):
        if not weigh_links(block, joints[n], mass[n], cg[n], inertia[n], arm[n], force[n]):
            # If holes leave nothing of a plate, an infinite mass makes the design violate every limit.
            mass[n] = np.inf
