"""Joint force index: largest joint force per unit of load, from the geometry alone (Norton, eq. 11.23)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kinematics.arrays import Real
from kinematics.dynamics.friction import Friction
from kinematics.dynamics.loads import Load
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import compute_reactions


def compute_joint_force_index(machine: Machine, now: Places, load: Load) -> Real:
    """Compute the largest pin or slide force over the load, without masses, springs and friction; shape S + (N,).

    For a torque the index has the unit 1/length. It is NaN where the load vanishes or the reactions are not
    determined: at a dead centre the index is infinite.
    """
    # Only the load acts, so that the index depends on the geometry alone.
    alone = replace(machine, bodies={}, pin_masses={}, gravity=0j, loads=(load,), friction=Friction())
    found = compute_reactions(alone, now)
    shape = now.smooth.shape
    acting = [np.broadcast_to(np.hypot(np.abs(e.force), e.couple), shape) for e in load.efforts(now)]
    forces = [np.abs(force) for on in found.joints.values() for force in on.values()]
    forces += [np.abs(normal) for normal in found.slides]
    strength = np.max(acting, axis=0)
    with np.errstate(invalid="ignore"):
        return np.where(strength > 0.0, np.max(forces, axis=0) / np.where(strength > 0.0, strength, 1.0), np.nan)
