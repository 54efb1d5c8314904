"""Indexing drives: for each number of rollers the drive of given size, or the smallest within the constraints."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from kinematics.indexing.drag_link import CrankCourse, compute_steady_share
from kinematics.indexing.geneva import Geneva
from kinematics.message import compose
from synthesis.kinds.indexing import plane, sphere
from synthesis.kinds.indexing.design import (
    GenevaMechanism,
    IndexingCourse,
    IndexingDesign,
    IndexingMetrics,
    IndexingProgram,
    IndexingResult,
    RatchetDesign,
    SizedBy,
    SphericalGenevaMechanism,
)
from synthesis.kinds.indexing.driver import find_best_course
from synthesis.kinds.indexing.forces import Load, compute_pin_force, compute_wheel_torque, find_peaks
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.kinds.indexing.ratchet import solve_ratchet
from synthesis.kinds.indexing.smallest import enlarge_until_verified, find_smallest
from synthesis.kinds.indexing.verification.verify import verify_indexing
from synthesis.model.answer import Verification
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import NUMERICAL_REASONS, CandidateLog
from synthesis.results.remarks import append_remark, write_name, write_quantity

PROGRAM_POINT_COUNT = 361
"""Number of positions of a program."""

UNPROVEN_REASONS = NUMERICAL_REASONS | {
    "no_drag_link_found",
    "reaches_next_station",
    "program_is_driven",
    "forces_by_reactions",
    "energy_balance",
    "peaks",
    "walls_as_told",
    "size_as_told",
    "steady_as_told",
    "ring",
    "wall",
    "disc_clears_wheel",
    "roller_in_slot",
    "roller_clears_wheel",
    "locked_at_rest",
    "play",
}
"""Reasons of rejection that depend on outlines of finite steps or on rounding, so that an empty answer is no proof."""

STEADY_SAMPLES = 4001
"""Number of positions of an index at which the steadiness of the wheel is evaluated."""

METHODS = {"crank": "closed_form", "drag_link": "random draws and descent"}
"""Search methods of answers, by driver."""

NO_DRAG_LINK = "no_drag_link_found"
"""Reason if no tried drag link keeps the constraints."""

NOT_DRAWABLE = "no_room_for_walls"
"""Reason if the walls leave no valid outline."""


def solve_indexing(problem: IndexingProblem, progress: Progress) -> IndexingResult:
    """Solve a problem of indexing drives.

    Returns
    -------
    IndexingResult
        One design for each number of rollers that keeps the constraints. With a plain crank the answer is complete,
        since each number has one drive of the given size, or one smallest drive. ``summary`` gives the obstacle if
        there is no design.
    """
    if problem.drive == "ratchet":
        return solve_ratchet(problem, progress)
    sifting = CandidateLog[IndexingDesign | RatchetDesign](problem)
    numbers = range(1, problem.most_rollers + 1) if problem.rollers is None else [problem.rollers]
    progress(0.0, compose("indexing-sizing"))
    sifting.verify_candidates(numbers, partial(_build_candidate, problem))
    progress(1.0, compose("results-verified"))
    designs = sifting.select_designs(lambda found: found)
    # The best drag link is searched, not enumerated.
    complete = problem.driver == "crank" and not UNPROVEN_REASONS & sifting.rejected.keys()
    return IndexingResult(
        designs=designs,
        search=sifting.build_search(METHODS[problem.driver], complete=complete),
        summary=_write_summary(problem, sifting, complete),
    )


def _drive(problem: IndexingProblem) -> Geneva:
    assert problem.drive != "ratchet"
    if problem.spherical:
        # Spherical drives have no other crank.
        return Geneva.shock_free(problem.drive, problem.stations)
    return Geneva(problem.drive, problem.stations, problem.crank_ratio)


def _build_candidate(problem: IndexingProblem, rollers: int) -> IndexingDesign | str:
    """Build the drive with a number of rollers, verified; the reason if it cannot be drawn."""
    drive = _drive(problem)
    course = CrankCourse(drive) if problem.driver == "crank" else find_best_course(problem, drive)
    if course is None:
        return NO_DRAG_LINK
    # A given size is used as it is; otherwise the smallest is searched.
    stated = problem.sphere_radius if problem.spherical else problem.center_distance
    if stated is not None:
        return _build_of_size(problem, course, rollers, stated, None)
    found = find_smallest(problem, course, _build_load(problem))
    if found is None:
        return NOT_DRAWABLE
    return enlarge_until_verified(found, partial(_build_of_size, problem, course, rollers))


def _build_load(problem: IndexingProblem) -> Load:
    return Load(problem.load_inertia, problem.load_torque, problem.crank_speed)


def _build_of_size(
    problem: IndexingProblem, course: CrankCourse, rollers: int, size: float, sized_by: SizedBy | None
) -> IndexingDesign | str:
    """Build the drive of a size, verified; the reason if it cannot be drawn."""
    drive, load = course.geneva, _build_load(problem)
    if problem.spherical:
        hemisphere = sphere.build_hemisphere(problem, size)
        if not sphere.is_drawable(problem, hemisphere):
            return NOT_DRAWABLE
        walls = {"wall": hemisphere.wall, "web": hemisphere.web, "size": 2.0 * size}
        free = hemisphere.inmost - 0.5 * problem.wheel_shaft_diameter
        mechanism: GenevaMechanism | SphericalGenevaMechanism = sphere.build_mechanism(problem, hemisphere)
    else:
        wheel = plane.build_wheel(problem, drive, size)
        if not plane.is_drawable(wheel, problem.clearances.locking):
            return NOT_DRAWABLE
        walls = {"wall": wheel.wall, "web": wheel.web, "size": plane.compute_size(problem, wheel, drive.ratio * size)}
        # A ring has no bore.
        free = math.inf if wheel.internal else wheel.slot_end - wheel.half_slot - 0.5 * problem.wheel_shaft_diameter
        mechanism = plane.build_mechanism(problem, course, wheel, rollers)
    metrics = _compute_metrics(
        problem, course, load, size, walls, undercut=free < 0.0 or walls["web"] < 0.0, sized_by=sized_by
    )
    start, end = course.start, course.end
    angle = np.linspace(start, end, PROGRAM_POINT_COUNT)
    # Samples to plot.
    motion, torque = course.motion(angle), compute_wheel_torque(course, load, angle)
    index = math.degrees(end - start)
    design = IndexingDesign(
        mechanism=mechanism,
        verification=Verification.from_checks([]),
        index_angle=index,
        dwell_share=1.0 - rollers * index / 360.0,
        program=IndexingProgram(
            angle=np.degrees(angle - start).tolist(),
            s=np.degrees(motion.s - motion.s[0]).tolist(),
            v=motion.v.tolist(),
            a=motion.a.tolist(),
            j=motion.j.tolist(),
        ),
        course=IndexingCourse(
            wheel_torque=torque.tolist(),
            drive_torque=(torque * motion.v).tolist(),
            pin_force=compute_pin_force(course, load, angle, problem.scale * size).tolist(),
        ),
        metrics=metrics,
    )
    return verify_indexing(problem, design)


def _compute_metrics(
    problem: IndexingProblem,
    course: CrankCourse,
    load: Load,
    size: float,
    walls: dict[str, float],
    *,
    undercut: bool,
    sized_by: SizedBy | None,
) -> IndexingMetrics:
    greatest, drive, link = find_peaks(course, load, problem.scale * size), course.geneva, course.link
    acceleration, at = greatest.acceleration, greatest.acceleration_at
    if link is None:
        # With a constant crank speed, the peak is known in closed form.
        at = drive.half - drive.peak_angle
        acceleration = abs(float(drive.motion(np.array(at - drive.half)).a))
    # Share of the index at nearly constant speed.
    evenly = course.motion(np.linspace(course.start, course.end, STEADY_SAMPLES)).v
    return IndexingMetrics(
        peak_velocity=greatest.velocity,
        peak_acceleration=acceleration,
        peak_acceleration_angle=math.degrees(at),
        steady_share=compute_steady_share(evenly),
        min_transmission_angle=None if link is None else math.degrees(float(link.transmission_angle)),
        peak_jerk=greatest.jerk,
        entry_speed=float(course.motion(np.array(course.start)).v),
        peak_wheel_torque=greatest.wheel_torque,
        peak_drive_torque=greatest.drive_torque,
        peak_pin_force=greatest.pin_force,
        undercut=undercut,
        locking_angle=0.0,
        play=0.0,
        sized_by=sized_by,
        **walls,
    )


def _write_summary(
    problem: IndexingProblem, sifting: CandidateLog[IndexingDesign | RatchetDesign], complete: bool
) -> str:
    best = sifting.passed[0] if sifting.passed else None
    if not isinstance(best, IndexingDesign):
        verdict = "indexing-none-exists" if complete else "indexing-none-found"
        return compose(verdict, reasons=sifting.format_reasons())
    metrics, unit = best.metrics, problem.length_unit
    size = write_quantity(f"{metrics.size:.6g}", unit)
    wheel = compose(
        "indexing-crank-drive" if problem.driver == "crank" else "indexing-drag-link-drive",
        angle=f"{best.index_angle:.6g}",
        share=f"{100.0 * best.dwell_share:.4g}",
        size=compose("indexing-drive-size", size=size)
        if metrics.sized_by is None
        else compose("indexing-smallest-drive-size", size=size, limit=write_name(metrics.sized_by)),
    )
    return append_remark(wheel, sifting.describe_reasons())
