"""Verification of a cam: its follower is laid against the finished profile, and its motion is measured.

Only the answer itself is used, none of the solver's other results. The points of the profile alone give
displacement, pressure angle and radius of curvature at cam angles four times as close as the design's. The
displacement is compared with the program's table and with the quintic between its angles. The table is compared with
the request, using the analysis core for laws and dwells. Constraints of automatic and optimal motions (ends,
conditions, bands, limits on velocity, acceleration and jerk) are also measured on the profile
(:mod:`synthesis.kinds.cam.verification.rates`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real
from kinematics.cam.finished.contact import Contour
from kinematics.cam.finished.extreme_values import WorstValues, find_worst_values
from kinematics.cam.follower import Follower
from kinematics.errors import DimensionError, ShapeError
from synthesis.kinds.cam.design import CamMechanism
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.profile import build_core_follower, find_stretches, read_points
from synthesis.kinds.cam.statement.followers import OscillatingRoller, TranslatingRoller
from synthesis.kinds.cam.statement.limits import CamLimits
from synthesis.kinds.cam.verification.rates import check_rates
from synthesis.kinds.cam.verification.reproduction import REFINEMENT_FACTOR, TABLE_SLACK, Reproduction, limit_reported
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.verification.checks import check_maximum, check_minimum

MEASURED_SLACK = 1e-5
"""Relative slack of limits on pressure angle, curvature and width, which are measured on a curve through points. The
possible error of that curve is added to the measured values."""

NO_CONTACT_CHECK = Check(name="follower_can_be_laid_on", passed=False)
"""Failed check of a profile that the follower cannot be laid against, or touches at other angles than its points'."""

UNSETTLED_SLACK = 2e-3
"""Relative slack of limits on curvature if a profile of very many short moves can have no more points."""

ROUNDED_SLACK = 2e-2
"""Maximum of this slack if the profile has spikes a millionth of a turn long, of a motion without a limit on its
acceleration, for which rounding of the points leaves the curvature few digits."""


@dataclass(frozen=True)
class MeasuredProfile:
    """Measurements on the finished profile.

    Attributes
    ----------
    rising, falling : float
        Maximum pressure angles, degrees.
    convex_radius, concave_radius : float
        Minimum radii of curvature of the profile; infinite if no part is convex, or concave.
    curvature_ratio : float
        Minimum radius of curvature of the pitch curve over the roller's; infinite under a flat face.
    sweep : float
        Length on a flat face that the contact sweeps.
    radius : float
        Maximum radius of the profile.
    off : float64, shape (n,)
        Maximum deviation of the displacement from the program, from each of the n angles of its table to the next, as
        a share of the lift; NaN if the follower touches nothing.
    rounded : float
        Increase of the maximum curvature, as a share, that allows for the rounding of the points.
    unsettled : float64, shape (n,)
        Dependence of the curvature on the point spacing, from each angle to the next, as a multiple of the permitted
        one; 0 where the curvature cannot have its maximum.
    unsteady : float, shape (n,)
        The same for the pressure angle, or for the width of a face.
    """

    rising: float
    falling: float
    convex_radius: float
    concave_radius: float
    curvature_ratio: float
    sweep: float
    radius: float
    off: Real
    rounded: float
    unsettled: Real
    unsteady: Real


def verify(problem: CamProblem, mechanism: CamMechanism) -> tuple[Verification, MeasuredProfile | None]:
    """Measure a cam against its problem.

    Parameters
    ----------
    problem : CamProblem
        The request.
    mechanism : CamMechanism
        The finished cam; its pitch curve is not used.

    Returns
    -------
    verification : Verification
        The checks.
    measured : MeasuredProfile or None
        None if the follower cannot be laid against the profile at all.
    """
    demanded = Reproduction.from_program(problem, mechanism.program)
    try:
        stretches = find_stretches(mechanism.program)
        contour = Contour(read_points(mechanism.profile), np.radians(mechanism.program.angle), stretches.breaks)
        follower = build_core_follower(mechanism)
        contact = contour.follow(follower, demanded.angle, mechanism.rotation)
    except (DimensionError, ShapeError):
        return Verification.from_checks([NO_CONTACT_CHECK]), None
    touches = bool(contact.valid.all())
    off = demanded.deviation(contact.s)
    checks = [
        *demanded.checks,
        Check(name="touches_everywhere", passed=touches),
        demanded.check("reproduces_program", off, touches),
        Check(name="no_cusp", passed=not contour.has_cusp),
        Check(name="does_not_cross_itself", passed=len(contour.crossings) == 0),
    ]
    if problem.closure == "form":
        wall_checks, wall_off = _check_groove(mechanism, contour, follower, demanded)
        checks += wall_checks
        # The worse wall decides the refinement.
        off = np.maximum(off, wall_off)
    try:
        found = find_worst_values(contour, follower, mechanism.rotation, stretches)
    except DimensionError:
        # The follower cannot reach the points at their own angles, so that the profile has no contacts to measure.
        return Verification.from_checks([*checks, NO_CONTACT_CHECK]), None
    measured = build_measured_profile(found, mechanism.follower.roller_radius or 0.0, off)
    if touches:

        def measure(angle: Real) -> tuple[Real, Real]:
            along = contour.follow(follower, angle, mechanism.rotation)
            return along.s, along.v

        checks += check_rates(problem, measure, demanded.lift, demanded.tolerance, float(off.max()))
        checks += _check_limits(problem, mechanism, measured)
    return Verification.from_checks(checks), measured


