"""Pre-filter that evaluates force limits for many linkages of one topology at once.

It serves searches that choose among many candidates before any is driven. The forces are computed dyad by dyad
(elimination). A rejected linkage violates a limit at one of the evaluated positions. A linkage that passes is measured
later by the general equations.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.dynamics.dyads import compute_dyad_forces, is_built_of_dyads
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.mechanisms.machine import build_machines
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.results.forces import STEP_COUNT, apply_link_shape

FORCES_IN_CLOSED_FORM = ("drive_torque", "joint_force", "shaking_force", "shaking_moment", "power")
"""Forces whose limits are evaluated here; the joint force index needs a computation of its own."""


def select_bearable(problem: LinkageProblem, mechanism: Mechanism, moved: Real) -> NDArray[np.bool_]:
    """Return a mask of the linkages that satisfy their force limits at the evaluated positions.

    Parameters
    ----------
    problem : LinkageProblem
        Problem with limits on forces.
    mechanism : Mechanism
        Designs of shape (n,) at the first target.
    moved : float, shape (n,)
        Motion of the input from the first target to the last, radians or length units. An input that rotates fully is
        evaluated over a whole turn.

    Returns
    -------
    bool, shape (n,)
        All True if the elimination does not support the masses and loads of the problem.
    """
    stated, limits = problem.dynamics, problem.constraints.force_limits
    every = np.ones(mechanism.shape, np.bool_)
    slides = mechanism.has_slide_input
    if stated is None or not limits.keys() & set(FORCES_IN_CLOSED_FORM) or not every.size:
        # There is nothing to evaluate; the general equations decide later.
        return every
    speed = stated.speed if slides else stated.speed_rpm
    machine = (
        None
        if speed is None
        else build_machines(apply_link_shape(stated, mechanism.links), mechanism, problem.length_unit)
    )
    # This block cannot be decided by elimination; the designs are measured later in any case.
    if speed is None or machine is None or not is_built_of_dyads(machine):
        return every
    pace = speed if slides else speed * math.tau / 60.0
    # The reference input may be common to all designs.
    start = np.broadcast_to(np.asarray(mechanism.reference_input), mechanism.shape)[:, None]
    shares = np.linspace(0.0, 1.0, STEP_COUNT + 1)
    found = compute_dyad_forces(machine, start + moved[:, None] * shares, pace)
    if not slides:
        # A crank is loaded over its whole turn; a linkage that jams on the way is evaluated over the used range only.
        whole = compute_dyad_forces(machine, start + math.tau * shares, pace)
        turns = np.isfinite(whole.drive).all(axis=1, keepdims=True)
        found = type(found)(*(np.where(turns, full, part) for full, part in zip(whole, found, strict=True)))
    peaks = {
        "drive_torque": found.drive,
        "joint_force": found.pin,
        "shaking_force": found.shaking_force,
        "shaking_moment": found.shaking_moment,
        # A slide's speed is in length units, so its power needs the scale of the forces.
        "power": found.drive * pace * (machine.scale if slides else 1.0),
    }
    for name, limit in limits.items():
        if name in peaks:
            # NaN means that the linkage cannot move there: the comparison is False, and the linkage fails.
            every &= np.abs(peaks[name]).max(axis=1) <= limit
    return every
