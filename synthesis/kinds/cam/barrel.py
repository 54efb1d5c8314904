"""Barrel cams: the smallest cylinder for a motion program, its groove, and their verification.

tan φ = v/R, so that the greatest velocities of rise and fall require R ≥ |v|/tan φ. The unrolled pitch curve has the
curvature a R/(R² + v²)^{3/2}; its radius must exceed the roller's by the required ratio at every angle.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.barrel import BarrelCam
from kinematics.cam.pieces import Motion
from kinematics.cam.program import Program
from synthesis.kinds.cam.answer import joints_of, motion_metrics, none_of, optimality_of, result_of, segments_of
from synthesis.kinds.cam.barrel_verification import MeasuredBarrel, verify_barrel
from synthesis.kinds.cam.composition import Composition, least_pitch_radius
from synthesis.kinds.cam.critical import smallest_allowed
from synthesis.kinds.cam.design import BarrelCamDesign, BarrelMetrics, CamResult
from synthesis.kinds.cam.followers import BarrelRoller
from synthesis.kinds.cam.mechanism import barrel_mechanism, profile_angles, refined
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.reproduction import REPRODUCED, reported
from synthesis.kinds.cam.resolution import resolved
from synthesis.kinds.cam.sizing import MARGIN, MAX_RADIUS, Size
from synthesis.model.kind import Progress

Real = NDArray[np.float64]


def solve_barrel(problem: CamProblem, follower: BarrelRoller, composed: Composition, progress: Progress) -> CamResult:
    """Size, make and verify the barrel cam of a composed program."""
    program, roller = composed.program, follower.roller_radius
    size = smallest_barrel(problem, follower, program)
    if size is None:
        reason = "no cylinder carries the program within the limits on pressure angle and curvature"
        return none_of(problem, reason, composed.bound is None, "size")
    barrel = BarrelCam(program, size.radius, roller)
    progress(0.7, "verifying")

    # Both walls get points at the same angles: those of the wall that needs more of them.
    walls = partial(barrel.wall, side=-1), partial(barrel.wall, side=1)
    angle = max((profile_angles(program, wall, roller, problem.profile_points) for wall in walls), key=len)
    mechanism, verification, measured = resolved(
        angle, partial(barrel_mechanism, barrel, problem.rotation), partial(verify_barrel, problem), _closer, progress
    )
    if measured is None:
        reason = (
            f"the contact of a roller of radius {roller:.6g} in a groove on a cylinder of radius {size.radius:.6g} is "
            "not resolved by the maximum number of points per wall; use a larger roller or a slower motion"
        )
        return none_of(problem, reason, False, "follower_can_be_laid_on")
    design = BarrelCamDesign(
        mechanism=mechanism,
        segments=segments_of(problem, composed),
        joints=joints_of(problem, program),
        optimality=optimality_of(problem, composed, size.radius),
        verification=verification,
        metrics=_metrics(problem, program, follower.roller_radius, measured),
    )
    progress(1.0, "verified")
    return result_of(problem, composed, design, size, ("cylinder", size.radius))


def _closer(angle: Real, measured: MeasuredBarrel, failed: set[str]) -> Real | None:
    """Return a finer set of angles if the walls have too few points; None if more points do not help."""
    # A cusp is a property of the groove, not of its resolution.
    if "no_cusp" in failed:
        return None
    if any("reproduces" in name for name in failed):
        return refined(angle, measured.off, REPRODUCED)
    # Refine where the curvature is unsettled; refine for the pressure angle only once no curvature is.
    doubtful = measured.unsettled if measured.unsettled.any() else measured.unsteady
    return refined(angle, doubtful, 1.0) if doubtful.any() else None


def smallest_barrel(problem: CamProblem, follower: BarrelRoller, program: Program) -> Size | None:
    """Return the smallest radius of the cylinder, or the given one; None if curvature allows none."""
    if follower.cylinder_radius is not None:
        return Size(follower.cylinder_radius, proven=True)
    limits, v, roller = problem.limits, program.peaks[1], follower.roller_radius
    rise = math.tan(math.radians(limits.pressure_angle))
    fall = math.tan(math.radians(limits.falling_pressure_angle))
    # Pressure angle, hub and roller bound R directly; curvature needs the search over all cam angles below.
    # R ≥ |v|/tan φ for rise and fall separately, and at least hub and roller.
    least = max(v.greatest / rise, -v.least / fall, limits.hub_radius, roller)
    rho = least_pitch_radius(limits, roller)
    # Beyond this radius the unrolled curve is almost straight, so that curvature no longer decides.
    stop = MAX_RADIUS * (least + program.peaks[2].largest + rho)
    radius = smallest_allowed(program, _curvature(rho), least, stop)
    # The margin keeps rounding in the finished groove from breaking the limit.
    return None if radius is None else Size(radius * (1.0 + MARGIN), proven=True)


def _curvature(rho: float) -> Callable[[Motion, Real], Real]:
    """Return |κ| ρ − 1 as a function of motion and R."""

    def excess(motion: Motion, radius: Real) -> Real:
        return np.asarray(np.abs(motion.a) * radius * rho / (radius**2 + motion.v**2) ** 1.5 - 1.0)

    return excess


def _metrics(problem: CamProblem, program: Program, roller: float, measured: MeasuredBarrel) -> BarrelMetrics:
    """Return the metrics of the measured groove as the answer reports them."""
    least = reported(measured.least_radius)
    return BarrelMetrics(
        lift=program.lift,
        groove_width=2.0 * roller,
        length=measured.length,
        max_pressure_angle_rise=measured.rising,
        max_pressure_angle_fall=measured.falling,
        min_radius=least,
        curvature_ratio=least / roller,
        **motion_metrics(problem, program),
    )
