"""Verification of a ratchet: its outline is turned under its pawls, and the forces of held teeth are summed.

From the outline's corners, the pivots and the noses alone: the stops of a turn and the number of pawls at each;
that a pawl is drawn in from every point of a face; the total torque of the pawls; the lift of a pawl by a passing
tooth, and that it falls to the foot.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
from numpy.typing import NDArray

from kinematics.indexing.ratchet import Ratchet
from synthesis.kinds.indexing.design import RatchetDesign, RatchetMechanism, RatchetMetrics
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ANGLE, FORCE, LENGTH
from synthesis.proof.checks import at_least, at_most, tolerated

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]

AGREES = 1e-9
"""Relative difference of closed forms from the outline that is attributed to rounding."""

AS_TOLD = 1e-6
"""Degrees by which reported angles may differ from those of the outline."""

HALVINGS = 50
"""Number of bisections of a pitch, for the angle at which a tip leaves the nose."""

ON_FACE, RIDDEN = 33, 121
"""Number of points of a face, and of positions of a pitch."""


def verify_ratchet(problem: IndexingProblem, design: RatchetDesign) -> RatchetDesign:
    """Measure a ratchet against its problem; its checks are replaced."""
    mechanism, metrics = design.mechanism, design.metrics
    feet, tips = _corners(mechanism)
    pivots, noses = _pawls(mechanism)
    locking = _locking(feet, tips, pivots, noses)
    friction = math.degrees(math.atan(problem.pawl.friction))
    stated = problem.constraints
    root = float(np.abs(feet).min())
    checks = [
        *_stops(mechanism, feet, noses),
        tolerated("locking_as_told", abs(locking - metrics.locking_angle), AS_TOLD, ANGLE),
        at_least("locking_angle", locking, friction + problem.pawl.reserve, ANGLE),
        tolerated("holds_the_torque", _torque_error(problem, design, feet, tips), AGREES),
        tolerated("pawl_rides", _ride_error(mechanism, metrics.overtravel), AGREES),
        *_told(mechanism, metrics, tips, pivots, noses),
        Check(name="falls_in", passed=_falls_in(mechanism, feet, tips)),
        at_least("tooth_thickness", float(np.abs(np.diff(feet)).min()), problem.wall, LENGTH),
        at_least("bore", root - 0.5 * problem.wheel_shaft_diameter, problem.wall, LENGTH),
    ]
    if stated.pin_force is not None:
        checks.append(at_most("pin_force", metrics.tooth_force, stated.pin_force, FORCE))
    if stated.size is not None:
        checks.append(at_most("size", 2.0 * float(np.abs(tips).max()), stated.size, LENGTH))
    return design.model_copy(update={"verification": Verification.of(checks)})


def _corners(mechanism: RatchetMechanism) -> tuple[Complex, Complex]:
    """Return feet and tips in turn around the wheel, as the first pawl holds it."""
    outline = np.array(mechanism.profile.x) + 1j * np.array(mechanism.profile.y)
    return outline[0::2], outline[1::2]


def _pawls(mechanism: RatchetMechanism) -> tuple[Complex, Complex]:
    return (
        np.array([complex(*pawl.pivot) for pawl in mechanism.pawls]),
        np.array([complex(*pawl.nose) for pawl in mechanism.pawls]),
    )


def _stops(mechanism: RatchetMechanism, feet: Complex, noses: Complex) -> list[Check]:
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
        tolerated("equal_stops", off, AGREES),
        at_least("pawls_at_every_stop", float(held.min()), float(mechanism.overlap)),
    ]


def _locking(feet: Complex, tips: Complex, pivots: Complex, noses: Complex) -> float:
    """Measure the least angle, degrees, from the pivot's line to the face's normal, over the held face."""
    # With the first tooth held by the first pawl.
    points = feet[0] + (tips[0] - feet[0]) * np.linspace(0.0, 1.0, ON_FACE)
    normal = (tips[0] - feet[0]) * -1j
    to_pivot = pivots[0] - points
    # Clockwise from the line to the pivot is towards the wheel.
    return math.degrees(float(np.angle(to_pivot / normal).min()))


def _torque_error(problem: IndexingProblem, design: RatchetDesign, feet: Complex, tips: Complex) -> float:
    """Compare the moment of the reported force at the middle of each held face with the torque."""
    middle, along = 0.5 * (feet[0] + tips[0]), (tips[0] - feet[0]) / abs(tips[0] - feet[0])
    push = 1j * along * design.metrics.tooth_force
    moment = problem.scale * (middle.conjugate() * push).imag * design.mechanism.overlap
    size = max(abs(moment), problem.load_torque)
    return abs(moment - problem.load_torque) / size if size > 0.0 else 0.0


def _ride_error(mechanism: RatchetMechanism, overtravel: float) -> float:
    """Compare the nose's circle cut with the edges of the turning outline to the closed form, radians."""
    wheel = Ratchet(
        mechanism.teeth,
        mechanism.wheel_radius,
        mechanism.tooth_height,
        math.radians(mechanism.face_angle),
        mechanism.pawl_length,
    )
    pitch, start = 2.0 * math.pi / mechanism.teeth, math.radians(overtravel)
    angle = start + pitch * (np.arange(RIDDEN) + 0.5) / RIDDEN
    outline = np.array(mechanism.profile.x) + 1j * np.array(mechanism.profile.y)
    pivots, noses = _pawls(mechanism)
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
    return float(np.abs(outermost - wheel.lifted(angle)).max())


def _told(
    mechanism: RatchetMechanism, metrics: RatchetMetrics, tips: Complex, pivots: Complex, noses: Complex
) -> list[Check]:
    """Check, by bisection, the angle at which the held tip leaves the nose's circle, and the pawl's lift there."""
    nose = noses[0] - pivots[0]
    low, high = 0.0, 2.0 * math.pi / mechanism.teeth
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if abs(tips[0] * cmath.exp(1j * middle) - pivots[0]) < abs(nose):
            low = middle
        else:
            high = middle
    lift = abs(cmath.phase((tips[0] * cmath.exp(1j * high) - pivots[0]) / nose))
    return [
        tolerated("overtravel_as_told", abs(math.degrees(high) - metrics.overtravel), AS_TOLD, ANGLE),
        tolerated("lift_as_told", abs(math.degrees(lift) - metrics.lift), AS_TOLD, ANGLE),
    ]


def _falls_in(mechanism: RatchetMechanism, feet: Complex, tips: Complex) -> bool:
    """Return whether a nose off the tip finds the space behind it open: the back falls all the way to the foot."""
    back = np.roll(tips, 1) - feet
    return bool((back * feet.conj()).real.min() > 0.0) and len(feet) == mechanism.teeth