def build_measured_profile(found: WorstValues, roller: float, off: Real) -> MeasuredProfile:
    """Build the measurements from the worst places of a profile, for a roller's radius or 0 for a flat face."""
    convex = 1.0 / found.convex if found.convex > 0.0 else math.inf
    concave = 1.0 / found.concave if found.concave > 0.0 else math.inf
    return MeasuredProfile(
        math.degrees(found.rising),
        math.degrees(found.falling),
        convex,
        concave,
        # The pitch curve runs one roller radius outside the profile.
        min(convex + roller, concave - roller) / roller if roller else math.inf,
        found.sweep,
        found.radius,
        off,
        found.rounded,
        found.unsettled,
        found.unsteady,
    )


def _check_groove(
    mechanism: CamMechanism, contour: Contour, follower: Follower, demanded: Reproduction
) -> tuple[list[Check], Real]:
    """Check the roller against the outer wall, from within; also return its deviation from the program."""
    name, unmeasured = "outer_wall_reproduces_program", np.zeros(len(demanded.angle) // REFINEMENT_FACTOR)
    if mechanism.outer_wall is None:
        return [Check(name=name, passed=False)], unmeasured
    try:
        wall = Contour(read_points(mechanism.outer_wall), contour.at, contour.breaks)
        displacement = wall.follow_inside(follower, demanded.angle, mechanism.rotation)
    except (DimensionError, ShapeError):
        return [Check(name=name, passed=False)], unmeasured
    off = demanded.deviation(displacement)
    sound = not wall.has_cusp and len(wall.crossings) == 0
    return [
        demanded.check(name, off, bool(np.isfinite(displacement).all())),
        Check(name="outer_wall_is_sound", passed=sound),
    ], off


def _check_limits(problem: CamProblem, mechanism: CamMechanism, measured: MeasuredProfile) -> list[Check]:
    """Check the client's limits; the requested follower decides which of them apply, not the answer's."""
    limits, slack = problem.limits, compute_curvature_slack(measured.unsettled, measured.rounded)
    if isinstance(problem.follower, TranslatingRoller | OscillatingRoller):
        checks = check_roller(limits, measured.rising, measured.falling, measured.curvature_ratio, slack)
        size = mechanism.prime_radius or 0.0
    else:
        checks = [
            check_minimum("min_radius", limit_reported(measured.convex_radius), limits.min_radius, LENGTH, slack),
            Check(name="convex", passed=math.isinf(measured.concave_radius)),
        ]
        if limits.face_width is not None:
            checks.append(check_maximum("face_width", measured.sweep, limits.face_width, LENGTH, MEASURED_SLACK))
        size = mechanism.base_radius or 0.0
    pivot = mechanism.follower.pivot_distance
    if pivot is not None:
        # The cam turns fully, so that its maximum radius passes the pivot of the arm.
        clear = measured.radius < pivot
        checks.append(Check(name="clears_pivot", passed=clear, value=measured.radius, limit=pivot, dimension=LENGTH))
    return [*checks, *check_sizes(limits, size - (mechanism.follower.roller_radius or 0.0), size)]


def compute_curvature_slack(unsettled: Real, rounded: float) -> float:
    """Return the relative slack of limits on curvature, from its dependence on point spacing and from rounding.

    Rounding may have increased the curvature by as much as the added allowance.
    """
    return UNSETTLED_SLACK if unsettled.any() else MEASURED_SLACK + min(2.0 * rounded, ROUNDED_SLACK)


def check_roller(limits: CamLimits, rising: float, falling: float, curvature_ratio: float, slack: float) -> list[Check]:
    """Check the limits of any roller: pressure angles (degrees), and pitch curve radius over roller radius."""
    return [
        check_maximum("pressure_angle", rising, limits.pressure_angle, ANGLE, MEASURED_SLACK),
        check_maximum("pressure_angle_fall", falling, limits.falling_pressure_angle, ANGLE, MEASURED_SLACK),
        check_minimum("curvature_ratio", limit_reported(curvature_ratio), limits.curvature_ratio, slack=slack),
    ]


def check_sizes(limits: CamLimits, hub: float, size: float) -> list[Check]:
    """Check the given limits on a cam's dimensions: the radius left for the hub, and the cam's own radius."""
    checks = []
    if limits.hub_radius > 0.0:
        checks.append(check_minimum("hub_radius", hub, limits.hub_radius, LENGTH, TABLE_SLACK))
    if limits.size is not None:
        checks.append(check_maximum("size", size, limits.size, LENGTH, TABLE_SLACK))
    return checks
