"""Verification of a cam: its follower is laid against the finished profile, and its motion is measured.

Only the answer itself is used, none of the solver's other results. The points of the profile alone give
displacement, pressure angle and radius of curvature at cam angles four times as close as the design's; the
displacement is compared with the program's table and its quintic in between, and the table with the request: laws and
rests by the analysis core. Constraints of automatic and optimal motions (ends, conditions, bands, limits on velocity,
acceleration and jerk) are measured on the profile too (:mod:`synthesis.kinds.cam.measured_rates`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.contact import Contour
from kinematics.cam.finished import Worst, worst
from kinematics.cam.follower import Follower
from kinematics.errors import DimensionError, ShapeError
from synthesis.kinds.cam.design import CamMechanism
from synthesis.kinds.cam.followers import OscillatingRoller, TranslatingRoller
from synthesis.kinds.cam.limits import CamLimits
from synthesis.kinds.cam.measured_rates import rate_checks
from synthesis.kinds.cam.mechanism import core_follower, points_of, stretches_of
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.reproduction import FINER, TABLE_SLACK, Reproduction, reported
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.proof.checks import at_least, at_most

Real = NDArray[np.float64]

MEASURED_SLACK = 1e-5
"""Relative slack of limits on pressure angle, curvature and width. They are measured on a curve through points and
worsened by the possible error of that curve."""

NOT_LAID_ON = Check(name="follower_can_be_laid_on", passed=False)
"""Failed check of a profile that the follower cannot be laid against, or touches at other angles than its points'."""

UNSETTLED_SLACK = 2e-3
"""Relative slack of limits on curvature if a profile of very many short moves can have no more points."""

ROUNDED_SLACK = 2e-2
"""Maximum of this slack if the profile has spikes a millionth of a turn long, of a motion without a limit on its
acceleration, for which rounding of the points leaves the curvature few digits."""


