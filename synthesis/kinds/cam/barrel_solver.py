"""Barrel cams: the smallest cylinder for a motion program, its groove, and their verification.

The pressure angle φ follows from tan φ = v/R, so that the peak velocities of rise and fall require R ≥ |v|/tan φ. The
unrolled pitch curve has the curvature a R/(R² + v²)^{3/2}. At every angle, its radius of curvature over the roller's
radius must be at least the required ratio.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from kinematics.arrays import Real
from kinematics.cam.barrel import BarrelCam
from kinematics.cam.motion.pieces import Motion
from kinematics.cam.motion.program import Program
from kinematics.message import compose
from synthesis.kinds.cam.answer import (
    build_empty_result,
    build_result,
    compute_motion_metrics,
    describe_joints,
    describe_segments,
    evaluate_optimality,
)
from synthesis.kinds.cam.design import BarrelCamDesign, BarrelMetrics, CamResult
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.profile import build_barrel_mechanism, choose_profile_angles, refine_angles
from synthesis.kinds.cam.program.composition import Composition
from synthesis.kinds.cam.program.radius_limits import compute_min_pitch_radius
from synthesis.kinds.cam.sizing.critical_points import find_smallest_allowed
from synthesis.kinds.cam.sizing.resolution import resolve_profile
from synthesis.kinds.cam.sizing.sizing import MAX_RADIUS, RADIUS_MARGIN, Size
from synthesis.kinds.cam.statement.followers import BarrelRoller
from synthesis.kinds.cam.verification.barrel import MeasuredBarrel, verify_barrel
from synthesis.kinds.cam.verification.reproduction import DISPLACEMENT_TOLERANCE, limit_reported
from synthesis.model.kind import Progress


def solve_barrel(problem: CamProblem, follower: BarrelRoller, composed: Composition, progress: Progress) -> CamResult:
    """Size, build and verify the barrel cam of a composed program."""
    program, roller = composed.program, follower.roller_radius
    size = size_barrel(problem, follower, program)
    if size is None:
        reason = compose("cam-no-cylinder-fits")
        return build_empty_result(problem, reason, composed.bound is None, "size")
    barrel = BarrelCam(program, size.radius, roller)
    progress(0.7, compose("cam-verifying"))

    # Both walls get points at the same angles, those of the wall that needs more points.
    walls = partial(barrel.wall, side=-1), partial(barrel.wall, side=1)
    angle = max((choose_profile_angles(program, wall, roller, problem.profile_points) for wall in walls), key=len)
    mechanism, verification, measured = resolve_profile(
        angle,
        partial(build_barrel_mechanism, barrel, problem.rotation),
        partial(verify_barrel, problem),
        _refine_angles,
        progress,
    )
    if measured is None:
        reason = compose("cam-groove-unresolved", roller=f"{roller:.6g}", cylinder=f"{size.radius:.6g}")
        return build_empty_result(problem, reason, False, "follower_can_be_laid_on")
    design = BarrelCamDesign(
        mechanism=mechanism,
        segments=describe_segments(problem, composed),
        joints=describe_joints(problem, program),
        optimality=evaluate_optimality(problem, composed, size.radius),
        verification=verification,
        metrics=_compute_metrics(problem, program, follower.roller_radius, measured),
    )
    progress(1.0, compose("cam-verified"))
    return build_result(problem, composed, design, size, ("cylinder", size.radius))


def _refine_angles(angle: Real, measured: MeasuredBarrel, failed: set[str]) -> Real | None:
    """Return a refined set of angles if the walls have too few points; None if more points do not help."""
    # A cusp is a property of the groove, not of its resolution.
    if "no_cusp" in failed:
        return None
    if any("reproduces" in name for name in failed):
        return refine_angles(angle, measured.off, DISPLACEMENT_TOLERANCE)
    # Refine stretches with unsettled curvature first. Refine for the pressure angle only if the curvature has settled.
    doubtful = measured.unsettled if measured.unsettled.any() else measured.unsteady
    return refine_angles(angle, doubtful, 1.0) if doubtful.any() else None


def size_barrel(problem: CamProblem, follower: BarrelRoller, program: Program) -> Size | None:
    """Return the smallest radius of the cylinder, or the given one; None if curvature allows none."""
    if follower.cylinder_radius is not None:
        return Size(follower.cylinder_radius, proven=True)
    limits, v, roller = problem.limits, program.peaks[1], follower.roller_radius
    rise = math.tan(math.radians(limits.pressure_angle))
    fall = math.tan(math.radians(limits.falling_pressure_angle))
    # Pressure angle, hub and roller bound R directly. Curvature needs the search over all cam angles below.
    # R ≥ |v|/tan φ for rise and fall separately, and at least hub and roller.
    least = max(v.greatest / rise, -v.least / fall, limits.hub_radius, roller)
    rho = compute_min_pitch_radius(limits, roller)
    # Beyond this radius the unrolled curve is almost straight, so that curvature is not the limit.
    stop = MAX_RADIUS * (least + program.peaks[2].largest + rho)
    radius = find_smallest_allowed(program, _make_curvature(rho), least, stop)
    # With the margin, rounding in the finished groove cannot break the limit.
    return None if radius is None else Size(radius * (1.0 + RADIUS_MARGIN), proven=True)


def _make_curvature(rho: float) -> Callable[[Motion, Real], Real]:
    """Return |κ| ρ − 1 as a function of motion and R."""

    def excess(motion: Motion, radius: Real) -> Real:
        return np.asarray(np.abs(motion.a) * radius * rho / (radius**2 + motion.v**2) ** 1.5 - 1.0)

    return excess


def _compute_metrics(problem: CamProblem, program: Program, roller: float, measured: MeasuredBarrel) -> BarrelMetrics:
    """Return the metrics of the measured groove as the answer reports them."""
    least = limit_reported(measured.least_radius)
    return BarrelMetrics(
        lift=program.lift,
        groove_width=2.0 * roller,
        length=measured.length,
        max_pressure_angle_rise=measured.rising,
        max_pressure_angle_fall=measured.falling,
        min_radius=least,
        curvature_ratio=least / roller,
        **compute_motion_metrics(problem, program),
    )
