"""The moment that tilts a translating follower in its guide, and the slide offset that minimizes it.

Under a flat face, the contact force F acts at the distance v − e from the slide's axis, and the moment is F (v − e). A
roller is pushed sideways with F tan φ = F (v − e)/(d + s). The lever arm of this force about the guide shrinks with the
displacement, so that the moment is F (v − e)(l − s)/(d + s), with l the overhang at s = 0. F is the component along the
motion and depends neither on the offset e nor on the size of the cam. The moment of a face is therefore convex in e. A
limit M on the moment of a roller requires d ≥ |v − e| |F| (l − s)/M − s, like a pressure angle with the tangent
M/(|F| (l − s)).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import minimize_scalar

from kinematics.arrays import Real
from kinematics.cam import follower as core
from kinematics.cam.motion.extremes import find_extremes
from kinematics.cam.motion.pieces import Motion
from kinematics.cam.motion.program import Program
from kinematics.cam.profile import Cam
from synthesis.kinds.cam.follower_loads import press_follower
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.statement.followers import TranslatingRoller

OFFSET_TOLERANCE = 1e-11
"""Accuracy of the optimal offset of a face, as a share of the range that its contact sweeps."""


def compute_overturning_moment(problem: CamProblem, cam: Cam) -> float | None:
    """Compute the maximum moment on a finished cam's slide; None without a slide, a lever arm or forces."""
    if problem.dynamics is None:
        return None
    running, follower, program = press_follower(problem, cam.program).running, cam.follower, cam.program
    overhang = problem.follower.overhang if isinstance(problem.follower, TranslatingRoller) else None
    if isinstance(follower, core.TranslatingFlat):
        face = follower

        def moment(at: Real) -> Real:
            return running.force(at) * (face.face(program.motion(at)).h1 - face.offset)
    elif isinstance(follower, core.TranslatingRoller) and overhang is not None:
        roller = follower

        def moment(at: Real) -> Real:
            motion = program.motion(at)
            return np.asarray(running.force(at) * np.tan(roller.pressure_angle(motion)) * (overhang - motion.s))
    else:
        return None
    return find_extremes(moment, program.breaks).largest


def make_moment_share(problem: CamProblem, program: Program) -> Callable[[Motion], Real] | None:
    """Return the function F (l − s)/M for a roller with limited moment; |v − e|/(d + s) may not exceed its inverse."""
    limit, follower = problem.limits.overturning_moment, problem.follower
    if limit is None or not isinstance(follower, TranslatingRoller) or follower.overhang is None:
        return None
    running, overhang = press_follower(problem, program).running, follower.overhang
    return lambda motion: running.load.force(motion, running.speed) * (overhang - motion.s) / limit


def find_face_offset(problem: CamProblem, program: Program) -> float:
    """Find the face offset of minimum overturning moment, which is global, since the moment is convex in the offset."""
    running, v = press_follower(problem, program).running, program.peaks[1]

    def moment(offset: float) -> float:
        return find_extremes(lambda at: running.force(at) * (program.motion(at).v - offset), program.breaks).largest

    # The contact sweeps the range between these velocities, which contains the best offset.
    span = v.greatest - v.least
    best = minimize_scalar(
        moment, bounds=(v.least, v.greatest), method="bounded", options={"xatol": OFFSET_TOLERANCE * span}
    )
    return float(best.x)
