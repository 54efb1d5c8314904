"""Verification of a Geneva drive: its roller is driven through its slots, its disc past its wheel.

Nothing but the answer is used: motion and forces follow from the roller's path
(:mod:`synthesis.kinds.indexing.reactions`), walls and distances from the outlines, the work of the crank from an
integral.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.indexing.drag_link import steady_share
from synthesis.kinds.indexing.clearance import Measured, measured
from synthesis.kinds.indexing.design import GenevaMechanism, IndexingDesign, SphericalGenevaMechanism
from synthesis.kinds.indexing.forces import Load
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.kinds.indexing.reactions import Driven, crank_motion, driven, driven_link
from synthesis.kinds.indexing.sphere import LEAST_CAP
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ACCELERATION, ANGLE, FORCE, LENGTH, TORQUE
from synthesis.proof.checks import at_least, at_most, tolerated

Real = NDArray[np.float64]

AGREES = 1e-9
"""Relative difference of closed forms from the driven geometry that is attributed to rounding."""

NODES = 96
"""Number of nodes of Gauss's rule over half an index, for the work of the crank."""

SAMPLED = 4001
"""Number of positions at which peaks are searched."""

BELOW = 1e-5
"""Share by which a peak may exceed the greatest sample."""

AS_TOLD = 1e-6
"""Degrees by which a reported transmission angle may differ from that of the driven drag link."""

LOCKED = 0.5
"""Minimum share of a rest over which the disc must hold the wheel in both directions; at the ends of a rest one side is
about to release it."""

MOST_PLAY = 0.1
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
    span = _span(design)
    drive = driven(design.mechanism, load, problem.scale, span[0] + np.radians(design.program.angle))
    crank = crank_motion(design.mechanism, span[0] + np.radians(design.program.angle)).s
    outlines = measured(design, 0.5 * float(crank[-1] - crank[0]))
    sampled = driven(design.mechanism, load, problem.scale, np.linspace(*span, SAMPLED))
    # Sampled independently of the program in the answer.
    steady = steady_share(sampled.motion.v)
    checks = [
        tolerated("reaches_next_station", _station_error(design, drive), AGREES),
        *_agreement(design, drive),
        *_energy(problem, design, load, span),
        *_peaks(design, sampled),
        *_walls(problem, design, outlines),
        tolerated("steady_as_told", abs(steady - design.metrics.steady_share), AGREES + 1.0 / SAMPLED),
        *_constraints(problem, design, drive, steady),
    ]
    metrics = design.metrics.model_copy(update={"locking_angle": outlines.locked_angle, "play": outlines.play})
    return design.model_copy(update={"verification": Verification.of(checks), "metrics": metrics})


def _span(design: IndexingDesign) -> tuple[float, float]:
    """Return the input's angles, radians, at the entry and the exit of a roller."""
    link = getattr(design.mechanism, "drag_link", None)
    start = math.radians(-0.5 * design.index_angle if link is None else link.entry_angle)
    return start, start + math.radians(design.index_angle)


def _station_error(design: IndexingDesign, drive: Driven) -> float:
    """Return the difference of the wheel's rotation from the angle between stations, radians."""
    return abs(float(drive.motion.s[-1] - drive.motion.s[0]) - 2.0 * math.pi / design.mechanism.stations)


def _off(told: list[float], found: Real) -> float:
    """Return the greatest difference as a share of the greatest value; 0 if all are 0."""
    size = max(float(np.abs(found).max()), float(np.abs(told).max()))
    return float(np.abs(np.array(told) - found).max()) / size if size > 0.0 else 0.0


def _agreement(design: IndexingDesign, drive: Driven) -> list[Check]:
    program, course, motion = design.program, design.course, drive.motion
    turned = np.degrees(motion.s - motion.s[0])
    motion_off = [_off(program.s, turned), _off(program.v, motion.v), _off(program.a, motion.a)]
    forces_off = [
        _off(course.wheel_torque, drive.wheel_torque),
        _off(course.drive_torque, drive.drive_torque),
        _off(course.pin_force, drive.pin_force),
    ]
    return [
        tolerated("program_is_driven", max(*motion_off, _off(program.j, motion.j)), AGREES),
        tolerated("forces_by_reactions", max(forces_off), AGREES),
    ]


def _energy(problem: IndexingProblem, design: IndexingDesign, load: Load, span: tuple[float, float]) -> list[Check]:
    """Check that the input's work over the first half of an index equals the wheel's energy and work against load."""
    # Gauss quadrature over the first half of the index.
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    start, half = span[0], 0.5 * (span[1] - span[0])
    through = driven(design.mechanism, load, problem.scale, start + 0.5 * half * (nodes + 1.0))
    work = 0.5 * half * float(weights @ through.drive_torque)
    ends = driven(design.mechanism, load, problem.scale, np.array([start, start + half])).motion
    gained = 0.5 * load.inertia * load.speed**2 * float(ends.v[1] ** 2 - ends.v[0] ** 2)
    # Kinetic energy plus the work against the load.
    gained += load.torque * float(ends.s[1] - ends.s[0])
    size = max(abs(work), abs(gained))
    return [tolerated("energy_balance", abs(work - gained) / size if size > 0.0 else 0.0, AGREES)]


