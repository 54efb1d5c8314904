"""What many fourbars weigh and carry, as the closed form of :mod:`kinematics.dynamics.fourbar` takes it."""

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
    """Whether a block has nothing that the closed form leaves out: springs, friction, loads that change."""
    return pack_loads(block, "m", 0j) is not None


def build_fourbars(joints: Complex, span: Real, scale: float) -> Fourbars:
    """Fourbars by their joints O2, A, B, O4, P in the reference, shape (n, 5), that turn by ``span`` from there."""
    o2, a, b, o4, p = (scale * column for column in joints.T)
    line = (b - a) / np.abs(b - a)
    sign = np.where((np.conj(o4 - a) * (b - a)).imag >= 0.0, 1.0, -1.0)
    return Fourbars(
        o2, o4, np.abs(a - o2), np.abs(b - a), np.abs(b - o4), (p - a) / line, sign, np.angle(a - o2), np.asarray(span)
    )


def build_weights(dynamics: DesignDynamics, joints: Complex, unit: LengthUnit) -> Weights:
    """What fourbars weigh and carry by a block in :func:`is_closed_form`.

    Parameters
    ----------
    stated : DesignDynamics
        What every fourbar weighs and carries.
    joints : complex, shape (n, 5)
        O2, A, B, O4, P in the reference, length units.
    unit : str
        The length unit.

    Raises
    ------
    ValueError
        Where the block has more.
    """
    count, scale = len(joints), dynamics.scale(unit)
    origin = complex(joints[0, 0]) if count else 0j
    block = pack_loads(dynamics, unit, origin)
    if block is None:
        raise ValueError("expected a block without springs, friction and loads that change; weigh it by its machine")
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
            mass[n] = np.inf
