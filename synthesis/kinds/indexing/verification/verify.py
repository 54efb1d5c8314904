"""Verification of a Geneva drive: its roller is driven through its slots, its disc past its wheel.

Only the answer is used. Motion and forces follow from the roller's path (:mod:`synthesis.kinds.indexing.reactions`),
walls and distances from the outlines, and the work of the crank from an integral.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from kinematics.indexing.drag_link import compute_steady_share
from synthesis.kinds.indexing.clearance import MeasuredDrive, measure_drive
from synthesis.kinds.indexing.design import GenevaMechanism, IndexingDesign, SphericalGenevaMechanism
from synthesis.kinds.indexing.forces import Load
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.kinds.indexing.reactions import DrivenIndex, compute_crank_motion, drive_link, drive_roller
from synthesis.kinds.indexing.sphere import MIN_CAP_SHARE
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ACCELERATION, ANGLE, FORCE, LENGTH, TORQUE
from synthesis.verification.checks import check_error, check_maximum, check_minimum

ROUTE_TOLERANCE = 1e-9
"""Relative difference of closed forms from the driven geometry that is attributed to rounding."""

NODE_COUNT = 96
"""Number of nodes of Gauss's rule over half an index, for the work of the crank."""

SAMPLE_COUNT = 4001
"""Number of positions at which peaks are searched."""

PEAK_SHORTFALL = 1e-5
"""Maximum relative excess of a peak over the largest sample."""

REPORTED_ANGLE_TOLERANCE = 1e-6
"""Degrees by which a reported transmission angle may differ from that of the driven drag link."""

MIN_LOCKED_SHARE = 0.5
"""Minimum share of a rest over which the disc must hold the wheel in both directions; at the ends of a rest one side is
about to release it."""

MAX_PLAY_SHARE = 0.1
"""Maximum play of a locked wheel, as a share of half the angle between stations: beyond it the wheel is not held."""


def verify_indexing(problem: IndexingProblem, design: IndexingDesign) -> IndexingDesign:
    """Measure a drive against its problem.

    Parameters
    ----------
    problem : IndexingProblem
        The request.
    design : IndexingDesign
        The answer; its checks are replaced.

    Returns
    -------
    IndexingDesign
        With the checks of the measurements, and the angle over which the wheel is held.
    """
    load = Load(problem.load_inertia, problem.load_torque, problem.crank_speed)
    span = _compute_span(design)
    drive = drive_roller(design.mechanism, load, problem.scale, span[0] + np.radians(design.program.angle))
    crank = compute_crank_motion(design.mechanism, span[0] + np.radians(design.program.angle)).s
    outlines = measure_drive(design, 0.5 * float(crank[-1] - crank[0]))
    sampled = drive_roller(design.mechanism, load, problem.scale, np.linspace(*span, SAMPLE_COUNT))
    # Sampled independently of the program in the answer.
    steady = compute_steady_share(sampled.motion.v)
    checks = [
        check_error("reaches_next_station", _measure_station_error(design, drive), ROUTE_TOLERANCE),
        *_check_agreement(design, drive),
        *_check_energy(problem, design, load, span),
        *_check_peaks(design, sampled),
        *_check_walls(problem, design, outlines),
        check_error("steady_as_told", abs(steady - design.metrics.steady_share), ROUTE_TOLERANCE + 1.0 / SAMPLE_COUNT),
        *_check_constraints(problem, design, drive, steady),
    ]
    metrics = design.metrics.model_copy(update={"locking_angle": outlines.locked_angle, "play": outlines.play})
    return design.model_copy(update={"verification": Verification.from_checks(checks), "metrics": metrics})


def _compute_span(design: IndexingDesign) -> tuple[float, float]:
    """Return the input's angles, radians, at the entry and the exit of a roller."""
    link = design.mechanism.drag_link if isinstance(design.mechanism, GenevaMechanism) else None
    start = math.radians(-0.5 * design.index_angle if link is None else link.entry_angle)
    return start, start + math.radians(design.index_angle)


def _measure_station_error(design: IndexingDesign, drive: DrivenIndex) -> float:
    """Return the difference of the wheel's rotation from the angle between stations, radians."""
    return abs(float(drive.motion.s[-1] - drive.motion.s[0]) - 2.0 * math.pi / design.mechanism.stations)


