"""Contact force and overturning moment on the finished cam, computed from the motion that its profile produces.

The follower is laid against the profile at cam angles four times as close as the design's. Each contact gives
displacement, velocity and acceleration, and these the force of mass, damping and spring at many speeds. Neither the
program nor the closed form of the force over speed (a parabola) is used.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.contact import ContactMotion, Contour
from kinematics.cam.dynamics import FollowerLoad
from kinematics.cam.pieces import Motion
from kinematics.cam.program import TURN
from synthesis.kinds.cam.design import CamForces, CamMechanism, CamMetrics
from synthesis.kinds.cam.followers import TranslatingRoller
from synthesis.kinds.cam.loads import arm_length, follower_load, radians_a_second
from synthesis.kinds.cam.mechanism import core_follower, points_of, stretches_of
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.reproduction import FINER
from synthesis.model.answer import Check
from synthesis.model.dimension import FORCE, TORQUE
from synthesis.proof.checks import at_most

Real = NDArray[np.float64]

MOMENT_SLACK = 1e-8
"""Relative slack of an overturning moment at its limit: the radius is enlarged by no more than rounding."""

SPEEDS = 65
"""Number of speeds at which the force is measured, from 0 to the greatest."""

MEASURED_FORCE = 1e-3
"""Share of the greatest force by which a measured one may be less: accelerations come from the profile's curvature."""


def measured_contact(problem: CamProblem, mechanism: CamMechanism, forces: CamForces | None) -> list[Check]:
    """Check ``contact_on_profile``: the measured minimum contact force, if one is kept over a range of speeds."""
    if forces is None or forces.over_speeds is None or problem.dynamics is None:
        return []
    load, _ = _load(problem, forces)
    found, _ = _laid(mechanism)
    # The least force over speed may lie anywhere: sample the range instead of its closed form.
    speeds = np.linspace(0.0, radians_a_second(forces.over_speeds.max_rpm), SPEEDS)[:, None]
    force = load.force(_motion(found), speeds) / arm_length(problem)
    least, floor = float(force.min()), problem.dynamics.least_force
    allowed = MEASURED_FORCE * max(float(np.abs(force).max()), floor)
    passed = bool(found.valid.all()) and least >= floor - allowed
    return [Check(name="contact_on_profile", passed=passed, value=least, limit=floor, dimension=FORCE)]


def overturning_checks(problem: CamProblem, mechanism: CamMechanism, metrics: CamMetrics) -> list[Check]:
    """Check the answer's overturning moment, and that of the contacts with the finished profile, against the limit."""
    limit, forces, moment = problem.limits.overturning_moment, metrics.forces, metrics.overturning_moment
    if limit is None or forces is None or moment is None:
        return []
    load, speed = _load(problem, forces)
    found, angle = _laid(mechanism)
    force = load.force(_motion(found), speed)
    # In the ground's frame, of a cam that turns clockwise.
    turned = np.exp(1j * angle)
    if mechanism.rotation == "ccw":
        point, normal = np.conj(found.point * turned), np.conj(found.normal * turned)
    else:
        point, normal = found.point / turned, found.normal / turned
    if isinstance(problem.follower, TranslatingRoller):
        # The guide's lever shrinks with the displacement; the lateral force is the contact force times tan φ.
        lever = (problem.follower.overhang or 0.0) - found.s
        measured = force * normal.imag / normal.real * lever
    else:
        measured = force * (point.imag - (mechanism.follower.offset or 0.0))
    greatest = float(np.abs(measured).max())
    allowed = limit * (1.0 + MEASURED_FORCE)
    passed = bool(found.valid.all()) and greatest <= allowed
    return [
        at_most("overturning_moment", moment, limit, TORQUE, MOMENT_SLACK),
        Check(name="overturning_on_profile", passed=passed, value=greatest, limit=limit, dimension=TORQUE),
    ]


def _load(problem: CamProblem, forces: CamForces) -> tuple[FollowerLoad, float]:
    """Return the load with the answer's spring and preload, and the speed."""
    assert problem.dynamics is not None
    dynamics = problem.dynamics.model_copy(update={"spring_rate": forces.spring_rate, "preload": forces.preload})
    return follower_load(problem.model_copy(update={"dynamics": dynamics}))


def _laid(mechanism: CamMechanism) -> tuple[ContactMotion, Real]:
    """Lay the follower against the profile; also return the cam angles of the contacts."""
    at = np.radians(mechanism.program.angle)
    step = np.diff(np.append(at, at[0] + TURN))
    angle = (at[:, None] + step[:, None] * (np.arange(FINER) / FINER)).ravel()
    contour = Contour(points_of(mechanism.profile), at, stretches_of(mechanism.program).breaks)
    return contour.follow(core_follower(mechanism), angle, mechanism.rotation), angle


def _motion(found: ContactMotion) -> Motion:
    # Forces need no jerk.
    return Motion(found.s, found.v, found.a, np.zeros_like(found.s))
