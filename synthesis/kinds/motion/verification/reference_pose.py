"""Reference configuration of a linkage at its first target, if its solver used a different one.

Within tolerances a solver's first pose is one of many; the first target is met where the driven body is nearest to it.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from kinematics.linkage.planar.drive import drive
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.linkage.answer import (
    FourbarMechanism,
    LinkageDesign,
    LinkageMechanism,
    MultiloopMechanism,
    SliderCrankMechanism,
)
from synthesis.model.linkage.conversion import (
    FourbarConfiguration,
    build_fourbar,
    build_inverted_slider_crank,
    build_slider_crank,
)
from synthesis.verification.reconstruction import rebuild_mechanism

INPUT_TOLERANCE = 1e-7
"""Tolerance for equal inputs, radians or task sizes: at a smooth minimum an input is known to half of its digits."""


def move_to_first_target(problem: MotionProblem, design: LinkageDesign) -> LinkageMechanism | None:
    """Return a design's mechanism with its first target as reference configuration.

    Return None if the reference is there already, and for sixbars, whose first target is a limit of their crank.
    """
    mechanism = design.mechanism
    driven = None if isinstance(mechanism, MultiloopMechanism) else rebuild_mechanism(mechanism)
    if driven is None:
        return None
    place, angle = design.targets[0].input_place, design.targets[0].input_angle
    at = math.radians(angle or 0.0) if place is None else place
    away = at - float(driven.reference_input)
    # Rotations are compared modulo a full turn, strokes relative to the task.
    away = math.remainder(away, math.tau) if place is None else away / problem.task_size
    if abs(away) <= INPUT_TOLERANCE:
        return None
    motion = drive(driven, np.array([at]), order=0)
    if not motion.valid.all():
        return None
    joints = {name: complex(jet[0, 0]) for name, jet in motion.joints.items()}
    turned = float(motion.angles["coupler"][0, 0] - driven.link_angle("coupler"))
    stood = mechanism.reference_body_angle
    body_angle = (problem.positions[0].angle if stood is None else stood) + math.degrees(turned)
    o2, a, p = joints["O2"], joints["A"], joints["P"]
    if isinstance(mechanism, FourbarMechanism):
        return build_fourbar(FourbarConfiguration(o2, a, joints["B"], joints["O4"], p), body_angle)
    if isinstance(mechanism, SliderCrankMechanism):
        along = math.radians(mechanism.slide.angle)
        return build_slider_crank(o2, a, joints["B"], along, p, driven_by=mechanism.driven_by, body_angle=body_angle)
    line = cmath.exp(1j * (float(driven.slides[0].angle) + turned))
    return build_inverted_slider_crank(o2, a, joints["O4"], cmath.phase(line), p, body_angle=body_angle)