def _peaks(design: IndexingDesign, found: Driven) -> list[Check]:
    """Check that no sample exceeds a peak, and that the greatest is nearly as high."""
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
            # Both directions share one number: above by rounding, below by the sampling.
            above = (most - peak) / peak
            worst = max(worst, above / AGREES, -above / BELOW)
    return [at_most("peaks", worst, 1.0)]


def _walls(problem: IndexingProblem, design: IndexingDesign, found: Measured) -> list[Check]:
    mechanism, metrics = design.mechanism, design.metrics
    size = metrics.size
    # Coordinates are rounded in proportion to the drive, not to the roller.
    rounding = AGREES * max(1.0, size / mechanism.roller_diameter)
    # Errors of lengths are shares of the size.
    told = max(abs(found.wall - metrics.wall), abs(found.web - metrics.web)) / size
    checks = [
        tolerated("walls_as_told", told, AGREES),
        at_least("roller_in_slot", found.roller, 0.5 * mechanism.roller_diameter, LENGTH, rounding),
        tolerated("disc_clears_wheel", found.overlap / size, AGREES),
        at_least("locked_at_rest", found.locked, LOCKED),
        at_most("play", found.play, MOST_PLAY * 180.0 / mechanism.stations, ANGLE),
        at_least("wall", found.wall, problem.wall, LENGTH),
        at_least("web", found.web, problem.wall, LENGTH),
    ]
    least = 0.5 * mechanism.roller_diameter
    checks.append(at_least("roller_clears_wheel", found.passing, least, LENGTH, rounding))
    if isinstance(mechanism, SphericalGenevaMechanism):
        reaches = mechanism.cap_offset / (mechanism.sphere_radius * math.sin(math.radians(mechanism.cap_angle)))
        checks.append(at_most("locking_cap", reaches, LEAST_CAP))
    else:
        disc, ring = mechanism.disc, mechanism.ring_radius
        checks.append(at_least("locking_disc", max(disc.outer_radius), least, LENGTH, rounding))
    if mechanism.type == "geneva_internal":
        thinnest = float((np.array(disc.outer_radius) - np.array(disc.inner_radius)).min())
        assert ring is not None
        checks.append(
            at_least("ring", ring - found.outmost, problem.wall, LENGTH, AGREES * max(1.0, size / problem.wall))
        )
        checks.append(at_least("crescent", thinnest, problem.wall, LENGTH, rounding))
    else:
        checks.append(at_least("bore", found.inmost - 0.5 * problem.wheel_shaft_diameter, problem.wall, LENGTH))
    if problem.crank_shaft_diameter > 0.0:
        checks.append(at_least("crank_shaft", found.neck, 0.5 * problem.crank_shaft_diameter, LENGTH))
    if not isinstance(mechanism, SphericalGenevaMechanism):
        checks.append(tolerated("size_as_told", abs(found.size - size) / size, AGREES))
    return checks


def _constraints(problem: IndexingProblem, design: IndexingDesign, drive: Driven, steady: float) -> list[Check]:
    stated, metrics, checks = problem.constraints, design.metrics, []
    if stated.shock_free:
        checks.append(tolerated("shock_free_entry", abs(float(drive.motion.v[0])), AGREES))
    if stated.dwell_share is not None:
        # Each roller turns the wheel once per turn of the crank.
        share = 1.0 - design.mechanism.rollers * design.index_angle / 360.0
        if stated.dwell_share.min is not None:
            checks.append(at_least("min_dwell_share", share, stated.dwell_share.min))
        if stated.dwell_share.max is not None:
            checks.append(at_most("max_dwell_share", share, stated.dwell_share.max))
    if stated.steady_share is not None:
        checks.append(at_least("steady_share", steady, stated.steady_share))
    if metrics.min_transmission_angle is not None:
        measured_angle = _transmission_angle(design)
        told = abs(measured_angle - metrics.min_transmission_angle)
        checks.append(tolerated("transmission_as_told", told, AS_TOLD, ANGLE))
        checks.append(at_least("transmission_angle", measured_angle, problem.transmission_angle, ANGLE, AGREES))
    if stated.peak_acceleration is not None:
        limit = stated.peak_acceleration
        checks.append(at_most("peak_acceleration", metrics.peak_acceleration, limit, ACCELERATION))
    if stated.drive_torque is not None:
        checks.append(at_most("drive_torque", metrics.peak_drive_torque, stated.drive_torque, TORQUE))
    if stated.pin_force is not None:
        checks.append(at_most("pin_force", metrics.peak_pin_force, stated.pin_force, FORCE))
    if stated.size is not None:
        checks.append(at_most("size", metrics.size, stated.size, LENGTH))
    return checks


def _transmission_angle(design: IndexingDesign) -> float:
    """Measure the drag link's least transmission angle, degrees: with the input aligned with the ground."""
    assert isinstance(design.mechanism, GenevaMechanism)
    link = design.mechanism.drag_link
    assert link is not None
    # The angle is extreme where crank and ground align.
    moved = driven_link(design.mechanism, np.array([0.0, math.pi]))
    return math.degrees(float(np.arcsin(np.abs(moved.sines["coupler"]).min())))