@dataclass(frozen=True)
class Measured:
    """Measurements on the finished profile.

    Attributes
    ----------
    rising, falling : float
        Greatest pressure angles, degrees.
    convex_radius, concave_radius : float
        Least radii of curvature of the profile; infinite if no part is convex, or concave.
    curvature_ratio : float
        Least radius of curvature of the pitch curve over the roller's; infinite under a flat face.
    sweep : float
        Length on a flat face that the contact sweeps.
    radius : float
        Greatest radius of the profile.
    off : float64, shape (n,)
        Greatest deviation of the displacement from the program, from each of the n angles of its table to the next, as
        a share of the lift; NaN if the follower touches nothing.
    rounded : float
        Share of the greatest curvature by which it is made worse for the rounding of the points.
    unsettled : float64, shape (n,)
        Dependence of the curvature on the point spacing, from each angle to the next, as a multiple of the permitted
        one; 0 where the curvature cannot be greatest.
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


def verify(problem: CamProblem, mechanism: CamMechanism) -> tuple[Verification, Measured | None]:
    """Measure a cam against its problem.

    Parameters
    ----------
    problem : CamProblem
        The request.
    mechanism : CamMechanism
        The finished cam; its pitch curve is not used.

    Returns
    -------
    Verification, Measured or None
        None if the follower cannot be laid against the profile at all.
    """
    demanded = Reproduction.of(problem, mechanism.program)
    try:
        stretches = stretches_of(mechanism.program)
        contour = Contour(points_of(mechanism.profile), np.radians(mechanism.program.angle), stretches.breaks)
        follower = core_follower(mechanism)
        contact = contour.follow(follower, demanded.angle, mechanism.rotation)
    except (DimensionError, ShapeError):
        return Verification.of([NOT_LAID_ON]), None
    touches = bool(contact.valid.all())
    off = demanded.deviation(contact.s)
    checks = [
        *demanded.checks,
        Check(name="touches_everywhere", passed=touches),
        demanded.check("reproduces_program", off, touches),
        Check(name="no_cusp", passed=not contour.cusped),
        Check(name="does_not_cross_itself", passed=len(contour.crossings) == 0),
    ]
    if problem.closure == "form":
        wall_checks, wall_off = _groove_checks(mechanism, contour, follower, demanded)
        checks += wall_checks
        # The worse wall decides the refinement.
        off = np.maximum(off, wall_off)
    try:
        found = worst(contour, follower, mechanism.rotation, stretches)
    except DimensionError:
        # The points are out of the follower's reach at their own angles: the profile has no contacts to measure.
        return Verification.of([*checks, NOT_LAID_ON]), None
    measured = measured_of(found, mechanism.follower.roller_radius or 0.0, off)
    if touches:

        def measure(angle: Real) -> tuple[Real, Real]:
            along = contour.follow(follower, angle, mechanism.rotation)
            return along.s, along.v

        checks += rate_checks(problem, measure, demanded.lift, demanded.tolerance, float(off.max()))
        checks += _limit_checks(problem, mechanism, measured)
    return Verification.of(checks), measured


def measured_of(found: Worst, roller: float, off: Real) -> Measured:
    """Build the measurements from the worst places of a profile, for a roller's radius or 0 for a flat face."""
    convex = 1.0 / found.convex if found.convex > 0.0 else math.inf
    concave = 1.0 / found.concave if found.concave > 0.0 else math.inf
    return Measured(
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


def _groove_checks(
    mechanism: CamMechanism, contour: Contour, follower: Follower, demanded: Reproduction
) -> tuple[list[Check], Real]:
    """Check the roller against the outer wall, from within; also return its deviation from the program."""
    name, unmeasured = "outer_wall_reproduces_program", np.zeros(len(demanded.angle) // FINER)
    if mechanism.outer_wall is None:
        return [Check(name=name, passed=False)], unmeasured
    try:
        wall = Contour(points_of(mechanism.outer_wall), contour.at, contour.breaks)
        displacement = wall.within(follower, demanded.angle, mechanism.rotation)
    except (DimensionError, ShapeError):
        return [Check(name=name, passed=False)], unmeasured
    off = demanded.deviation(displacement)
    sound = not wall.cusped and len(wall.crossings) == 0
    return [
        demanded.check(name, off, bool(np.isfinite(displacement).all())),
        Check(name="outer_wall_is_sound", passed=sound),
    ], off


def _limit_checks(problem: CamProblem, mechanism: CamMechanism, measured: Measured) -> list[Check]:
    """Check the client's limits; the requested follower decides which of them apply, not the answer's."""
    limits, slack = problem.limits, curvature_slack(measured.unsettled, measured.rounded)
    if isinstance(problem.follower, TranslatingRoller | OscillatingRoller):
        checks = roller_checks(limits, measured.rising, measured.falling, measured.curvature_ratio, slack)
        size = mechanism.prime_radius or 0.0
    else:
        checks = [
            at_least("min_radius", reported(measured.convex_radius), limits.min_radius, LENGTH, slack),
            Check(name="convex", passed=math.isinf(measured.concave_radius)),
        ]
        if limits.face_width is not None:
            checks.append(at_most("face_width", measured.sweep, limits.face_width, LENGTH, MEASURED_SLACK))
        size = mechanism.base_radius or 0.0
    pivot = mechanism.follower.pivot_distance
    if pivot is not None:
        # The cam turns fully, so that its greatest radius passes the pivot of the arm.
        clear = measured.radius < pivot
        checks.append(Check(name="clears_pivot", passed=clear, value=measured.radius, limit=pivot, dimension=LENGTH))
    return [*checks, *size_checks(limits, size - (mechanism.follower.roller_radius or 0.0), size)]


def curvature_slack(unsettled: Real, rounded: float) -> float:
    """Return the relative slack of limits on curvature, from its dependence on point spacing and from rounding.

    Rounding may have worsened the curvature by as much as is added for it.
    """
    return UNSETTLED_SLACK if unsettled.any() else MEASURED_SLACK + min(2.0 * rounded, ROUNDED_SLACK)


def roller_checks(
    limits: CamLimits, rising: float, falling: float, curvature_ratio: float, slack: float
) -> list[Check]:
    """Check every roller's limits: pressure angles (degrees), and the least pitch-curve radius over the roller's."""
    return [
        at_most("pressure_angle", rising, limits.pressure_angle, ANGLE, MEASURED_SLACK),
        at_most("pressure_angle_fall", falling, limits.falling_pressure_angle, ANGLE, MEASURED_SLACK),
        at_least("curvature_ratio", reported(curvature_ratio), limits.curvature_ratio, slack=slack),
    ]


def size_checks(limits: CamLimits, hub: float, size: float) -> list[Check]:
    """Check the given limits on a cam's dimensions: the radius left for the hub, and the cam's own radius."""
    checks = []
    if limits.hub_radius > 0.0:
        checks.append(at_least("hub_radius", hub, limits.hub_radius, LENGTH, TABLE_SLACK))
    if limits.size is not None:
        checks.append(at_most("size", size, limits.size, LENGTH, TABLE_SLACK))
    return checks