def _measure_difference(reported: list[float], found: Real) -> float:
    """Return the maximum difference as a share of the maximum value; 0 if all are 0."""
    size = max(float(np.abs(found).max()), float(np.abs(reported).max()))
    return float(np.abs(np.array(reported) - found).max()) / size if size > 0.0 else 0.0


def _check_agreement(design: IndexingDesign, drive: DrivenIndex) -> list[Check]:
    program, course, motion = design.program, design.course, drive.motion
    turned = np.degrees(motion.s - motion.s[0])
    motion_off = [
        _measure_difference(program.s, turned),
        _measure_difference(program.v, motion.v),
        _measure_difference(program.a, motion.a),
    ]
    forces_off = [
        _measure_difference(course.wheel_torque, drive.wheel_torque),
        _measure_difference(course.drive_torque, drive.drive_torque),
        _measure_difference(course.pin_force, drive.pin_force),
    ]
    return [
        check_error("program_is_driven", max(*motion_off, _measure_difference(program.j, motion.j)), ROUTE_TOLERANCE),
        check_error("forces_by_reactions", max(forces_off), ROUTE_TOLERANCE),
    ]


def _check_energy(
    problem: IndexingProblem, design: IndexingDesign, load: Load, span: tuple[float, float]
) -> list[Check]:
    """Check that the input's work over the first half of an index equals the wheel's energy and work against load."""
    # Gauss quadrature over the first half of the index.
    nodes, weights = np.polynomial.legendre.leggauss(NODE_COUNT)
    start, half = span[0], 0.5 * (span[1] - span[0])
    through = drive_roller(design.mechanism, load, problem.scale, start + 0.5 * half * (nodes + 1.0))
    work = 0.5 * half * float(weights @ through.drive_torque)
    ends = drive_roller(design.mechanism, load, problem.scale, np.array([start, start + half])).motion
    gained = 0.5 * load.inertia * load.speed**2 * float(ends.v[1] ** 2 - ends.v[0] ** 2)
    # Kinetic energy plus the work against the load.
    gained += load.torque * float(ends.s[1] - ends.s[0])
    size = max(abs(work), abs(gained))
    return [check_error("energy_balance", abs(work - gained) / size if size > 0.0 else 0.0, ROUTE_TOLERANCE)]


def _check_peaks(design: IndexingDesign, found: DrivenIndex) -> list[Check]:
    """Check that no sample exceeds a reported peak, and that the largest sample is nearly as high."""
    metrics = design.metrics
    beside = [
        (metrics.peak_velocity, found.motion.v),
        (metrics.peak_acceleration, found.motion.a),
        (metrics.peak_jerk, found.motion.j),
        (metrics.peak_wheel_torque, found.wheel_torque),
        (metrics.peak_drive_torque, found.drive_torque),
        (metrics.peak_pin_force, found.pin_force),
    ]
    worst = 0.0
    for peak, values in beside:
        most = float(np.abs(values).max())
        if peak > 0.0:
            # One number covers both directions: above the peak by rounding, below it by the sampling.
            above = (most - peak) / peak
            worst = max(worst, above / ROUTE_TOLERANCE, -above / PEAK_SHORTFALL)
    return [check_maximum("peaks", worst, 1.0)]


