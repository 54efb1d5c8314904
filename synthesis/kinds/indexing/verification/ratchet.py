"""Verification of a ratchet: its outline is turned under its pawls, and the forces of held teeth are summed.

Only the outline's corners, the pivots and the noses are used. They give the stops of a turn with the number of pawls
at each, the total torque of the pawls, and the lift of a pawl by a passing tooth. It is also checked that a pawl is
drawn in from every point of a face, and that it falls to the foot.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from kinematics.arrays import Complex
from kinematics.indexing.ratchet import Ratchet
from synthesis.kinds.indexing.design import RatchetDesign, RatchetMechanism, RatchetMetrics
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ANGLE, FORCE, LENGTH
from synthesis.verification.checks import check_error, check_maximum, check_minimum

ROUTE_TOLERANCE = 1e-9
"""Relative difference of closed forms from the outline that is attributed to rounding."""

REPORTED_ANGLE_TOLERANCE = 1e-6
"""Degrees by which reported angles may differ from those of the outline."""

BISECTION_COUNT = 50
"""Number of bisections of a pitch, for the angle at which a tip leaves the nose."""

FACE_POINT_COUNT, POSITIONS_PER_PITCH = 33, 121
"""Number of points of a face, and of positions of a pitch."""


def verify_ratchet(problem: IndexingProblem, design: RatchetDesign) -> RatchetDesign:
    """Measure a ratchet against its problem; its checks are replaced."""
    mechanism, metrics = design.mechanism, design.metrics
    feet, tips = _read_corners(mechanism)
    pivots, noses = _read_pawls(mechanism)
    locking = _measure_locking_angle(feet, tips, pivots, noses)
    friction = math.degrees(math.atan(problem.pawl.friction))
    stated = problem.constraints
    root = float(np.abs(feet).min())
    checks = [
        *_check_stops(mechanism, feet, noses),
        check_error("locking_as_told", abs(locking - metrics.locking_angle), REPORTED_ANGLE_TOLERANCE, ANGLE),
        check_minimum("locking_angle", locking, friction + problem.pawl.reserve, ANGLE),
        check_error("holds_the_torque", _measure_torque_error(problem, design, feet, tips), ROUTE_TOLERANCE),
        check_error("pawl_rides", _measure_ride_error(mechanism, metrics.overtravel), ROUTE_TOLERANCE),
        *_check_reported_angles(mechanism, metrics, tips, pivots, noses),
        Check(name="falls_in", passed=_is_open_behind_tip(mechanism, feet, tips)),
        check_minimum("tooth_thickness", float(np.abs(np.diff(feet)).min()), problem.wall, LENGTH),
        check_minimum("bore", root - 0.5 * problem.wheel_shaft_diameter, problem.wall, LENGTH),
    ]
    if stated.pin_force is not None:
        checks.append(check_maximum("pin_force", metrics.tooth_force, stated.pin_force, FORCE))
    if stated.size is not None:
        checks.append(check_maximum("size", 2.0 * float(np.abs(tips).max()), stated.size, LENGTH))
    return design.model_copy(update={"verification": Verification.from_checks(checks)})


def _read_corners(mechanism: RatchetMechanism) -> tuple[Complex, Complex]:
    """Return feet and tips in turn around the wheel, as the first pawl holds it."""
    outline = np.array(mechanism.profile.x) + 1j * np.array(mechanism.profile.y)
    return outline[0::2], outline[1::2]


def _read_pawls(mechanism: RatchetMechanism) -> tuple[Complex, Complex]:
    return (
        np.array([complex(*pawl.pivot) for pawl in mechanism.pawls]),
        np.array([complex(*pawl.nose) for pawl in mechanism.pawls]),
    )


def _check_stops(mechanism: RatchetMechanism, feet: Complex, noses: Complex) -> list[Check]:
    """Check the wheel's angles with a foot at a nose: equally spaced, each held by the reported number of pawls."""
    turns = np.mod(np.angle(noses[:, None] / feet), 2.0 * math.pi)
    off = float(np.abs(np.abs(noses)[:, None] - np.abs(feet)).max()) / mechanism.wheel_radius
    step = 2.0 * math.pi / mechanism.stations
    # Index of the stop at which a foot meets a nose.
    number = np.round(turns / step)
    off = max(off, float(np.abs(turns - number * step).max()))
    # Number of pawls at every stop.
    held = np.bincount(np.mod(number.astype(int), mechanism.stations).ravel(), minlength=mechanism.stations)
    return [
        check_error("equal_stops", off, ROUTE_TOLERANCE),
        check_minimum("pawls_at_every_stop", float(held.min()), float(mechanism.overlap)),
    ]


