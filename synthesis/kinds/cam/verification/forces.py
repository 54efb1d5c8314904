"""Contact force and overturning moment on the finished cam, computed from the motion that its profile produces.

The follower is laid against the profile at cam angles four times as close as the design's. Each contact gives
displacement, velocity and acceleration, from which the force of mass, damping and spring follows at many speeds.
Neither the program nor the closed form of the force over speed (a parabola) is used.
"""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Real
from kinematics.cam.dynamics import FollowerLoad
from kinematics.cam.finished.contact import ContactMotion, Contour
from kinematics.cam.motion.pieces import Motion
from kinematics.cam.motion.program import TURN
from synthesis.kinds.cam.design import CamForces, CamMechanism, CamMetrics
from synthesis.kinds.cam.follower_loads import build_follower_load, convert_rpm, get_arm_length
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.profile import build_core_follower, find_stretches, read_points
from synthesis.kinds.cam.statement.followers import TranslatingRoller
from synthesis.kinds.cam.verification.reproduction import REFINEMENT_FACTOR
from synthesis.model.answer import Check
from synthesis.model.dimension import FORCE, TORQUE
from synthesis.verification.checks import check_maximum

MOMENT_SLACK = 1e-8
"""Relative slack of an overturning moment at its limit, since the radius is only enlarged by rounding."""

SPEED_COUNT = 65
"""Number of speeds, from 0 to the maximum, at which the force is measured."""

FORCE_TOLERANCE = 1e-3
"""Permitted shortfall of a measured force, as a share of the maximum force, because accelerations are derived from the
profile's curvature."""


def check_measured_contact(problem: CamProblem, mechanism: CamMechanism, forces: CamForces | None) -> list[Check]:
    """Check ``contact_on_profile``: the measured minimum contact force, if one is kept over a range of speeds."""
    if forces is None or forces.over_speeds is None or problem.dynamics is None:
        return []
    load, _ = _load(problem, forces)
    found, _ = _lay_follower(mechanism)
    # The minimum force over speed may lie anywhere: sample the range instead of its closed form.
    speeds = np.linspace(0.0, convert_rpm(forces.over_speeds.max_rpm), SPEED_COUNT)[:, None]
    force = load.force(_build_motion(found), speeds) / get_arm_length(problem)
    least, floor = float(force.min()), problem.dynamics.least_force
    allowed = FORCE_TOLERANCE * max(float(np.abs(force).max()), floor)
    passed = bool(found.valid.all()) and least >= floor - allowed
    return [Check(name="contact_on_profile", passed=passed, value=least, limit=floor, dimension=FORCE)]


def check_overturning(problem: CamProblem, mechanism: CamMechanism, metrics: CamMetrics) -> list[Check]:
    """Check the answer's overturning moment, and that of the contacts with the finished profile, against the limit."""
    limit, forces, moment = problem.limits.overturning_moment, metrics.forces, metrics.overturning_moment
    if limit is None or forces is None or moment is None:
        return []
    load, speed = _load(problem, forces)
    found, angle = _lay_follower(mechanism)
    force = load.force(_build_motion(found), speed)
    # Rotate to the ground's frame; the cam turns clockwise.
    turned = np.exp(1j * angle)
    if mechanism.rotation == "ccw":
        point, normal = np.conj(found.point * turned), np.conj(found.normal * turned)
    else:
        point, normal = found.point / turned, found.normal / turned
    if isinstance(problem.follower, TranslatingRoller):
        # The lever arm to the guide shrinks with the displacement. The lateral force is the contact force times tan φ.
        lever = (problem.follower.overhang or 0.0) - found.s
        measured = force * normal.imag / normal.real * lever
    else:
        measured = force * (point.imag - (mechanism.follower.offset or 0.0))
    greatest = float(np.abs(measured).max())
    allowed = limit * (1.0 + FORCE_TOLERANCE)
    passed = bool(found.valid.all()) and greatest <= allowed
    return [
        check_maximum("overturning_moment", moment, limit, TORQUE, MOMENT_SLACK),
        Check(name="overturning_on_profile", passed=passed, value=greatest, limit=limit, dimension=TORQUE),
    ]


def _load(problem: CamProblem, forces: CamForces) -> tuple[FollowerLoad, float]:
    """Return the load with the answer's spring and preload, and the speed."""
    assert problem.dynamics is not None
    dynamics = problem.dynamics.model_copy(update={"spring_rate": forces.spring_rate, "preload": forces.preload})
    return build_follower_load(problem.model_copy(update={"dynamics": dynamics}))


def _lay_follower(mechanism: CamMechanism) -> tuple[ContactMotion, Real]:
    """Lay the follower against the profile; also return the cam angles of the contacts."""
    at = np.radians(mechanism.program.angle)
    step = np.diff(np.append(at, at[0] + TURN))
    angle = (at[:, None] + step[:, None] * (np.arange(REFINEMENT_FACTOR) / REFINEMENT_FACTOR)).ravel()
    contour = Contour(read_points(mechanism.profile), at, find_stretches(mechanism.program).breaks)
    return contour.follow(build_core_follower(mechanism), angle, mechanism.rotation), angle


def _build_motion(found: ContactMotion) -> Motion:
    # Forces need no jerk.
    return Motion(found.s, found.v, found.a, np.zeros_like(found.s))