def _check_walls(problem: IndexingProblem, design: IndexingDesign, found: MeasuredDrive) -> list[Check]:
    mechanism, metrics = design.mechanism, design.metrics
    size = metrics.size
    # Coordinates are rounded in proportion to the drive, not to the roller.
    rounding = ROUTE_TOLERANCE * max(1.0, size / mechanism.roller_diameter)
    # Errors of lengths are shares of the size.
    told = max(abs(found.wall - metrics.wall), abs(found.web - metrics.web)) / size
    checks = [
        check_error("walls_as_told", told, ROUTE_TOLERANCE),
        check_minimum("roller_in_slot", found.roller, 0.5 * mechanism.roller_diameter, LENGTH, rounding),
        check_error("disc_clears_wheel", found.overlap / size, ROUTE_TOLERANCE),
        check_minimum("locked_at_rest", found.locked, MIN_LOCKED_SHARE),
        check_maximum("play", found.play, MAX_PLAY_SHARE * 180.0 / mechanism.stations, ANGLE),
        check_minimum("wall", found.wall, problem.wall, LENGTH),
        check_minimum("web", found.web, problem.wall, LENGTH),
    ]
    least = 0.5 * mechanism.roller_diameter
    checks.append(check_minimum("roller_clears_wheel", found.passing, least, LENGTH, rounding))
    if isinstance(mechanism, SphericalGenevaMechanism):
        reaches = mechanism.cap_offset / (mechanism.sphere_radius * math.sin(math.radians(mechanism.cap_angle)))
        checks.append(check_maximum("locking_cap", reaches, MIN_CAP_SHARE))
    else:
        disc, ring = mechanism.disc, mechanism.ring_radius
        checks.append(check_minimum("locking_disc", max(disc.outer_radius), least, LENGTH, rounding))
    if mechanism.type == "geneva_internal":
        thinnest = float((np.array(disc.outer_radius) - np.array(disc.inner_radius)).min())
        assert ring is not None
        checks.append(
            check_minimum(
                "ring", ring - found.outmost, problem.wall, LENGTH, ROUTE_TOLERANCE * max(1.0, size / problem.wall)
            )
        )
        checks.append(check_minimum("crescent", thinnest, problem.wall, LENGTH, rounding))
    else:
        checks.append(check_minimum("bore", found.inmost - 0.5 * problem.wheel_shaft_diameter, problem.wall, LENGTH))
    if problem.crank_shaft_diameter > 0.0:
        checks.append(check_minimum("crank_shaft", found.neck, 0.5 * problem.crank_shaft_diameter, LENGTH))
    if not isinstance(mechanism, SphericalGenevaMechanism):
        checks.append(check_error("size_as_told", abs(found.size - size) / size, ROUTE_TOLERANCE))
    return checks


def _check_constraints(
    problem: IndexingProblem, design: IndexingDesign, drive: DrivenIndex, steady: float
) -> list[Check]:
    stated, metrics, checks = problem.constraints, design.metrics, []
    if stated.shock_free:
        checks.append(check_error("shock_free_entry", abs(float(drive.motion.v[0])), ROUTE_TOLERANCE))
    if stated.dwell_share is not None:
        # Each roller turns the wheel once per turn of the crank.
        share = 1.0 - design.mechanism.rollers * design.index_angle / 360.0
        if stated.dwell_share.min is not None:
            checks.append(check_minimum("min_dwell_share", share, stated.dwell_share.min))
        if stated.dwell_share.max is not None:
            checks.append(check_maximum("max_dwell_share", share, stated.dwell_share.max))
    if stated.steady_share is not None:
        checks.append(check_minimum("steady_share", steady, stated.steady_share))
    if metrics.min_transmission_angle is not None:
        measured_angle = _measure_transmission_angle(design)
        told = abs(measured_angle - metrics.min_transmission_angle)
        checks.append(check_error("transmission_as_told", told, REPORTED_ANGLE_TOLERANCE, ANGLE))
        checks.append(
            check_minimum("transmission_angle", measured_angle, problem.transmission_angle, ANGLE, ROUTE_TOLERANCE)
        )
    if stated.peak_acceleration is not None:
        limit = stated.peak_acceleration
        checks.append(check_maximum("peak_acceleration", metrics.peak_acceleration, limit, ACCELERATION))
    if stated.drive_torque is not None:
        checks.append(check_maximum("drive_torque", metrics.peak_drive_torque, stated.drive_torque, TORQUE))
    if stated.pin_force is not None:
        checks.append(check_maximum("pin_force", metrics.peak_pin_force, stated.pin_force, FORCE))
    if stated.size is not None:
        checks.append(check_maximum("size", metrics.size, stated.size, LENGTH))
    return checks


def _measure_transmission_angle(design: IndexingDesign) -> float:
    """Measure the drag link's minimum transmission angle, degrees: with the input aligned with the ground."""
    assert isinstance(design.mechanism, GenevaMechanism)
    link = design.mechanism.drag_link
    assert link is not None
    # The angle is extreme where crank and ground align.
    moved = drive_link(design.mechanism, np.array([0.0, math.pi]))
    return math.degrees(float(np.arcsin(np.abs(moved.sines["coupler"]).min())))