def _measure_locking_angle(feet: Complex, tips: Complex, pivots: Complex, noses: Complex) -> float:
    """Measure the minimum angle, degrees, from the pivot's line to the face's normal, over the held face."""
    # With the first tooth held by the first pawl.
    points = feet[0] + (tips[0] - feet[0]) * np.linspace(0.0, 1.0, FACE_POINT_COUNT)
    normal = (tips[0] - feet[0]) * -1j
    to_pivot = pivots[0] - points
    # Clockwise from the line to the pivot is towards the wheel.
    return math.degrees(float(np.angle(to_pivot / normal).min()))


def _measure_torque_error(problem: IndexingProblem, design: RatchetDesign, feet: Complex, tips: Complex) -> float:
    """Compare the moment of the reported force at the middle of each held face with the torque."""
    middle, along = 0.5 * (feet[0] + tips[0]), (tips[0] - feet[0]) / abs(tips[0] - feet[0])
    push = 1j * along * design.metrics.tooth_force
    moment = problem.scale * (middle.conjugate() * push).imag * design.mechanism.overlap
    size = max(abs(moment), problem.load_torque)
    return abs(moment - problem.load_torque) / size if size > 0.0 else 0.0


def _measure_ride_error(mechanism: RatchetMechanism, overtravel: float) -> float:
    """Compare the nose's circle cut with the edges of the turning outline to the closed form, radians."""
    wheel = Ratchet(
        mechanism.teeth,
        mechanism.wheel_radius,
        mechanism.tooth_height,
        math.radians(mechanism.face_angle),
        mechanism.pawl_length,
    )
    pitch, start = 2.0 * math.pi / mechanism.teeth, math.radians(overtravel)
    angle = start + pitch * (np.arange(POSITIONS_PER_PITCH) + 0.5) / POSITIONS_PER_PITCH
    outline = np.array(mechanism.profile.x) + 1j * np.array(mechanism.profile.y)
    pivots, noses = _read_pawls(mechanism)
    # The back that comes to the first foot from the tip behind it, and its neighbours.
    corners = np.roll(outline, 5)[:8]
    begin = corners[:-1] * np.exp(1j * angle)[:, None] - pivots[0]
    edge = np.diff(corners) * np.exp(1j * angle)[:, None]
    a, b = np.abs(edge) ** 2, (begin * edge.conj()).real
    c = np.abs(begin) ** 2 - abs(noses[0] - pivots[0]) ** 2
    # Discriminant of the circle's intersection with the line of each edge.
    square = b * b - a * c
    root = np.sqrt(np.maximum(square, 0.0))
    lifts = []
    for share in ((-b - root) / a, (-b + root) / a):
        lift = np.angle((noses[0] - pivots[0]) * (begin + share * edge).conj())
        cut = (square >= 0.0) & (share >= 0.0) & (share <= 1.0) & (np.abs(lift) < 0.5 * math.pi)
        lifts.append(np.where(cut, lift, -math.pi))
    outermost = np.maximum(*lifts).max(axis=1)
    return float(np.abs(outermost - wheel.pawl_lift(angle)).max())


def _check_reported_angles(
    mechanism: RatchetMechanism, metrics: RatchetMetrics, tips: Complex, pivots: Complex, noses: Complex
) -> list[Check]:
    """Check, by bisection, the angle at which the held tip leaves the nose's circle, and the pawl's lift there."""
    nose = noses[0] - pivots[0]
    low, high = 0.0, 2.0 * math.pi / mechanism.teeth
    for _ in range(BISECTION_COUNT):
        middle = 0.5 * (low + high)
        if abs(tips[0] * cmath.exp(1j * middle) - pivots[0]) < abs(nose):
            low = middle
        else:
            high = middle
    lift = abs(cmath.phase((tips[0] * cmath.exp(1j * high) - pivots[0]) / nose))
    return [
        check_error(
            "overtravel_as_told", abs(math.degrees(high) - metrics.overtravel), REPORTED_ANGLE_TOLERANCE, ANGLE
        ),
        check_error("lift_as_told", abs(math.degrees(lift) - metrics.lift), REPORTED_ANGLE_TOLERANCE, ANGLE),
    ]


def _is_open_behind_tip(mechanism: RatchetMechanism, feet: Complex, tips: Complex) -> bool:
    """Return whether the space behind the tip is open for a nose that leaves it: the back falls down to the foot."""
    back = np.roll(tips, 1) - feet
    return bool((back * feet.conj()).real.min() > 0.0) and len(feet) == mechanism.teeth
