"""Whether a chosen spring holds the follower to the finished cam: forces of the motion that its profile gives.

The follower is laid against the profile at cam angles four times as close as the design's. From each contact come
displacement, velocity and acceleration, and with them the force of mass, damping and spring at many speeds. Neither the
program nor the parabola of the force over speed is looked at.
"""

from __future__ import annotations

import numpy as np

from kinematics.cam.contact import Contour
from kinematics.cam.pieces import Motion
from synthesis.kinds.cam.design import CamForces, CamMechanism
from synthesis.kinds.cam.loads import arm_length, follower_load, radians_a_second
from synthesis.kinds.cam.mechanism import core_follower, points_of, stretches_of
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.reproduction import FINER
from synthesis.model.answer import Check
from synthesis.model.dimension import FORCE

SPEEDS = 65
"""Speeds at which the force is measured, from 0 to the greatest."""

MEASURED_FORCE = 1e-3
"""Share of the greatest force by which a measured one may be less: accelerations come from the profile's curvature."""


def measured_contact(problem: CamProblem, mechanism: CamMechanism, forces: CamForces | None) -> list[Check]:
    """The check ``contact_on_profile``: the least contact force measured, where one is kept over a range of speeds."""
    if forces is None or forces.over_speeds is None or problem.dynamics is None:
        return []
    dynamics = problem.dynamics.model_copy(update={"spring_rate": forces.spring_rate, "preload": forces.preload})
    load, _ = follower_load(problem.model_copy(update={"dynamics": dynamics}))
    at = np.radians(mechanism.program.angle)
    parts = np.arange(FINER) / FINER
    step = np.diff(np.append(at, at[0] + 2.0 * np.pi))
    angle = (at[:, None] + step[:, None] * parts).ravel()
    contour = Contour(points_of(mechanism.profile), at, stretches_of(mechanism.program).breaks)
    found = contour.follow(core_follower(mechanism), angle, mechanism.rotation)
    motion = Motion(found.s, found.v, found.a, np.zeros_like(found.s))
    speeds = np.linspace(0.0, radians_a_second(forces.over_speeds.max_rpm), SPEEDS)[:, None]
    force = load.force(motion, speeds) / arm_length(problem)
    least, floor = float(force.min()), dynamics.least_force
    allowed = MEASURED_FORCE * max(float(np.abs(force).max()), floor)
    passed = bool(found.valid.all()) and least >= floor - allowed
    return [Check(name="contact_on_profile", passed=passed, value=least, limit=floor, dimension=FORCE)]
